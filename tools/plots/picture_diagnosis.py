"""Pictures of a diagnosis. Each function draws one figure, or returns None where the data are not there."""
import numpy as np

import style
from picture_deciding import deciding

FORWARD, BACKWARD = style.COMPENSATED, style.PLAIN
BEFORE, AFTER = style.QUIET, style.COMPENSATED
MOST_POINTS = 6000
SECONDS_SHOWN = 12.0


def thin(*signals):
    """The same points of each, as few as a picture can show."""
    step = max(1, len(signals[0]) // MOST_POINTS)
    return [s[::step] for s in signals]


def rms(x):
    x = x[np.isfinite(x)]
    return float(np.sqrt(np.mean(x * x))) if len(x) else float("nan")


def smoothed(x, width):
    """Mean over `width` neighbours; what the eye would draw through noise."""
    if width < 2:
        return x
    good = np.isfinite(x)
    ones = np.convolve(good.astype(float), np.ones(width), "same")
    sums = np.convolve(np.where(good, x, 0.0), np.ones(width), "same")
    return np.where(ones > 0, sums / np.maximum(ones, 1), np.nan)


def sums_over(x, rows):
    """Of so many neighbours, from every one on: a log at 10 kHz has too many for a convolution."""
    total = np.concatenate(([0.0], np.cumsum(x)))
    return total[rows:] - total[:-rows]


def window(f):
    """The stretch in which what was found shows most; where nothing was, in which most is going on."""
    time, v = f["time_s"], np.nan_to_num(f["velocity"])
    rows = int(SECONDS_SHOWN / f.period_s)
    if len(time) <= rows:
        return slice(0, len(time))
    change = np.nan_to_num(f["residual_before"] - f["residual_after"]) ** 2
    if f.data["causes"] and np.any(change > 0):
        start = int(np.argmax(sums_over(change, rows)))
        return slice(start, start + rows)
    activity = np.abs(np.diff(np.sign(v))) + 1e-3 * np.abs(v[1:]) / (np.max(np.abs(v)) + 1e-30)
    start = int(np.argmax(sums_over(activity, rows)))
    return slice(start, start + rows)


def overlay(pyplot, f):
    """Measured against simulated, before and after, with the residual below."""
    w = window(f)
    time, measured, before, after = f["time_s"][w], f["measured"][w], f["simulated_before"][w], f["simulated_after"][w]
    figure, (top, middle, bottom) = pyplot.subplots(3, 1, figsize=(9.5, 7.2), sharex=True,
                                                    gridspec_kw={"height_ratios": [2, 1.3, 1.3]})
    width = max(1, int(0.003 / f.period_s))
    t, m, b, a = thin(time, smoothed(measured, width), smoothed(before, width), smoothed(after, width))
    top.plot(t, m, color=style.TRUTH, linewidth=2.0, label="measured")
    top.plot(t, b, color=style.WINDOW, linewidth=1.1, label="simulated, model as stated")
    top.plot(t, a, "--", color=style.COMPENSATED, linewidth=1.1, label="simulated, model with what was found")
    top.set_ylabel(f"{f.effort} the motion needs ({f.unit})")
    top.legend(loc="upper center", bbox_to_anchor=(0.5, 1.2), ncol=3)
    reach = 1.1 * np.nanpercentile(np.abs(f["residual_before"][w]), 99.8) + 1e-30
    for panel, name, colour, words in ((middle, "residual_before", BEFORE, "before"), (bottom, "residual_after", AFTER, "after")):
        t, r = thin(time, f[name][w])
        panel.plot(t, r, color=colour, linewidth=0.6)
        panel.set_ylim(-reach, reach)
        panel.set_ylabel(f"residual ({f.unit})")
        panel.set_title(f"{words}: {rms(f[name]):.3g} {f.unit} rms over the whole log", fontsize=10)
    bottom.set_xlabel("time (s)")
    return figure


def binned(x, y, count=60):
    """Means of y in bins of x with as many points each, and their standard errors."""
    good = np.isfinite(x) & np.isfinite(y)
    x, y = x[good], y[good]
    if len(x) < 4 * count:
        return None
    order = np.argsort(x)
    parts = np.array_split(order, count)
    mean = np.array([x[p].mean() for p in parts])
    value = np.array([y[p].mean() for p in parts])
    error = np.array([y[p].std() / np.sqrt(len(p)) for p in parts])
    # No line across what was never visited.
    widths = np.array([np.ptp(x[p]) for p in parts])
    gaps = 1 + np.flatnonzero(np.diff(mean) > 3 * (widths[:-1] + widths[1:]) + 1e-12)
    return tuple(np.insert(a, gaps, np.nan) for a in (mean, value, error))


def stretches(x):
    """Slices of what lies between the places that are no number."""
    ends = [-1, *np.flatnonzero(np.isnan(x)), len(x)]
    return [slice(a + 1, b) for a, b in zip(ends, ends[1:]) if b > a + 1]


def against(pyplot, f):
    """Residual against what may explain it, forward and backward apart: above before, below after."""
    columns = []
    if f.turns is not None:
        columns.append(("motor angle (turns)", np.mod(f.turns, 1.0)))
    position, velocity, acceleration = f.motion
    columns += [position, velocity, ("time (s)", f["time_s"]), acceleration]
    if f.has("temperature_degC"):
        columns.append(("temperature (°C)", f["temperature_degC"]))
    direction = f.moving()
    figure, panels = pyplot.subplots(2, len(columns), figsize=(3.1 * len(columns) + 0.6, 5.6), sharey=True, sharex="col",
                                     squeeze=False)
    reach = 0.0
    for row, (name, words) in enumerate((("residual_before", "before"), ("residual_after", "after"))):
        residual = f[name]
        for column, (label, x) in enumerate(columns):
            panel = panels[row][column]
            for sign, colour, side in ((1, FORWARD, "forward"), (-1, BACKWARD, "backward")):
                mask = direction == sign
                points = binned(x[mask], residual[mask])
                if points is None:
                    continue
                cx, cy, se = points
                for part in stretches(cx):
                    panel.fill_between(cx[part], (cy - 2 * se)[part], (cy + 2 * se)[part], color=colour, alpha=0.25, linewidth=0)
                panel.plot(cx, cy, color=colour, linewidth=1.2, marker=".", markersize=3, label=side)
                reach = max(reach, float(np.nanmax(np.abs(cy) + 2 * se)))
            panel.axhline(0, color=style.QUIET, linewidth=0.8)
            if row == 1:
                panel.set_xlabel(label)
        panels[row][0].set_ylabel(f"{words}: residual ({f.unit})")
    if reach > 0.0:
        panels[0][0].set_ylim(-1.15 * reach, 1.15 * reach)
        panels[0][0].legend(loc="lower left", bbox_to_anchor=(0, 1.0), ncol=2)
    return figure


def density(x, rate, size):
    """Power density by Welch's method, half-overlapping Hann windows."""
    x = np.nan_to_num(x)
    size = min(size, len(x))
    taper = np.hanning(size)
    total, count = 0.0, 0
    for start in range(0, len(x) - size + 1, max(1, size // 2)):
        part = x[start:start + size]
        total = total + np.abs(np.fft.rfft((part - part.mean()) * taper)) ** 2
        count += 1
    return np.fft.rfftfreq(size, 1.0 / rate), 2.0 * total / count / (rate * np.sum(taper ** 2))


def per_turn(f, residual):
    """Amplitude per order of the motor's turn: residual over the angle, averaged in angle bins while it moves."""
    turns = f.turns
    if turns is None or np.ptp(turns[np.isfinite(turns)]) < 3:
        return None
    moving = (f.moving() != 0) & np.isfinite(residual) & np.isfinite(turns)
    steps = 256
    lowest = np.floor(turns[moving].min())
    index = ((turns[moving] - lowest) * steps).astype(int)
    count = np.bincount(index)
    mean = np.bincount(index, weights=residual[moving]) / np.maximum(count, 1)
    whole = (len(mean) // steps) * steps
    if whole < 2 * steps:
        return None
    spectrum = np.abs(np.fft.rfft(mean[:whole] - mean[:whole].mean())) * 2.0 / whole
    return np.fft.rfftfreq(whole, 1.0 / steps), spectrum


def spectra(pyplot, f):
    """Residual per frequency and per turn, before and after."""
    turned = per_turn(f, f["residual_before"])
    figure, panels = pyplot.subplots(1, 2 if turned else 1, figsize=(9.5 if turned else 6, 4), squeeze=False)
    panel = panels[0][0]
    for name, colour, words in (("residual_before", BEFORE, "before"), ("residual_after", AFTER, "after")):
        frequency, power = density(f[name], 1.0 / f.period_s, 4096)
        panel.loglog(frequency[1:], np.sqrt(power[1:]), color=colour, label=words, linewidth=1.0)
    panel.set_xlabel("frequency (Hz)")
    panel.set_ylabel(f"residual ({f.unit}/√Hz)")
    panel.legend()
    if turned:
        panel = panels[0][1]
        for name, colour, words in (("residual_before", BEFORE, "before"), ("residual_after", AFTER, "after")):
            order, amplitude = per_turn(f, f[name])
            mask = (order > 0.2) & (order < 64)
            panel.semilogx(order[mask], amplitude[mask], color=colour, label=words, linewidth=1.0)
        panel.set_xlabel("order (periods per motor turn)")
        panel.set_ylabel(f"amplitude ({f.unit})")
        panel.legend()
    return figure


def evidence(pyplot, f):
    """Every candidate's evidence, with the gate."""
    candidates = f.data["candidates"]
    best = {}
    for c in candidates:
        value = c["refitted"] if c["refitted"] is not None else c["score"]
        if value is None:
            continue
        if c["kind"] not in best or value > best[c["kind"]][0]:
            best[c["kind"]] = (value, c["accepted"], c["refitted"] is not None)
    if not best:
        return None
    rows = sorted(best.items(), key=lambda item: item[1][0])
    figure, panel = pyplot.subplots(figsize=(8, 0.24 * len(rows) + 1.4))
    values = [max(v[0], 0.05) for _, v in rows]
    colours = [style.PLAIN if v[1] else (style.COMPENSATED if v[2] else style.QUIET) for _, v in rows]
    panel.barh([kind.replace("_", " ") for kind, _ in rows], values, color=colours, height=0.7)
    panel.set_xscale("symlog", linthresh=10)
    panel.set_xlim(0, 3 * max(max(values), f.data["gate"] or 1))
    if f.data["gate"]:
        panel.axvline(f.data["gate"], color=style.TRUTH, linewidth=1.2)
        panel.text(f.data["gate"], len(rows) - 0.3, f" gate {f.data['gate']:.3g}", va="bottom")
    panel.set_xlabel("evidence (2 × log, after penalties); orange accepted, blue refitted together with the model")
    panel.grid(axis="y", visible=False)
    return figure


def correlation(x, y, lags):
    x, y = np.nan_to_num(x - np.nanmean(x)), np.nan_to_num(y - np.nanmean(y))
    size = 1 << int(np.ceil(np.log2(2 * len(x))))
    product = np.fft.irfft(np.conj(np.fft.rfft(x, size)) * np.fft.rfft(y, size), size)[:lags]
    return product / (np.sqrt(np.sum(x * x) * np.sum(y * y)) + 1e-300)


def correlations(pyplot, f):
    """The residual's correlation with itself and with the torque before it."""
    lags = min(200, len(f["time_s"]) // 4)
    figure, panels = pyplot.subplots(1, 2, figsize=(9.5, 3.6))
    lag_ms = 1e3 * f.period_s * np.arange(lags)
    own, torque = (correlation(f[name], f[name], lags) for name in ("residual_after", "measured"))
    # Bartlett: what chance makes of signals that are not white themselves.
    rows = np.isfinite(f["residual_after"]).sum()
    bands = [2.0 * np.sqrt(max(1.0, 2.0 * float(np.sum(own * other)) - 1.0) / rows) for other in (own, torque)]
    for name, colour, words in (("residual_before", BEFORE, "before"), ("residual_after", AFTER, "after")):
        panels[0].plot(lag_ms[1:], correlation(f[name], f[name], lags)[1:], color=colour, label=words)
        panels[1].plot(lag_ms, correlation(f["measured"], f[name], lags), color=colour, label=words)
    for panel, band, words in zip(panels, bands, ("of the residual with itself", f"of the residual with the {f.effort} before it")):
        panel.axhspan(-band, band, color=style.QUIET, alpha=0.25, linewidth=0)
        panel.set_xlabel("lag (ms)")
        panel.set_title("correlation " + words + "\n(band: ±2σ by chance, of noise as coloured as this)", fontsize=9)
    panels[0].legend()
    return figure


def blocks(pyplot, f):
    """What the causes gain in each block of the log."""
    rows = [b for b in f.data["blocks"] if b[2] is not None]
    if not rows:
        return None
    figure, panel = pyplot.subplots(figsize=(9.5, 3.2))
    start, end, gain = np.array(rows).T
    panel.bar(start, 100 * gain, width=0.92 * (end - start), align="edge",
              color=np.where(gain >= 0, style.COMPENSATED, style.PLAIN))
    panel.axhline(0, color=style.TRUTH, linewidth=0.8)
    panel.set_xlabel("time (s)")
    panel.set_ylabel("residual less by (%)")
    panel.set_title("gain in each block, by a fit that has not seen it", fontsize=10)
    return figure


def shapes(pyplot, f):
    """Fitted curves with their bands."""
    tables = [(c["kind"], t) for c in f.data["causes"] for t in c["shapes"]]
    if not tables:
        return None
    figure, panels = pyplot.subplots(1, len(tables), figsize=(4.8 * len(tables) + 1, 3.6), squeeze=False)
    units = {"friction_rel": ("friction beyond the model (%)", 100.0), "torque_Nm": (f"{f.effort} ({f.unit})", 1.0),
             "error_um": ("error (um)", 1.0)}
    for panel, (kind, t) in zip(panels[0], tables):
        label, scale = units.get(t["ordinate"], (t["ordinate"], 1.0))
        x, y = np.array(t["x"], float), scale * np.array(t["y"], float)
        if t["sigma"]:
            sigma = 2 * scale * np.array(t["sigma"], float)
            panel.fill_between(x, y - sigma, y + sigma, color=style.COMPENSATED, alpha=0.25, linewidth=0)
        panel.plot(x, y, color=style.COMPENSATED)
        panel.set_xlabel(t["abscissa"].replace("_", " (", 1) + ")")
        panel.set_ylabel(label)
        panel.set_title(kind.replace("_", " ") + ", ± 2σ", fontsize=10)
    return figure


def scale(pyplot, f):
    """Linear scale minus what motor and wind-up say, before and after."""
    if not f.has("scale_before"):
        return None
    figure, panels = pyplot.subplots(1, 2, figsize=(9.5, 3.6), sharey=True)
    direction = f.moving()
    for panel, name, words in zip(panels, ("scale_before", "scale_after"), ("before", "after")):
        if not f.has(name):
            continue
        for sign, colour, side in ((1, FORWARD, "forward"), (-1, BACKWARD, "backward")):
            mask = direction == sign
            points = binned(f.position_mm[mask], 1e6 * f[name][mask])
            if points is not None:
                panel.plot(points[0], points[1], color=colour, label=side)
        panel.set_xlabel("position (mm)")
        panel.set_title(f"{words}: {1e6 * rms(f[name]):.3g} um rms", fontsize=10)
    panels[0].set_ylabel("scale minus model (um)")
    panels[0].legend()
    return figure


ALL = [
    ("deciding", deciding, "What decides"),
    ("overlay", overlay, "Measured against simulated"),
    ("against", against, "What is left, against what may explain it"),
    ("shapes", shapes, "Fitted curves"),
    ("scale", scale, "At the linear scale"),
    ("spectra", spectra, "What is left, per frequency and per turn"),
    ("evidence", evidence, "Evidence of every candidate"),
    ("blocks", blocks, "Gain over time"),
    ("correlations", correlations, "Is what is left still connected?"),
]
