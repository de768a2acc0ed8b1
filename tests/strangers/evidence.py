#!/usr/bin/env python3
"""What a hidden effect is worth to whoever knows the axis's noise: by how much -2 ln likelihood falls with it, after a linear refit.

    evidence.py CASE...

Folders of strangers.py --make; their logs are made once more, with what the models without the effect leave unexplained. An upper bound:
the noise is known, and so is the shape of the effect. Of a torque only (no pitch error, no jitter).
"""
import json
import sys
from pathlib import Path

import numpy as np

from draw_axis import STATED, TICK_S, TURN
from share import dynamic_stiffness, foreseen, friction_moved, sensitivities, spectrum
from sizing import Case, simulate

# Below half the rate.
BAND_HZ = 499.0
# Of a coupling that nobody stated, its stiffness: a factor of two.
UNSTATED = {**STATED, "stiffness": 1.0}


def noise_density(axis, f):
    """Of the torque, per row: its own noise, and what the encoder's rounding looks like."""
    keep = np.exp(-TURN * axis["corner_Hz"] * TICK_S)
    slow = axis["coloured"] ** 2 * (1.0 - keep**2) / np.abs(1.0 - keep * np.exp(-1j * TURN * f * TICK_S)) ** 2
    rounding = np.abs(dynamic_stiffness(axis, f)[0]) ** 2 * (TURN / axis["counts"]) ** 2 / 12.0
    return axis["white"] ** 2 + slow + rounding


def evidence(axis, log, friction):
    """`axis`: without what is hidden. The square of the effect, as white as the noise, that no number of it makes up for."""
    rows, kept = len(log["q"]), foreseen(axis, log)
    f = np.arange(int(BAND_HZ * rows * TICK_S) + 1) / (rows * TICK_S)
    root = 1.0 / np.sqrt(noise_density(axis, f))
    effect = np.fft.irfft(spectrum(log["unexplained_torque"] * kept, BAND_HZ) * root, rows)[kept]
    columns = sensitivities(axis, log, friction, BAND_HZ, UNSTATED if axis["stated_rigid"] else STATED)
    columns = np.fft.irfft(columns * root[:, None], rows, axis=0)[kept]
    on = columns.T @ effect
    return float(effect @ effect - on @ np.linalg.solve(columns.T @ columns + np.eye(len(on)), on))


def case_of(folder):
    truth = json.loads((Path(folder) / "truth.json").read_text(encoding="utf-8"))
    case = Case(truth["kind"], truth["seed"], truth["strength"], truth["law"])
    case.size = truth["size"]
    case.prepare()
    return case


def main():
    cases = [case_of(folder) for folder in sys.argv[1:]]
    for case in cases:
        (log,), q = simulate([case])
        friction = friction_moved([case.model], case.law, q)[:, :, 0]
        print(f"{case.name}: {evidence(case.model, log, friction):.0f}", flush=True)


if __name__ == "__main__":
    main()
