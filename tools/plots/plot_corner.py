#!/usr/bin/env python3
"""Draws one corner as two runs took it: one that stops there, and one that blends it (G64 P, corner_tolerance_mm).

    plot_corner.py STOPPING BLENDED --corner-mm X Y [--passage N] [--span-um S] [--out FILE]

Each run is a directory with cycles.csv and metrics.json of `contour simulate`. The corner is given from where the program
began; N counts how often the reference passes it (1). Left: the way of reference and table about the corner; right: the
axes' speeds about the instant that is nearest to it. Prints the file it wrote.
"""
import argparse
import sys

import numpy as np

import style
from run_data import Run, RunError

AROUND_S = 0.045
APART_S = 0.05  # what is nearer than this in time is the same passage
COLORS = (style.PLAIN, style.COMPENSATED)


def columns(run, ending):
    return [run.column(f"{axis}_{ending}") for axis in run.axes[:2]]


def passage(run, corner_mm, number):
    """Index of the row nearest to the corner when the reference passes it for the n-th time."""
    x, y = columns(run, "reference_position_m")
    away = np.hypot(x - x[0] - 1e-3 * corner_mm[0], y - y[0] - 1e-3 * corner_mm[1])
    close = np.flatnonzero(away < away.min() + 1e-4)
    visits = np.split(close, np.flatnonzero(np.diff(run.column("path_time_s")[close]) > APART_S) + 1)
    if number > len(visits):
        raise RunError(f"{run.directory}: the corner is passed {len(visits)} times, not {number}")
    visit = visits[number - 1]
    return visit[np.argmin(away[visit])]


def about(values, start, corner_mm, rows):
    return 1e6 * (values[rows] - start - 1e-3 * corner_mm)


def draw(pyplot, runs, corner_mm, number, span_um):
    figure, (path, speed) = pyplot.subplots(1, 2, figsize=(9.5, 4.4))
    for run, color, name in zip(runs, COLORS, ("with a stop", "blended")):
        middle = passage(run, corner_mm, number)
        time = run.column("path_time_s") - run.column("path_time_s")[middle]
        rows = np.flatnonzero(np.abs(time) < AROUND_S)
        start = [column[0] for column in columns(run, "reference_position_m")]
        for values, dashes, what in ((columns(run, "reference_position_m"), "--", "reference"),
                                     (run.best_position()[0], "-", run.best_position()[1])):
            x, y = [about(v, s, c, rows) for v, s, c in zip(values, start, corner_mm)]
            path.plot(x, y, dashes, color=color, label=f"{name}: {what}")
        for axis, dashes in zip(run.axes[:2], ("-", ":")):
            velocity = run.column(f"{axis}_reference_velocity_m_s")
            speed.plot(1e3 * time[rows], 1e3 * velocity[rows], dashes, color=color, label=f"{name}: {axis}")
    path.set_xlim(-span_um, span_um)
    path.set_ylim(-span_um, span_um)
    path.set_aspect("equal")
    path.set_xlabel("from the corner, first axis (µm)")
    path.set_ylabel("second axis (µm)")
    speed.set_xlabel("time from the passage of the corner (ms)")
    speed.set_ylabel("reference velocity (mm/s)")
    for axes in (path, speed):
        axes.legend(fontsize=8)
    return figure


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("stopping", metavar="STOPPING")
    parser.add_argument("blended", metavar="BLENDED")
    parser.add_argument("--corner-mm", type=float, nargs=2, required=True, metavar=("X", "Y"))
    parser.add_argument("--passage", type=int, default=1)
    parser.add_argument("--span-um", type=float, default=25.0)
    parser.add_argument("--out", default="corner.png")
    arguments = parser.parse_args()
    try:
        runs = [Run(arguments.stopping), Run(arguments.blended)]
        figure = draw(style.apply(), runs, arguments.corner_mm, arguments.passage, arguments.span_um)
    except RunError as error:
        print(f"plot_corner.py: {error}", file=sys.stderr)
        return 2
    figure.savefig(arguments.out)
    print(arguments.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
