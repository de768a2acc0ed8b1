"""The quantity that decides: what the extension explains depends on it most, with the fitted curve and its band."""
import re

import numpy as np

import style

FORWARD, BACKWARD = style.COMPENSATED, style.PLAIN
BINS = 72


def orders(f):
    """Orders per motor turn of the causes that have one."""
    for cause in f.data["causes"]:
        for parameter in cause["parameters"]:
            if parameter["name"].startswith("order"):
                number = re.match(r"[-+0-9.eE]+", parameter["value"])
                if number and float(number.group()) > 0:
                    yield float(number.group())


def quantities(f):
    """Label and values of what a deviation may depend on."""
    out = [*f.motion, ("time (s)", f["time_s"])]
    if f.turns is not None:
        out.append(("motor angle (turns)", np.mod(f.turns, 1.0)))
        out += [(f"motor angle (periods of order {n:g})", np.mod(n * f.turns, 1.0)) for n in orders(f) if n != 1.0]
    if f.has("temperature_degC"):
        out.append(("temperature (°C)", f["temperature_degC"]))
    return out


def sorted_into(x, good):
    """Bins of equal width between the outermost percents, and their middles."""
    low, high = np.nanpercentile(x[good], [0.5, 99.5])
    if not high > low:
        return None
    return np.clip(((x - low) / (high - low) * BINS).astype(int), 0, BINS - 1), low + (high - low) * (np.arange(BINS) + 0.5) / BINS


def means(bins, y, good):
    count = np.bincount(bins[good], minlength=BINS)
    total = np.bincount(bins[good], weights=y[good], minlength=BINS)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(count > 5, total / count, np.nan), count


def explained_by(x, change, direction):
    """Share of the change's variance that a curve over x has, each direction with its own."""
    inside = total = 0.0
    for sign in (1, -1):
        good = (direction == sign) & np.isfinite(x) & np.isfinite(change)
        if good.sum() < 20 * BINS or sorted_into(x, good) is None:
            continue
        bins, _ = sorted_into(np.nan_to_num(x), good)
        mean, count = means(bins, change, good)
        inside += float(np.nansum(count * np.nan_to_num(mean) ** 2))
        total += float(np.sum(change[good] ** 2))
    return inside / total if total > 0 else 0.0


def error_of_visits(bins, y, good):
    """Standard error of a bin's mean: rows of one visit go together, visits do not."""
    order = np.flatnonzero(good)
    new = np.r_[True, (np.diff(bins[order]) != 0) | (np.diff(order) > 1)]
    visit = np.cumsum(new) - 1
    rows = np.bincount(visit)
    mean = np.bincount(visit, weights=y[order]) / rows
    of_bin, count = bins[order][new], np.bincount(bins[order][new], minlength=BINS)
    all_rows = np.bincount(of_bin, weights=rows, minlength=BINS)
    middle = np.bincount(of_bin, weights=rows * mean, minlength=BINS) / np.maximum(all_rows, 1)
    square = np.bincount(of_bin, weights=(rows * (mean - middle[of_bin])) ** 2, minlength=BINS)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(count > 1, np.sqrt(square * count / np.maximum(count - 1, 1)) / np.maximum(all_rows, 1), np.nan)


def relative_deviation(f):
    """Of the first cause's main size, one standard deviation over the value."""
    for parameter in f.data["causes"][0]["parameters"] if f.data["causes"] else []:
        numbers = [re.match(r"[-+0-9.eE]+", parameter[k]) for k in ("value", "low", "high")]
        if all(numbers) and not parameter["name"].startswith(("order", "phase", "time")):
            value, low, high = (float(n.group()) for n in numbers)
            if value:
                return abs(high - low) / 3.92 / abs(value)
    return 0.0


def at_scale(f):
    return bool(f.data["causes"]) and f.data["causes"][0]["unit"] == "um" and f.has("scale_before")


def deciding(pyplot, f):
    """Residual of the stated model over the quantity that decides, and what the extended model makes of it."""
    before, after = ("scale_before", "scale_after") if at_scale(f) else ("residual_before", "residual_after")
    per, unit = (1e6, "um") if at_scale(f) else (1.0, f.unit)
    if not f.data["causes"] or not f.has(after):
        return None
    residual, left = per * f[before], per * f[after]
    change, direction = residual - left, f.moving()
    ranked = sorted(((explained_by(x, change, direction), label, x) for label, x in quantities(f)), key=lambda r: -r[0])
    share, label, x = ranked[0]
    figure, panel = pyplot.subplots(figsize=(9.5, 5.2))
    spread = relative_deviation(f)
    for sign, colour, side in ((1, FORWARD, "forward"), (-1, BACKWARD, "backward")):
        good = (direction == sign) & np.isfinite(x) & np.isfinite(residual) & np.isfinite(left)
        if good.sum() < 20 * BINS or sorted_into(x, good) is None:
            continue
        bins, middle = sorted_into(np.nan_to_num(x), good)
        measured, fitted = means(bins, residual, good)[0], means(bins, change, good)[0]
        error = 2.0 * error_of_visits(bins, left, good)
        # What was visited once has no error of its own.
        panel.errorbar(middle, measured, yerr=np.nan_to_num(error), fmt=".", color=colour, markersize=4, linewidth=0.7, alpha=0.75,
                       label=f"{side}: residual, ±2σ")
        panel.plot(middle, fitted, color=colour, linewidth=2.0, label=f"{side}: fitted")
        band = 2.0 * spread * np.abs(fitted)
        panel.fill_between(middle, fitted - band, fitted + band, color=colour, alpha=0.25, linewidth=0)
    panel.axhline(0, color=style.QUIET, linewidth=0.8)
    panel.set_xlabel(label)
    panel.set_ylabel(f"{'scale minus model' if at_scale(f) else 'residual ' + f.effort} ({unit})")
    panel.set_title(f"{100 * share:.0f} % of what the extension explains goes with this", fontsize=10)
    if panel.get_legend_handles_labels()[0]:
        panel.legend(ncol=2, fontsize=8)
    return figure
