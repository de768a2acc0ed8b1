"""Friction of a batch of axes, a law each: what a bristle, a slip element or a row of them answers to a step of motion."""
import numpy as np


class LuGre:
    """Bristle by backward Euler: at high speeds it sits on its level, at low ones it follows the motion."""

    def __init__(self, axes):
        self.s0, self.s1, self.z = axes["sigma0"], axes["sigma1"], np.zeros(len(axes["Fc"]))
        self.decay = axes["vs"]

    def torque(self, w, level, step_s):
        before = self.z
        self.z = (before + step_s * w) / (1.0 + step_s * np.abs(w) * self.s0 / level)
        return 0.5 * self.s0 * (self.z + before) + self.s1 * (self.z - before) / step_s


class Dahl:
    """Dahl's curve with an exponent that LuGre does not have; no break-away peak of its own beyond the level's."""

    EXPONENT = 2.0

    def __init__(self, axes):
        self.s0, self.z = axes["sigma0"], np.zeros(len(axes["Fc"]))

    def torque(self, w, level, step_s):
        before, end = self.z, level / self.s0
        short = np.clip(1.0 - np.sign(w) * before / end, 0.0, 2.0)
        self.z = np.clip(before + step_s * w * short**self.EXPONENT, -end, end)
        return 0.5 * self.s0 * (self.z + before)


class GeneralisedMaxwellSlip:
    """Ten elements that slip one after the other, over a decade of travel about that of the bristle."""

    def __init__(self, axes):
        travel = np.geomspace(0.3, 4.0, 10)
        share = np.ones(10) / 10.0
        self.share, n = share, len(axes["Fc"])
        self.stiffness = (axes["Fc"] * share[:, None]) / (travel[:, None] * axes["Fc"] / axes["sigma0"])
        self.z = np.zeros((10, n))

    def torque(self, w, level, step_s):
        end = self.share[:, None] * level / self.stiffness
        before = self.z
        self.z = np.clip(before + step_s * w, -end, end)
        return (0.5 * self.stiffness * (self.z + before)).sum(0)


LAWS = {"lugre": LuGre, "dahl": Dahl, "maxwell_slip": GeneralisedMaxwellSlip}
