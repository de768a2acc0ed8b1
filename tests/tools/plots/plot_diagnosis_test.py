#!/usr/bin/env python3
"""The report of a diagnosis: every picture is drawn, the page holds them and says in words what was found.

    plot_diagnosis_test.py ROOT
"""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(sys.argv[1]).resolve()
sys.path.insert(0, str(ROOT / "tools/plots"))
from diagnosis_data import Finding  # noqa: E402


def write_finding(directory, temperature=True, causes=True, of_time=False):
    """A made-up axis with a ripple of 12 periods per turn, or a force of time, that a second model knows."""
    random = np.random.default_rng(1)
    time = np.arange(20000) * 1e-3
    position = 40 * np.sin(2 * np.pi * 0.1 * time)  # rad
    velocity = np.gradient(position, 1e-3)
    noise = 0.002 * random.standard_normal(len(time))
    ripple = 0.01 * np.sin(0.3 * time) if of_time else 0.01 * np.sin(12 * position)
    model = 0.03 * np.sign(velocity) + 1e-4 * velocity
    signals = {"time_s": time, "position": position, "velocity": velocity, "acceleration": np.gradient(velocity, 1e-3),
               "measured": model + ripple + noise, "simulated_before": model, "simulated_after": model + ripple,
               "residual_before": ripple + noise, "residual_after": noise, "scale_before": 1e-6 * np.sin(position / 40),
               "scale_after": 1e-7 * random.standard_normal(len(time)),
               "temperature_degC": 20 + time / 4 if temperature else np.array([])}
    with open(directory / "report_traces.bin", "wb") as file:
        for values in signals.values():
            np.asarray(values, float).tofile(file)
    shape = {"abscissa": "position_mm", "ordinate": "friction_rel", "x": [-30, 0, 30], "y": [-0.1, 0, 0.1], "sigma": [0.01] * 3}
    cause = {"kind": "cogging", "words": "cogging: a torque that repeats", "advice": "Feed it <forward>.",
             "parameters": [{"name": "amplitude", "value": "0.01 Nm", "low": "0.009 Nm", "high": "0.011 Nm"}],
             "evidence": 1234.5, "before": 0.0073, "after": 0.002, "gain": 0.72, "gain_low": 0.7, "gain_high": None, "unit": "Nm",
             "indistinguishable_from": ["friction_ripple"], "experiment": "Sweep.", "program": "shape: sweep", "shapes": [shape]}
    data = {"log": "log.csv", "model": "model.yaml", "linear": False, "table_per_q": 7.96e-4, "lead_m": 5e-3, "gear_ratio": 1.0,
            "rated": 0.6, "Fc": 0.03, "verdict": "cause_found" if causes else "nothing_found",
            "verdict_text": "One cause was found." if causes else "Nothing was found.", "causes": [cause] if causes else [],
            "contour_gain": {"program": "a circle", "before_um": 13.0, "after_um": 0.65} if causes else None,
            "extended_model": "out/extended_model.yaml", "false_alarm_rate": 0.05, "gate": 25.0, "not_excited": ["backlash"],
            "detectable": [{"kind": "cogging", "name": "amplitude", "size": "0.001 Nm"}],
            "candidates": [{"kind": "cogging", "score": 2000.0, "refitted": 2468.0, "accepted": True},
                           {"kind": "stribeck", "score": -3.0, "refitted": None, "accepted": False}],
            "base": [{"name": "Fc", "stated": 0.03, "fitted": 0.031, "sigma": 0.001}],
            "blocks": [[0, 10, 0.7], [10, 20, -0.1]], "notes": ["a note"],
            "quality": {"rows": 20000, "missing": 0, "stale": 1, "outliers": 2},
            "traces": [[name, len(values)] for name, values in signals.items()]}
    (directory / "report_data.json").write_text(json.dumps(data), encoding="utf-8")


def draw(directory):
    return subprocess.run([sys.executable, "-W", "error::UserWarning", ROOT / "tools/plots/plot_diagnosis.py", directory], capture_output=True, text=True)


class Units(unittest.TestCase):
    def finding(self, **data):
        with tempfile.TemporaryDirectory() as name:
            write_finding(Path(name))
            file = Path(name) / "report_data.json"
            file.write_text(json.dumps(json.loads(file.read_text(encoding="utf-8")) | data), encoding="utf-8")
            return Finding(name)

    def test_a_table_moves_in_millimetres(self):
        labels = [label for label, _ in self.finding().motion]
        self.assertEqual(labels, ["position (mm)", "velocity (mm/s)", "acceleration (m/s²)"])

    def test_an_axis_that_only_turns_has_radians(self):
        # Before: 2 rad/s of a joint were drawn as 2000 mm/s.
        f = self.finding(lead_m=0.0, table_per_q=1.0, gear_ratio=50.0)
        self.assertEqual([label for label, _ in f.motion], ["position (rad)", "velocity (rad/s)", "acceleration (rad/s²)"])
        np.testing.assert_array_equal(f.motion[1][1], f["velocity"])
        # Orders are told per turn of the motor.
        np.testing.assert_allclose(f.turns, f["position"] * 50.0 / (2 * np.pi))


class Report(unittest.TestCase):
    def test_pictures_and_page(self):
        with tempfile.TemporaryDirectory() as name:
            directory = Path(name)
            write_finding(directory)
            done = draw(directory)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stderr, "")
            pictures = {p.stem for p in directory.glob("*.png")}
            self.assertEqual(pictures, {"deciding", "overlay", "against", "shapes", "scale", "spectra", "evidence", "blocks", "correlations"})
            page = (directory / "report.html").read_text(encoding="utf-8")
            self.assertEqual(page.count("data:image/png;base64,"), 9)
            self.assertNotIn("src='http", page)
            for words in ("One cause was found.", "0.009 Nm to 0.011 Nm", "72 % less", "friction_ripple", "shape: sweep",
                          "Feed it &lt;forward&gt;.", "13 um to 0.65 um", "95 % less", "backlash", "2 outliers"):
                self.assertIn(words, page)

    def test_nothing_found(self):
        with tempfile.TemporaryDirectory() as name:
            write_finding(Path(name), temperature=False, causes=False)
            done = draw(name)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("Nothing was found.", (Path(name) / "report.html").read_text(encoding="utf-8"))

    # Before: "UserWarning: converting a masked element to nan", on the user's terminal.
    def test_what_was_visited_once_is_drawn_without_a_warning(self):
        with tempfile.TemporaryDirectory() as name:
            write_finding(Path(name), of_time=True)
            done = draw(name)
            self.assertEqual(done.stderr, "")
            self.assertEqual(done.returncode, 0)

    def test_no_data_is_said(self):
        with tempfile.TemporaryDirectory() as name:
            done = draw(name)
            self.assertEqual(done.returncode, 2)
            self.assertIn("report_data.json", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
