#!/usr/bin/env python3
"""Draws how far a drive's own loop gives to a force on the motor, as contour commission --drive measured it.

    plot_drive.py DRIVE_JSON [--out FILE]

Above: travel per force over frequency, measured with its scatter, and the fitted loop. Below: the phase. Prints the file it wrote.
"""
import argparse
import json
import sys
from pathlib import Path

import numpy as np

import style


def draw(pyplot, drive):
    lines = drive["response"]
    frequency, measured, scatter, model, phase, model_phase = (
        np.array([line[key] for line in lines])
        for key in ("frequency_Hz", "compliance_um_N", "scatter_rel", "model_um_N", "phase_deg", "model_phase_deg"))
    figure, (size, angle) = pyplot.subplots(2, 1, figsize=(8, 6.4), sharex=True)
    certain = scatter < 0.5
    size.fill_between(frequency, measured * np.maximum(1 - 2 * scatter, 0.02), measured * (1 + 2 * scatter), where=certain,
                      color=style.QUIET, alpha=0.3, linewidth=0, label="two standard deviations")
    size.loglog(frequency[certain], measured[certain], ".", markersize=3, color=style.PLAIN, label="measured")
    size.loglog(frequency, model, color=style.COMPENSATED, label="fitted loop")
    size.set_ylabel("travel per force (µm/N)")
    size.legend()
    angle.semilogx(frequency[certain], phase[certain], ".", markersize=3, color=style.PLAIN)
    angle.semilogx(frequency, model_phase, color=style.COMPENSATED)
    angle.set_ylabel("phase (deg)")
    angle.set_yticks(range(-180, 181, 90))
    angle.set_xlabel("frequency (Hz)")
    figure.suptitle(f"Axis {drive['axis']}, its drive's own loop: peak of sensitivity {drive['sensitivity_peak']:.2f}, "
                    f"bandwidth {drive['bandwidth_Hz']:.0f} Hz")
    return figure


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("drive", type=Path)
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    try:
        drive = json.loads(options.drive.read_text())
        style.apply()
        figure = draw(style.pyplot, drive)
    except (OSError, ValueError, KeyError) as error:
        print(f"plot_drive.py: {options.drive}: {error}", file=sys.stderr)
        return 2
    out = options.out or options.drive.with_suffix(".png")
    figure.savefig(out)
    print(out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
