#!/usr/bin/env python3
"""The loops of the family's machines in torque mode, with a linear scale both, as `contour tune --from-model` finds them: loops.csv.

    tune_loops.py CONTOUR                 searches all of them and writes loops.csv; make_family.py puts them into the files
    tune_loops.py CONTOUR --check [NAME...]
                                          exit 1 when a search finds another loop than stands in loops.csv, or in config/*.yaml

A search takes about ten seconds. Both axes of a machine have one loop: they differ in their friction's directions only, which the search does
not look at. A machine without a row has no loop that keeps its limits.
"""
import argparse
import csv
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import make_family

LOOPS = make_family.HERE / "loops.csv"
KEYS = ["regulator_Hz", "windup_weight", "velocity_weight", "disturbance_Hz", "motor_force_Hz", "table_force_Hz", "notch_ratio",
        "notch_pole_damping", "notch_zero_damping", "scale_noise_ratio", "bias_Hz"]
EXAMPLES = ["xy_emulated", "xy_vcan", "single_axis", "xyz_emulated"]


def found_loops(contour, file, *more):
    """By axis, what the search finds: `loop`, and of an axis with a linear scale `scale_loop`; without those that keep no limits."""
    run = subprocess.run([contour, "tune", "--from-model", file, *more], capture_output=True, text=True, check=False)
    if run.returncode not in (0, 1):
        sys.exit(f"{file}: contour tune ended with {run.returncode}: {run.stderr}")
    loops = {}
    for block in re.split(r"(?m)^axis ", run.stdout)[1:]:
        of_axis = loops.setdefault(block.partition(":")[0], {})
        for which, text in re.findall(r"(?m)^\s+axes\.\w+\.(scale_loop|loop):\n((?:\s+\w+: [-+.e\d]+\n?)+)", block):
            numbers = dict(re.findall(r"(\w+): ([-+.e\d]+)", text))
            of_axis[which] = {key: numbers[key] for key in KEYS}
    return loops


def search(contour, names):
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for model in ("catalogue", "near"):
            out = Path(folder) / model
            (out / "near").mkdir(parents=True)
            for path, text in make_family.files(out, model == "near", with_loops=False):
                path.write_text(text, encoding="utf-8")
            for name in names:
                found = found_loops(contour, out / f"{name}.yaml", "--axis", "x")["x"]
                print(f"{name}, {model}: {found or 'none'}", flush=True)
                rows += [{"name": name, "model": model, "key": key, **numbers} for key, numbers in found.items()]
    return rows


def examples_differ(contour, names):
    wrong = []
    for name in names:
        path = make_family.ROOT / "config" / f"{name}.yaml"
        text = path.read_text(encoding="utf-8")
        found = [loops.get("loop", {}) for loops in found_loops(contour, path).values()]
        stated = [dict(re.findall(r"(?m)^\s+(\w+): ([-+.e\d]+)$", block)) for block in re.findall(r"(?m)^    loop:\n((?:      .*\n)+)", text)]
        if [{k: float(v) for k, v in s.items()} for s in stated] != [{k: float(v) for k, v in f.items()} for f in found]:
            wrong.append(f"config/{name}.yaml: another loop is found than stands there: {found}")
    return wrong


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("contour")
    arguments.add_argument("--check", action="store_true")
    arguments.add_argument("names", nargs="*")
    options = arguments.parse_args()
    machines = [row["name"] for row in make_family.read(make_family.HERE / "machines.csv")]
    names = [n for n in machines if not options.names or n in options.names]
    rows = search(options.contour, names)
    if not options.check:
        with LOOPS.open("w", encoding="utf-8", newline="") as out:
            writer = csv.DictWriter(out, ["name", "model", "key", *KEYS], lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
        return 0
    stated = [row for row in make_family.read(LOOPS) if row["name"] in names]
    wrong = [f"{row['name']}, {row['model']}, {row['key']}: only found, or other than stated" for row in rows if row not in stated]
    wrong += [f"{row['name']}, {row['model']}, {row['key']}: only stated, or other than found" for row in stated if row not in rows]
    wrong += examples_differ(options.contour, [n for n in EXAMPLES if not options.names or n in options.names])
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
