"""Axes that nobody here has: a rigid axis, sticking and sliding by Karnopp's rule, integrated by Heun's method, under a
velocity controller of its own; torque noise of a first-order colour, an encoder of finite steps."""
import math
import random
from dataclasses import dataclass, field


@dataclass
class Axis:
    inertia: float = 2.3e-4
    Fc_plus: float = 0.03
    Fc_minus: float = 0.03
    viscous: float = 4e-4
    drag: float = 0.0  # per square of the speed
    warm_up: tuple = (0.0, 1.0)  # share that friction has more when cold, s
    cogging: list = field(default_factory=list)  # amplitude, order, phase
    counts: int = 65536
    noise: tuple = (4e-4, 8.0)  # deviation, Hz
    weight: float = 0.0  # pulls always
    spring: float = 0.0  # pulls back to zero, per rad

    def friction(self, w, time):
        level = self.Fc_plus if w > 0 else self.Fc_minus
        warm = 1 + self.warm_up[0] * math.exp(-time / self.warm_up[1])
        return warm * (math.copysign(level, w) + self.viscous * w + self.drag * w * abs(w))

    def pull(self, q):
        return self.weight - self.spring * q + sum(a * math.sin(n * q + p) for a, n, p in self.cogging)


def acceleration(axis, q, w, torque, time):
    driving = torque + axis.pull(q)
    if abs(w) < 1e-6:
        level = axis.Fc_plus if driving > 0 else axis.Fc_minus
        if abs(driving) <= level:
            return None
        return (driving - math.copysign(level, driving)) / axis.inertia
    return (driving - axis.friction(w, time)) / axis.inertia


def run(axis, speed_of, seconds, rate_Hz=1000.0, seed=1, since_s=0.0, start=0.0, gains=(20.0, 60.0)):
    """Rows of time, torque and angle. `speed_of(t)`: the speed that is asked for; gains of the loop in 1/s, 1/s^2."""
    random_ = random.Random(seed)
    period, steps = 1.0 / rate_Hz, max(4, math.ceil(4000.0 / rate_Hz))
    h = period / steps
    q, w, integral, colour = start, 0.0, 0.0, 0.0
    keep = math.exp(-2 * math.pi * axis.noise[1] * h)
    rows, step = [], 2 * math.pi / axis.counts
    before = q
    for k in range(int(seconds * rate_Hz)):
        time = k * period
        read = math.floor(q / step + 0.5) * step
        error = speed_of(time) - (read - before) / period
        before = read
        integral = max(-0.5, min(0.5, integral + gains[1] * axis.inertia * error * period))
        torque = gains[0] * axis.inertia * error + integral
        rows.append((time, torque, read))
        for _ in range(steps):
            colour = keep * colour + math.sqrt(1 - keep * keep) * random_.gauss(0.0, axis.noise[0])
            at = since_s + time
            a = acceleration(axis, q, w, torque + colour, at)
            if a is None:
                w = 0.0
                continue
            middle = w + h * a
            if w * middle < 0:  # it stops on its way
                w = 0.0
                continue
            b = acceleration(axis, q + h * w, middle, torque + colour, at)
            after = w + h / 2 * (a + (b if b is not None else 0.0))
            q += h / 2 * (w + after)
            w = 0.0 if w * after < 0 else after
    return rows


def strokes(top, seed, lift=0.35, hold=1.6, sign=None):
    """Trapezoids of random height, back and forth, or in one direction."""
    random_ = random.Random(seed)
    heights = [top * random_.uniform(0.15, 1.0) * (sign if sign is not None else (-1) ** i) for i in range(400)]
    period = 2 * lift + hold + 0.4

    def speed_of(time):
        number, t = int(time / period), time % period
        return heights[number] * max(0.0, min(1.0, t / lift, (2 * lift + hold - t) / lift))
    return speed_of


def places(top, angles, lift=0.2, rest=0.3):
    """From one angle to the next and the first again, at one speed."""
    moves, at = [], 0.0
    for here, there in zip(angles, (*angles[1:], angles[0])):
        moves.append((at, abs(there - here) / top + lift, math.copysign(top, there - here)))
        at += moves[-1][1] + rest

    def speed_of(time):
        t = time % at
        start, length, speed = max(m for m in moves if m[0] <= t)
        return speed * max(0.0, min(1.0, (t - start) / lift, (start + length - t) / lift))
    return speed_of


def write(path, rows, header="time_s,torque_Nm,position_rad", text=lambda row: ",".join(f"{x:.9g}" for x in row)):
    with open(path, "w", encoding="utf-8") as file:
        file.write(header + "\n" if header else "")
        file.writelines(text(row) + "\n" for row in rows)
