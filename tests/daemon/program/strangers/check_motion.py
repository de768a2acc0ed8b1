#!/usr/bin/env python3
"""Programs of strangers through `contour simulate`, judged by what the cycle was asked for and where the table was.

    check_motion.py CONTOUR MACHINE_FILE [--seeds FROM TO] [--kinds KIND...] [--mode cst csp] [--set KEY=VALUE] [--table]

Velocity, acceleration and jerk by differences of *_reference_position_m from cycle to cycle, against axes.*.limits of the machine file;
distances of reference and table from the programmed path, which is read from `contour check --canon` and from nothing else. Fails where a
limit is exceeded by more than 2 %, or the reference leaves the tolerance; with --table also where the table does.
"""
import argparse
import csv
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import yaml

import cam_programs
from programmed_path import MACHINE, ProgrammedPath

LIMITS_KEPT = 1.02
ROUNDING_UM = 0.05    # of decimals in `--canon`, and of chords for arcs


def columns(file, names):
    with open(file, newline="") as stream:
        rows = csv.reader(stream)
        header = next(rows)
        at = [header.index(n) for n in names]
        return np.array([[float(row[i]) for i in at] for row in rows])


def machine_of(contour, file, sets):
    with open(file, encoding="utf-8") as stream:
        machine = yaml.safe_load(stream)
    for s in sets:
        key, value = s.split("=", 1)
        node = machine
        *path, last = key.split(".")
        for k in path:
            node = node.setdefault(k, {})
        node[last] = yaml.safe_load(value)
    return machine


def own_tolerance_mm(contour, file, sets):
    """What the machine file means where a program states no tolerance."""
    check = subprocess.run([contour, "check", str(file), *[w for s in sets for w in ("--set", s)]], capture_output=True, text=True).stdout
    return float(re.search(r"tolerance ([0-9.e-]+) mm where a program states none", check).group(1))


def judge(contour, file, machine, program, folder, sets):
    """Ratios to the limits, distances beyond the tolerance in um, and the time that the motion took."""
    axes = list(machine["axes"])
    canon = subprocess.run([contour, "check", "--canon", str(program)], check=True, capture_output=True, text=True).stdout
    out = folder / "run"
    done = subprocess.run([contour, "simulate", "--config", str(file), "--program", str(program), "--out", str(out),
                           *[w for s in sets for w in ("--set", s)]], capture_output=True, text=True)
    if done.returncode != 0:
        return {"refused": (done.stderr or done.stdout).strip().splitlines()[-1]}
    names = [f"{a}_{c}" for c in ("reference_position_m", "table_position_truth_m") for a in axes]
    rows = columns(out / "cycles.csv", names)
    n = len(axes)
    reference, table = rows[:, :n], rows[:, n:]
    period_s = 1e-6 * machine["machine"].get("cycle_us", 1000)
    result = {}
    for order, key in ((1, "velocity_mm_s"), (2, "acceleration_mm_s2"), (3, "jerk_mm_s3")):
        differences = np.abs(np.diff(reference, order, axis=0)) / period_s**order
        limits = np.array([machine["axes"][a]["limits"].get(key, 0) or np.inf for a in axes]) * 1e-3
        result[key.split("_")[0]] = float((differences / limits).max())
    moving = np.nonzero(np.any(np.diff(reference, axis=0) != 0, axis=1))[0]
    if len(moving) == 0:
        return {"refused": "it does not move"}
    first, last = moving[0], moving[-1] + 2
    result["seconds"] = (last - first) * period_s
    path = ProgrammedPath(canon, axes)
    zero = reference[0]
    own_mm = own_tolerance_mm(contour, file, sets)
    slack_um = ROUNDING_UM + 1e3 * path.off_radius
    for name, points in (("reference", reference), ("table", table)):
        distance, around = path.distances(1e3 * (points[first:last] - zero))
        allowed = np.where(around == MACHINE, own_mm, around).max(axis=0)
        beyond_um = 1e3 * (distance - allowed) - slack_um
        result[name + "_beyond"] = float(beyond_um.max())
        result[name + "_um"] = float(1e3 * distance.max())
        result["tolerance_um"] = float(1e3 * allowed.min())
    return result


def naive_um(text):
    """Largest Q of a program: within it LinuxCNC joins moves."""
    largest = 0.0
    for line in text.lower().replace(" ", "").replace("\t", "").splitlines():
        if "g64" in line and "q" in line:
            number = line.split("q", 1)[1].strip()
            largest = max(largest, float(number) * (25.4e3 if "g20" in text.lower() else 1e3))
    return largest


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("contour")
    parser.add_argument("machine")
    parser.add_argument("--seeds", nargs=2, type=int, default=[1, 1])
    parser.add_argument("--kinds", nargs="+", default=None)
    parser.add_argument("--mode", nargs="+", default=["cst"])
    parser.add_argument("--set", nargs="+", default=[], action="extend")
    parser.add_argument("--table", action="store_true", help="the table has to keep the tolerance, too")
    options = parser.parse_args()
    plain = machine_of(options.contour, options.machine, options.set)
    kinds = options.kinds or [k for k in cam_programs.KINDS if len(plain["axes"]) > 2 or k not in cam_programs.IN_SPACE]
    failed, worst, beyond, count = 0, np.zeros(5), 0, 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for seed in range(options.seeds[0], options.seeds[1] + 1):
            for number, kind in enumerate(kinds):
                mode = options.mode[(seed + number) % len(options.mode)]
                sets = options.set + [f"axes.{a}.drive.mode={mode}" for a in plain["axes"]]
                file = folder / "program.ngc"
                text = cam_programs.program(kind, seed)
                file.write_bytes(text.encode())
                r = judge(options.contour, options.machine, plain, file, folder, sets)
                name = f"{kind} {seed} {mode}"
                if "refused" in r:
                    print(f"{name:26} {r['refused']}")
                    failed += 1
                    continue
                # What LinuxCNC joins within Q is off by Q, beside arcs by a quarter more.
                for k in ("reference_beyond", "table_beyond"):
                    r[k] -= 1.25 * naive_um(text)
                limits = [r["velocity"], r["acceleration"], r["jerk"]]
                good = max(limits) <= LIMITS_KEPT and r["reference_beyond"] <= 0
                table_kept = r["table_beyond"] <= 0
                count, beyond = count + 1, beyond + (not table_kept)
                failed += not (good and (table_kept or not options.table))
                worst = np.maximum(worst, [*limits, r["table_beyond"], r["table_um"] - r["reference_um"]])
                print(f"{name:26} {r['seconds']:7.2f} s, limits {limits[0]:.3f} {limits[1]:.3f} {limits[2]:.3f}, "
                      f"tolerance from {r['tolerance_um']:5.1f} um, reference off by {r['reference_um']:6.2f}, table {r['table_um']:6.2f} um"
                      + ("" if good else "  <- BEYOND") + ("" if table_kept else f"  table beyond by {r['table_beyond']:.2f} um"), flush=True)
    print(f"{count} programs: limits at most {worst[0]:.3f} {worst[1]:.3f} {worst[2]:.3f}; the table beyond the tolerance in {beyond}, "
          f"by {max(0.0, worst[3]):.2f} um at most, further off than its reference by {worst[4]:.2f} um at most; {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
