#!/usr/bin/env python3
"""`contour identify` of a ball screw from tables of other people: a log with a sign turned round or in other
units is refused with the numbers, and nothing is written.

    screw_log.py CONTOUR
"""
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools/real_axes"))
from generator import Axis, run, strokes  # noqa: E402

MODEL = """model:
  lead_mm: 10
  motor_inertia_kgm2: 1.5e-4
  table_mass_kg: 30
  screw_stiffness_N_um: 200
  screw_damping_Ns_m: 2000
  friction: {Fs_plus_N: 20, Fs_minus_N: 20, Fc_plus_N: 19, Fc_minus_N: 19, vs_mm_s: 2, sigma0_N_m: 5e6, sigma1_Ns_m: 2000, sigma2_Ns_m: 150}
drive: {encoder_counts_per_rev: 65536}
"""


def identify(contour, work, rows, columns=""):
    (work / "log.csv").write_text("time_s,torque_Nm,motor_angle_rad\n" + "".join(f"{t:.6f},{u:.9f},{q:.9f}\n" for t, u, q in rows), encoding="utf-8")
    (work / "model.yaml").write_text(MODEL, encoding="utf-8")
    (work / "out.yaml").unlink(missing_ok=True)
    done = subprocess.run([contour, "identify", work / "log.csv", "--model", work / "model.yaml", "--out", work / "out.yaml",
                           *(["--columns", columns] if columns else [])], capture_output=True, text=True)
    if (work / "out.yaml").exists() != (done.returncode == 0):
        sys.exit(f"status {done.returncode} and a model that does not go with it")
    return done


def expect(what, done, status, said):
    if done.returncode != status or said not in done.stdout + done.stderr:
        sys.exit(f"{what}: status {done.returncode}, expected {status} and {said!r}\n{done.stdout}{done.stderr}")


def main():
    contour, rows = sys.argv[1], run(Axis(), strokes(60.0, 1), 30.0)
    headers = "torque_Nm=torque_Nm{},position_rad=motor_angle_rad{}"
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        # Strokes alone say too little of the masses; that is another complaint, and comes later.
        expect("as it is", identify(contour, work, rows), 1, "raise the limits")
        expect("a sign turned round", identify(contour, work, rows, headers.format("*-1", "")), 1, "opposite signs")
        expect("mN m", identify(contour, work, rows, headers.format("*1000", "")), 1, "times more than the model states")
        expect("degrees", identify(contour, work, rows, headers.format("", "*57.3")), 1, "times less than the model states")


if __name__ == "__main__":
    main()
