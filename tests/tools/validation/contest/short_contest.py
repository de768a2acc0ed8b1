#!/usr/bin/env python3
"""The short contest: its aims, its table, and the same figures as `contour simulate` gives.

    short_contest.py CONTOUR ROOT
"""
import csv
import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CONTOUR, ROOT = sys.argv.pop(1), Path(sys.argv.pop(1))
FILES = ["--config", ROOT / "config" / "xy_emulated.yaml", "--contest", ROOT / "config" / "contest.yaml"]


def contour(*arguments):
    return subprocess.run([CONTOUR, *map(str, arguments)], capture_output=True, text=True, check=False)


class ShortContest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.out = Path(cls.folder.name)
        cls.result = contour("contest", "--short", *FILES, "--out", cls.out)
        with (cls.out / "results.csv").open(encoding="utf-8", newline="") as text:
            cls.rows = list(csv.DictReader(text))

    def test_full_is_never_unstable_never_far_behind_and_nearly_always_best(self):
        self.assertEqual(self.result.returncode, 0, self.result.stdout + self.result.stderr)
        self.assertEqual(self.result.stderr, "")
        self.assertIn("full is unstable in 0 ", self.result.stdout)
        self.assertIn("full is worse than twice the best in 0 ", self.result.stdout)
        near, runs = map(int, re.search(r"best in (\d+) of (\d+) runs", self.result.stdout).groups())
        self.assertEqual(near, runs, self.result.stdout)

    def test_check_turns_a_missed_aim_into_a_status(self):
        # A controller that compensates for nothing, in the place of full: behind everywhere.
        choice = ["--programs", "circle_100um", "--machines", "nominal", "--controllers", "csp", "full"]
        spoilt = ["--set", "control.full.contour_bandwidth_Hz=3", "--set", "control.full.lag_bandwidth_Hz=3",
                  "--set", "axes.x.drive.mode=cst", "--set", "axes.y.drive.mode=cst", "--set", "control.friction=srukf",
                  # So soft a loop takes long to show a frozen encoder.
                  "--set", "axes.x.limits.safe_travel_mm=90", "--set", "axes.y.limits.safe_travel_mm=90"]
        self.assertEqual(contour("contest", "--check", "--seeds", 1, *choice, *FILES, "--out", self.out / "a").returncode, 0)
        result = contour("contest", "--check", "--seeds", 1, *choice, *spoilt, *FILES, "--out", self.out / "b")
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("missed", result.stdout)

    def test_a_contest_in_pieces_is_the_same_contest(self):
        choice = ["--programs", "circle_100um", "--machines", "nominal", "--seeds", 1, *FILES]
        pieces, whole = self.out / "pieces", self.out / "whole"
        self.assertEqual(contour("contest", "--controllers", "csp", *choice, "--out", pieces).returncode, 0)
        kept = (pieces / "cells.tsv").read_text(encoding="utf-8")
        self.assertEqual(kept.count("\n"), 1)
        both = ["--controllers", "csp", "full", *choice]
        self.assertEqual(contour("contest", "--resume", *both, "--out", pieces).returncode, 0)
        self.assertTrue((pieces / "cells.tsv").read_text(encoding="utf-8").startswith(kept))
        self.assertEqual(contour("contest", *both, "--out", whole).returncode, 0)
        for name in ("results.csv", "contest.md"):
            self.assertEqual((pieces / name).read_bytes(), (whole / name).read_bytes())
        # What is kept is believed; what is to be made again is not.
        spoilt = kept.split("\t")
        spoilt[5] = "77"
        (pieces / "cells.tsv").write_text("\t".join(spoilt), encoding="utf-8")
        contour("contest", "--resume", *both, "--out", pieces)
        self.assertIn("csp,77,", (pieces / "results.csv").read_text(encoding="utf-8"))
        contour("contest", "--resume", "--again", "csp", *both, "--out", pieces)
        self.assertEqual((pieces / "results.csv").read_bytes(), (whole / "results.csv").read_bytes())
        self.assertEqual(contour("contest", "--again", "csp", *both, "--out", pieces).returncode, 2)

    def test_every_controller_ran_on_everything(self):
        self.assertEqual(len({r["controller"] for r in self.rows}), 9)
        self.assertEqual(len(self.rows), 9 * len({(r["program"], r["machine"], r["seed"]) for r in self.rows}))

    def test_a_run_is_what_simulate_gives(self):
        program = self.out / "circle.yaml"
        program.write_text("{shape: circle, radius_mm: 0.1, frequency_hz: 0.7853981634, turns: 10}", encoding="utf-8")
        for controller, mode in (("csp", "cst"), ("full", "csp")):
            result = contour("simulate", "--config", FILES[1], "--program", program, "--controller", controller,
                             "--set", f"axes.x.drive.mode={mode}", "--set", f"axes.y.drive.mode={mode}",
                             "--set", "emulator.axes.x.friction.law=maxwell_slip",
                             "--set", "emulator.axes.y.friction.law=maxwell_slip", "--seed", 1, "--out", self.out / "s")
            self.assertEqual(result.returncode, 0, result.stderr)
            metrics = json.loads((self.out / "s" / "metrics.json").read_text(encoding="utf-8"))
            row = next(r for r in self.rows if (r["program"], r["machine"], r["controller"]) ==
                       ("circle_100um", "maxwell_slip", controller))
            self.assertAlmostEqual(float(row["table_peak_um"]), metrics["contour"]["table"]["peak_um"], delta=1e-5)
            self.assertAlmostEqual(float(row["encoder_peak_um"]), metrics["contour"]["encoder"]["peak_um"], delta=1e-5)

    def test_pictures_are_drawn(self):
        script = ROOT / "tools" / "plots" / "plot_contest.py"
        result = subprocess.run([sys.executable, script, self.out], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in ("contest_nominal.png", "contest_ratio.png", "contest_spread.png"):
            self.assertEqual((self.out / name).read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def test_unknown_names_are_refused_with_the_known_ones(self):
        result = contour("contest", *FILES, "--machines", "lathe", "--out", self.out / "no")
        self.assertEqual(result.returncode, 2)
        self.assertIn("maxwell_slip", result.stderr)


if __name__ == "__main__":
    unittest.main()
