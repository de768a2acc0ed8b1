#!/usr/bin/env python3
"""The gains of core/two_inertia_loop.h by scipy, in micrometres, milliseconds, newtons and kilograms.

    loop_by_scipy.py

Prints what tests/core/two_inertia_loop_test.cc compares with.
"""
import numpy as np
from scipy.linalg import expm, solve_discrete_are

TWO_PI = 2 * np.pi


def over(axis, span_ms):
    """Motion p1 v1 p2 v2 u over a span; columns after it: command, force on motor, force on table."""
    m1, m2, k, c, s2, lag = (axis[key] for key in ("m1", "m2", "k", "c", "s2", "lag"))
    a = np.zeros((8, 8))
    a[0, 1] = a[2, 3] = 1
    a[1] = [-k / m1, -c / m1, k / m1, c / m1, 1 / m1, 0, 1 / m1, 0]
    a[3] = [k / m2, c / m2, -k / m2, -(c + s2) / m2, 0, 0, 0, 1 / m2]
    a[4, 4], a[4, 5] = -1 / lag, 1 / lag
    return expm(a * span_ms)


def motion(axis, period_ms):
    dead = axis["dead"]
    whole = over(axis, period_ms)
    if dead == 0:
        return whole[:5, :5], np.column_stack([whole[:5, 5], np.zeros(5)]), whole[:5, 6], whole[:5, 7], 1
    first, second = over(axis, dead), over(axis, period_ms - dead)
    old = second[:5, :5] @ first[:5, 5]
    return whole[:5, :5], np.column_stack([old, second[:5, 5]]), whole[:5, 6], whole[:5, 7], 2


def observer(axis, t, period_ms, scale):
    a5, _, on_motor, on_table, _ = motion(axis, period_ms)
    n = 7 if scale else 6
    a = np.eye(n)
    a[:5, :5] = a5
    a[:5, -1] = -on_table
    w = lambda f: TWO_PI * f * 1e-3
    q = np.zeros((n, n))
    q[:5, :5] = (axis["m1"] * w(t["f1"]) ** 2) ** 2 * np.outer(on_motor, on_motor)
    q[:5, :5] += (axis["m2"] * w(t["f2"]) ** 2) ** 2 * np.outer(on_table, on_table)
    q[-1, -1] = ((axis["m1"] + axis["m2"]) * w(t["fd"]) ** 3 * period_ms) ** 2
    c = np.zeros((2 if scale else 1, n))
    c[0, 0] = 1
    r = np.eye(len(c))
    if scale:
        c[0, 5] = 1
        c[1, 2] = 1
        r[1, 1] = t["rs"] ** 2
        q[5, 5] = (w(t["fb"]) * period_ms) ** 2
    p = solve_discrete_are(a.T, c.T, q, r)
    return p @ c.T @ np.linalg.inv(c @ p @ c.T + r)


def regulator(axis, t, period_ms):
    a5, inputs, _, _, queued = motion(axis, period_ms)
    n = 5 + queued
    a, b = np.zeros((n, n)), np.zeros((n, 1))
    a[:5, :5] = a5
    a[:5, 5:5 + queued] = inputs[:, :queued]
    for i in range(queued - 1):
        a[5 + i, 6 + i] = 1
    b[-1] = 1
    w = TWO_PI * t["fn"] * 1e-3
    mass = axis["m1"] + axis["m2"]
    q = np.zeros((n, n))
    q[2, 2] = 1
    stretch = np.zeros(n)
    stretch[1], stretch[3] = 1, -1
    q += (t["rho"] / w) ** 2 * np.outer(stretch, stretch)
    q[3, 3] += (t["beta"] / w) ** 2
    r = np.array([[1 / (mass * w * w) ** 2]])
    x = solve_discrete_are(a, b, q, r)
    return np.linalg.solve(r + b.T @ x @ b, b.T @ x @ a)


def main():
    base = dict(m1=79.0, m2=10.0, k=40.0, c=1.1, s2=0.5, lag=0.2, dead=0.0)
    soft = dict(m1=79.0, m2=60.0, k=15.0, c=1.4, s2=0.9, lag=0.2, dead=0.06)
    tuning = dict(fn=18.0, rho=0.4, beta=0.15, fd=200.0, f1=400.0, f2=80.0, rs=1.5, fb=5.0)
    np.set_printoptions(precision=15)
    for name, axis, period_ms, scale in (("base", base, 1.0, False), ("soft", soft, 1.0, True), ("fast", base, 0.5, False)):
        si = np.array([1, 1e3, 1, 1e3, 1e6] + ([1] if scale else []) + [1e6])
        print(name, "observer", (observer(axis, tuning, period_ms, scale) * si[:, None]).tolist())
        k = regulator(axis, tuning, period_ms)[0]
        si = np.array([1e6, 1e3, 1e6, 1e3] + [1] * (len(k) - 4))
        print(name, "regulator", (k * si).tolist())


if __name__ == "__main__":
    main()
