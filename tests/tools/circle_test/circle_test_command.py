#!/usr/bin/env python3
"""contour circle-test on a simulated machine whose friction is partly the motor's and whose screws wobble.

    circle_test_command.py CONTOUR SOURCE_DIR
"""
import csv
import math
import re
import subprocess
import sys
import tempfile
from pathlib import Path

SHARE = 0.3
WOBBLE_UM = 0.4
LEAD_MM, STROKE_MM = 5.0, 400.0


def run(*command, status=0):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    assert done.returncode == status, f"{command}: status {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout + done.stderr


def number(text, key):
    return float(re.search(rf"^ *{key}: (\S+)$", text, re.MULTILINE).group(1))


def ball_bar(cycles, file):
    """The radius of the table in the last turn of the circle, as a ball bar exports it, turned by one degree steps."""
    with open(cycles, encoding="utf-8") as rows:
        points = [(float(r["x_table_position_truth_m"]), float(r["y_table_position_truth_m"])) for r in
                  csv.DictReader(rows)
                  if r["x_table_position_truth_m"] and float(r["path_time_s"] or "nan") > 2.0 and
                  math.hypot(float(r["x_reference_velocity_m_s"]), float(r["y_reference_velocity_m_s"])) > 0.049]
    centre = [0.5 * (min(p[i] for p in points) + max(p[i] for p in points)) for i in (0, 1)]
    with open(file, "w", encoding="utf-8") as out:
        out.write("angle_deg;deviation_um\n")
        for x, y in points:
            angle = math.degrees(math.atan2(y - centre[1], x - centre[0]))
            out.write(f"{angle:.3f};{1e6 * (math.hypot(x - centre[0], y - centre[1]) - 0.01):.1f}\n")


def main():
    contour, source = Path(sys.argv[1]), Path(sys.argv[2])
    machine = source / "config/xy_emulated.yaml"
    emulated = []
    for axis in "xy":
        key = f"emulator.axes.{axis}."
        emulated += ["--set", f"{key}friction.motor_share_rel={SHARE}", "--set",
                     f"{key}effects.pitch_error={{amplitude_um: {WOBBLE_UM}, periods_per_stroke: {STROKE_MM / LEAD_MM}}}"]
        emulated += ["--set", f"axes.{axis}.drive.mode=csp", "--set", f"axes.{axis}.model.screw_stiffness_N_um=40"]

    def draw(out, *more):
        run(contour, "simulate", "--config", machine, "--program", source / "config/programs/circle_10mm.yaml",
            "--out", out, *emulated, *more)

    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        draw(out / "before")
        stated = out / "machine.yaml"
        # K as it is: what the file has it off by would be in the share.
        text = machine.read_text(encoding="utf-8")
        stated.write_text(re.sub(r"screw_stiffness_N_um: \d\d\S*", "screw_stiffness_N_um: 40", text), encoding="utf-8")
        cycles = out / "before/cycles.csv"
        columns = ["--table-columns", "x_table_position_truth_m", "y_table_position_truth_m"]
        said = run(contour, "circle-test", cycles, "--machine", stated, *columns, "--out", out / "scale")
        assert "share of friction before the screw" in said, said
        ball_bar(cycles, out / "bar.csv")
        run(contour, "circle-test", cycles, "--machine", stated, "--measured", out / "bar.csv", "--out", out / "bar")
        for how in ("scale", "bar"):
            for axis in "xy":
                model = (out / how / f"{axis}.yaml").read_text(encoding="utf-8")
                share = number(model, "motor_share_rel")
                assert abs(share - SHARE) < 0.06, (how, axis, share)
                assert abs(number(model, "amplitude_um") - WOBBLE_UM) < 0.08, model
                assert "lead_wobble" in model

        # Without what was measured, with half of it, and with too little of it.
        run(contour, "circle-test", cycles, "--machine", stated, "--out", out / "none", status=2)
        lines = (out / "bar.csv").read_text(encoding="utf-8").splitlines()
        (out / "part.csv").write_text("\n".join(lines[:30]) + "\n", encoding="utf-8")
        run(contour, "circle-test", cycles, "--machine", stated, "--measured", out / "part.csv", "--out",
            out / "part", status=1)
        assert not (out / "part").exists()
        said = run(contour, "circle-test", cycles, "--machine", stated, "--measured", cycles, "--out", out / "x",
                   status=2)
        assert "angle_deg" in said, said


if __name__ == "__main__":
    main()
