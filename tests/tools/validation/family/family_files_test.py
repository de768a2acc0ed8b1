#!/usr/bin/env python3
"""The family's files: they are what the tables say, their drives keep their margins, and `contour check` takes them.

    family_files_test.py CONTOUR ROOT

CONTOUR_LONG_TESTS=1 in the environment: every file in both modes with both models, as tools/nightly has it; else one of the four
for each file, in turn.
"""
import csv
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CONTOUR, ROOT = sys.argv.pop(1), Path(sys.argv.pop(1))
TOOLS = Path("tools") / "validation" / "family"
# A toothed belt, and a screw whose mode lies below 90 Hz, may be refused with torques; with the drive's loop nothing may.
MAY_BE_REFUSED_IN_CST = {"belt", "slow40"}


def python(*arguments):
    return subprocess.run([sys.executable, *map(str, arguments)], capture_output=True, text=True, check=False)


class FamilyFiles(unittest.TestCase):
    def test_files_are_what_the_tables_say(self):
        result = python(ROOT / TOOLS / "make_family.py", "--check")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_a_changed_table_is_noticed(self):
        with tempfile.TemporaryDirectory() as folder:
            copy = Path(folder)
            shutil.copytree(ROOT / TOOLS, copy / TOOLS)
            shutil.copytree(ROOT / "config" / "family", copy / "config" / "family")
            self.assertEqual(python(copy / TOOLS / "make_family.py", "--check").returncode, 0)
            table = copy / TOOLS / "machines.csv"
            table.write_text(table.read_text(encoding="utf-8").replace("t50,5,5e-5,50", "t50,5,5e-5,51"), encoding="utf-8")
            result = python(copy / TOOLS / "make_family.py", "--check")
            self.assertEqual(result.returncode, 1)
            self.assertIn("config/family/t50.yaml", result.stdout)
            self.assertNotIn("t30", result.stdout)
            self.assertEqual(python(copy / TOOLS / "make_family.py").returncode, 0)
            self.assertEqual(python(copy / TOOLS / "make_family.py", "--check").returncode, 0)

    def test_files_elsewhere_may_have_the_near_models(self):
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "family"
            self.assertEqual(python(ROOT / TOOLS / "make_family.py", "--out", out, "--model", "near").returncode, 0)
            self.assertIn("model: near/t30_x.yaml", (out / "t30.yaml").read_text(encoding="utf-8"))
            result = subprocess.run([CONTOUR, "check", out / "t30.yaml"], capture_output=True, text=True, check=False)
            self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(python(ROOT / TOOLS / "make_family.py", "--model", "near").returncode, 2)

    def test_drives_keep_their_margins(self):
        result = python(ROOT / TOOLS / "drive_gains.py", "--check")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_a_drive_without_margin_is_noticed(self):
        with tempfile.TemporaryDirectory() as folder:
            with (ROOT / TOOLS / "drive_gains.csv").open(encoding="utf-8", newline="") as text:
                rows = list(csv.DictReader(text))
            for key in ("position_gain_1_s", "velocity_gain_1_s"):
                rows[0][key] = 2 * float(rows[0][key])
            stiff = Path(folder) / "stiff.csv"
            with stiff.open("w", encoding="utf-8", newline="") as text:
                writer = csv.DictWriter(text, rows[0].keys())
                writer.writeheader()
                writer.writerows(rows)
            self.assertEqual(python(ROOT / TOOLS / "drive_gains.py", "--check", "--out", stiff).returncode, 1)

    def test_check_takes_them(self):
        every = bool(os.environ.get("CONTOUR_LONG_TESTS"))
        for number, file in enumerate(sorted((ROOT / "config" / "family").glob("*.yaml"))):
            for mode in ("cst", "csp") if every else (("cst", "csp")[number % 2],):
                near = [f"axes.{axis}.model=near/{file.stem}_{axis}.yaml" for axis in "xy"]
                for which in ("loop", "scale_loop"):
                    loop = file.parent / "near" / f"{file.stem}_{which}.yaml"
                    if loop.exists():
                        near += [f"axes.{axis}.{which}={loop.read_text(encoding='utf-8').splitlines()[1]}" for axis in "xy"]
                for more in ([], near) if every else (([], near)[number // 2 % 2],):
                    sets = [f"axes.{axis}.drive.mode={mode}" for axis in "xy"] + more
                    result = subprocess.run([CONTOUR, "check", file, *(part for s in sets for part in ("--set", s))], capture_output=True,
                                            text=True, check=False)
                    if mode == "cst" and file.stem in MAY_BE_REFUSED_IN_CST:
                        self.assertIn(result.returncode, (0, 2), result.stderr)
                    else:
                        self.assertEqual(result.returncode, 0, f"{file} {sets}: {result.stderr}")


if __name__ == "__main__":
    unittest.main()
