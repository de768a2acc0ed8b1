"""How fast a loop an axis bears: what whoever commissions it would find by turning the gain up, and back again.

Without it, axes with a soft mode and a long delay would swing against the limit of their drives: nobody records those.
"""
import numpy as np

from draw_axis import TICK_S, TURN

MOST_HZ, LEAST_HZ = 18.0, 1.0
# From the critical point: largest sensitivity of 2, as textbooks ask for.
NEAREST = 0.5


def open_loop(a, band, w):
    """From an error of speed to the speed that is measured, the loops of simulate.Controller around the motor. One column an axis."""
    s = 1j * w[:, None]
    j1, j2, k, d = a["motor_inertia"], a["load_inertia"], a["stiffness"], a["damping"]
    coupling = d * s + k
    speed_per_torque = (j2 * s**2 + coupling) / (s * (j1 * j2 * s**2 + (j1 + j2) * coupling))
    z = np.exp(-s * TICK_S)
    measured = (1.0 - z) / (s * TICK_S) * 0.5 / (1.0 - 0.5 * z)
    drive = np.exp(-s * (a["delay_s"] + 0.5 * TICK_S)) / (1.0 + s * a["lag_s"])
    return band * a["inertia"] * (1.0 + band / 5.0 / s) * (measured + band / 4.0 / s) * speed_per_torque * drive


def loop_band(a):
    """[rad/s] Of the speed loop, per axis."""
    w = TURN * np.geomspace(0.5, 0.45 / TICK_S, 1500)
    n = len(a["inertia"])
    band, going = np.full(n, TURN * LEAST_HZ), np.ones(n, bool)
    for hertz in np.geomspace(LEAST_HZ, MOST_HZ, 40):
        nearest = np.abs(1.0 + open_loop(a, TURN * hertz * np.ones(n), w)).min(0)
        going &= nearest > NEAREST
        band[going] = TURN * hertz
    return band
