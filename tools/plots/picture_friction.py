"""Friction of one axis over time: truth against estimate with its band of two standard deviations."""
import numpy as np

import style

TURNS_SHOWN = 2
SECONDS_SHOWN = 10.0


def can_draw(run, axis):
    return run.has(f"{axis}_friction_N") and bool(np.any(run.column(f"{axis}_friction_N") != 0))


def window(run):
    """Cycles to show: the first scored turns of a circle, the first scored seconds of anything else."""
    mask = run.scored()
    if run.is_circle:
        return mask & (run.turns() <= 1 + TURNS_SHOWN)
    time = run.column("path_time_s")
    return mask & (time <= time[mask][0] + SECONDS_SHOWN)


def draw(pyplot, run, axis):
    mask = window(run)
    time = run.column("path_time_s")[mask]
    estimate = run.column(f"{axis}_friction_N")[mask]
    band = 2 * run.column(f"{axis}_friction_std_N")[mask]
    known = run.has(f"{axis}_friction_truth_N")
    figure, panels = pyplot.subplots(2 if known else 1, 1, figsize=(9.5, 6.0 if known else 4.0), sharex=True,
                                     squeeze=False, gridspec_kw={"height_ratios": [2.2, 1]} if known else None)
    top = panels[0][0]
    top.fill_between(time, estimate - band, estimate + band, color=style.COMPENSATED, alpha=0.25, linewidth=0,
                     label="estimate ± 2σ")
    if known:
        truth = run.column(f"{axis}_friction_truth_N")[mask]
        top.plot(time, truth, color=style.TRUTH, linewidth=2.2, label="true friction of the emulated machine")
    top.plot(time, estimate, "--" if known else "-", color=style.WINDOW if known else style.COMPENSATED,
             linewidth=1.4, label="estimate")
    top.set_ylabel("friction (N)")
    top.legend(loc="upper center", bbox_to_anchor=(0.5, 1.14), ncol=3)
    panels[-1][0].set_xlabel("time since the program began (s)")
    figure.suptitle(f"{run.name}, {style.label(run)}: friction of axis {axis}")
    if not known:
        return figure
    bottom = panels[1][0]
    error = estimate - truth
    bottom.fill_between(time, -band, band, color=style.COMPENSATED, alpha=0.25, linewidth=0, label="± 2σ")
    bottom.plot(time, error, color=style.COMPENSATED, linewidth=1.0, label="estimate − truth")
    reach = 1.15 * max(float(np.max(np.abs(error))), 2.5 * float(np.median(band)), 1e-6)
    bottom.set_ylim(-reach, reach)
    bottom.set_ylabel("error (N)")
    rms = run.metrics["friction_estimate_error_rms_N"].get(axis)
    if rms is not None:
        bottom.set_title(f"error {rms:.2g} N rms over all scored cycles", fontsize=10)
    return figure
