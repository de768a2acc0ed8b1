"""Radial error over the angle, as polar plots, each with its own scale; the reversals of the axes marked."""
import numpy as np

import style

HALF_WINDOW = np.radians(15)
REVERSALS = ("+X", "+Y", "−X", "−Y")


def round_up(value):
    power = 10.0 ** np.floor(np.log10(value))
    return power * min(f for f in (1, 2, 2.5, 5, 10) if f * power >= value * 0.9999)


def panel(axes, run, colour):
    angle, error, where = run.radial()
    order = np.argsort(angle)
    error_um = error * 1e6
    reach = round_up(max(float(np.max(np.abs(error_um))), 1e-3))
    # The circle without error lies at radius `zero`, so that errors to the inside show as well.
    zero = 1.6 * reach
    for k in range(4):
        middle = k * np.pi / 2
        axes.fill_between(np.linspace(middle - HALF_WINDOW, middle + HALF_WINDOW, 40), 0, zero + 1.15 * reach,
                          color=style.WINDOW, alpha=0.18, linewidth=0)
    full_turn = np.linspace(0, 2 * np.pi, 361)
    axes.plot(full_turn, np.full_like(full_turn, zero), color=style.QUIET, linewidth=1.2)
    axes.plot(angle[order], zero + error_um[order], ".", markersize=1.2, color=colour)
    axes.set_ylim(0, zero + 1.15 * reach)
    ticks = [-reach, -reach / 2, 0, reach / 2, reach]
    axes.set_yticks([zero + tick for tick in ticks])
    axes.set_yticklabels([f"{tick:+g} µm".replace("-", "−") if tick else "0" for tick in ticks], fontsize=8)
    axes.set_rlabel_position(45)
    peaks = run.metrics["contour"][where]["quadrant_peak_um"]
    axes.set_xticks([0, np.pi / 2, np.pi, 3 * np.pi / 2])
    axes.set_xticklabels([f"{name}\n{peak:.3g} µm" for name, peak in zip(REVERSALS, peaks)])
    axes.tick_params(axis="x", pad=22)
    deviation = run.metrics["contour"][where]["circular_deviation_um"]
    axes.set_title(f"{style.label(run)}\ncircular deviation {deviation:.3g} µm", pad=20)


def draw(pyplot, runs):
    figure, panels = pyplot.subplots(1, len(runs), figsize=(6.5 * len(runs), 7.0), squeeze=False,
                                     constrained_layout=False, subplot_kw={"projection": "polar"})
    figure.subplots_adjust(left=0.14 / len(runs), right=1 - 0.14 / len(runs), top=0.76, bottom=0.1, wspace=0.5)
    colours = {"mpc": style.PLAIN}
    for axes, run in zip(panels[0], runs):
        panel(axes, run, colours.get(run.controller, style.COMPENSATED))
    figure.suptitle(f"{runs[-1].name}: radial error at the {runs[-1].radial()[2]}, "
                    "its largest value within 15° of each reversal beside it", y=0.97)
    return figure
