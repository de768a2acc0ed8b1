#!/usr/bin/env python3
"""compare_diagnoses.py sees every difference and no other, with two programs that only pretend to diagnose.

    compare_diagnoses_test.py ROOT
"""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(sys.argv.pop(1)).resolve()
# Answers with what its own file says: the log's path is argument 2, the result's follows --json.
PRETENDS = """#!/bin/sh
case=$(basename "$(dirname "$2")")
[ "$case" != broken ] || { echo "cannot read" >&2; exit 1; }
while [ "$1" != --json ]; do shift; done
cat "$0.$case" > "$2"
"""


class CompareDiagnoses(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = Path(self.folder.name)

    def program(self, name, **answers):
        path = self.root / name
        path.write_text(PRETENDS, encoding="utf-8")
        path.chmod(0o755)
        for case, text in answers.items():
            Path(f"{path}.{case}").write_text(text, encoding="utf-8")
        return path

    def compare(self, old, new, *options, cases=("one", "two")):
        for case in cases:
            (self.root / "archive" / case).mkdir(parents=True, exist_ok=True)
            for file in ("log.csv", "model.yaml"):
                (self.root / "archive" / case / file).write_text("", encoding="utf-8")
        run = subprocess.run([sys.executable, ROOT / "tools/validation/compare_diagnoses.py", self.root / "archive", old, new, *options],
                             capture_output=True, text=True, check=False)
        return run.returncode, run.stdout

    def test_equal_answers(self):
        same = {"one": '{"verdict": "cause_found"}', "two": "{}"}
        code, text = self.compare(self.program("old", **same), self.program("new", **same))
        self.assertEqual(code, 0, text)
        self.assertIn("2 cases, 0 differ", text)

    def test_another_number_is_named_with_its_place(self):
        old = self.program("old", one='{"causes": [{"gain": 1.0}]}', two="{}")
        new = self.program("new", one='{"causes": [{"gain": 1.0000001}]}', two="{}")
        code, text = self.compare(old, new)
        self.assertEqual(code, 1, text)
        self.assertIn("one: causes[0].gain: 1.0, now 1.0000001", text)
        self.assertEqual(self.compare(old, new, "--within", "1e-6")[0], 0)

    def test_another_word_a_missing_key_and_another_length_are_never_within(self):
        old = self.program("old", one='{"verdict": "ambiguous", "a": 1, "list": [1]}', two="{}")
        new = self.program("new", one='{"verdict": "unexplained", "list": []}', two="{}")
        code, text = self.compare(old, new, "--within", "0.5")
        self.assertEqual(code, 1, text)
        for found in ("one: a: only in old", "one: list: 1 elements, now 0", "one: verdict: 'ambiguous', now 'unexplained'"):
            self.assertIn(found, text)

    def test_the_same_written_differently_is_not_byte_equal(self):
        old, new = self.program("old", one='{"a": 1}', two="{}"), self.program("new", one='{"a":1}', two="{}")
        code, text = self.compare(old, new)
        self.assertEqual(code, 1, text)
        self.assertIn("written differently", text)

    def test_what_cannot_be_diagnosed_counts_as_a_result(self):
        old = self.program("old", broken="{}")
        code, text = self.compare(old, self.program("new", broken="{}"), cases=("broken",))
        self.assertEqual(code, 0, text)

    def test_what_was_kept_is_not_made_again(self):
        same = {"one": "{}", "two": "{}"}
        old, new, keep = self.program("old", **same), self.program("new", **same), self.root / "keep"
        self.assertEqual(self.compare(old, new, "--keep", keep)[0], 0)
        old.unlink()
        self.assertEqual(self.compare(old, new, "--keep", keep)[0], 0)

    def test_only_some_cases(self):
        old, new = self.program("old", one="{}", two="{}"), self.program("new", one="{}", two='{"a": 1}')
        self.assertEqual(self.compare(old, new, "--only", "o*")[0], 0)
        self.assertEqual(self.compare(old, new, "--only", "none")[0], 2)


if __name__ == "__main__":
    unittest.main()
