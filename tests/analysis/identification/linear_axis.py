#!/usr/bin/env python3
"""`contour identify` says plainly that it does not take linear axes, with status 2; it writes nothing.

    linear_axis.py CONTOUR
"""
import subprocess
import sys
import tempfile
from pathlib import Path


def main():
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        (work / "model.yaml").write_text("mass_kg: 95\nfriction: {Fc_plus_N: 20, Fc_minus_N: 20, sigma2_Ns_m: 200}\n", encoding="utf-8")
        rows = "".join(f"{k * 1e-3:.3f},0,0\n" for k in range(50))
        (work / "log.csv").write_text("time_s,force_N,position_m\n" + rows, encoding="utf-8")
        done = subprocess.run([sys.argv[1], "identify", work / "log.csv", "--model", work / "model.yaml", "--out", work / "out.yaml"],
                              capture_output=True, text=True)
        if done.returncode != 2 or "linear axis" not in done.stderr or "contour diagnose" not in done.stderr:
            sys.exit(f"status {done.returncode}\n{done.stdout}{done.stderr}")
        if (work / "out.yaml").exists():
            sys.exit("a model was written")


if __name__ == "__main__":
    main()
