#!/usr/bin/env python3
"""Draws what `contour identify --report` or `contour commission` found.

    plot_identification.py DIR

DIR holds identification.json. Writes stribeck.png, presliding.png, overlay.png, screw.png where there is data for
it, and report.html, one page with all of them. Prints the files it wrote, one per line.
"""
import argparse
import base64
import cmath
import html
import json
import math
import sys
from pathlib import Path

from style import COMPENSATED, PLAIN, QUIET, TRUTH, WINDOW, apply

NAMES = {
    "motor_mass_kg": ("inertia of motor and screw, seen at the table", 1, "kg"),
    "table_mass_kg": ("mass of the table", 1, "kg"),
    "stiffness_N_m": ("stiffness of the screw", 1e-6, "N/um"),
    "damping_Ns_m": ("damping of the screw", 1, "N s/m"),
    "Fs_plus_N": ("break-away level, upwards", 1, "N"),
    "Fs_minus_N": ("break-away level, downwards", 1, "N"),
    "Fc_plus_N": ("Coulomb level, upwards", 1, "N"),
    "Fc_minus_N": ("Coulomb level, downwards", 1, "N"),
    "vs_m_s": ("Stribeck velocity", 1e3, "mm/s"),
    "sigma0_N_m": ("stiffness of the bristle", 1e-6, "N/um"),
    "sigma1_Ns_m": ("damping of the bristle", 1, "N s/m"),
    "sigma1_decay_m_s": ("velocity at which it fades", 1e3, "mm/s"),
    "sigma2_Ns_m": ("viscous friction", 1, "N s/m"),
    "offset_N": ("constant force", 1, "N"),
    "delay_s": ("delay of the torque", 1e3, "ms"),
    "lag_s": ("lag of the torque", 1e3, "ms"),
}
PARAMETER = {
    "motor_mass_kg": "motor_inertia_kgm2",
    "stiffness_N_m": "screw_stiffness_N_um",
    "damping_Ns_m": "screw_damping_Ns_m",
    "vs_m_s": "vs_mm_s",
    "sigma1_decay_m_s": "sigma1_decay_mm_s",
}


def steady(model, velocity):
    """Friction at constant speed."""
    plus = velocity >= 0
    coulomb = model["Fc_plus_N"] if plus else model["Fc_minus_N"]
    breakaway = model["Fs_plus_N"] if plus else model["Fs_minus_N"]
    share = math.exp(-((abs(velocity) / model["vs_m_s"]) ** model["stribeck_exponent"]))
    return math.copysign(coulomb + (breakaway - coulomb) * share, velocity) + model["sigma2_Ns_m"] * velocity


def draw_stribeck(pyplot, data):
    figure, panes = pyplot.subplots(1, 2, figsize=(10, 4.2), sharey=False)
    points = data["stribeck_points"]
    fastest = max(abs(p["velocity_m_s"]) for p in points)
    speeds = [2e-5 * (fastest / 2e-5) ** (i / 200) for i in range(201)]
    for pane, sign, title in ((panes[0], -1, "downwards"), (panes[1], 1, "upwards")):
        mine = [p for p in points if p["velocity_m_s"] * sign > 0]
        pane.errorbar([abs(p["velocity_m_s"]) * 1e3 for p in mine], [abs(p["friction_N"]) for p in mine],
                      yerr=[p["spread_N"] for p in mine], fmt="o", ms=4, color=TRUTH, ecolor=QUIET,
                      label="measured: mean and spread over the way")
        pane.plot([v * 1e3 for v in speeds], [abs(steady(data["stated"], sign * v)) for v in speeds], "--",
                  color=PLAIN, label="model as stated")
        pane.plot([v * 1e3 for v in speeds], [abs(steady(data["identified"], sign * v)) for v in speeds],
                  color=COMPENSATED, label="model as identified")
        pane.set_xscale("log")
        pane.set_ylim(bottom=0)
        pane.set_title(title)
        pane.set_xlabel("speed, mm/s")
    panes[0].set_ylabel("friction, N")
    panes[1].legend(loc="lower right")
    figure.suptitle("Friction over speed")
    return figure


def pieces(points, pause_s=0.02):
    """Runs of consecutive instants."""
    run = []
    for i, time in enumerate(points["time_s"]):
        if run and time - points["time_s"][run[-1]] > pause_s:
            yield run
            run = []
        run.append(i)
    if run:
        yield run


def draw_presliding(pyplot, data):
    figure, pane = pyplot.subplots(figsize=(7, 5))
    measured, simulated = data["presliding"]["measured"], data["presliding"]["simulated"]
    first = True
    for run in pieces(measured):
        centre = sum(measured["way_m"][i] for i in run) / len(run)
        shift = sum(simulated["way_m"][i] for i in run) / len(run)
        pane.plot([(measured["way_m"][i] - centre) * 1e6 for i in run], [measured["friction_N"][i] for i in run],
                  color=TRUTH, lw=1.6, label="measured" if first else None)
        pane.plot([(simulated["way_m"][i] - shift) * 1e6 for i in run], [simulated["friction_N"][i] for i in run],
                  color=COMPENSATED, lw=0.9, ls="--", label="simulated" if first else None)
        first = False
    pane.set_xlabel("way of the table about the middle of each loop, um")
    pane.set_ylabel("friction, N")
    pane.set_title("Presliding loops")
    pane.legend(loc="lower right")
    return figure


def draw_overlay(pyplot, data):
    overlay = data["overlay"]
    figure, panes = pyplot.subplots(3, 1, figsize=(10, 7), sharex=True, height_ratios=[1, 2, 1])
    time = overlay["time_s"]
    panes[0].plot(time, [v * 1e3 for v in overlay["velocity_m_s"]], color=QUIET, lw=0.7)
    panes[0].set_ylabel("velocity, mm/s")
    panes[0].set_yscale("symlog", linthresh=0.1)
    panes[1].plot(time, overlay["measured_N"], color=TRUTH, lw=0.7, label="measured: torque less inertia")
    panes[1].plot(time, overlay["simulated_N"], color=COMPENSATED, lw=0.7, label="simulated")
    panes[1].set_ylabel("friction, N")
    panes[1].legend(loc="upper right")
    rest = [m - s for m, s in zip(overlay["measured_N"], overlay["simulated_N"])]
    panes[2].plot(time, rest, color=PLAIN, lw=0.6)
    panes[2].set_ylabel("difference, N")
    ordered = sorted(abs(r) for r in rest)
    bound = max(1.0, 1.5 * ordered[int(0.995 * (len(ordered) - 1))])
    panes[2].set_ylim(-bound, bound)
    panes[2].set_xlabel("time, s")
    figure.suptitle("Measured and simulated friction")
    return figure


def accelerance(model, frequency, period_s):
    """Of the motor, two masses joined by a damped spring, behind a held torque with its delay and lag: as the measured
    one is made, from second differences of the sampled position and the mean of two commands, images included."""
    motor, table_mass = model["motor_mass_kg"], model["table_mass_kg"]
    position = 0
    for image in range(-4, 5):
        omega = 2 * math.pi * (frequency + image / period_s)
        link = complex(model["stiffness_N_m"], omega * model["damping_Ns_m"])
        free = link - table_mass * omega**2
        held = (1 - cmath.exp(-1j * omega * period_s)) / (1j * omega * period_s)
        torque = held * cmath.exp(-1j * omega * model["delay_s"]) / complex(1, omega * model["lag_s"])
        position -= torque * free / (motor * free + table_mass * link) / omega**2
    phase = 2 * math.pi * frequency * period_s
    return abs(position) * (2 - 2 * math.cos(phase)) / period_s**2 / abs(math.cos(phase / 2))


def coherent(data):
    return [p for p in data["screw"]["response"] if p["coherence"] > 0.7]


def draw_screw(pyplot, data):
    figure, pane = pyplot.subplots(figsize=(7, 4))
    good = coherent(data)
    pane.semilogy([p["frequency_Hz"] for p in good], [p["accelerance_1_kg"] for p in good], color=TRUTH,
                  label="measured")
    if data["screw"]["found"]:
        for key, word in (("antiresonance_Hz", "antiresonance"), ("resonance_Hz", "resonance")):
            pane.axvline(data["screw"][key], color=COMPENSATED, ls="--",
                         label=f"{word} {data['screw'][key]:.0f} Hz")
    frequencies = range(int(good[0]["frequency_Hz"]), int(good[-1]["frequency_Hz"]) + 1)
    period_s = data["screw"]["period_s"]
    pane.semilogy(frequencies, [accelerance(data["identified"], f, period_s) for f in frequencies], color=WINDOW,
                  lw=1, label="model as identified, without friction")
    pane.axhline(1 / data["identified"]["mass_kg"], color=QUIET, lw=0.8, label="1 / whole mass")
    pane.set_xlabel("frequency, Hz")
    pane.set_ylabel("acceleration of the motor per force, 1/kg")
    found = data["screw"]["found"]
    pane.set_title("The screw's antiresonance and resonance" if found else "No screw to be seen: rigid")
    pane.legend()
    return figure


def table(data):
    rows = []
    for key, (name, scale, unit) in NAMES.items():
        parameter = data["parameters"].get(PARAMETER.get(key, key))
        stated, found = data["stated"][key] * scale, data["identified"][key] * scale
        if parameter is None:
            interval = "not identified" if stated == found else "with the motor's"
        elif parameter["relative"]:
            low, high = (found * math.exp(s * 1.96 * parameter["sigma"]) for s in (-1, 1))
            interval = f"{low:.4g} to {high:.4g}"
        else:
            half = 1.96 * parameter["sigma"] * scale
            interval = f"{found - half:.4g} to {found + half:.4g}"
        rows.append(f"<tr><td>{html.escape(name)}</td><td>{stated:.4g}</td><td>{found:.4g}</td>"
                    f"<td>{interval}</td><td>{unit}</td></tr>")
    return ("<table><tr><th></th><th>stated</th><th>identified</th><th>95 % interval</th><th></th></tr>"
            + "".join(rows) + "</table>")


def page(data, pictures):
    low, high = (1e3 * x for x in data["stretch_m"])
    notes = "".join(f"<p>Note: {html.escape(n)}.</p>" for n in data["notes"])
    images = "".join(f'<p><img alt="{p.stem}" src="data:image/png;base64,'
                     f'{base64.b64encode(p.read_bytes()).decode()}"></p>' for p in pictures)
    errors = data["prediction_error_rms_m"]
    return f"""<!doctype html><html lang="en"><meta charset="utf-8"><title>Identification</title>
<style>body{{font:15px/1.5 sans-serif;max-width:60em;margin:2em auto}}table{{border-collapse:collapse}}
td,th{{padding:.15em .8em;text-align:right}}td:first-child{{text-align:left}}img{{max-width:100%}}</style>
<h1>Identification</h1><p>From {html.escape(", ".join(data["sources"]))}: {data["seconds"]:.0f} s of motion.
Friction levels are averages from {low:.2f} to {high:.2f} mm. One period ahead, the model foresees the position to
{errors["after"] * 1e9:.1f} nm rms (as it was stated, after the first steps: {errors["before"] * 1e9:.1f} nm).</p>
{notes}{table(data)}{images}</html>
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("directory", metavar="DIR", type=Path, help="directory with identification.json")
    directory = parser.parse_args().directory
    try:
        data = json.loads((directory / "identification.json").read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        print(f"plot_identification.py: {error}", file=sys.stderr)
        return 2
    pyplot = apply()
    wanted = [("stribeck", draw_stribeck, data["stribeck_points"]),
              ("presliding", draw_presliding, data["presliding"]["measured"]["time_s"]),
              ("overlay", draw_overlay, data["overlay"]["time_s"]),
              ("screw", draw_screw, coherent(data))]
    pictures = []
    for name, draw, there in wanted:
        if not there:
            continue
        path = directory / f"{name}.png"
        figure = draw(pyplot, data)
        figure.savefig(path)
        pyplot.close(figure)
        pictures.append(path)
        print(path)
    report = directory / "report.html"
    report.write_text(page(data, pictures), encoding="utf-8")
    print(report)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (ArithmeticError, KeyError, LookupError, OSError, TypeError, ValueError) as error:
        sys.exit(f"plot_identification.py: the record does not hold what the pictures show: {error}")
