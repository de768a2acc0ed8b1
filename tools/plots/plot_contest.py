#!/usr/bin/env python3
"""Draws the results.csv of `contour contest --out DIR`: contest_nominal.png, contest_ratio.png and contest_spread.png.

    plot_contest.py DIR [--out DIR]
"""
import argparse
import csv
import math
import statistics
import sys
from pathlib import Path

import numpy

import style

LARGEST_RATIO = 4.0


class Results:
    """Peak error at the table in um by (program, machine, controller): a list over the seeds; inf when stopped."""

    def __init__(self, rows):
        self.peaks = {}
        self.programs, self.machines, self.controllers = [], [], []
        for row in rows:
            key = (row["program"], row["machine"], row["controller"])
            for name, known in zip(key, (self.programs, self.machines, self.controllers)):
                if name not in known:
                    known.append(name)
            self.peaks.setdefault(key, []).append(float(row["table_peak_um"] or math.inf))

    def median(self, program, machine, controller):
        values = self.peaks.get((program, machine, controller))
        return statistics.median_high(values) if values else math.nan

    def best_rival(self, program, machine):
        rivals = [self.median(program, machine, c) for c in self.controllers if c != "full"]
        return min((r for r in rivals if not math.isnan(r)), default=math.nan)


def read(file):
    with open(file, encoding="utf-8", newline="") as text:
        results = Results(csv.DictReader(text))
    if not results.peaks:
        raise ValueError(f"{file}: no rows")
    return results


def nominal(pyplot, results):
    """Every controller on the first machine."""
    machine = results.machines[0]
    figure, axes = pyplot.subplots(figsize=(11, 4.8))
    width = 0.8 / len(results.controllers)
    colours = pyplot.get_cmap("viridis")(numpy.linspace(0.1, 0.9, len(results.controllers)))
    for i, controller in enumerate(results.controllers):
        values = [results.median(p, machine, controller) for p in results.programs]
        shown = [v if math.isfinite(v) else math.nan for v in values]
        colour = style.COMPENSATED if controller == "full" else colours[i]
        if controller == "mpc":
            colour = style.PLAIN
        axes.bar(numpy.arange(len(values)) + (i - len(results.controllers) / 2 + 0.5) * width, shown, width,
                 label=style.LABELS.get(controller, controller), color=colour)
    axes.set_yscale("log")
    axes.set_xticks(range(len(results.programs)), results.programs, rotation=20, ha="right")
    axes.set_ylabel("largest contour error at the table / um")
    axes.set_title(f"Every controller, machine {machine}, median of the seeds (no bar: the machine stopped)")
    axes.grid(axis="x", visible=False)
    axes.legend(ncols=2, fontsize=8)
    return figure


def ratio(pyplot, results):
    """`full` over the best rival, a square per program and machine."""
    table = numpy.array([[results.median(p, m, "full") / results.best_rival(p, m) for p in results.programs]
                         for m in results.machines])
    figure, axes = pyplot.subplots(figsize=(1.6 + 1.05 * len(results.programs), 1.9 + 0.36 * len(results.machines)))
    limit = math.log2(LARGEST_RATIO)
    logarithm = numpy.log2(numpy.where(numpy.isfinite(table), table, 1e9))
    image = axes.imshow(numpy.clip(logarithm, -limit, limit), cmap="RdBu_r", vmin=-limit, vmax=limit, aspect="auto")
    for (row, column), value in numpy.ndenumerate(table):
        text = f"{value:.2f}" if math.isfinite(value) else "stopped"
        dark = abs(min(max(logarithm[row, column], -limit), limit)) > 0.65 * limit
        axes.text(column, row, text, ha="center", va="center", fontsize=8, color="white" if dark else "black")
    axes.set_xticks(range(len(results.programs)), results.programs, rotation=25, ha="right", fontsize=8)
    axes.set_yticks(range(len(results.machines)), results.machines, fontsize=8)
    axes.grid(visible=False)
    axes.set_title("full over the best rival: largest error at the table, median of the seeds")
    bar = figure.colorbar(image, ax=axes, shrink=0.8)
    ticks = numpy.arange(-limit, limit + 0.5)
    bar.set_ticks(ticks, labels=[f"{2.0 ** t:g}" for t in ticks])
    return figure


def spread(pyplot, results):
    """Each controller over the best of its run: how often within what factor."""
    figure, axes = pyplot.subplots(figsize=(8, 4.8))
    best = {}
    for (program, machine, _), values in results.peaks.items():
        for i, value in enumerate(values):
            best[program, machine, i] = min(value, best.get((program, machine, i), math.inf))
    for controller in results.controllers:
        factors = sorted(v / best[p, m, i] for (p, m, c), values in results.peaks.items() if c == controller
                         for i, v in enumerate(values) if math.isfinite(best[p, m, i]))
        share = numpy.arange(1, len(factors) + 1) / len(factors) * 100
        shown = [f if math.isfinite(f) else math.nan for f in factors]
        thick = controller in ("full", "mpc")
        colour = {"full": style.COMPENSATED, "mpc": style.PLAIN}.get(controller)
        axes.step(shown, share, where="post", label=style.LABELS.get(controller, controller), color=colour,
                  linewidth=2.2 if thick else 1.2)
    axes.set_xscale("log")
    axes.set_xlabel("largest error at the table over the best of the run")
    axes.set_ylabel("share of all runs / %")
    axes.set_ylim(0, 101)
    axes.set_title("How near the best each controller comes")
    axes.legend(fontsize=8)
    return figure


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("directory", type=Path)
    parser.add_argument("--out", type=Path, help="where the pictures go; default: beside the table")
    arguments = parser.parse_args()
    try:
        results = read(arguments.directory / "results.csv")
    except (OSError, ValueError, KeyError) as error:
        print(f"plot_contest.py: {error}", file=sys.stderr)
        return 2
    out = arguments.out or arguments.directory
    out.mkdir(parents=True, exist_ok=True)
    pyplot = style.apply()
    pictures = {"contest_nominal": nominal, "contest_spread": spread}
    if "full" in results.controllers and len(results.controllers) > 1:
        pictures["contest_ratio"] = ratio
    for name, draw in pictures.items():
        figure = draw(pyplot, results)
        figure.savefig(out / f"{name}.png")
        pyplot.close(figure)
        print(out / f"{name}.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
