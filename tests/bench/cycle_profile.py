#!/usr/bin/env python3
"""Where the instructions of a two-axis cycle with `full` go, counted by callgrind cycle by cycle: a table in Markdown.

    cycle_profile.py PROBE MACHINE_FILE [--mode cst|csp ...] [--cycles N]
"""
import argparse
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

# The first that fits a function's name has its instructions.
GROUPS = [
    ("friction preview", r"FrictionRoll|ReferenceTerms|PreviewFriction"),
    ("learning beside the filter", r"MomentumBalance|AngleForceMap|WindUpFit|LearnWindUp|KnownEffects"),
    ("filter, time update", r"::TimeUpdate|SevenStateModel::Propagate\(contour::SigmaPoints"),
    ("filter, rest", r"SevenState|AxisEstimator|Sqrt"),
    ("MPC, solver", r"Riccati|QpSolver"),
    ("MPC, feed-forward and weights", r"FlatFeedforward|PathWeights|MpcGroup|MpcLaw|CascadeLaw|ControlLaw|CspLaw"),
    ("path and planner", r"PathFollower|Planner|ContourController"),
    ("contour error", r"FindContourError|ContourPath|RecordContourError"),
    ("drives, guard, records", r""),
]
# Callgrind takes the same pattern for two purposes as one.
STEP = "contour::(anonymous namespace)::MeasuredStep*"
SITUATIONS = ["rest", "motion", "reversal"]


def groups_of_part(path):
    """Instructions by group in one dump of callgrind; only a function's own, calls are counted where they end."""
    names, counts = {}, dict.fromkeys([name for name, _ in GROUPS], 0)
    group, skip = None, False
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.startswith("fn="):
            found = re.match(r"fn=\((\d+)\)(?: (.*))?", line)
            if found.group(2):
                names[found.group(1)] = found.group(2)
            name = names[found.group(1)]
            group = next(label for label, pattern in GROUPS if re.search(pattern, name))
        elif line.startswith("cfn="):
            found = re.match(r"cfn=\((\d+)\)(?: (.*))?", line)
            if found.group(2):
                names[found.group(1)] = found.group(2)
        elif line.startswith("calls="):
            skip = True
        elif re.match(r"[+\-*\d]\S* \d+$", line) and group is not None:
            if not skip:
                counts[group] += int(line.split()[1])
            skip = False
    return counts


def profile(probe, machine_file, mode, cycles):
    with tempfile.TemporaryDirectory() as directory:
        out = Path(directory) / "out"
        result = subprocess.run(
            ["valgrind", "--tool=callgrind", "--toggle-collect=contour::*MeasuredStep*", f"--dump-after={STEP}",
             f"--callgrind-out-file={out}", probe, mode, str(cycles), machine_file],
            capture_output=True, text=True, check=False)
        if result.returncode != 0:
            sys.exit(result.stderr[-2000:])
        situations = result.stdout.split()
        return [(situation, groups_of_part(Path(f"{out}.{k + 1}"))) for k, situation in enumerate(situations)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("probe")
    parser.add_argument("machine_file")
    parser.add_argument("--mode", nargs="+", default=["cst", "csp"], choices=["cst", "csp"])
    parser.add_argument("--cycles", type=int, default=900)
    args = parser.parse_args()
    columns = []
    for mode in args.mode:
        steps = profile(args.probe, args.machine_file, mode, args.cycles)
        for situation in SITUATIONS:
            columns.append((f"{mode}, {situation}", [groups for found, groups in steps if found == situation]))
    print("| mean (most) | " + " | ".join(title for title, _ in columns) + " |")
    print("|---" * (len(columns) + 1) + "|")
    for label in [name for name, _ in GROUPS] + ["all"]:
        cells = []
        for _, steps in columns:
            counts = [sum(groups.values()) if label == "all" else groups[label] for groups in steps]
            cells.append(f"{statistics.mean(counts):.0f} ({max(counts)})" if counts else "")
        print(f"| {label} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
