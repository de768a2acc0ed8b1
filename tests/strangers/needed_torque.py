"""What torque the motion of a batch needs by the models without what is hidden, beside the simulation and in its own steps.

Of an axis with nothing hidden, the torque that arrives less the torque that is needed is its torque noise, to the last bits; of one with
an effect it is noise and effect. Inverse dynamics from a table of rounded samples have an error of their own that is larger than a barely
visible effect.
"""
import numpy as np

from friction_laws import LAWS


# By so much more friction. What grows out of it tenfold cannot be foreseen from the motor.
NUDGE = 1e-3


def nudged(axes):
    """The twins of models: where a table sticks and slips behind a soft coupling, when it slips does not follow from how the motor moves,
    and the two part."""
    return {**axes, **{name: axes[name] * (1.0 + NUDGE) for name in ("Fc", "Fs", "sigma0")}}


class NeededTorque:
    """`axes`: stacked numbers of the models, a column of the batch each."""

    def __init__(self, axes, law, step_s, start):
        self.a, self.h = axes, step_s
        a = axes
        reduced = a["motor_inertia"] * a["load_inertia"] / (a["motor_inertia"] + a["load_inertia"])
        self.d = 2.0 * a["damping_ratio"] * np.sqrt(a["stiffness"] * reduced)
        self.law = LAWS[law](a)
        self.on_load = a["friction_on_load"] > 0.5
        self.keep = np.exp(-step_s / a["lag_s"])
        self.share = 1.0 / (a["load_inertia"] / step_s + 0.25 * step_s * a["stiffness"] + 0.5 * self.d)
        zero = np.zeros(len(a["Fc"]))
        self.torque, self.acceleration, self.too_many = zero, zero, zero.copy()
        self.q1, self.w1, self.q2, self.w2 = start.copy(), zero, start.copy(), zero

    def friction(self, w):
        a = self.a
        level = a["Fc"] + (a["Fs"] - a["Fc"]) * np.exp(-((np.abs(w) / a["vs"]) ** a["stribeck_exponent"]))
        return self.law.torque(w, level, self.h) + a["sigma2"] * w

    def step(self, command, q1, w1):
        """To where the encoder has the motor now, by its rule for the implicit step: the load is what is not known of it."""
        a, h = self.a, self.h
        arriving = command + (self.torque - command) * (1.0 - self.keep) * a["lag_s"] / h
        self.torque = command + (self.torque - command) * self.keep
        side = np.where(self.on_load, self.w2, self.w1) + 0.5 * h * self.acceleration
        friction = self.friction(side)
        on_load = np.where(self.on_load, friction, 0.0)
        twist, spin = self.q1 - self.q2, self.w1 - self.w2
        pull = 0.5 * a["stiffness"] * (twist + q1 - self.q2 - 0.5 * h * self.w2) + 0.5 * self.d * (spin + w1)
        w2 = self.share * (a["load_inertia"] / h * self.w2 - on_load + pull)
        q2 = self.q2 + 0.5 * h * (self.w2 + w2)
        coupling = 0.5 * (a["stiffness"] * (twist + q1 - q2) + self.d * (spin + w1 - w2))
        self.too_many += arriving - a["motor_inertia"] * (w1 - self.w1) / h - coupling - np.where(self.on_load, 0.0, friction)
        self.acceleration = np.where(self.on_load, w2 - self.w2, w1 - self.w1) / h
        self.q1, self.w1, self.q2, self.w2 = q1, w1, q2, w2

    def taken(self, steps):
        """Torque that arrived and was not needed, its mean since the last time."""
        mean = self.too_many / steps
        self.too_many[:] = 0.0
        return mean
