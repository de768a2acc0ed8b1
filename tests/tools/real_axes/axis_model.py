"""A model that stands alone (docs/diagnosis_files.md), read and run by itself: shares nothing with the engine."""
import math

import numpy
import yaml


def numbers(tree):
    """YAML 1.1 takes 1e7 for text."""
    if isinstance(tree, dict):
        return {key: numbers(value) for key, value in tree.items()}
    if isinstance(tree, list):
        return [numbers(value) for value in tree]
    if isinstance(tree, str):
        try:
            return float(tree)
        except ValueError:
            return tree
    return tree


class AxisModel:
    """Numbers and extensions of a rigid axis in the units of its log."""

    def __init__(self, path):
        with open(path, encoding="utf-8") as file:
            tree = numbers(yaml.safe_load(file))
        model = tree.get("model", tree)
        drive = tree.get("drive", {}) or {}
        self.linear = "mass_kg" in model
        self.inertia = model["mass_kg"] if self.linear else model["motor_inertia_kgm2"] + model.get("load_inertia_kgm2", 0.0)
        lead = model.get("lead_mm", 0.0) * 1e-3
        self.table_per_q = 1.0 if self.linear or not lead else lead / (2 * math.pi)
        if self.linear:
            self.angle_per_q = 2 * math.pi / lead if lead else 1.0
        else:
            self.angle_per_q = 1.0 if lead else model.get("gear_ratio", 1.0)
            self.inertia += model.get("table_mass_kg", 0.0) * self.table_per_q ** 2
        friction = model["friction"]
        unit = "N" if self.linear else "Nm"

        def level(name):
            return friction[f"{name}_plus_{unit}"], friction[f"{name}_minus_{unit}"]

        self.Fc = level("Fc")
        self.Fs = level("Fs")
        self.vs = friction["vs_mm_s"] * 1e-3 if self.linear else friction["vs_rad_s"]
        self.exponent = friction.get("stribeck_exponent", 1.0)
        self.s0 = friction["sigma0_N_m"] if self.linear else friction["sigma0_Nm_rad"]
        self.s2 = friction["sigma2_Ns_m"] if self.linear else friction["sigma2_Nms_rad"]
        self.constant = model.get("constant_force_N", 0.0) + model.get("constant_torque_Nm", 0.0)
        self.per_ampere = drive.get("force_constant_N_A", 0.0) or drive.get("torque_constant_Nm_A", 0.0) or 1.0
        self.extensions = model.get("extensions") or {}
        self.take_numbers()

    def value(self, extension, *names):
        """Under whichever name the units of the axis have."""
        for name in names:
            if name in extension:
                return extension[name]
        raise KeyError(f"none of {names} in {extension}")

    def take_numbers(self):
        if e := self.extensions.get("asymmetric_coulomb"):
            up, down = 1 + e["difference_rel"] / 2, 1 - e["difference_rel"] / 2
            self.Fc = self.Fc[0] * up, self.Fc[1] * down
            self.Fs = self.Fs[0] * up, self.Fs[1] * down
        if e := self.extensions.get("stribeck"):
            self.Fs = tuple(e["Fs_over_Fc"] * f for f in self.Fc)
            self.vs = self.value(e, "vs_rad_s", "vs_m_s")
        self.unit_force = 1.0
        if e := self.extensions.get("torque_constant"):
            ratio = e["ratio"]
            self.inertia /= ratio
            self.Fc, self.Fs = tuple(f / ratio for f in self.Fc), tuple(f / ratio for f in self.Fs)
            self.s0, self.s2 = self.s0 / ratio, self.s2 / ratio
            self.unit_force = 1 / ratio

    def waves(self, name, angle, *amplitudes):
        total = 0.0
        e = self.extensions.get(name)
        for wave in [e, *e.get("further", [])] if e else []:
            total = total + self.value(wave, *amplitudes) * numpy.sin(wave["order_per_rev"] * angle + wave["phase_rad"])
        return total

    def table(self, name, q, *values):
        e = self.extensions.get(name)
        if not e:
            return 0.0
        places = 1e-3 * numpy.asarray(self.value(e, "position_mm", "position_mrad"))
        return numpy.interp(q * self.table_per_q, places, self.value(e, *values))

    def driving(self, q):
        """What acts beside the command."""
        angle = q * self.angle_per_q
        force = self.waves("cogging", angle, "amplitude_Nm", "amplitude_N") + self.table("cable_spring", q, "torque_Nm", "force_N")
        if e := self.extensions.get("constant_torque"):
            force = force + self.value(e, "torque_Nm", "force_N")
        return self.constant + self.unit_force * force

    def coulomb(self, q, v):
        """Level that friction comes to at a steady speed."""
        angle = q * self.angle_per_q
        up = v >= 0
        c, s = numpy.where(up, *self.Fc), numpy.where(up, *self.Fs)
        level = c + (s - c) * numpy.exp(-(numpy.abs(v) / self.vs) ** self.exponent)
        for name in ("friction_ripple", "ball_ripple"):
            level = level * (1 + self.waves(name, angle, "amplitude_rel"))
        return level * (1 + self.table("position_friction", q, "friction_rel"))

    def viscous(self, v):
        e = self.extensions.get("asymmetric_viscous")
        out = self.s2 * v * (1 + (e["difference_rel"] / 2 * numpy.sign(v) if e else 0.0))
        e = self.extensions.get("viscous_nonlinear")
        for curve in [e, *e.get("further", [])] if e else []:
            top = self.value(curve, "max_speed_rad_s", "max_speed_m_s")
            y, knee = numpy.abs(v) / top, curve.get("knee_rad_s", curve.get("knee_m_s", 0.0)) / top
            shape = y * (1 + knee) / (y + knee) if knee > 0 else y ** curve.get("exponent", 2.0)
            out = out + self.unit_force * self.value(curve, "torque_at_max_speed_Nm", "force_at_max_speed_N") * shape * numpy.sign(v)
        return out

    def resisting(self, q, v):
        """Friction of an axis that slides."""
        return self.coulomb(q, v) * numpy.sign(v) + self.viscous(v)

    def free_runs(self, position, velocity, command, starts, length, period_s, steps=5):
        """Errors of runs on the command alone, held over each row: one row of the result per start."""
        starts = numpy.asarray(starts)
        q, v, z = position[starts].astype(float), velocity[starts].astype(float), numpy.sign(velocity[starts])
        h = period_s / steps
        out = numpy.empty((len(starts), length))
        for k in range(length):
            out[:, k] = q
            u = command[starts + k] * self.per_ampere
            for _ in range(steps):
                middle = v
                # z: the bristle over its end; it follows the motion within its length.
                level = self.coulomb(q, middle)
                rate = numpy.abs(middle) * h * self.s0 / numpy.maximum(level, 1e-12)
                z = numpy.sign(middle) + (z - numpy.sign(middle)) * numpy.exp(-rate)
                v = v + h * (u + self.driving(q) - level * z - self.viscous(middle)) / self.inertia
                q = q + h * v
        return out


def butterworth(x, corner_Hz, rate_Hz):
    """4th order, forward and backward, settled at the first value."""
    x = list(map(float, x))
    k = math.tan(math.pi * corner_Hz / rate_Hz)
    for _ in range(2):
        for q in (1 / (2 * math.cos(math.pi / 8)), 1 / (2 * math.cos(3 * math.pi / 8))):
            norm = 1 / (1 + k / q + k * k)
            b0, b1, a1, a2 = k * k * norm, 2 * k * k * norm, 2 * (k * k - 1) * norm, (1 - k / q + k * k) * norm
            x1 = x2 = y1 = y2 = x[0]
            for i, value in enumerate(x):
                y = b0 * value + b1 * x1 + b0 * x2 - a1 * y1 - a2 * y2
                x2, x1, y2, y1 = x1, value, y1, y
                x[i] = y
        x.reverse()
    return numpy.array(x)


def central_difference(x, period_s):
    out = numpy.zeros_like(x)
    out[1:-1] = (x[2:] - x[:-2]) / (2 * period_s)
    return out


def rms(x):
    return float(numpy.sqrt(numpy.mean(numpy.square(x))))
