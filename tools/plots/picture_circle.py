"""The circle with its errors magnified: without compensation dashed, compensated solid."""
import numpy as np

import style

# How far the largest error should stand out, as a part of the radius.
SHOWN_ERROR = 0.22


def magnification(error_m, radius_m):
    """A round factor (1, 2 or 5 times a power of ten) that shows the largest error well."""
    wanted = SHOWN_ERROR * radius_m / max(float(np.max(np.abs(error_m))), 1e-12)
    power = 10.0 ** np.floor(np.log10(wanted))
    return power * max(f for f in (1, 2, 5) if f * power <= wanted * 1.0001)


def scale_text(factor):
    if factor == 1:
        return "true to scale"
    return "radial error × " + (f"{factor:,.0f}" if factor > 1 else f"{factor:g}")


def unit_of(radius_m):
    """Unit of the axes and how many of it make a metre."""
    return ("mm", 1e3) if radius_m >= 1e-3 else ("µm", 1e6)


def outline(axes, run, factor, colour, dash, turns=None):
    """All scored turns, or only the first of them, so that a dashed line stays one."""
    angle, error, _ = run.radial()
    if turns is not None:
        count = int(np.sum(run.turns()[run.scored()] <= 1 + turns))
        angle, error = angle[:count], error[:count]
    _, _, radius = run.circle()
    drawn = (radius + factor * error) * unit_of(radius)[1]
    axes.plot(drawn * np.cos(angle), drawn * np.sin(angle), dash, color=colour, label=style.label(run), linewidth=1.4)


def panel(axes, radius_m, factor, title):
    unit, per_m = unit_of(radius_m)
    radius = radius_m * per_m
    angle = np.linspace(0, 2 * np.pi, 721)
    axes.plot(radius * np.cos(angle), radius * np.sin(angle), color=style.QUIET, linewidth=0.9, label="commanded")
    axes.set_aspect("equal")
    axes.set_title(f"{title}\n{scale_text(factor)}")
    axes.set_xlabel(f"x ({unit})")
    axes.set_ylabel(f"y ({unit})")
    limit = radius * (1 + SHOWN_ERROR) * 1.12
    axes.set_xlim(-limit, limit)
    axes.set_ylim(-limit, limit)


def scale_bar(axes, radius_m, factor):
    """A bar as long as a round error drawn at this magnification."""
    per_m = unit_of(radius_m)[1]
    length_um = SHOWN_ERROR * radius_m * 1e6 / factor
    power = 10.0 ** np.floor(np.log10(length_um))
    error_um = power * max(f for f in (1, 2, 5) if f * power <= length_um * 1.0001)
    drawn = error_um * 1e-6 * per_m * factor
    axes.plot([-drawn / 2, drawn / 2], [0, 0], color=style.TRUTH, linewidth=2.5, solid_capstyle="butt")
    axes.text(0, 0.04 * radius_m * per_m, f"error of {error_um:g} µm", ha="center", va="bottom", fontsize=9)


def draw(pyplot, plain, full):
    runs = [run for run in (plain, full) if run is not None]
    figure, panels = pyplot.subplots(1, len(runs), figsize=(5.5 * len(runs), 6.4), squeeze=False,
                                     constrained_layout=False)
    figure.subplots_adjust(left=0.15 / len(runs), right=0.98, top=0.84, bottom=0.15, wspace=0.2)
    _, _, radius = runs[0].circle()
    for axes, scaled_by in zip(panels[0], runs):
        factor = magnification(scaled_by.radial()[1], radius)
        both = plain is not None and full is not None
        title = style.label(scaled_by)
        if both:
            title = "With and without compensation" if scaled_by is plain else "Compensated, magnified further"
        panel(axes, radius, factor, title)
        if scaled_by is plain:
            outline(axes, plain, factor, style.PLAIN, "--", turns=1)
        if full is not None:
            outline(axes, full, factor, style.COMPENSATED, "-")
        scale_bar(axes, radius, factor)
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=3)
    figure.suptitle(f"{runs[-1].name}: drawn by the {runs[-1].radial()[2]}", y=0.97)
    return figure
