#!/usr/bin/env python3
"""tools/validation/contest/corner_feeds.py: what it says of corners with a tolerance, and its exit status.

    corner_feeds_test.py CONTOUR ROOT
"""
import subprocess
import sys
import unittest
from pathlib import Path

CONTOUR, ROOT = sys.argv.pop(1), Path(sys.argv.pop(1))


def corner_feeds(*arguments):
    command = [sys.executable, ROOT / "tools" / "validation" / "contest" / "corner_feeds.py", CONTOUR, "--config",
               ROOT / "config" / "xy_emulated.yaml", "--turns", "2", "--seeds", "1", *arguments]
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)


def rows(result):
    """Cells of the table by shape and kind of corner."""
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in result.stdout.splitlines()[3:]]
    return {(cells[0], cells[1]): cells[2:] for cells in lines}


class CornerFeeds(unittest.TestCase):
    def test_blended_corners_keep_the_tolerance_in_less_time_than_stops(self):
        result = corner_feeds("--feeds", 2000, 3000, "--kinds", "blended", "exact_stop")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        table = rows(result)
        for shape in ("square", "diamond"):
            for blended, stopping in zip(table[shape, "blended"][:2], table[shape, "exact_stop"][:2]):
                error_um, time_s = map(float, blended.split(" / "))
                self.assertLess(error_um, 5.0)
                self.assertGreater(error_um, 2.0)  # uses the tolerance, rather than keep far below it
                self.assertLess(time_s, float(stopping.split(" / ")[1]))
            self.assertEqual(table[shape, "blended"][2], "3000")

    def test_a_missed_tolerance_is_a_status(self):
        # Without compensation of friction nothing is kept.
        result = corner_feeds("--feeds", 3000, "--kinds", "blended", "--controller", "mpc")
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertEqual(rows(result)["square", "blended"][1], "none")

    def test_a_feed_beyond_the_limits_is_named(self):
        result = corner_feeds("--feeds", 30000, "--kinds", "velocity_jump")
        self.assertEqual(rows(result)["square", "velocity_jump"], ["refused", "none"], result.stderr)

    def test_a_wrong_machine_file_is_an_error(self):
        result = corner_feeds("--feeds", 3000, "--set", "axes.x.limits.velocity_mm_s=fast")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("velocity_mm_s", result.stderr)


if __name__ == "__main__":
    unittest.main()
