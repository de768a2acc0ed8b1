#!/usr/bin/env python3
"""Replays the reference inputs and compares what the cycle computes with the tables in reference/.

    reference.py CONTOUR [--exact | --tolerance SHARE] [--write]

Each table is one controller's: every 60th cycle in full precision, and a checksum over all cycles and quantities, so that
every numeric change shows as a diff. --write accepts what is computed now (see docs/replay.md).
"""
import argparse
import csv
import difflib
import hashlib
import lzma
import subprocess
import sys
import tempfile
from pathlib import Path

REFERENCE = Path(__file__).resolve().parent / "reference"
# Controller, and the recording whose inputs it gets. The drives are configured for torque or for position.
CONTROLLERS = {"full": "torque", "mpc": "torque", "mpc_observer": "torque", "mpc_srukf4": "torque", "mpc_ekf7": "torque",
               "mpc_srukf7": "torque", "pid": "torque", "csp": "position"}
EVERY = 60
MACHINE_COLUMNS = ["cycle", "state", "reason", "path_time_s", "contour_error_m", "solver_iterations"]
AXIS_COLUMNS = ["motor_angle_rad", "torque_Nm", "wanted_torque_Nm", "feedforward_torque_Nm", "estimated_velocity_m_s",
                "friction_N", "friction_std_N", "bristle_N", "g_plus_N", "disturbance_N", "innovation_m", "limit"]


def computed(contour, controller, directory):
    """The table of a controller as lines of text."""
    log = directory / f"{controller}.lcmlog"
    log.write_bytes(lzma.decompress((REFERENCE / f"{CONTROLLERS[controller]}.lcmlog.xz").read_bytes()))
    table = directory / f"{controller}.csv"
    # Another controller than the one that ran asks for another torque than the one that moved the axes: nothing is to be made of that.
    loose = ["--set", "control.monitor.reported_torque_error_rel=1"]
    for axis in ("x", "y"):
        loose += ["--set", f"axes.{axis}.limits.external_force_N=5e3", "--set", f"axes.{axis}.limits.safe_travel_mm=100"]
    run = subprocess.run([contour, "replay", str(log), "--set", f"machine.controller={controller}", *loose, "--table", str(table)],
                         capture_output=True, text=True, check=False)
    if run.returncode != 0:
        sys.exit(f"contour replay {log.name} ended with {run.returncode}: {run.stdout}{run.stderr}"
                 "If the log's format has changed, record the inputs again: tests/replay/rerecord --inputs")
    text = table.read_bytes()
    rows = list(csv.DictReader(text.decode().splitlines()))
    columns = MACHINE_COLUMNS + [f"{axis}_{name}" for axis in ("x", "y") for name in AXIS_COLUMNS]
    lines = [",".join(columns)]
    lines += [",".join(row[name] for name in columns) for row in rows if int(row["cycle"]) % EVERY == 0]
    lines.append(f"# all {len(rows)} cycles: sha256 {hashlib.sha256(text).hexdigest()}")
    return lines


def largest_differences(was, now):
    """Per column: largest difference as a share of the column's largest value, and the cycle; texts count as infinite."""
    columns = was[0].split(",")
    if now[0] != was[0] or len(was) != len(now):
        return {"the shape of the table": (float("inf"), 0)}
    rows = [(a.split(","), b.split(",")) for a, b in zip(was[1:-1], now[1:-1])]
    found = {}
    for i, name in enumerate(columns):
        worst, where, scale = 0.0, 0, 0.0
        for a, b in rows:
            try:
                difference, scale = abs(float(a[i]) - float(b[i])), max(scale, abs(float(a[i])))
            except ValueError:
                difference = 0.0 if a[i] == b[i] else float("inf")
            if difference > worst:
                worst, where = difference, a[0]
        if worst > 0.0:
            found[name] = (worst / scale if scale > 0.0 else float("inf"), where)
    return found


def compare(controller, was, now, tolerance):
    """Whether a table is as it was; says what is not."""
    if was == now:
        return True
    differences = largest_differences(was, now)
    if tolerance is not None and all(share <= tolerance for share, _ in differences.values()):
        return True
    print(f"-- {controller}: the cycle computes something else")
    for name, (share, where) in sorted(differences.items(), key=lambda item: -item[1][0])[:8]:
        print(f"   {name}: by {share:.3g} of its largest value, at cycle {where}")
    if not differences:
        print("   not in the rows shown, but in others")
    diff = list(difflib.unified_diff(was, now, "reference", "now", lineterm="", n=0))
    print(*(line[:200] for line in diff[:8]), sep="\n")
    return False


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("contour")
    parser.add_argument("--tolerance", type=float, help="share of a column's largest value; default: every bit counts")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    same = True
    with tempfile.TemporaryDirectory() as directory:
        for controller in CONTROLLERS:
            file = REFERENCE / f"{controller}.csv"
            now = computed(arguments.contour, controller, Path(directory))
            if arguments.write:
                file.write_text("\n".join(now) + "\n", encoding="utf-8")
            else:
                same = compare(controller, file.read_text(encoding="utf-8").splitlines(), now, arguments.tolerance) and same
    if not same:
        print("If that is meant: tests/replay/rerecord, look at the diff, and commit it with the change.")
        sys.exit(1)
    print(f"{len(CONTROLLERS)} controllers: " + ("written" if arguments.write else "as recorded"))


if __name__ == "__main__":
    main()
