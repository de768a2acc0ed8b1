"""A reference and an added torque, a sample each tick: what somebody would run who wants to see all of an axis."""
import numpy as np

from draw_axis import TICK_S, TURN


def stroke(distance, speed, acceleration):
    """Positions of a move that begins and ends at rest, from 0; its jerk is finite."""
    time_s = abs(distance) / speed + speed / acceleration
    if speed * speed / acceleration > abs(distance):
        time_s = 2.0 * np.sqrt(abs(distance) / acceleration)
        speed = time_s * acceleration / 2.0
    t = np.arange(0.0, time_s + 0.03, TICK_S)
    v = np.clip(np.minimum(acceleration * t, acceleration * (time_s - t)), 0.0, speed)
    v = np.convolve(v, np.ones(20) / 20.0)[: len(t)]
    x = np.cumsum(v)
    return distance * x / x[-1]


class Motion:
    def __init__(self, axis):
        self.axis, self.x, self.u, self.other = axis, [np.zeros(400)], [np.zeros(400)], [np.zeros(400)]
        self.random = np.random.default_rng([axis["excitation"]])
        self.fast = axis["fast_rad_s"]
        self.acceleration = 0.25 * axis["rated"] / axis["inertia"]

    @property
    def at(self):
        return self.x[-1][-1]

    def add(self, x, u=None, other=None):
        n = len(x)
        self.x.append(np.asarray(x, float))
        self.u.append(np.zeros(n) if u is None else u[:n])
        self.other.append(np.zeros(n) if other is None else other[:n])

    def to(self, target, speed, other=False, torque=None):
        if abs(target - self.at) < 1e-9:
            return
        x = self.at + stroke(target - self.at, speed, self.acceleration)
        n = len(x)
        t = np.arange(n) * TICK_S
        u = None if torque is None else torque(t)
        o = None
        if other:
            fade = np.minimum(1.0, np.minimum(t, t[::-1]) / 0.3)
            o = fade * sum(5e-4 * np.sin(TURN * f * t + f) / f for f in (1.3, 3.1, 4.7, 7.9))
        self.add(x, u, o)
        self.rest(0.12)

    def rest(self, seconds, torque=None):
        n = int(seconds / TICK_S)
        self.add(np.full(n, self.at), torque)

    def torque_steps(self):
        for size in (0.4, -0.4, 0.7, -0.7):
            n = 250
            push = size * self.axis["Fs"] * np.minimum(1.0, np.minimum(np.arange(n), np.arange(n)[::-1]) / 60.0)
            self.rest(0.25, push)
            self.rest(0.1)

    def reversals(self):
        for size_m in (3e-6, 1e-5, 4e-5, 2e-4, 1e-3):
            t = np.arange(0.0, 1.0, TICK_S)
            self.add(self.at + size_m / self.axis["lever_m"] * np.sin(TURN * 2.0 * t) * np.minimum(1.0, np.minimum(t, t[::-1]) / 0.2))

    def shaken(self, target, speed):
        lines = np.linspace(12.0, 330.0, 36) * self.random.uniform(0.98, 1.02, 36)
        phases = self.random.uniform(0.0, TURN, 36)
        size = 0.012 * self.axis["rated"]
        self.to(target, speed, torque=lambda t: size * np.sin(TURN * np.outer(t, lines) + phases).sum(1) / 4.0)

    def pulses(self, target, speed):
        size = 0.5 * self.axis["rated"]
        self.to(target, speed, torque=lambda t: size * ((t % 0.31 < 0.006) * 1.0 - ((t + 0.155) % 0.31 < 0.006)))


def both_directions(axis):
    """Everything that the catalogue asks for, in about a minute. Reference in rad, added torque, the other axis in m."""
    m = Motion(axis)
    half = 0.5 * axis["stroke_m"] / axis["lever_m"]
    fast, slow = m.fast * m.random.uniform(0.85, 1.0), m.fast * m.random.uniform(0.12, 0.2)
    m.torque_steps()
    m.reversals()
    for v in (0.5, 2.0, 6.0):
        m.to(m.at + min(0.2 * half, v * axis["vs"] * 0.6), v * axis["vs"])
        m.to(m.at - min(0.2 * half, v * axis["vs"] * 0.6), v * axis["vs"])
    reach = 0.3 * half
    m.shaken(reach, slow)
    m.shaken(-reach, slow)
    m.pulses(reach, 0.4 * fast)
    m.pulses(-reach, 0.4 * fast)
    m.to(-half, fast)
    for v in (0.45 * fast, fast, fast):
        m.to(half, v)
        m.to(-half, v)
    m.to(0.0, slow, other=axis["second_axis"])
    m.to(-0.5 * half, slow, other=axis["second_axis"])
    m.rest(3.0)
    m.reversals()
    m.to(-half, fast)
    for v in (0.5 * fast, fast):
        m.to(half, v)
        m.to(-half, v)
    m.pulses(reach, 0.4 * fast)
    m.shaken(-reach, slow)
    m.torque_steps()
    m.rest(0.5)
    return np.concatenate(m.x), np.concatenate(m.u), np.concatenate(m.other)
