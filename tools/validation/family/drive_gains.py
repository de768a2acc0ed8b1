#!/usr/bin/env python3
"""Gains of each family machine's drive cascade, from the axis's own numbers: what an autotuning drive finds.

    drive_gains.py [--out FILE]     searches, writes drive_gains.csv
    drive_gains.py --check          exit 1 when a margin of drive_gains.csv is missed

The smallest peak of motor travel per force on the table, over frequency, whose modulus margin 1 / Ms keeps Ms at most 2 for the axis
itself and 2.5 for stiffness and masses each 30 % off, all masses 30 % lighter, and the table held by its bristles. The loop is cut at
the torque: position P, velocity PI of a filtered difference of the encoder, a notch, half a tick of holding, the current loop's lag.
"""
import argparse
import csv
import itertools
import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
TICK_S, LAG_S, VELOCITY_FILTER_HZ = 125e-6, 0.2e-3, 3000.0
OWN_LIMIT, SET_LIMIT = 2.0, 2.5
ZETA = 0.03
PRESLIDING_M = 9e-6
COLUMNS = ["name", "position_gain_1_s", "velocity_gain_1_s", "velocity_integral_1_s", "notch_Hz", "notch_width", "notch_depth", "Ms_own", "Ms_set"]


class Axis:
    """Two inertias at the table; the friction's bristles hold the table where `held`."""

    def __init__(self, row, stiffness=1.0, table=1.0, masses=1.0, held=0.0):
        radius = float(row["lead_mm"]) * 1e-3 / (2 * math.pi)
        self.motor_kg = float(row["motor_inertia_kgm2"]) / radius**2 * masses
        self.table_kg = float(row["table_mass_kg"]) * table * masses
        self.stiffness = float(row["screw_stiffness_N_um"]) * 1e6 * stiffness
        nominal = 1 / (float(row["motor_inertia_kgm2"]) / radius**2) + 1 / float(row["table_mass_kg"])
        self.damping = 2 * ZETA * math.sqrt(float(row["screw_stiffness_N_um"]) * 1e6 / nominal)
        friction = float(row["friction_N"])
        self.bristle = held * friction / PRESLIDING_M
        self.bristle_damping = held * friction / 45 * 3000
        self.viscous = friction / 45 * 500

    @property
    def mode_Hz(self):
        return math.sqrt(self.stiffness * (1 / self.motor_kg + 1 / self.table_kg)) / (2 * math.pi)

    def per_force(self, s):
        """Motor travel per force on the motor, and per force on the table."""
        screw = self.stiffness + self.damping * s
        motor = self.motor_kg * s**2 + screw
        table = self.table_kg * s**2 + (self.viscous + self.bristle_damping) * s + self.bristle + screw
        both = motor * table - screw**2
        return table / both, screw / both


def members(row):
    yield Axis(row)
    for change in ({"stiffness": 0.7}, {"stiffness": 1.3}, {"table": 0.7}, {"table": 1.3}, {"masses": 0.7}, {"held": 1.0},
                   {"held": 1.0, "masses": 0.7}):
        yield Axis(row, **change)


class Drive:
    """What one tick of the cascade does, at the frequencies s."""

    def __init__(self, row, s):
        own = Axis(row)
        self.mass_kg, self.s = own.motor_kg + own.table_kg, s
        self.velocity = s * np.exp(-0.5 * TICK_S * s) / (1 + s / (2 * math.pi * VELOCITY_FILTER_HZ))
        self.to_torque = np.exp(-0.5 * TICK_S * s) / (1 + LAG_S * s)
        self.plants = [axis.per_force(s) for axis in members(row)]

    def force_per_travel(self, kp, kv, ki, notch):
        frequency, width, depth = notch
        filtered = 1.0
        if frequency > 0:
            w = 2 * math.pi * frequency
            filtered = (self.s**2 + 2 * depth * width * w * self.s + w**2) / (self.s**2 + 2 * width * w * self.s + w**2)
        return self.mass_kg * kv * (1 + ki / self.s) * (kp + self.velocity) * self.to_torque * filtered

    def judged(self, gains):
        """Ms of the axis itself, of all members, and the peak of motor travel per force on the table."""
        feedback = self.force_per_travel(*gains)
        peaks = [np.max(1 / np.abs(1 + feedback * motor)) for motor, _ in self.plants]
        motor, table = self.plants[0]
        return peaks[0], max(peaks), np.max(np.abs(table / (1 + feedback * motor)))


def frequencies():
    return 2j * np.pi * np.geomspace(0.3, 3000, 420)


def search(row):
    drive, mode_Hz = Drive(row, frequencies()), Axis(row).mode_Hz
    best = None
    notches = [(0.0, 0.5, 0.1), *itertools.product((0.75 * mode_Hz, 0.9 * mode_Hz, mode_Hz, 1.25 * mode_Hz), (0.3, 0.7), (0.1, 0.4))]
    for notch, kp_share, ki_share in itertools.product(notches, (0.2, 0.3, 0.4, 0.55), (0.08, 0.15, 0.25)):
        # From soft to stiff: a loop that has kept its margin all the way has not gone through instability.
        for kv in np.geomspace(0.02 * mode_Hz, 20 * mode_Hz, 90):
            gains = (kp_share * kv, kv, ki_share * kv, notch)
            own, worst, compliance = drive.judged(gains)
            if own > OWN_LIMIT or worst > SET_LIMIT:
                break
            if best is None or compliance < best[0]:
                best = (compliance, gains, own, worst)
    return best[1:]


def rounded(value):
    return float(f"{value:.3g}")


def read(path):
    with path.open(encoding="utf-8", newline="") as text:
        return list(csv.DictReader(text))


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--out", type=Path, default=HERE / "drive_gains.csv")
    arguments.add_argument("--check", action="store_true")
    options = arguments.parse_args()
    machines = read(HERE / "machines.csv")
    if options.check:
        bad = 0
        for row in read(options.out):
            gains = [float(row[c]) for c in COLUMNS[1:7]]
            own, worst, _ = Drive(next(m for m in machines if m["name"] == row["name"]), frequencies()).judged((*gains[:3], gains[3:]))
            if own > 1.02 * OWN_LIMIT or worst > 1.02 * SET_LIMIT:
                print(f"{row['name']}: Ms {own:.2f}, {worst:.2f}")
                bad = 1
        return bad
    with options.out.open("w", encoding="utf-8", newline="") as text:
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(COLUMNS)
        for row in machines:
            (kp, kv, ki, notch), own, worst = search(row)
            writer.writerow([row["name"], *(f"{rounded(v):g}" for v in (kp, kv, ki, *notch)), f"{own:.2f}", f"{worst:.2f}"])
            text.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
