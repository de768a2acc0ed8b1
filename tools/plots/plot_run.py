#!/usr/bin/env python3
"""Draws runs of `contour simulate` or `contour run --out`.

    plot_run.py DIR... [--out DIR] [--axis NAME]

Each DIR holds cycles.csv and metrics.json of one run. Runs of one program are drawn together: `mpc` dashed, the
compensated one (`full`, or else the last given) solid. Prints the files it wrote, one per line.
"""
import argparse
import sys
from pathlib import Path

from run_data import Run, RunError, by_program, pair
from style import apply
import picture_circle
import picture_error
import picture_friction
import picture_radial
import picture_timing


def draw(runs, out, axis, pyplot):
    """All pictures that the runs of one program have the data for; yields the files."""
    plain, full = pair(runs)
    shown = [run for run in (plain, full) if run is not None]
    pictures = []
    if all(run.is_circle for run in shown):
        pictures += [("circle", lambda: picture_circle.draw(pyplot, plain, full)),
                     ("radial_error", lambda: picture_radial.draw(pyplot, shown))]
    else:
        pictures += [("contour_error", lambda: picture_error.draw(pyplot, shown))]
    best = full or plain
    if picture_friction.can_draw(best, axis):
        pictures += [(f"friction_{axis}", lambda: picture_friction.draw(pyplot, best, axis))]
    if picture_timing.can_draw(best):
        pictures += [("timing", lambda: picture_timing.draw(pyplot, best))]
    for name, make in pictures:
        path = out / f"{best.name}_{name}.png"
        figure = make()
        figure.savefig(path)
        pyplot.close(figure)
        yield path


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("runs", nargs="+", metavar="DIR", help="directory with cycles.csv and metrics.json")
    parser.add_argument("--out", metavar="DIR", help="where the pictures go (default: the last run's directory)")
    parser.add_argument("--axis", help="axis of the friction picture (default: the first)")
    arguments = parser.parse_args()
    try:
        runs = [Run(directory) for directory in arguments.runs]
        out = Path(arguments.out or arguments.runs[-1])
        out.mkdir(parents=True, exist_ok=True)
        pyplot = apply()
        for group in by_program(runs).values():
            axis = arguments.axis or group[0].axes[0]
            if axis not in group[0].axes:
                raise RunError(f"--axis: found {axis}, expected one of {', '.join(group[0].axes)}")
            for path in draw(group, out, axis, pyplot):
                print(path)
    except RunError as error:
        print(f"plot_run.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
