#!/usr/bin/env python3
"""unit_tests.py finds what it is there to find, and lets pass what is right."""
import tempfile
import unittest
from pathlib import Path

import unit_tests

UNIT, TEST, LIST = "analysis/a/b.cc", "tests/analysis/a/b_test.cc", "tests/analysis/a/CMakeLists.txt"
GOOD = {UNIT: "int b;\n", TEST: "TEST(B, Works) {}\n", LIST: "contour_test(a_test SOURCES b_test.cc)\n"}


def offences(files, without=frozenset(), shared=None):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return unit_tests.check(Path(folder), set(without), shared or {})[0]


class UnitTests(unittest.TestCase):
    def assert_one(self, found, words):
        self.assertEqual(len(found), 1, found)
        self.assertIn(words, found[0])

    def test_a_unit_with_its_test_passes(self):
        self.assertEqual(offences(GOOD), [])

    def test_a_unit_without_a_test_is_found(self):
        self.assert_one(offences({UNIT: ""}), f"{UNIT}: has no test {TEST}")

    def test_a_test_that_tests_nothing_or_is_not_built_is_none(self):
        self.assert_one(offences({**GOOD, TEST: "// TEST(\n"}), "without TEST")
        self.assert_one(offences({**GOOD, LIST: ""}), "no CMakeLists.txt builds")

    def test_a_test_of_nothing_that_is_there_is_found_where_nothing_builds_it(self):
        self.assert_one(offences({**GOOD, "tests/analysis/a/gone_test.cc": "TEST(Gone, Is) {}\n"}), "gone_test.cc: no CMakeLists.txt builds")

    def test_the_list_of_exceptions_shrinks(self):
        self.assertEqual(offences({UNIT: ""}, without=[UNIT]), [])
        self.assert_one(offences(GOOD, without=[UNIT]), "must leave WITHOUT")
        self.assert_one(offences(GOOD, without=["analysis/gone.cc"]), "is gone")
        self.assertEqual(offences({UNIT: ""}, without=["analysis/a/"]), [])
        self.assert_one(offences(GOOD, without=["analysis/a/"]), "must leave WITHOUT")

    def test_a_shared_test_counts(self):
        self.assertEqual(offences({**GOOD, "analysis/a/c.cc": ""}, shared={"analysis/a/c.cc": TEST}), [])


if __name__ == "__main__":
    unittest.main()
