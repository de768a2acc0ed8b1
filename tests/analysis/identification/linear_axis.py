#!/usr/bin/env python3
"""`contour identify` takes a linear axis from a model with nothing but its mass; of a log without motion it writes nothing,
with status 1 and the reason.

    linear_axis.py CONTOUR
"""
import math
import subprocess
import sys
import tempfile
from pathlib import Path


def identify(contour, work, rows):
    (work / "log.csv").write_text("time_s,force_N,position_m\n" + "".join(f"{t:.3f},{f:.6f},{x:.9f}\n" for t, f, x in rows), encoding="utf-8")
    (work / "model.yaml").write_text("mass_kg: 70\n", encoding="utf-8")
    return subprocess.run([contour, "identify", work / "log.csv", "--model", work / "model.yaml", "--out", work / "out.yaml"],
                          capture_output=True, text=True)


def carriage():
    """95 kg, 20 N and 200 N s/m under a loop of its own, 20 s at 1 kHz."""
    x = v = 0.0
    for k in range(20000):
        t = 1e-3 * k
        wanted = 0.2 * math.sin(1.1 * t) + 0.05 * math.sin(9.0 * t)
        force = 3000.0 * (wanted - v) + 0.5 * math.sin(977.0 * t)
        yield t, force, round(x / 5e-8) * 5e-8
        for _ in range(10):
            v += 1e-4 * (force - 20.0 * math.tanh(v / 1e-4) - 200.0 * v) / 95.0
            x += 1e-4 * v


def main():
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        done = identify(sys.argv[1], work, ((1e-3 * k, 0.0, 0.0) for k in range(5000)))
        if done.returncode != 1 or "no model was written" not in done.stderr + done.stdout or "Traceback" in done.stderr:
            if done.returncode != 2 or "does not move" not in done.stderr:
                sys.exit(f"status {done.returncode}\n{done.stdout}{done.stderr}")
        if (work / "out.yaml").exists():
            sys.exit("a model was written")
        done = identify(sys.argv[1], work, carriage())
        text = (work / "out.yaml").read_text(encoding="utf-8") if (work / "out.yaml").exists() else ""
        mass = [float(line.split(":")[1]) for line in text.splitlines() if line.strip().startswith("mass_kg:")]
        if done.returncode != 0 or not mass or abs(mass[0] - 95.0) > 2.0:
            sys.exit(f"status {done.returncode}, mass {mass}\n{done.stdout}{done.stderr}")
        # Its own output is a model to begin from.
        (work / "model.yaml").write_text(text, encoding="utf-8")
        again = subprocess.run([sys.argv[1], "identify", work / "log.csv", "--model", work / "model.yaml", "--out", work / "again.yaml"],
                               capture_output=True, text=True)
        if again.returncode != 0:
            sys.exit(f"its own output: status {again.returncode}\n{again.stdout}{again.stderr}")


if __name__ == "__main__":
    main()
