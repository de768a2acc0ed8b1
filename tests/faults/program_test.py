#!/usr/bin/env python3
"""contour_faults as a user sees it: exit status, files, the command that repeats a failed run, the picture.

    program_test.py CONTOUR_FAULTS ROOT
"""
import csv
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = sys.argv[1]
ROOT = Path(sys.argv[2]).resolve()

# What holds on the example machine whatever the seed; the full form is in tools/nightly.
SHORT = ("feedback_frame_lost,feedback_frames_lost,feedback_frame_late,feedback_frame_twice,position_bit_low,status_bit_enabled,"
         "setpoints_lost,heartbeats_lost,bus_down,flood_burst,flood,drive_restarts,drive_leaves_operational,drive_drops_out,"
         "drive_fault,log_blocked")


def run(*options):
    return subprocess.run([PROGRAM, *options], capture_output=True, text=True, cwd=ROOT)


class Program(unittest.TestCase):
    def test_wrong_words_end_with_2_and_are_named(self):
        for options, word in (
            (("--only", "encoder_frozen,nonsense"), "nonsense"),
            (("--mode", "velocity"), "velocity"),
            (("--without", "nobody"), "nobody"),
            (("--shard", "3/3"), "3/3"),
            (("--runs", "0"), "--runs"),
            (("--config", "no_such_file.yaml"), "no_such_file.yaml"),
            (("--nonsense",), "--nonsense"),
        ):
            result = run(*options)
            self.assertEqual(result.returncode, 2, options)
            self.assertIn(word, result.stderr)

    def test_lists_what_there_is(self):
        result = run("--list")
        self.assertEqual(result.returncode, 0)
        for word in ("encoder_frozen", "reversal", "stale_feedback"):
            self.assertIn(word, result.stdout)

    def test_what_goes_on_ends_with_0_and_leaves_its_files_and_picture(self):
        with tempfile.TemporaryDirectory() as out:
            result = run("--only", "feedback_frame_lost,log_blocked", "--runs", "8", "--out", out)
            self.assertEqual(result.returncode, 0, result.stdout)
            self.assertEqual(result.stderr, "", "quiet in a pipe")
            with open(Path(out) / "runs.csv", newline="", encoding="utf-8") as text:
                self.assertEqual(len(list(csv.DictReader(text))), 8)
            drawn = subprocess.run([sys.executable, ROOT / "tools/plots/plot_faults.py", out], capture_output=True, text=True)
            self.assertEqual(drawn.returncode, 0, drawn.stderr)
            self.assertGreater((Path(out) / "faults.png").stat().st_size, 10000)

    def test_the_short_campaign_holds(self):
        result = run("--only", SHORT, "--runs", "100")
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertIn("100 runs", result.stdout)

    def test_without_a_supervisor_it_ends_with_1_and_says_how_to_repeat_that(self):
        result = run("--without", "stale_feedback", "--only", "feedback_frames_lost,constant", "--feed", "200", "--runs", "2")
        self.assertEqual(result.returncode, 1, result.stdout)
        command = re.search(r"^  contour_faults (.*)$", result.stdout, re.MULTILINE)
        again = run(*command.group(1).split())
        self.assertEqual(again.returncode, 1)
        wrong = re.search(r"^feedback_frames_lost.*: .*$", result.stdout, re.MULTILINE).group(0)
        self.assertIn(wrong, again.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
