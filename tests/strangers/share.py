"""The strength of what is hidden: the share of the residual's variance that it leaves after a refit within what is stated of the model.

Of the torque residual from 0 to 100 Hz; of the scale's residual where the scale is what tells (pitch error; with a scale, backlash and
compliance); of the variance of the second difference of the angle for jitter.
"""
import numpy as np

from draw_axis import STATED, TICK_S, TURN
from friction_laws import LAWS
from needed_torque import NUDGE

BAND_HZ = 100.0
# Standard deviations that a refit may move a number: 95 % of what is stated.
WITHIN = 2.0
AT_SCALE = ("backlash", "compliance")
FRICTION = ("Fc", "Fs", "vs", "sigma0", "sigma1", "sigma2")


def spectrum(x, band_Hz=BAND_HZ):
    """Up to the band, one signal a column."""
    return np.fft.rfft(x, axis=0)[: int(band_Hz * len(x) * TICK_S) + 1]


def in_band(amplitudes, rows, kept):
    """Back to time at the rate that the band needs, without what is not to count; a row of it is one of noise that is white in the band."""
    n = 2 * (len(amplitudes) - 1)
    out = np.fft.irfft(amplitudes, n, axis=0) * (n / rows)
    return out[kept[(np.arange(n) * rows) // n]]


def foreseen(axis, log):
    """Rows where the twins of the model agree to ten nudges, with half a second about the others left out."""
    parted = np.abs(log["parted"]) > 10.0 * NUDGE * axis["Fc"]
    return np.convolve(parted, np.ones(1001))[500:500 + len(parted)] < 0.5


def dynamic_stiffness(axis, f):
    """[Nm/rad] What the motor's torque is of its angle; and what arrives there of a torque on the load."""
    s = 1j * TURN * f
    j1, j2, k = axis["motor_inertia"], axis["load_inertia"], axis["stiffness"]
    coupling = k + s * 2.0 * axis["damping_ratio"] * np.sqrt(k * j1 * j2 / (j1 + j2))
    passed = coupling / (j2 * s**2 + coupling)
    return j1 * s**2 + j2 * s**2 * passed, passed


def friction_moved(axes, law, q):
    """[Nm] What friction along the angles of logs does when a number of it is off by what is stated: rows, numbers, axes."""
    changed = [dict(axis, **({} if k is None else {k: axis[k] * (1.0 + STATED[k])})) for k in (None, *FRICTION) for axis in axes]
    columns = {k: np.array([float(c[k]) for c in changed]) for k in (*FRICTION, "stribeck_exponent")}
    bristle, out = LAWS[law](columns), np.zeros((len(q), len(FRICTION), len(axes)))
    speeds = np.tile(np.diff(q, prepend=q[:1], axis=0) / TICK_S, (1, 1 + len(FRICTION)))
    for i, w in enumerate(speeds):
        level = columns["Fc"] + (columns["Fs"] - columns["Fc"]) * np.exp(-((np.abs(w) / columns["vs"]) ** columns["stribeck_exponent"]))
        torque = (bristle.torque(w, level, TICK_S) + columns["sigma2"] * w).reshape(-1, len(axes))
        out[i] = torque[1:] - torque[0]
    return out


def sensitivities(axis, log, friction, band_Hz=BAND_HZ, stated=STATED):
    """What the torque residual does when a number is off by what is stated of it. Spectra, a column a number."""
    q = log["true_q"]
    f = np.arange(int(band_Hz * len(q) * TICK_S) + 1) / (len(q) * TICK_S)
    now, passed = dynamic_stiffness(axis, f)
    angle, command = spectrum(q - q[0], band_Hz), spectrum(log["torque"], band_Hz)
    lag = 1.0 / (1.0 + 1j * TURN * f * axis["lag_s"])
    arriving = command * np.exp(-1j * TURN * f * (axis["delay_s"] + 0.5 * TICK_S)) * lag
    out = [dynamic_stiffness({**axis, k: axis[k] * (1.0 + stated[k])}, f)[0] * angle - now * angle
           for k in ("motor_inertia", "load_inertia", "stiffness")]
    out.append(stated["torque_constant"] * arriving)
    out.append(stated["delay_s"] * axis["delay_s"] * 1j * TURN * f * arriving)
    out.append(stated["lag_s"] * axis["lag_s"] * 1j * TURN * f * arriving * lag)
    moved = spectrum(friction, band_Hz)
    return np.column_stack(out + [moved * (passed if axis["friction_on_load"] else np.ones_like(passed))[:, None]])


def left_after_refit(effect, columns, noise_square):
    """Mean square that is left of it once every number has moved as the fit wants, by no more than is stated."""
    gram, on = columns.T @ columns, columns.T @ effect
    moved = np.zeros(len(on))
    for _ in range(300):
        for i in range(len(on)):
            step = (on[i] - gram[i] @ moved - noise_square * moved[i]) / (gram[i, i] + noise_square)
            moved[i] = np.clip(moved[i] + step, -WITHIN, WITHIN)
    return float(np.mean((effect - columns @ moved) ** 2))


def of_torque(axis, log, noise, friction):
    """Mean squares of what the effect leaves, and of the noise: of the torque, and what the encoder's steps look like."""
    rows, kept = len(noise), foreseen(axis, log)
    f = np.arange(int(BAND_HZ * rows * TICK_S) + 1) / (rows * TICK_S)
    steps = dynamic_stiffness(axis, f)[0] * spectrum(log["q"] - log["true_q"])
    noise_square = float(np.mean(in_band(spectrum(noise) - steps, rows, kept) ** 2))
    columns = in_band(sensitivities(axis, log, friction), rows, kept)
    return left_after_refit(in_band(spectrum(log["unexplained_torque"] * kept), rows, kept), columns, noise_square), noise_square


def of_scale(axis, log):
    """A model's zero is its own; a coupling that is stated may be as much stiffer or softer as that is stated."""
    kept = foreseen(axis, log)
    effect = log["unexplained_table"][kept] - log["unexplained_table"][kept].mean()
    wound_up = (log["true_table"] - log["unexplained_table"] - axis["lever_m"] * log["true_q"])[kept]
    column = (0.0 if axis["stated_rigid"] else STATED["stiffness"]) * (wound_up - wound_up.mean())
    moved = np.clip(column @ effect / max(column @ column, 1e-300), -WITHIN, WITHIN)
    return float(np.mean((effect - moved * column) ** 2)), float(np.var((log["table"] - log["true_table"])[kept]))


def of_second_difference(axis, log, noise, jitter_s):
    late_by = np.gradient(log["true_q"], TICK_S) * jitter_s
    effect = 6.0 * float(np.mean(late_by**2))
    moved = float(np.var(noise)) * (TICK_S**2 / axis["motor_inertia"]) ** 2
    return effect, moved + 6.0 * (TURN / axis["counts"]) ** 2 / 12.0


def share_of(kind, axis, hidden, log, noise, friction):
    """`axis`: without what is hidden; `friction`: of friction_moved."""
    if kind == "sample_jitter":
        effect, rest = of_second_difference(axis, log, noise, hidden["jitter_s"])
    elif kind == "pitch_error" or (kind in AT_SCALE and axis["scale"]):
        effect, rest = of_scale(axis, log)
    else:
        effect, rest = of_torque(axis, log, noise, friction)
    return effect / (effect + rest)
