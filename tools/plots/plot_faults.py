#!/usr/bin/env python3
"""Draws the runs.csv of `contour_faults --out DIR`: faults.png, each fault's departures against what was promised.

    plot_faults.py DIR [--out DIR]
"""
import argparse
import csv
import sys
from pathlib import Path

import style

SMALLEST_MM = 1e-5


class Fault:
    """The runs of one fault: departure and bound in mm, failed or not."""

    def __init__(self, name):
        self.name = name
        self.runs = []

    def add(self, row):
        departure = max(float(row["departure_mm"]), SMALLEST_MM)
        self.runs.append((departure, float(row["departure_bound_mm"]), bool(row["violations"])))

    def worst(self):
        """The run with the largest share of its bound."""
        return max(self.runs, key=lambda run: run[0] / run[1])


def read(file):
    faults = {}
    with open(file, encoding="utf-8", newline="") as text:
        for row in csv.DictReader(text):
            if float(row["departure_bound_mm"]) <= 0:
                continue
            faults.setdefault(row["fault"], Fault(row["fault"])).add(row)
    if not faults:
        raise ValueError(f"{file}: no rows")
    return list(faults.values())


def draw(pyplot, faults):
    figure, axes = pyplot.subplots(figsize=(10, 1.2 + 0.22 * len(faults)))
    for row, fault in enumerate(faults):
        held = [run[0] for run in fault.runs if not run[2]]
        failed = [run[0] for run in fault.runs if run[2]]
        axes.plot(held, [row] * len(held), ".", color=style.COMPENSATED, alpha=0.25, markersize=4)
        axes.plot(failed, [row] * len(failed), "x", color=style.PLAIN, markersize=5)
        departure, bound, _ = fault.worst()
        axes.plot([departure], [row], "o", color=style.COMPENSATED, markersize=5, fillstyle="none")
        axes.plot([bound], [row], "|", color=style.TRUTH, markersize=12, markeredgewidth=2)
    axes.plot([], [], ".", color=style.COMPENSATED, label="a run")
    axes.plot([], [], "x", color=style.PLAIN, label="a run with a broken invariant")
    axes.plot([], [], "o", color=style.COMPENSATED, fillstyle="none", label="nearest to its bound")
    axes.plot([], [], "|", color=style.TRUTH, markersize=12, markeredgewidth=2, label="bound of that run")
    axes.set_xscale("log")
    axes.set_yticks(range(len(faults)), [fault.name for fault in faults], fontsize=8)
    axes.invert_yaxis()
    axes.set_xlabel("departure from the commanded path until the torque is off, mm")
    axes.legend(loc="lower left", fontsize=8, ncols=2, bbox_to_anchor=(0, 1))
    return figure


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("directory", type=Path)
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    out = options.out or options.directory
    try:
        faults = read(options.directory / "runs.csv")
    except (OSError, ValueError, KeyError) as error:
        print(f"plot_faults: {error}", file=sys.stderr)
        return 2
    style.apply()
    out.mkdir(parents=True, exist_ok=True)
    figure = draw(style.pyplot, faults)
    figure.savefig(out / "faults.png")
    print(f"wrote {out / 'faults.png'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
