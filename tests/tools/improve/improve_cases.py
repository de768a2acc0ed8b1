#!/usr/bin/env python3
"""Improves the model of an axis on emulated machines with one hidden effect each, and compares with the truth stated.

    improve_cases.py CONTOURD CONTOUR MACHINE_FILE [--effects NAME...] [--seeds N...] [--friction linear|srukf] [--scale] [--table FILE]
    improve_cases.py CONTOURD CONTOUR MACHINE_FILE --only-truth ...      # what the truth would give, by contour simulate; seconds

For every case a daemon in lock-step with the effect hidden, `contour improve --axis x --yes`, and another daemon whose model of the
axis is the truth, which draws the same programs as often. Errors are of the true place of the table. Ends with 1 where the peak
error of either program is higher than before, where the truth would take at least a third of it and the new model takes less than a
third, where more than 15 minutes of machine time went, or where the machine is not Idle afterwards.
"""
import argparse
import json
import math
import os
import random
import socket as sockets
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import yaml

# What the emulated axes are; the machine file's own hidden variations are taken out.
TRUE = {"motor_inertia_kgm2": 5e-5, "table_mass_kg": 10.0, "screw_stiffness_N_um": 40.0, "screw_damping_Ns_m": 1100.0}
FRICTION = {"vs_mm_s": 2.0, "sigma0_N_m": 5e6, "sigma1_Ns_m": 3000.0, "sigma1_decay_mm_s": 2.0, "sigma2_Ns_m": 500.0}
LEVELS = {"x": {"Fs_plus_N": 50.0, "Fs_minus_N": 50.0, "Fc_plus_N": 40.0, "Fc_minus_N": 40.0},
          "y": {"Fs_plus_N": 48.0, "Fs_minus_N": 53.0, "Fc_plus_N": 37.0, "Fc_minus_N": 43.0}}
STATED_WITHIN = 0.03  # as commissioning leaves it, one standard deviation
HALF_STROKE_MM = 200.0
PASSES = 3


def flow(value):
    """YAML in one line; what is JSON is YAML."""
    return json.dumps(value)


def ripple(rng):
    wave = {"amplitude_rel": rng.uniform(0.2, 0.35), "order_per_rev": rng.choice([1, 2, 3]), "phase_rad": rng.uniform(-3.1, 3.1)}
    return {"effects.friction_ripple": wave}, {"extensions.friction_ripple": wave}


def cogging(rng):
    wave = {"amplitude_Nm": rng.uniform(0.012, 0.025), "order_per_rev": rng.choice([4, 6, 8, 12, 18]), "phase_rad": rng.uniform(-3.1, 3.1)}
    return {"effects.cogging": wave}, {"extensions.cogging": wave}


def position_friction(rng):
    amplitude, periods, phase = rng.uniform(0.25, 0.4), rng.uniform(8.0, 16.0), rng.uniform(-3.1, 3.1)
    places = [0.5 * k for k in range(-80, 81)]
    table = [amplitude * math.sin(periods * math.pi * x / HALF_STROKE_MM + phase) for x in places]
    return ({"effects.position_friction": {"amplitude_rel": amplitude, "periods_per_stroke": periods, "phase_rad": phase}},
            {"extensions.position_friction": {"position_mm": places, "friction_rel": table}})


def wrong_stiffness(rng):
    stiffness = rng.choice([rng.uniform(22.0, 28.0), rng.uniform(60.0, 75.0)])
    return {"screw_stiffness_N_um": stiffness}, {"screw_stiffness_N_um": stiffness}


def asymmetry(rng):
    difference = rng.choice([-1.0, 1.0]) * rng.uniform(0.3, 0.6)
    levels = {k: v * (1 + (0.5 if "plus" in k else -0.5) * difference) for k, v in LEVELS["x"].items()}
    return {f"friction.{k}": v for k, v in levels.items()}, {f"friction.{k}": v for k, v in levels.items()}


def cable_spring(rng):
    torque = rng.uniform(0.2, 0.4)
    return ({"effects.cable_spring": {"torque_at_stroke_end_Nm": torque}},
            {"extensions.cable_spring": {"position_mm": [-HALF_STROKE_MM, HALF_STROKE_MM], "torque_Nm": [torque, -torque]}})


EFFECTS = {"cogging": cogging, "position_friction": position_friction, "friction_ripple": ripple, "wrong_stiffness": wrong_stiffness,
           "asymmetry": asymmetry, "cable_spring": cable_spring}


def free_port():
    with sockets.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Case:
    """One emulated machine: overrides of the emulated axes, of the model as stated and of the model as it is."""

    def __init__(self, effect, seed, friction, scale):
        rng = random.Random(f"{effect} {seed}")
        self.name = f"{effect}-{seed}"
        hidden, known = EFFECTS[effect](rng)
        port = free_port()
        self.machine = [f"emulator.seed={seed}", "emulator.parameter_variation_rel=0", f"io.modbus.port={port}",
                        f"emulator.io.port={port}", "telemetry.publish=false", "telemetry.flight_recorder_s=0", "realtime.required=false"]
        if friction:
            self.machine.append(f"control.friction={friction}")
        self.stated, self.truth = [], []
        for axis, levels in LEVELS.items():
            if scale:
                self.machine.append(f"axes.{axis}.drive.linear_scale={{count_um: 0.01}}")
            emulated = {**TRUE, **{f"friction.{k}": v for k, v in {**FRICTION, **levels}.items()}}
            for key, value in emulated.items():
                self.machine.append(f"emulator.axes.{axis}.{key}={value}")
                off = value * math.exp(rng.gauss(0.0, STATED_WITHIN))
                self.stated.append(f"axes.{axis}.model.{key}={off}")
                self.truth.append(f"axes.{axis}.model.{key}={value if axis == 'x' else off}")
            for key in ("position_amplitude_rel", "ripple_amplitude_rel"):
                self.machine.append(f"emulator.axes.{axis}.friction.{key}=0")
            self.machine.append(f"axes.{axis}.model.uncertainty.screw_stiffness_N_um=0.05")
        self.machine += [f"emulator.axes.x.{k}={flow(v)}" for k, v in hidden.items()]
        for key, value in known.items():
            full = f"axes.x.model.{key}"
            if key.startswith("friction."):  # commissioning has not seen it: levels as they were
                self.truth = [t for t in self.truth if not t.startswith(full + "=")]
            self.truth = [t for t in self.truth if not t.startswith(full + "=")] + [f"{full}={flow(value)}"]


class Daemon:
    """contourd in lock-step; ends with the block."""

    def __init__(self, programs, folder, overrides):
        self.contourd, self.contour, self.file = programs
        self.folder, self.overrides = Path(folder), overrides
        self.socket, self.truth = self.folder / "control.sock", self.folder / "truth.csv"

    def __enter__(self):
        command = [self.contourd, "--config", self.file, "--clock", "lockstep", "--socket", self.socket, "--truth", self.truth]
        for override in self.overrides:
            command += ["--set", override]
        with (self.folder / "daemon.txt").open("w", encoding="utf-8") as messages:
            self.process = subprocess.Popen([str(c) for c in command], stdout=messages, stderr=messages)
        for _ in range(600):
            if self.state() == "Idle":
                return self
            time.sleep(0.1)
        raise RuntimeError((self.folder / "daemon.txt").read_text(encoding="utf-8"))

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(timeout=60)

    def run(self, *words, check=True):
        done = subprocess.run([str(self.contour), *map(str, words), "--socket", str(self.socket)], capture_output=True, text=True)
        if check and done.returncode != 0:
            raise RuntimeError(f"contour {' '.join(map(str, words))}\n{done.stdout}{done.stderr}"
                               + (self.folder / "daemon.txt").read_text(encoding="utf-8")[-2000:])
        return done

    def state(self):
        done = self.run("status", "--json", check=False)
        return json.loads(done.stdout)["state"] if done.returncode == 0 else "no answer"


def improve(programs, case, folder, extra=()):
    """What contour improve says, and its improve.json."""
    with Daemon(programs, folder, case.machine + case.stated) as daemon:
        report = Path(folder) / "report"
        done = daemon.run("improve", "--axis", "x", "--yes", "--out", Path(folder) / "x_model.yaml", "--report", report, "--passes", PASSES,
                          "--truth", daemon.truth, *extra)
        state = daemon.state()
    return done.stdout, json.loads((report / "improve.json").read_text(encoding="utf-8")), state


# The programs that contour improve draws on this machine by default.
PROGRAMS = {"path": "shape: circle\naxes: [x, y]\nradius_mm: 9\nfeed_mm_min: 3000\nturns: 4\ndirection: ccw\n",
            "check": "shape: circle\naxes: [x, y]\nradius_mm: 5.58\nfeed_mm_min: 1110\nturns: 4\ndirection: cw\n"}


def with_truth(programs, case, folder):
    """Largest errors of the table with the model that is the truth, in the passes after the first."""
    peaks = {"path": [], "check": []}
    with Daemon(programs, folder, case.machine + case.truth) as daemon:
        daemon.run("enable")
        for name, text in PROGRAMS.items():
            (Path(folder) / f"{name}.yaml").write_text(text, encoding="utf-8")
        for number in range(PASSES + 1):
            for name in PROGRAMS:
                out = Path(folder) / f"{name}{number}"
                daemon.run("run", Path(folder) / f"{name}.yaml", "--out", out, "--truth", daemon.truth)
                if number > 0:
                    metrics = json.loads((out / "metrics.json").read_text(encoding="utf-8"))
                    peaks[name].append(metrics["contour"]["table"]["peak_um"])
        daemon.run("disable")
    return peaks


def mean(values):
    return sum(values) / len(values)


def judge(case, said, found, state, truth):
    """A line of the table, and what is wrong."""
    wrong, cells = [], []
    for name in ("path", "check"):
        before = mean(found["before"][name]["truth"]["peak_um"][1:])
        after = mean((found["after"] if found["kept"] else found["before"])[name]["truth"]["peak_um"][1:])
        best = mean(truth[name])
        spread = max(found["before"][name]["truth"]["peak_um"][1:]) - min(found["before"][name]["truth"]["peak_um"][1:])
        cells.append((before, after, best))
        if after > before + max(spread, 0.01):
            wrong.append(f"{name} is higher than before")
        if best < before * 2 / 3 and after > before * 2 / 3:
            wrong.append(f"{name}: the truth would take a third")
    if found["machine_time_s"] > 900:
        wrong.append(f"{found['machine_time_s']:.0f} s of machine time")
    if state != "Idle":
        wrong.append(f"the machine is {state}")
    kinds = [c["kind"] for c in found["diagnosed"][-1]["diagnosis"]["causes"]] or [found["diagnosed"][-1]["diagnosis"]["verdict"]]
    line = f"| {case.name} | {', '.join(kinds)} | " + " | ".join(" - ".join(f"{v:.2f}" for v in c) for c in cells)
    line += f" | {'kept' if found['kept'] else 'not kept'} | {found['machine_time_s']:.0f} | {'; '.join(wrong)} |"
    return line, wrong


def what_truth_gives(programs, case, folder):
    """A line of the other table: largest errors of the table, model as stated and as it is, each drawn once from a cold start."""
    cells = []
    for name, text in PROGRAMS.items():
        (Path(folder) / f"{name}.yaml").write_text(text, encoding="utf-8")
        peaks = []
        for model in (case.stated, case.truth):
            words = [programs[1], "simulate", "--config", programs[2], "--program", Path(folder) / f"{name}.yaml", "--out", folder]
            for override in case.machine + model:
                words += ["--set", override]
            subprocess.run([str(w) for w in words], check=True, capture_output=True)
            peaks.append(json.loads((Path(folder) / "metrics.json").read_text(encoding="utf-8"))["contour"]["table"]["peak_um"])
        cells.append(" - ".join(f"{p:.2f}" for p in peaks))
    return f"| {case.name} | {' | '.join(cells)} |"


HEAD = ("| case | found | path: before - after - truth stated, um | check | new model | machine time, s | wrong |\n"
        "|---|---|---|---|---|---|---|")

TRUTH_HEAD = "| case | path: as stated - truth stated, um | check |\n|---|---|---|"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("contourd")
    parser.add_argument("contour")
    parser.add_argument("machine_file")
    parser.add_argument("--effects", nargs="+", default=list(EFFECTS), choices=list(EFFECTS))
    parser.add_argument("--seeds", nargs="+", type=int, default=[1])
    parser.add_argument("--friction", choices=["linear", "srukf"])
    parser.add_argument("--scale", action="store_true", help="linear scales on both axes")
    parser.add_argument("--extra", nargs="*", default=[], help="further words for contour improve")
    parser.add_argument("--table", type=Path, help="file for the table, beside the output")
    parser.add_argument("--only-truth", action="store_true", help="what the model as it is would give, and nothing else")
    options = parser.parse_args()
    programs = (Path(options.contourd).resolve(), Path(options.contour).resolve(), Path(options.machine_file).resolve())
    lines, failed = [HEAD], 0
    print(TRUTH_HEAD if options.only_truth else HEAD, flush=True)
    for effect in options.effects:
        for seed in options.seeds:
            case = Case(effect, seed, options.friction, options.scale)
            if options.only_truth:
                with tempfile.TemporaryDirectory() as one:
                    print(what_truth_gives(programs, case, one), flush=True)
                continue
            with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as two:
                said, found, state = improve(programs, case, one, options.extra)
                if os.environ.get("CONTOUR_VERBOSE"):
                    print(said)
                line, wrong = judge(case, said, found, state, with_truth(programs, case, two))
            print(line, flush=True)
            lines.append(line)
            failed += bool(wrong)
    if options.table:
        options.table.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
