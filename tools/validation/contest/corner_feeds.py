#!/usr/bin/env python3
"""The highest feed at which polygons are drawn within a tolerance: with corners blended, at full feed, and with stops.

    corner_feeds.py CONTOUR --config FILE [--tolerance-mm P] [--side-mm L] [--turns N] [--feeds F...] [--seeds N...]
                    [--kinds KIND...] [--controller NAME] [--set KEY=VALUE...]

Runs `contour simulate` for every shape, kind of corner, feed and seed, and prints the worst contour error at the table
against the programmed path, the time it took, and the highest feed up to which the tolerance was kept at every feed.
Exit status: 0 the blended corners kept it at every feed, 1 they did not, 2 bad usage.
"""
import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

SHAPES = ("square", "diamond")
BLENDED = "blended"


def corners(kind, tolerance_mm):
    return f"corner_tolerance_mm: {tolerance_mm}" if kind == BLENDED else f"corners: {kind}"


def simulate(arguments, program, seed, out):
    """Metrics of one run; where there are none, what happened: "refused", or "stopped" by the machine."""
    command = [arguments.contour, "simulate", "--config", arguments.config, "--program", program, "--seed", str(seed),
               "--controller", arguments.controller, "--out", out]
    for assignment in arguments.set:
        command += ["--set", assignment]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    refusals = ("is not reached within one turn", "is beyond the limit of")
    if result.returncode == 2 and any(refusal in result.stderr for refusal in refusals):
        return "refused"
    if result.returncode == 1 and "quick stop" in result.stderr:
        return "stopped"
    if result.returncode != 0:
        raise SystemExit(f"corner_feeds.py: {' '.join(map(str, command))}: {result.stderr.strip()}")
    return json.loads((Path(out) / "metrics.json").read_text(encoding="utf-8"))


def worst(arguments, shape, kind, feed, folder):
    """Largest error in um and time in s over the seeds, or "refused" or "stopped"."""
    program = Path(folder) / "program.yaml"
    program.write_text(f"{{shape: {shape}, side_mm: {arguments.side_mm}, feed_mm_min: {feed}, turns: {arguments.turns}, "
                       f"{corners(kind, arguments.tolerance_mm)}}}\n", encoding="utf-8")
    runs = [simulate(arguments, program, seed, folder) for seed in arguments.seeds]
    for run in runs:
        if isinstance(run, str):
            return run
    return (max(run["contour"]["table"]["peak_um"] for run in runs),
            max(run["cycles"] * run["cycle_us"] * 1e-6 for run in runs))


def highest(results, tolerance_mm):
    """The last feed before the tolerance was exceeded or there was no run to its end; None when that was the first one."""
    kept = None
    for feed, result in results:
        if isinstance(result, str) or result[0] > 1e3 * tolerance_mm:
            break
        kept = feed
    return kept


def row(shape, kind, results, tolerance_mm):
    cells = [result if isinstance(result, str) else f"{result[0]:.2f} / {result[1]:.2f}" for _, result in results]
    feed = highest(results, tolerance_mm)
    return f"| {shape} | {kind} | {' | '.join(cells)} | {'none' if feed is None else f'{feed:g}'} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("contour", help="the program contour")
    parser.add_argument("--config", required=True, help="machine file with an emulator: section")
    parser.add_argument("--tolerance-mm", type=float, default=0.005)
    parser.add_argument("--side-mm", type=float, default=10.0)
    parser.add_argument("--turns", type=int, default=15)
    parser.add_argument("--feeds", type=float, nargs="+", default=[500, 1000, 2000, 3000, 4500, 6000, 9000, 12000],
                        help="mm/min, rising")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3, 4, 5])
    parser.add_argument("--kinds", nargs="+", choices=[BLENDED, "velocity_jump", "exact_stop"],
                        default=[BLENDED, "velocity_jump", "exact_stop"])
    parser.add_argument("--controller", default="full")
    parser.add_argument("--set", nargs="+", default=[], metavar="KEY=VALUE", help="on top of the machine file")
    arguments = parser.parse_args()

    print(f"largest contour error in um / time in s; {arguments.side_mm:g} mm, {arguments.turns} turns, tolerance "
          f"{1e3 * arguments.tolerance_mm:g} um, {arguments.controller}, seeds {' '.join(map(str, arguments.seeds))}")
    print(f"| shape | corners | {' | '.join(f'{feed:g} mm/min' for feed in arguments.feeds)} | kept up to, mm/min |")
    print("|---" * (len(arguments.feeds) + 3) + "|")
    kept = True
    with tempfile.TemporaryDirectory() as folder:
        for shape in SHAPES:
            for kind in arguments.kinds:
                results = [(feed, worst(arguments, shape, kind, feed, folder)) for feed in arguments.feeds]
                print(row(shape, kind, results, arguments.tolerance_mm), flush=True)
                if kind == BLENDED:
                    kept = kept and highest(results, arguments.tolerance_mm) == arguments.feeds[-1]
    return 0 if kept else 1


if __name__ == "__main__":
    sys.exit(main())
