#!/usr/bin/env python3
"""`contour identify` of strokes that shake nothing says nothing of the screw: how much of the mass is the motor's, and the
stiffness, are as unsure as they were, and a warning says what shows more.

    open_screw.py CONTOUR ROOT
"""
import subprocess
import sys
import tempfile
from pathlib import Path

STROKES = """sequence:
  - {shape: line, dx_mm: -20, feed_mm_min: 6000}
  - {shape: creep, axis: x, stroke_mm: 40, velocities_mm_s: [40, 100]}
  - {shape: line, dx_mm: 20, feed_mm_min: 6000}
  - {shape: reversals, axis: x, amplitudes_mm: [0.005, 0.05, 1], frequency_hz: 1}
"""
# As the model of the machine file states them.
STATED = {"motor_inertia_kgm2": 0.05, "table_mass_kg": 0.05, "screw_stiffness_N_um": 0.1}


def main():
    contour, machine = sys.argv[1], Path(sys.argv[2]) / "config/single_axis.yaml"
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        (work / "strokes.yaml").write_text(STROKES, encoding="utf-8")
        for arguments in (["simulate", "--config", machine, "--program", work / "strokes.yaml", "--out", work / "run"],
                          ["identify", work / "run/cycles.csv", "--axis", "x", "--model", machine, "--out", work / "x.yaml"]):
            done = subprocess.run([contour, *map(str, arguments)], capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"{arguments[0]}: status {done.returncode}\n{done.stdout}{done.stderr}")
        if "warning: nothing of the screw showed" not in done.stdout:
            sys.exit(f"no warning\n{done.stdout}")
        uncertainty = (work / "x.yaml").read_text(encoding="utf-8").partition("\nuncertainty:\n")[2]
        pairs = (line.partition(":") for line in uncertainty.partition("\nextensions:")[0].splitlines())
        found = {key.strip(): float(value) for key, _, value in pairs}
        errors = [f"{key}: {found.get(key)}, expected {least} at least" for key, least in STATED.items() if found.get(key, 0.0) < least]
        if errors:
            sys.exit("\n".join(errors) + "\n" + uncertainty)


if __name__ == "__main__":
    main()
