#!/usr/bin/env python3
"""The readers and pictures of tools/plots on made-up runs whose errors are known.

    plots_test.py ROOT
"""
import json
import math
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(sys.argv.pop(1))
sys.path.insert(0, str(ROOT / "tools" / "plots"))
import picture_circle  # noqa: E402  the path comes first
from compare_runs import table_text  # noqa: E402
from plot_corner import passage  # noqa: E402
from run_data import Run, RunError, by_program, pair  # noqa: E402

RADIUS_M = 1e-4
CYCLES_PER_TURN = 200
TURNS = 3


def write_run(directory, controller, error_m, circle=True):
    """A circle about (2 mm, -1 mm), starting at +X, whose table runs error_m outside."""
    directory.mkdir(parents=True)
    names = ["state", "path_time_s", "contour_error_m", "wakeup_late_us", "received_us", "stepped_us", "sent_us"]
    for axis in "xy":
        names += [f"{axis}_{name}" for name in ("position_m", "table_position_m", "reference_position_m", "friction_N",
                                                "friction_std_N", "table_position_truth_m", "friction_truth_N",
                                                "reference_velocity_m_s")]
    lines = [",".join(names)]
    for k in range(-5, CYCLES_PER_TURN * TURNS + 5):
        on_path = min(max(k, 0), CYCLES_PER_TURN * TURNS)
        angle = 2 * math.pi * on_path / CYCLES_PER_TURN
        state = "Running" if k == on_path else "Ready"
        row = [state, on_path * 1e-2, error_m, 30, 40, 60, 70]
        for direction, rate, centre in ((math.cos(angle), -math.sin(angle), 2e-3), (math.sin(angle), math.cos(angle), -1e-3)):
            reference = centre + RADIUS_M * direction
            table = centre + (RADIUS_M + error_m) * direction
            row += [reference, "", reference, 40.0, 0.5, table, 39.0, RADIUS_M * rate * 2 * math.pi / (CYCLES_PER_TURN * 1e-2)]
        lines.append(",".join(str(field) for field in row))
    (directory / "cycles.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    place = {"rms_um": error_m * 1e6, "peak_um": error_m * 1e6, "circular_deviation_um": 0.0 if circle else None,
             "quadrant_peak_um": [error_m * 1e6] * 4 if circle else None}
    metrics = {"controller": controller, "program": "some/where/ring.yaml", "cycle_us": 1000, "late_cycles": 3,
               "stale_cycles": 0, "contour": {"encoder": place, "table": place},
               "friction_estimate_error_rms_N": {"x": 1.0, "y": None}}
    (directory / "metrics.json").write_text(json.dumps(metrics), encoding="utf-8")
    return directory


class FolderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name)


class RunDataTest(FolderTest):
    def test_radial_error_is_the_one_that_was_put_in(self):
        run = Run(write_run(self.path / "full", "full", 3e-6))
        centre_x, centre_y, radius = run.circle()
        self.assertAlmostEqual(centre_x, 2e-3, delta=1e-12)
        self.assertAlmostEqual(centre_y, -1e-3, delta=1e-12)
        self.assertAlmostEqual(radius, RADIUS_M, delta=1e-12)
        angle, error, where = run.radial()
        self.assertEqual(where, "table")
        self.assertAlmostEqual(float(abs(error - 3e-6).max()), 0.0, delta=1e-11)
        # Two whole turns after the first; the last row closes the circle.
        self.assertAlmostEqual(len(angle), 2 * CYCLES_PER_TURN, delta=1)

    def test_the_encoder_is_shown_where_no_truth_is_known(self):
        directory = write_run(self.path / "full", "full", 3e-6)
        text = (directory / "cycles.csv").read_text(encoding="utf-8").replace("table_position_truth_m", "else")
        (directory / "cycles.csv").write_text(text, encoding="utf-8")
        _, error, where = Run(directory).radial()
        self.assertEqual(where, "encoder")
        self.assertAlmostEqual(float(abs(error).max()), 0.0, delta=1e-11)

    def test_runs_are_paired_by_their_controllers(self):
        runs = [Run(write_run(self.path / name, name, 1e-6)) for name in ("full", "mpc", "pid")]
        plain, full = pair(runs)
        self.assertEqual((plain.controller, full.controller), ("mpc", "full"))
        self.assertEqual(pair(runs[1:])[1].controller, "pid")
        self.assertEqual(list(by_program(runs)), ["ring"])

    def test_a_directory_without_a_run_is_an_error(self):
        with self.assertRaises(RunError):
            Run(self.path)

    def test_magnification_is_round_and_shows_the_error(self):
        for error_m in (1e-8, 3.3e-7, 4e-6, 9e-5):
            factor = picture_circle.magnification([error_m], RADIUS_M)
            self.assertIn(round(factor / 10 ** math.floor(math.log10(factor) + 1e-9), 6), (1, 2, 5))
            self.assertLessEqual(factor * error_m, picture_circle.SHOWN_ERROR * RADIUS_M * 1.001)
            self.assertGreater(factor * error_m, picture_circle.SHOWN_ERROR * RADIUS_M / 2.6)


class CommandTest(FolderTest):
    def command(self, *arguments):
        return subprocess.run([sys.executable, ROOT / "tools" / "plots" / arguments[0], *arguments[1:]],
                              capture_output=True, text=True, check=False)

    def test_pictures_are_drawn(self):
        runs = [write_run(self.path / "mpc", "mpc", 2e-5), write_run(self.path / "full", "full", 3e-7)]
        result = self.command("plot_run.py", *runs, "--out", self.path / "out")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr, "")
        pictures = [Path(line) for line in result.stdout.splitlines()]
        self.assertEqual({p.name for p in pictures}, {"ring_circle.png", "ring_radial_error.png",
                                                      "ring_friction_x.png", "ring_timing.png"})
        for picture in pictures:
            self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def test_other_shapes_show_the_error_over_time(self):
        run = write_run(self.path / "full", "full", 3e-7, circle=False)
        result = self.command("plot_run.py", run)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("ring_contour_error.png", result.stdout)

    def test_picture_of_a_drives_loop(self):
        lines = [{"frequency_Hz": f, "compliance_um_N": 0.03, "phase_deg": -20.0, "scatter_rel": 0.01 * f, "model_um_N": 0.031,
                  "model_phase_deg": -19.0} for f in range(3, 100)]
        drive = {"axis": "x", "sensitivity_peak": 1.6, "bandwidth_Hz": 110.0, "response": lines}
        (self.path / "x_drive.json").write_text(json.dumps(drive), encoding="utf-8")
        result = self.command("plot_drive.py", self.path / "x_drive.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater((self.path / "x_drive.png").stat().st_size, 10000)
        del drive["response"]
        (self.path / "x_drive.json").write_text(json.dumps(drive), encoding="utf-8")
        self.assertEqual(self.command("plot_drive.py", self.path / "x_drive.json").returncode, 2)

    def test_a_corner_is_drawn_at_the_passage_asked_for(self):
        runs = [write_run(self.path / name, "full", 3e-7) for name in ("stop", "blend")]
        top = [-0.1, 0.1]  # a quarter of a turn after the start
        self.assertEqual([int(passage(Run(runs[0]), top, n)) for n in (1, 2, 3)], [50, 250, 450])
        picture = self.path / "corner.png"
        result = self.command("plot_corner.py", *runs, "--corner-mm", *map(str, top), "--out", picture)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        result = self.command("plot_corner.py", *runs, "--corner-mm", *map(str, top), "--passage", "4", "--out", picture)
        self.assertEqual(result.returncode, 2)
        self.assertIn("passed 3 times", result.stderr)

    def test_wrong_directories_and_axes_are_named(self):
        result = self.command("plot_run.py", self.path / "nowhere")
        self.assertEqual(result.returncode, 2)
        self.assertIn("nowhere", result.stderr)
        run = write_run(self.path / "full", "full", 3e-7)
        self.assertEqual(self.command("plot_run.py", run, "--axis", "q").returncode, 2)

    def test_table_has_a_row_per_run(self):
        runs = [write_run(self.path / "mpc", "mpc", 2e-5), write_run(self.path / "full", "full", 3e-7)]
        result = self.command("compare_runs.py", *runs)
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = result.stdout.splitlines()
        self.assertIn("ring", lines[0])
        self.assertRegex(lines[3], r"^mpc +real time +20 ")
        self.assertRegex(lines[4], r"^full +real time +0\.3 .*1 / -$")
        self.assertEqual(table_text([]), "")


if __name__ == "__main__":
    unittest.main()
