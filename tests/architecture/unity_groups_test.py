#!/usr/bin/env python3
"""cmake/unity_groups.py: sources that are compiled together mean what each means alone.

    unity_groups_test.py ROOT COMPILER
"""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT, COMPILER = Path(sys.argv.pop(1)), sys.argv.pop(1)
sys.path.insert(0, str(ROOT / "cmake"))
sys.dont_write_bytecode = True
import unity_groups  # noqa: E402

MAIN = "int A();\nint B();\nint main() { return 10 * A() + B(); }\n"


class UnityGroups(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = Path(self.folder.name)

    def groups(self, *texts):
        names = []
        for number, text in enumerate(texts):
            path = self.root / f"{'abcdefghijklmnop'[number]}.cc"
            path.write_text(text, encoding="utf-8")
            names.append(str(path))
        return unity_groups.groups_of([unity_groups.Source(name) for name in names])

    def status(self, *texts):
        """What the program ends with that is made of the groups."""
        files = [self.root / "main.cc"]
        files[0].write_text(MAIN, encoding="utf-8")
        for number, group in enumerate(self.groups(*texts)):
            files.append(self.root / f"together_{number}.cc")
            files[-1].write_text(unity_groups.text_of(group, self.root), encoding="utf-8")
        program = self.root / "program"
        subprocess.run([COMPILER, "-std=c++20", "-Wall", "-Wextra", "-Wshadow", "-Werror", f"-I{self.root}", "-o", program, *files], check=True)
        return subprocess.run([program], check=False).returncode

    def assert_apart(self, *texts):
        self.assertEqual(len(self.groups(*texts)), len(texts))

    def test_names_that_two_files_have_for_themselves_stay_two(self):
        one = "namespace {\nconstexpr int kPart = 2;\nint Part(int x) { return kPart + x; }\n}  // namespace\nint A() { return Part(0); }\n"
        other = "namespace {\nconstexpr int kNone = 0, kPart = 3;\nint Part(int x) { return kPart + x + kNone; }\n}  // namespace\nint B() { return Part(1); }\n"
        self.assertEqual(len(self.groups(one, other)), 1)
        self.assertEqual(self.status(one, other), 24)

    def test_a_file_s_own_name_hides_no_other_file_s_function(self):
        (self.root / "part.h").write_text("#pragma once\ninline int Part(double) { return 7; }\n", encoding="utf-8")
        one = "namespace {\nint Part(int x) { return x; }\n}  // namespace\nint A() { return Part(2); }\n"
        other = '#include "part.h"\nint B() { return Part(1); }\n'
        self.assertEqual(len(self.groups(one, other)), 1)
        self.assertEqual(self.status(one, other), 27)  # not 21, as one text after the other would have it

    def test_what_others_link_keeps_its_name(self):
        one = "namespace {\nint Part() { return 1; }\n}  // namespace\nint Shared() { return 3; }\nint A() { return Part(); }\n"
        other = "int Shared();\nint B() { return Shared(); }\n"
        self.assertEqual(len(self.groups(one, other)), 1)
        self.assertEqual(self.status(one, other), 13)

    def test_names_that_cannot_be_given_anew_keep_files_apart(self):
        fixture = "namespace {\nclass Rig {};\nTEST_F(Rig, Works) {}\n}  // namespace\n"  # the test would be called otherwise
        self.assert_apart(fixture, "class Rig {};\n")
        member = "namespace {\nint Size() { return 1; }\nint Of(const Box& b) { return b.Size() + Size(); }\n}  // namespace\n"
        self.assert_apart(member, "int C() { return Size(); }\n")
        self.assert_apart("#define LIMIT 3\n", "constexpr int LIMIT = 3;\n")
        self.assert_apart("static int size() { return 1; }\n", "int C() { return size(); }\n")

    def test_a_using_is_imposed_on_nobody(self):
        self.assert_apart("using Eigen::Index;\n", "int Index();\n")
        self.assert_apart("using namespace std;\n", "int C();\n")
        self.assertEqual(len(self.groups("using Eigen::Index;\nIndex a;\n", "using Eigen::Index;\nIndex b;\n")), 1)

    def test_includes_under_a_condition_stay_under_it(self):
        self.assert_apart("#ifdef __AVX__\n#include <immintrin.h>\n#endif\n", "int C();\n")

    def test_groups_have_an_end(self):
        self.assertEqual([len(group) for group in self.groups(*["int f();\n"] * (unity_groups.MOST_SOURCES + 1))],
                         [unity_groups.MOST_SOURCES, 1])
        self.assert_apart("\n" * unity_groups.MOST_LINES, "int f();\n")


if __name__ == "__main__":
    unittest.main()
