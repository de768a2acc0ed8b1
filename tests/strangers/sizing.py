"""Sizes what is hidden so that it leaves the share of the residual that its strength is defined by, and makes the logs."""
import numpy as np

from draw_axis import draw_axis, stated_of
from effects import NEEDS, Limits, hidden
from motion import both_directions
from share import friction_moved, share_of
from simulate import Batch, coloured, numbers

# Of the residual's variance, by strength; of a torque constant, how far it is off.
SHARES = {"clear": 0.55, "moderate": 0.13, "barely": 0.02}
# Before they were measured: what makes such shares of a torque that nothing in the model stands for. Where a search begins.
NOMINAL = {"clear": 1.0, "moderate": 0.35, "barely": 0.13}
OTHERWISE = {"torque_constant": {"clear": 1.0, "moderate": 0.6, "barely": 0.36},
             "input_delay": {"moderate": 1.0 / 3.0, "barely": 1.0 / 3.0}}
# Of effect to noise, as a factor.
NEAR_ENOUGH = 1.3
TURNS = 7
# Nobody can tell.
LEAST_PITCH_UM = 0.1
# An axis stated as rigid has a mode of its own; a softer one is to be a third below it.
SOFTER = (2.0 / 3.0) ** 2


class Case:
    def __init__(self, kind, seed, strength, law):
        self.kind, self.seed, self.strength, self.law = kind, seed, strength, law
        self.tried, self.share, self.why_not = [], None, None
        self.size = {**NOMINAL, **OTHERWISE.get(kind, {})}[strength]
        self.prepare()

    def prepare(self):
        self.axis = draw_axis(self.seed, NEEDS.get(self.kind, ()))
        self.stated, self.effect, self.truth, limits = stated_of(self.axis), {}, {}, Limits()
        self.model = dict(self.axis)
        if self.kind == "stribeck":
            self.model["Fs"] = self.model["Fc"]
        if self.kind != "clean":
            self.effect, self.truth = hidden(self.kind, self.axis, self.size, np.random.default_rng([self.seed, 4]), limits)
        self.motion = both_directions(self.axis)
        return not limits.beyond

    @property
    def name(self):
        return f"{'clean' if self.kind == 'clean' else self.strength + '_' + self.kind}_{self.law}_{self.seed}"

    def next_size(self):
        """The logarithm of it: between one that is too small and one that is too large, else along the last two."""
        low = max((t for t in self.tried if t[1] < 0.0), default=None)
        high = min((t for t in self.tried if t[1] > 0.0), default=None)
        if low and high and low[0] < high[0]:
            return low[0] + (high[0] - low[0]) * np.clip(low[1] / (low[1] - high[1]), 0.25, 0.75)
        (b, y), rise = self.tried[-1], 2.0
        if len(self.tried) > 1 and self.tried[-2][0] != b:
            a, x = self.tried[-2]
            rise = np.clip((y - x) / (b - a), 0.7, 5.0)
        return b + np.clip(-y / rise, -4.0, 2.5)

    def measured(self, share):
        """Whether it is as strong as it is to be; else its size is another one, or `why_not` says why there is none."""
        self.share = share
        asked, ratio = (np.log(s / (1.0 - s)) for s in (SHARES[self.strength], max(share, 1e-9)))
        if self.kind == "torque_constant" or abs(ratio - asked) < np.log(NEAR_ENOUGH):
            return True
        self.tried.append((float(np.log(self.size)), float(ratio - asked)))
        self.size = float(np.exp(self.next_size()))
        within = self.prepare()
        if not within:
            self.why_not = "beyond what a machine can have"
        elif self.kind == "pitch_error" and self.effect["pitch"] * 1e6 < LEAST_PITCH_UM:
            self.why_not = "nobody can tell"
        elif self.kind == "compliance" and self.axis["stiffness"] > SOFTER * self.model["stiffness"]:
            self.why_not = "no softer than the axis is anyway"
        return False


def simulate(cases):
    """Logs of cases of one law, a dict of columns each."""
    batch = Batch([c.axis for c in cases], [c.effect for c in cases], [c.motion for c in cases], cases[0].law, [c.model for c in cases])
    columns, out = batch.run(), []
    for i, case in enumerate(cases):
        out.append({name: values[:len(case.motion[0]), i] for name, values in columns.items()})
        out[-1]["other"] = case.motion[2]
    return out, columns["true_q"]


def shares(cases, logs, q):
    noise = coloured(len(q), numbers([c.model for c in cases]))
    friction = friction_moved([c.model for c in cases], cases[0].law, q)
    return [share_of(c.kind, c.model, c.effect, log, noise[:len(log["q"]), i], friction[:len(log["q"]), :, i])
            for i, (c, log) in enumerate(zip(cases, logs))]


def sized(cases, by_share):
    """Pairs of case and log; those that cannot be as strong as asked have none."""
    left = list(cases)
    for turn in range(TURNS):
        if not left:
            return
        logs, q = simulate(left)
        of_each, again = shares(left, logs, q), []
        for case, log, share in zip(left, logs, of_each):
            if case.kind == "clean" or not by_share:
                case.share = share
                yield case, log
            elif case.measured(share):
                yield case, log
            elif case.why_not or turn + 1 == TURNS:
                case.why_not = case.why_not or f"not reached in {TURNS} turns"
                yield case, None
            else:
                again.append(case)
        left = again
