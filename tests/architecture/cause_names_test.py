#!/usr/bin/env python3
"""cause_names.py finds what it is there to find, and lets pass what is right."""
import tempfile
import unittest
from pathlib import Path

import cause_names

HOME = cause_names.CAUSES


def found(**files):
    """Offences in a tree with two causes and the given files; __ in a key stands for / and a trailing _cc for the suffix."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        tree = {f"{HOME}/cause_list.inc": "// All.\nCAUSE(cogging)\nCAUSE(pitch_error)\nOUTSIDE(force_of_time)\n",
                f"{HOME}/cogging.cc": 'constexpr std::string_view kName = "cogging";\n',
                f"{HOME}/pitch_error.cc": 'constexpr std::string_view kName = "pitch_error";\n',
                f"{HOME}/outside_force_of_time.cc": 'constexpr std::string_view kName = "outside:force of time";\n',
                **{page: "`cogging`, `pitch_error`\n" for page in cause_names.PAGES}}
        for key, text in files.items():
            stem, suffix = key.replace("__", "/").rsplit("_", 1)
            tree[f"{stem}.{suffix}"] = text
        for file, text in tree.items():
            path = root / file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return cause_names.check(root)[0]


class CauseNames(unittest.TestCase):
    def test_the_right_tree_passes(self):
        self.assertEqual(found(
            analysis__diagnosis__report__text_cc='// "cogging" in a comment\nout += "a cogging motor: cogging";\ne.cogging = 1;\n',
            tools__plant_emulator__effects_config_h='v.Optional("cogging", cogging, "detent torque");\n'), [])

    def test_a_literal_elsewhere_is_caught_with_file_and_line(self):
        offences = found(analysis__diagnosis__decision__score_threshold_cc='int a;\nif (kind == "cogging") return 1.0;\n')
        self.assertEqual(len(offences), 1, offences)
        self.assertIn("analysis/diagnosis/decision/score_threshold.cc:2", offences[0])

    def test_as_part_of_a_key_it_is_one_too(self):
        self.assertEqual(len(found(tools__validation__hidden__a_cc='Set("effects.cogging.amplitude_Nm=1");\n')), 1)

    def test_in_the_file_of_another_cause_too(self):
        offences = found(analysis__diagnosis__causes__pitch_error_cc=
                         'constexpr std::string_view kName = "pitch_error";\nif (other == "cogging") return;\n')
        self.assertEqual(len(offences), 1, offences)

    def test_an_enumerator_is_caught(self):
        self.assertEqual(len(found(analysis__diagnosis__a_h="enum class Kind { kCogging, kPitchError };\n")), 2)

    def test_a_file_that_is_not_in_the_list_is_caught(self):
        offences = found(analysis__diagnosis__causes__backlash_cc='constexpr std::string_view kName = "backlash";\n')
        self.assertEqual(len(offences), 1, offences)
        self.assertIn("not in", offences[0])

    def test_a_name_that_is_not_the_files_is_caught(self):
        self.assertEqual(len(found(analysis__diagnosis__causes__cogging_cc='constexpr std::string_view kName = "coging";\n')), 1)

    def test_a_page_without_it_is_caught(self):
        offences = found(docs__diagnosis_md="`cogging`\n")
        self.assertEqual(offences, ["docs/diagnosis.md: says nothing of `pitch_error`"])


if __name__ == "__main__":
    unittest.main()
