#!/usr/bin/env python3
"""unit_sizes.py finds what it is there to find, and lets pass what is right."""
import tempfile
import unittest
from pathlib import Path

import unit_sizes


def offences(text, larger=None, name="analysis/a.cc"):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, name)
        path.parent.mkdir(parents=True)
        path.write_text(text, encoding="utf-8")
        return unit_sizes.check(Path(folder), larger or {})[0]


def function(lines, head="int F(int a) {", indent=""):
    return f"{indent}{head}\n" + f"{indent}  ++a;\n" * (lines - 2) + f"{indent}}}\n"


class UnitSizes(unittest.TestCase):
    def assert_one(self, found, *words):
        self.assertEqual(len(found), 1, found)
        for word in words:
            self.assertIn(word, found[0])

    def test_what_is_small_passes(self):
        self.assertEqual(offences("#pragma once\n" + function(60) + "\n" + function(60, "int G(int a, int b, int c, int d, int e, int f) {")), [])

    def test_a_long_file(self):
        self.assertEqual(offences("// a\n" * 400), [])
        self.assert_one(offences("// a\n" * 401), "analysis/a.cc:1", "401 lines, 400 at most")

    def test_a_long_function_also_in_a_class_or_with_its_head_on_two_lines(self):
        self.assert_one(offences("\n" + function(61)), "analysis/a.cc:2", "F: 61 lines, 60 at most")
        self.assert_one(offences("class A {\n" + function(61, indent="  ") + "};\n"), "analysis/a.cc:2", "F")
        self.assert_one(offences(function(62, "int B::F(int a,\n         int b) {")), "B::F: 63 lines")

    def test_many_parameters_but_commas_inside_brackets_count_for_nothing(self):
        self.assert_one(offences(function(3, "int F(int a, int b, int c, int d, int e, int f, int g) {")), "F(): 7 parameters")
        self.assertEqual(offences(function(3, "int F(std::map<int, std::map<int, int>> a, int b, int c, int d, int e, int f = G(1, 2)) {")), [])

    def test_a_public_member_with_an_underscore(self):
        self.assert_one(offences("struct A {\n  int a_ = 0;\n};\n"), "analysis/a.cc:2", "a_")
        self.assert_one(offences("class A {\n  int b_ = 0;\n public:\n  std::vector<int> a_;\n};\n"), "analysis/a.cc:4", "a_")
        self.assertEqual(offences("class A {\n public:\n  int F() { return a_; }\n\n private:\n  int a_ = 0;\n};\n"), [])

    def test_what_is_known_may_shrink_and_not_grow_and_must_leave_the_list(self):
        known = {"analysis/a.cc:F": 70}
        self.assertEqual(offences(function(65), known), [])
        self.assert_one(offences(function(71), known), "F: 71 lines")
        self.assert_one(offences(function(20), known), "take it off the list")


if __name__ == "__main__":
    unittest.main()
