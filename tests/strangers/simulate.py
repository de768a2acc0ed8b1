"""Moves a batch of axes side by side along their references, in closed loop, and returns what their drives would log.

Two inertias by the implicit trapezoidal rule in steps of 25 us, friction by friction_laws.py: neither integrator, nor friction, nor
noise is that of contourd or of its emulated machine.
"""
import numpy as np

from draw_axis import TICK_S, TURN
from fast_steps import FastSteps, compiled
from friction_laws import LAWS
from needed_torque import NeededTorque, nudged
from tune_loop import loop_band

# The friction of a step is that of its end, so that it acts half a step early. In steps of 100 us that looked like 6 us less delay,
# where a delay is stated to 5.
SUB = 40
STEP_S = TICK_S / SUB
HIDDEN = ["phase", "asymmetry", "asymmetry_viscous", "offset", "along", "along_periods", "spring", "ripple", "ripple_order", "cogging",
          "cogging_order", "square_drag", "rate_1_K", "drift", "viscous_drift", "ratio", "saturation", "payload", "payload_at", "gap", "soft_share",
          "soft_ratio", "more_delay_s", "more_lag_s", "reading", "reading_order", "pitch", "pitch_periods", "cross", "load_friction",
          "vibration", "vibration_Hz", "jitter_s"]


def stacked(dicts, keys, otherwise=None):
    return {k: np.array([float(d.get(k, (otherwise or {}).get(k, 0.0))) for d in dicts]) for k in keys}


def transition(j1, j2, k, d):
    """x' = A x + B f of [q1 w1 q2 w2] under forces on either, over a step."""
    n = len(j1)
    a, b = np.zeros((n, 4, 4)), np.zeros((n, 4, 2))
    a[:, 0, 1] = a[:, 2, 3] = 1.0
    a[:, 1] = np.stack([-k, -d, k, d], 1) / j1[:, None]
    a[:, 3] = np.stack([k, d, -k, -d], 1) / j2[:, None]
    b[:, 1, 0], b[:, 3, 1] = 1.0 / j1, 1.0 / j2
    left = np.linalg.inv(np.eye(4) - 0.5 * STEP_S * a)
    return left @ (np.eye(4) + 0.5 * STEP_S * a), left @ b * STEP_S


def deviates(seeds, stream, ticks):
    """Of every axis its own: what it is drawn beside changes nothing."""
    return np.stack([np.random.default_rng([int(seed), 3, stream]).normal(size=ticks) for seed in seeds], 1)


def coloured(ticks, axes):
    """Torque noise by tick: white, and a first-order one with its corner."""
    n = len(axes["white"])
    keep = np.exp(-TURN * axes["corner_Hz"] * TICK_S)
    out, slow = deviates(axes["seed"], 0, ticks), np.zeros(n)
    drive = deviates(axes["seed"], 1, ticks) * np.sqrt(1.0 - keep**2)
    for k in range(ticks):
        slow = keep * slow + drive[k]
        out[k] = axes["white"] * out[k] + axes["coloured"] * slow
    return out


class Controller:
    """Position P, speed PI, with the axis's own inertia and friction fed forward; on quantised positions."""

    def __init__(self, a):
        band = loop_band(a)
        self.kv, self.kp, self.ki = band * a["inertia"], band / 4.0, band / 5.0
        self.a, self.last, self.speed, self.sum = a, None, 0.0, np.zeros(len(band))

    def command(self, q, target, speed, acceleration):
        if self.last is not None:
            self.speed = 0.5 * self.speed + 0.5 * (q - self.last) / TICK_S
        self.last = q
        error = speed + self.kp * (target - q) - self.speed
        limit = 2.0 * self.a["Fs"] / (self.kv * self.ki * TICK_S)
        self.sum = np.clip(self.sum + error, -limit, limit)
        friction = 0.8 * self.a["Fc"] * np.tanh(speed / self.a["vs"]) + self.a["sigma2"] * speed
        return self.a["inertia"] * acceleration + friction + self.kv * (error + self.ki * TICK_S * self.sum)


def numbers(axes):
    return stacked(axes, [k for k, v in axes[0].items() if isinstance(v, (int, float, np.floating, np.integer))])


class Batch:
    """`models`: the axes without what is hidden; with them the log has the torque and the position that they leave unexplained, too."""

    def __init__(self, axes, effects, motions, law, models=None, fast=True):
        self.n = len(axes)
        self.a = numbers(axes)
        self.e = stacked(effects, HIDDEN, {"ratio": 1.0, "payload_at": 2.0})
        self.ticks = max(len(m[0]) for m in motions)
        pad = lambda x: np.concatenate([x, np.full(self.ticks - len(x), x[-1])])
        self.target, self.push, self.other = (np.stack([pad(m[i]) for m in motions], 1) for i in range(3))
        self.law = LAWS[law](self.a)
        self.soft = np.zeros(self.n)
        self.lengths = np.array([len(m[0]) for m in motions], float)
        self.x, self.torque = np.zeros((self.n, 4)), np.zeros(self.n)
        self.x[:, 0] = self.x[:, 2] = self.target[0]
        self.acceleration, self.temperature = np.zeros(self.n), np.full(self.n, 21.0)
        self.make_mechanics()
        model = numbers(models) if models else None
        self.model, self.twin = (NeededTorque(m, law, STEP_S, self.x[:, 0]) if models else None for m in (model, models and nudged(model)))
        self.function = compiled() if fast else None

    def make_mechanics(self):
        a, e = self.a, self.e
        load = a["load_inertia"] + e["payload"] * a["inertia"] * (e["payload_at"] < 0.0)
        reduced = a["motor_inertia"] * load / (a["motor_inertia"] + load)
        self.k = a["stiffness"]
        self.d = 2.0 * a["damping_ratio"] * np.sqrt(self.k * reduced)
        self.ad, self.bd = transition(a["motor_inertia"], load, self.k, self.d)
        self.total = a["motor_inertia"] + load

    def slow_parts(self, k):
        """What changes little within a tick: level of friction, and torque that does not come from the motor."""
        a, e = self.a, self.e
        x = self.x[:, 2] * a["lever_m"] / a["stroke_m"]
        along = 1.0 + e["along"] * np.sin(TURN * e["along_periods"] * x + e["phase"])
        done = np.minimum(1.0, k / self.lengths)
        in_time = 1.0 + e["drift"] * done
        net = np.abs(self.total * self.acceleration)
        self.level_factor = along * in_time + e["load_friction"] * net / a["Fc"]
        # What pulls from outside pulls at the table.
        self.outside = e["offset"] - e["spring"] * 2.0 * x
        k = min(max(k, 1), self.ticks - 2)
        other = (self.other[k + 1] - 2.0 * self.other[k] + self.other[k - 1]) / TICK_S**2
        self.outside = self.outside - e["cross"] * other
        self.viscous = a["sigma2"] * (1.0 + e["rate_1_K"] * (self.temperature - 21.0) + e["viscous_drift"] * done)

    def friction(self, w, q):
        a, e = self.a, self.e
        shape = np.exp(-((np.abs(w) / a["vs"]) ** a["stribeck_exponent"]))
        side = np.sign(w)
        ripple = 1.0 + e["ripple"] * np.sin(e["ripple_order"] * q + e["phase"])
        level = (a["Fc"] + (a["Fs"] - a["Fc"]) * shape) * np.maximum(0.05, self.level_factor * ripple + 0.5 * e["asymmetry"] * side)
        hard = self.law.torque(w, level * (1.0 - e["soft_share"]), STEP_S)
        # Softer in travel, whatever its share: one that breaks away where the rest does is no other element.
        stiffness = a["sigma0"] * np.maximum(e["soft_share"] * e["soft_ratio"], 1e-6)
        self.soft = (self.soft + STEP_S * w) / (1.0 + STEP_S * np.abs(w) * stiffness / (level * np.maximum(e["soft_share"], 1e-9)))
        drag = self.viscous * w * (1.0 + 0.5 * e["asymmetry_viscous"] * side) + e["square_drag"] * w * np.abs(w) / a["fast_rad_s"] ** 2
        return hard + stiffness * self.soft * (e["soft_share"] > 0.0) + drag

    def step(self, t, command, noise):
        a, e, x = self.a, self.e, self.x
        lag = a["lag_s"] + e["more_lag_s"]
        keep = np.exp(-STEP_S / lag)
        mean = command + (self.torque - command) * (1.0 - keep) * lag / STEP_S
        self.torque = command + (self.torque - command) * keep
        motor = mean * e["ratio"] * (1.0 - e["saturation"] * (mean / a["rated"]) ** 2) + noise
        q1 = x[:, 0]
        on_load = a["friction_on_load"] > 0.5
        w = np.where(on_load, x[:, 3], x[:, 1]) + 0.5 * STEP_S * self.last_acceleration
        friction = self.friction(w, q1)
        motor = motor - e["cogging"] * np.sin(e["cogging_order"] * q1 + e["phase"])
        outside = self.outside - e["vibration"] * np.sin(TURN * e["vibration_Hz"] * t)
        twist, spin = x[:, 0] - x[:, 2], x[:, 1] - x[:, 3]
        free = np.clip(twist, -0.5 * e["gap"], 0.5 * e["gap"])
        lost = self.k * free + self.d * spin * (np.abs(twist) < 0.5 * e["gap"])
        forces = np.stack([motor + lost - np.where(on_load, 0.0, friction), outside - lost - np.where(on_load, friction, 0.0)], 1)
        new = np.einsum("nij,nj->ni", self.ad, x) + np.einsum("nij,nj->ni", self.bd, forces)
        side = np.where(on_load, new[:, 3] - x[:, 3], new[:, 1] - x[:, 1])
        self.last_acceleration = side / STEP_S
        self.heat = friction * w
        self.x = new

    def reading(self, q):
        return q + self.e["reading"] * np.sin(self.e["reading_order"] * q + self.e["phase"])

    def reading_speed(self, q, w):
        return w * (1.0 + self.e["reading"] * self.e["reading_order"] * np.cos(self.e["reading_order"] * q + self.e["phase"]))

    def late(self, delay_s):
        """Rows back from now at which the command of each sub-step lies, and what of it is from a step before that."""
        steps = delay_s / STEP_S
        whole = np.floor(steps + 1e-6)
        back = [np.floor((np.arange(SUB)[:, None] - more - whole[None, :]) / SUB).astype(int) for more in (0, 1)]
        return back[0], back[1], np.maximum(0.0, steps - whole - 1e-6)

    def arriving(self, commands, k, late):
        """A row a sub-step."""
        newer, older, share = late
        now = commands[k + 8 + newer, self.everyone]
        return now if not share.any() else now + share * (commands[k + 8 + older, self.everyone] - now)

    def look(self, command):
        q, w = self.x[:, 0], self.x[:, 1]
        for model in (self.model, self.twin):
            model.step(command, self.reading(q), self.reading_speed(q, w))

    def run(self):
        a, e = self.a, self.e
        noise, self.everyone = coloured(self.ticks, a), np.arange(self.n)
        late, stated_late = self.late(a["delay_s"] + e["more_delay_s"]), self.late(a["delay_s"])
        fast = FastSteps(self, self.function, STEP_S) if self.function else None
        of_model = ("true_q", "true_table", "unexplained_torque", "unexplained_table", "parted") if self.model else ()
        shown = ("q", "table", "temperature") + of_model
        commands, out = np.zeros((self.ticks + 8, self.n)), {k: np.zeros((self.ticks, self.n)) for k in shown}
        count = TURN / a["counts"]
        controller, wander = Controller({**a, "damping": self.d}), np.zeros(self.n)
        self.last_acceleration, self.heat = np.zeros(self.n), np.zeros(self.n)
        keep = np.exp(-TICK_S / a["wander_s"])
        speed = np.gradient(self.target, TICK_S, axis=0)
        acceleration = np.gradient(speed, TICK_S, axis=0)
        jitter = deviates(a["seed"], 2, self.ticks) * e["jitter_s"]
        wandering = deviates(a["seed"], 4, self.ticks) * np.sqrt(1.0 - keep**2) * a["wander_m"]
        for k in range(self.ticks):
            changed = (e["payload_at"] >= 0.0) & (k >= e["payload_at"] * self.lengths)
            if changed.any():
                e["payload_at"][changed] = -1.0
                self.make_mechanics()
                if fast:
                    fast.mechanics()
            self.slow_parts(k)
            q = self.x[:, 0] + self.x[:, 1] * jitter[k]
            q = np.round(self.reading(q) / count) * count
            u = controller.command(q, self.target[k], speed[k], acceleration[k]) + self.push[k]
            u = np.round(np.clip(u, -2.0 * a["rated"], 2.0 * a["rated"]) / a["torque_step"]) * a["torque_step"]
            commands[k + 8] = u
            wander = keep * wander + wandering[k]
            x = self.x[:, 2] * a["lever_m"]
            x = x + e["pitch"] * np.sin(TURN * e["pitch_periods"] * x / a["stroke_m"] + e["phase"])
            if self.model:
                out["true_q"][k], out["true_table"][k] = self.reading(self.x[:, 0]), x
                out["unexplained_table"][k] = x - self.model.q2 * a["lever_m"]
            x = x + wander
            out["q"][k], out["table"][k] = q, np.round(x / a["scale_step_m"]) * a["scale_step_m"]
            out["temperature"][k] = self.temperature
            before = self.x[:, 3].copy()
            arriving, stated = self.arriving(commands, k, late), self.arriving(commands, k, stated_late) if self.model else None
            if fast:
                fast.tick(k * TICK_S, arriving, noise[k], stated)
            for j in range(0 if fast else SUB):
                self.step((k + j / SUB) * TICK_S, arriving[j], noise[k])
                if self.model:
                    self.look(stated[j])
            if self.model:
                left = self.model.taken(SUB)
                out["unexplained_torque"][k], out["parted"][k] = left + noise[k], left - self.twin.taken(SUB)
            self.acceleration = 0.5 * self.acceleration + 0.5 * (self.x[:, 3] - before) / TICK_S
            warm = 25.0 * self.heat / (a["Fc"] * a["fast_rad_s"]) - (self.temperature - 21.0)
            self.temperature = self.temperature + warm * TICK_S / 12.0
        return {"torque": commands[8:], **out}
