#!/usr/bin/env python3
"""diagnosis_thresholds.py finds what it is there to find, and lets pass what is right."""
import tempfile
import unittest
from pathlib import Path

import diagnosis_thresholds

ENTRY = """#pragma once
/// Numbers of a stage.
struct StageTuning {
  /// [rows] A bin with fewer says nothing.
  /// Source: reasoning. 2026-11-22
  double fewest_rows = 20.0;
  /// [of the size] Tried. Source: archive. 2026-11-22
  std::array<double, 3> sizes = {0.15, 0.5, 1.5};
};
inline constexpr StageTuning kStage;

/// Twice as many.
constexpr double More() { return 2 * kStage.fewest_rows; }
"""
USE = "double F() { return kStage.fewest_rows + kStage.sizes[0]; }\n"
HEADER = "stage_tuning.h"


def found(tuning=ENTRY, use=USE, page=None, by_hand=4, below=0):
    """Offences in a tree with one struct and one file that uses it."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for file, text in {f"{diagnosis_thresholds.TUNING}/{HEADER}": tuning,
                           f"{diagnosis_thresholds.DIAGNOSIS}/decision/use.cc": use,
                           f"{diagnosis_thresholds.DIAGNOSIS}/causes/cause.cc": "double grid = 17.0;\n",
                           "tools/none.cc": "", diagnosis_thresholds.PAGE: ""}.items():
            (root / file).parent.mkdir(parents=True, exist_ok=True)
            (root / file).write_text(text, encoding="utf-8")
        (root / diagnosis_thresholds.PAGE).write_text(
            diagnosis_thresholds.markdown(root) if page is None else page, encoding="utf-8")
        return diagnosis_thresholds.check(root, by_hand, below)[0]


class DiagnosisThresholds(unittest.TestCase):
    def assert_one(self, offences, *words):
        self.assertEqual(len(offences), 1, offences)
        for word in words:
            self.assertIn(word, offences[0])

    def test_the_right_tree_passes(self):
        self.assertEqual(found(), [])

    def test_a_literal_outside_the_tuning_is_caught_with_file_and_line(self):
        for literal in ("0.3", "25.0", "1e-4", "3", "5e2F", "0x40", "1'500"):
            with self.subTest(literal):
                self.assert_one(found(use=USE + f"bool G(double x) {{ return x > {literal}; }}\n"), "decision/use.cc:2", literal)

    def test_what_is_no_threshold_passes(self):
        self.assertEqual(found(use=USE + '// 0.3\nconst char* t = "0.3 mm";\ndouble a2 = -1.0 * b3 + 0.5 * 1e-3 / 1e-300;\n'), [])

    def test_what_one_file_may_have_another_may_not(self):
        self.assertEqual(diagnosis_thresholds.NO_THRESHOLDS["rounds.cc"]["0.2"], "progress")
        self.assertEqual(list(diagnosis_thresholds.offences_in(f"{diagnosis_thresholds.DIAGNOSIS}/rounds.cc", "x = 0.2;\n")), [])
        self.assert_one(found(use=USE + "double x = 0.2;\n"), "0.2")

    def test_an_entry_without_unit_reason_source_or_date_is_caught(self):
        for whole, part in ((" 2026-11-22\n  double", "\n  double"), ("[rows] ", ""), (" Source: archive.", ""), (" A bin with fewer says nothing.", "")):
            with self.subTest(whole):
                self.assert_one(found(tuning=ENTRY.replace(whole, part, 1)), f"{diagnosis_thresholds.TUNING}/{HEADER}:", "say")

    def test_an_entry_that_nobody_uses_is_caught(self):
        self.assert_one(found(use="double F() { return kStage.fewest_rows; }\n"), "sizes", "nobody uses it")

    def test_one_more_constant_than_allowed_is_caught(self):
        self.assert_one(found(by_hand=3), "4 constants are set by hand, 3 at most")
        self.assert_one(found(tuning=ENTRY.replace("0.5, 1.5", "1.0, 2.0"), by_hand=1), "2 constants are set by hand, 1 at most")

    def test_a_page_that_says_something_else_is_caught(self):
        self.assert_one(found(page="# Thresholds\n"), diagnosis_thresholds.PAGE)

    def test_the_page_has_every_entry_and_what_is_computed(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, diagnosis_thresholds.TUNING, HEADER)
            path.parent.mkdir(parents=True)
            path.write_text(ENTRY, encoding="utf-8")
            page = diagnosis_thresholds.markdown(Path(folder))
        self.assertIn("| `fewest_rows` | 20.0 | rows | A bin with fewer says nothing. | reasoning | 2026-11-22 |", page)
        self.assertIn("| `sizes` | 0.15, 0.5, 1.5 | of the size | Tried. | archive | 2026-11-22 |", page)
        self.assertIn("| `More` | `2 * kStage.fewest_rows` | Twice as many. |", page)
        self.assertIn("Set by hand: 4 numbers other than", page)


if __name__ == "__main__":
    unittest.main()
