"""What may be hidden in an axis: its size in the axis's own units, and what a diagnosis should say of it.

`size` 1 is a torque as large as the noise is below 100 Hz, and of other effects what makes about such a one. What share of the residual
that leaves is measured (share.py); sizing.py sizes by it.
"""
import numpy as np

from draw_axis import TURN

NEEDS = {"stribeck": (), "temperature_viscosity": ("thermometer",), "cross_coupling": ("second_axis",), "pitch_error": ("scale",),
         "backlash": ("two_inertia",), "compliance": ("rigid",)}


def noise_below_100_Hz(axis):
    """[Nm] Of both parts of the torque noise."""
    return float(np.hypot(axis["white"] * np.sqrt(0.2), axis["coloured"]))


class Limits:
    """Of what a machine can have; `beyond` where more was asked for."""

    def __init__(self):
        self.beyond = False

    def most(self, value, limit):
        self.beyond = self.beyond or value > limit
        return min(value, limit)


def hidden(kind, axis, size, random, limits=None):
    """Numbers that simulate.py knows, and the truth by the names of the catalogue. Changes `axis` where it is one of its numbers."""
    unit = size * noise_below_100_Hz(axis)
    sign, phase = random.choice([-1.0, 1.0]), random.uniform(0.0, TURN)
    out, truth = HIDE[kind](axis, unit, sign, phase, random, size, (limits or Limits()).most)
    return {"phase": phase, **out}, truth


def _asymmetric(axis, unit, sign, phase, random, size, most):
    d = sign * most(2.0 * unit / axis["Fc"], 0.8)
    return {"asymmetry": d}, {"difference_rel": d}


def _asymmetric_viscous(axis, unit, sign, phase, random, size, most):
    d = sign * most(4.0 * unit / (axis["sigma2"] * axis["fast_rad_s"]), 1.6)
    return {"asymmetry_viscous": d}, {"difference_rel": d}


def _constant(axis, unit, sign, phase, random, size, most):
    return {"offset": sign * unit}, {"torque_Nm": sign * unit}


def _stribeck(axis, unit, sign, phase, random, size, most):
    # Stated without; there, break-away far above it.
    axis["Fs"] = axis["Fc"] * (1.0 + most(0.9 * size, 2.0))
    return {}, {"Fs_over_Fc": axis["Fs"] / axis["Fc"]}


def _position_friction(axis, unit, sign, phase, random, size, most):
    a = most(1.6 * unit / axis["Fc"], 0.6)
    return {"along": a, "along_periods": random.uniform(0.7, 3.0)}, {"amplitude_rel": a}


def _cable(axis, unit, sign, phase, random, size, most):
    # Told at the end of the stroke that is stated, 5 mm beyond the one that is travelled.
    return {"spring": sign * 2.2 * unit}, {"torque_at_stroke_end_Nm": sign * 2.2 * unit * (1.0 + 0.01 / axis["stroke_m"])}


def _ripple(axis, unit, sign, phase, random, size, most):
    a, n = most(1.5 * unit / axis["Fc"], 0.6), float(random.choice([1, 2, 3, 5, 8]))
    return {"ripple": a, "ripple_order": n}, {"amplitude_rel": a, "order_per_rev": n}


def _ball(axis, unit, sign, phase, random, size, most):
    a, n = most(1.5 * unit / axis["Fc"], 0.6), random.uniform(2.2, 7.8)
    n += 0.15 * (abs(n - round(n)) < 0.12)
    return {"ripple": a, "ripple_order": n}, {"amplitude_rel": a, "order_per_rev": n}


def _cogging(axis, unit, sign, phase, random, size, most):
    n = float(random.choice([4, 6, 8, 12, 18, 24, 36]))
    return {"cogging": 1.5 * unit, "cogging_order": n}, {"amplitude_Nm": 1.5 * unit, "order_per_rev": n}


def _viscous(axis, unit, sign, phase, random, size, most):
    return {"square_drag": 3.0 * unit}, {"torque_at_max_speed_Nm": None}


def _temperature(axis, unit, sign, phase, random, size, most):
    rate = -most(2.2 * unit / (axis["sigma2"] * axis["fast_rad_s"] * 6.0), 0.04)
    return {"rate_1_K": rate}, {"rate_1_K": None}


def _drift(axis, unit, sign, phase, random, size, most):
    c = sign * most(3.0 * unit / axis["Fc"], 0.7)
    return {"drift": c}, {"change_rel": None}


def _viscous_drift(axis, unit, sign, phase, random, size, most):
    c = sign * most(4.0 * unit / (axis["sigma2"] * axis["fast_rad_s"]), 0.7)
    return {"viscous_drift": c}, {"change_rel": c}


def _constant_of_torque(axis, unit, sign, phase, random, size, most):
    k = 1.0 + sign * most(0.25 * size, 0.5)
    return {"ratio": k}, {"ratio": k}


def _saturation(axis, unit, sign, phase, random, size, most):
    loss = most(25.0 * unit / axis["rated"], 0.25)
    return {"saturation": loss}, {"loss_at_rated_rel": loss}


def _payload(axis, unit, sign, phase, random, size, most):
    c = sign * most(9.0 * unit / (0.25 * axis["rated"]), 0.4)
    return {"payload": c, "payload_at": random.uniform(0.35, 0.65)}, {"inertia_change_rel": c}


def _compliance(axis, unit, sign, phase, random, size, most):
    mode_Hz = 1.0 / most(np.sqrt(size) / (110.0 * random.uniform(0.9, 1.3)), 1.0 / 40.0)
    axis["stiffness"] = axis["set_stiffness"] * (mode_Hz / axis["mode_Hz"]) ** 2
    return {}, {"antiresonance_Hz": float(np.sqrt(axis["stiffness"] / axis["load_inertia"]) / TURN)}


def _backlash(axis, unit, sign, phase, random, size, most):
    gap = most(12e-6 * size * random.uniform(0.7, 1.5), 2e-4)
    return {"gap": gap / axis["lever_m"]}, {"gap_um": gap * 1e6}


def _presliding(axis, unit, sign, phase, random, size, most):
    share = most(4.0 * unit / axis["Fc"], 0.5)
    return {"soft_share": share, "soft_ratio": random.uniform(0.06, 0.2)}, {"share_rel": share}


def _delay(axis, unit, sign, phase, random, size, most):
    d = most(3e-4 * size, 4e-3)
    return {"more_delay_s": d}, {"delay_us": d * 1e6}


def _lag(axis, unit, sign, phase, random, size, most):
    d = most(5e-4 * size, 5e-3)
    return {"more_lag_s": d}, {"time_constant_us": d * 1e6}


def _eccentricity(axis, unit, sign, phase, random, size, most):
    a = most(3.0 * unit / (axis["inertia"] * axis["fast_rad_s"] ** 2), 0.03)
    return {"reading": a, "reading_order": 1.0}, {"amplitude_rad": a}


def _subdivision(axis, unit, sign, phase, random, size, most):
    n = float(2 ** random.integers(5, 9))
    a = most(3.0 * unit / (axis["inertia"] * (n * 0.06 * axis["fast_rad_s"]) ** 2 / n**0.5), 3e-3)
    return {"reading": a, "reading_order": n}, {"amplitude_rad": a, "order_per_rev": n}


def _pitch(axis, unit, sign, phase, random, size, most):
    a = most(3e-6 * size, 1e-4)
    return {"pitch": a, "pitch_periods": random.uniform(0.5, 2.0)}, {"amplitude_um": None}


def _cross(axis, unit, sign, phase, random, size, most):
    # What is hidden resists the other's acceleration; the catalogue names the torque on the motor.
    return {"cross": 6.0 * unit / 0.05}, {"torque_per_acceleration_Nms2_m": -6.0 * unit / 0.05}


def _load_friction(axis, unit, sign, phase, random, size, most):
    c = most(12.0 * unit / (0.25 * axis["rated"]), 0.4)
    return {"load_friction": c}, {"friction_per_torque_rel": c}


def _periodic(axis, unit, sign, phase, random, size, most):
    f = random.uniform(6.0, 80.0)
    return {"vibration": 1.4 * unit, "vibration_Hz": f}, {"amplitude_Nm": 1.4 * unit, "frequency_Hz": f}


def _jitter(axis, unit, sign, phase, random, size, most):
    rms = most(6e-6 * size, 1e-4)
    return {"jitter_s": rms}, {"rms_us": rms * 1e6}


HIDE = {"asymmetric_coulomb": _asymmetric, "asymmetric_viscous": _asymmetric_viscous, "constant_torque": _constant, "stribeck": _stribeck,
        "position_friction": _position_friction, "cable_spring": _cable, "friction_ripple": _ripple, "ball_ripple": _ball,
        "cogging": _cogging, "viscous_nonlinear": _viscous, "temperature_viscosity": _temperature, "friction_drift": _drift,
        "torque_constant": _constant_of_torque, "torque_saturation": _saturation, "payload_step": _payload, "compliance": _compliance,
        "backlash": _backlash, "presliding_hysteresis": _presliding, "input_delay": _delay, "current_lag": _lag,
        "encoder_eccentricity": _eccentricity, "encoder_subdivision": _subdivision, "pitch_error": _pitch, "cross_coupling": _cross,
        "load_friction": _load_friction, "periodic_force": _periodic, "sample_jitter": _jitter, "viscous_drift": _viscous_drift}
