#!/usr/bin/env python3
"""Draws the pictures of docs/laboratory/emps.md from the data that `contour emps` wrote.

    plot_emps.py DATA.csv DIR
"""
import sys
from pathlib import Path

import numpy as np

import style
from picture_diagnosis import BACKWARD, FORWARD, binned

TURN_M = 2.5e-3


def free_run(pyplot, d):
    figure, panel = pyplot.subplots(figsize=(9.5, 3.4))
    for name, colour, words in (("error_symmetric_m", style.PLAIN, "authors' symmetric model"),
                                ("error_fitted_m", style.COMPENSATED, "friction per direction and along the stroke, fitted on the first half")):
        error = d[name].copy()
        error[::1000] = np.nan  # a window begins
        rms = np.sqrt(np.nanmean(d[name] ** 2))
        panel.plot(d["t_s"], 1e6 * error, color=colour, label=f"{words}: {1e6 * rms:.0f} um rms")
    panel.set_xlabel("time (s)")
    panel.set_ylabel("free run minus measurement (um)")
    panel.legend(loc="upper center", bbox_to_anchor=(0.5, 1.2), ncol=2)
    return figure


def residual(pyplot, d):
    figure, panels = pyplot.subplots(2, 2, figsize=(9.5, 5.6), sharey=True, sharex="col")
    for row, (name, words) in enumerate((("residual_symmetric_N", "symmetric friction"), ("residual_full_N", "all causes"))):
        for column, (label, x) in enumerate((("travel in the motor's turn (mm)", 1e3 * np.mod(d["position_m"], TURN_M)),
                                             ("velocity (mm/s)", 1e3 * d["velocity_m_s"]))):
            panel = panels[row][column]
            for sign, colour, side in ((1, FORWARD, "forward"), (-1, BACKWARD, "backward")):
                mask = sign * d["velocity_m_s"] > 2e-3
                x_mean, y_mean, error = binned(x[mask], d[name][mask])
                panel.fill_between(x_mean, y_mean - 2 * error, y_mean + 2 * error, color=colour, alpha=0.25, linewidth=0)
                panel.plot(x_mean, y_mean, color=colour, label=side)
            panel.axhline(0, color=style.QUIET, linewidth=0.8)
            if row == 1:
                panel.set_xlabel(label)
        panels[row][0].set_ylabel(f"{words}: residual (N)")
    panels[0][0].legend(loc="lower left", bbox_to_anchor=(0, 1.0), ncol=2)
    return figure


def main():
    if len(sys.argv) != 3:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    data = np.genfromtxt(sys.argv[1], delimiter=",", names=True)
    pyplot = style.apply()
    for name, draw in (("emps_free_run", free_run), ("emps_residual", residual)):
        figure = draw(pyplot, data)
        figure.savefig(Path(sys.argv[2]) / f"{name}.png")
        pyplot.close(figure)
    return 0


if __name__ == "__main__":
    sys.exit(main())
