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
import csv
import json
import math
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import yaml

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from free_port import free_port  # noqa: E402

STATED_WITHIN = 0.03  # as commissioning leaves it, one standard deviation
PASSES = 3
SAFE_TRAVEL_REL = 2.5  # of what the file states: a pull of 0.6 of rated torque takes an axis at the torque limit twice as far


def flow(value):
    """YAML in one line; what is JSON is YAML."""
    return json.dumps(value)


class Axis:
    """What the machine file says of the axis that hides something: effects are drawn in its own units."""

    def __init__(self, stated, emulated):
        low, high = stated["limits"]["position_mm"]
        self.half_stroke_mm = 0.5 * emulated.get("stroke_mm", high - low)
        # That contour improve takes by default.
        self.travel_mm = max(min(20.0, 0.1 * (high - low)), float(stated["model"]["lead_mm"]))
        self.rated_Nm = float(stated["drive"]["rated_torque_Nm"])
        self.stiffness_N_um = float(emulated["screw_stiffness_N_um"])
        self.levels = {k: float(emulated["friction"][k]) for k in ("Fs_plus_N", "Fs_minus_N", "Fc_plus_N", "Fc_minus_N")}


def ripple(rng, _axis):
    wave = {"amplitude_rel": rng.uniform(0.2, 0.35), "order_per_rev": rng.choice([1, 2, 3]), "phase_rad": rng.uniform(-3.1, 3.1)}
    return {"effects.friction_ripple": wave}, {"extensions.friction_ripple": wave}


def cogging(rng, axis):
    wave = {"amplitude_Nm": axis.rated_Nm * rng.uniform(0.019, 0.039), "order_per_rev": rng.choice([4, 6, 8, 12, 18]),
            "phase_rad": rng.uniform(-3.1, 3.1)}
    return {"effects.cogging": wave}, {"extensions.cogging": wave}


def position_friction(rng, axis):
    amplitude, waves, phase = rng.uniform(0.25, 0.4), rng.uniform(0.4, 0.8), rng.uniform(-3.1, 3.1)
    periods = waves * 2.0 * axis.half_stroke_mm / axis.travel_mm
    places = [axis.half_stroke_mm * k / 160.0 for k in range(-160, 161)]
    table = [amplitude * math.sin(periods * math.pi * x / axis.half_stroke_mm + phase) for x in places]
    return ({"effects.position_friction": {"amplitude_rel": amplitude, "periods_per_stroke": periods, "phase_rad": phase}},
            {"extensions.position_friction": {"position_mm": places, "friction_rel": table}})


def wrong_stiffness(rng, axis):
    stiffness = axis.stiffness_N_um * rng.choice([rng.uniform(0.55, 0.7), rng.uniform(1.5, 1.875)])
    return {"screw_stiffness_N_um": stiffness}, {"screw_stiffness_N_um": stiffness}


def asymmetry(rng, axis):
    difference = rng.choice([-1.0, 1.0]) * rng.uniform(0.3, 0.6)
    levels = {k: v * (1 + (0.5 if "plus" in k else -0.5) * difference) for k, v in axis.levels.items()}
    return {f"friction.{k}": v for k, v in levels.items()}, {f"friction.{k}": v for k, v in levels.items()}


def cable_spring(rng, axis):
    torque = axis.rated_Nm * rng.uniform(0.3, 0.6)
    end = axis.half_stroke_mm
    return ({"effects.cable_spring": {"torque_at_stroke_end_Nm": torque}},
            {"extensions.cable_spring": {"position_mm": [-end, end], "torque_Nm": [torque, -torque]}})


EFFECTS = {"cogging": cogging, "position_friction": position_friction, "friction_ripple": ripple, "wrong_stiffness": wrong_stiffness,
           "asymmetry": asymmetry, "cable_spring": cable_spring}
MECHANICS = ("motor_inertia_kgm2", "table_mass_kg", "screw_stiffness_N_um", "screw_damping_Ns_m")
NO_FRICTION_NUMBERS = ("law", "stribeck_exponent", "acts_on", "position_amplitude_rel", "ripple_amplitude_rel")


def usual_programs(machine):
    """What contour improve draws where no program is given."""
    axes = machine["axes"]
    limits = [a["limits"] for a in axes.values()]
    name, first = next(iter(axes.items()))
    low, high = first["limits"]["position_mm"]
    way = max(min(20.0, 0.1 * (high - low)), float(first["model"]["lead_mm"]))
    way = min([way] + [v["position_mm"][1] - v["position_mm"][0] for v in limits])
    top = min(100.0, 0.4 * first["limits"]["velocity_mm_s"])
    speed = min([50.0] + [0.9 * min(top, v["velocity_mm_s"]) for v in limits])
    bend, jerk = (min(float(v[k]) for v in limits) for k in ("acceleration_mm_s2", "jerk_mm_s3"))
    programs = {}
    for which, size, slower, way_round in (("path", 1.0, 1.0, "ccw"), ("check", 0.62, 0.37, "cw")):
        radius = size * min(10.0, 0.45 * way)
        feed = 60.0 * min(slower * speed, math.sqrt(0.5 * bend * radius), (0.5 * jerk * radius**2) ** (1 / 3))
        if len(axes) < 2:
            programs[which] = f"shape: sine\naxis: {name}\namplitude_mm: {radius:.6f}\nfeed_mm_min: {feed:.3f}\ncycles: 4\n"
        else:
            programs[which] = (f"shape: circle\naxes: [{', '.join(list(axes)[:2])}]\nradius_mm: {radius:.6f}\nfeed_mm_min: {feed:.3f}\n"
                               f"turns: 4\ndirection: {way_round}\n")
    return programs


class Case:
    """One emulated machine: overrides of the emulated axes, of the model as stated and of the model as it is. Its first axis hides the
    effect and is improved."""

    def __init__(self, machine_file, effect, seed, friction, scale):
        rng = random.Random(f"{effect} {seed}")
        self.name = f"{effect}-{seed}"
        machine = yaml.safe_load(Path(machine_file).read_text(encoding="utf-8"))
        axes, emulator = machine["axes"], machine["emulator"]["axes"]
        self.axis, self.axes = next(iter(axes)), len(axes)
        self.programs = usual_programs(machine)
        hidden, known = EFFECTS[effect](rng, Axis(axes[self.axis], emulator[self.axis]))
        self.machine = [f"emulator.seed={seed}", "emulator.parameter_variation_rel=0", "telemetry.publish=false",
                        "telemetry.flight_recorder_s=0", "realtime.required=false"]
        if "io" in machine:
            # A machine in lock-step runs ahead of the I/O station's clock, more so on a busy host.
            port = free_port()
            self.machine += [f"io.modbus.port={port}", f"emulator.io.port={port}", "io.modbus.timeout_ms=5000",
                             "io.modbus.accept_blind_travel=true"]
        if friction:
            self.machine.append(f"control.friction={friction}")
        self.stated, self.truth = [], []
        for name, emulated in emulator.items():
            self.add_axis(name, emulated, rng, known)
            if scale:
                self.machine.append(f"axes.{name}.drive.linear_scale={{count_um: 0.01}}")
        self.machine += [f"emulator.axes.{self.axis}.{k}={flow(v)}" for k, v in hidden.items()]
        if "extensions.cable_spring" in known:
            # A file that states the pull is to promise how far it takes the axis.
            travel_mm = SAFE_TRAVEL_REL * axes[self.axis]["limits"]["safe_travel_mm"]
            self.machine.append(f"axes.{self.axis}.limits.safe_travel_mm={travel_mm}")
        for key, value in known.items():
            full = f"axes.{self.axis}.model.{key}"
            self.truth = [t for t in self.truth if not t.startswith(full + "=")] + [f"{full}={flow(value)}"]

    @staticmethod
    def level(emulated, key):
        kind = key.split(".")[1][:3]
        return 0.5 * sum(float(emulated["friction"][kind + way]) for way in ("plus_N", "minus_N"))

    def add_axis(self, name, emulated, rng, known):
        friction = {f"friction.{k}": v for k, v in emulated["friction"].items() if k not in NO_FRICTION_NUMBERS}
        for key, text in {**{k: emulated[k] for k in MECHANICS}, **friction}.items():
            value = float(text)  # 5e6 is none to YAML 1.1
            # What differs with the direction is for the effect that hides it alone.
            if name == self.axis and any("Fc_plus" in k for k in known) and key.endswith(("_plus_N", "_minus_N")):
                value = self.level(emulated, key)
            self.machine.append(f"emulator.axes.{name}.{key}={value}")
            off = value * math.exp(rng.gauss(0.0, STATED_WITHIN))
            self.stated.append(f"axes.{name}.model.{key}={off}")
            self.truth.append(f"axes.{name}.model.{key}={value if name == self.axis else off}")
        for key in ("position_amplitude_rel", "ripple_amplitude_rel"):
            self.machine.append(f"emulator.axes.{name}.friction.{key}=0")
        self.machine.append(f"axes.{name}.model.uncertainty.screw_stiffness_N_um=0.05")


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
        done = daemon.run("improve", "--axis", case.axis, "--yes", "--out", Path(folder) / "model.yaml", "--loop",
                          Path(folder) / "loop.yaml", "--report", report, "--passes", PASSES,
                          "--truth", daemon.truth, *extra)
        state = daemon.state()
    return done.stdout, json.loads((report / "improve.json").read_text(encoding="utf-8")), state


def table_peak_um(out, case):
    """Of a run: from the path, on a machine of one axis from the reference, as contour improve has it."""
    if case.axes > 1:
        return json.loads((out / "metrics.json").read_text(encoding="utf-8"))["contour"]["table"]["peak_um"]
    with (out / "cycles.csv").open(encoding="utf-8") as file:
        rows = [r for r in csv.DictReader(file) if r["path_time_s"] and float(r["path_time_s"]) >= 1.0 and r[f"{case.axis}_table_position_truth_m"]]
    return max(1e6 * abs(float(r[f"{case.axis}_table_position_truth_m"]) - float(r[f"{case.axis}_reference_position_m"])) for r in rows)


def simulated_peak_um(programs, case, model, name, folder):
    """Of one of the programs from a cold start, with overrides that state the model."""
    file = Path(folder) / f"{name}.yaml"
    file.write_text(case.programs[name], encoding="utf-8")
    words = [programs[1], "simulate", "--config", programs[2], "--program", file, "--out", folder]
    for override in case.machine + model:
        words += ["--set", override]
    subprocess.run([str(w) for w in words], check=True, capture_output=True)
    return table_peak_um(Path(folder), case)


def with_truth(programs, case, folder):
    """Largest errors of the table with the model that is the truth, in the passes after the first; on a machine of one axis, whose runs
    do not state its truth, simulated once."""
    if case.axes == 1:
        return {name: [simulated_peak_um(programs, case, case.truth, name, folder)] for name in case.programs}
    peaks = {"path": [], "check": []}
    with Daemon(programs, folder, case.machine + case.truth) as daemon:
        daemon.run("enable")
        for name, text in case.programs.items():
            (Path(folder) / f"{name}.yaml").write_text(text, encoding="utf-8")
        for number in range(PASSES + 1):
            for name in case.programs:
                out = Path(folder) / f"{name}{number}"
                daemon.run("run", Path(folder) / f"{name}.yaml", "--out", out, "--truth", daemon.truth)
                if number > 0:
                    peaks[name].append(table_peak_um(out, case))
        daemon.run("disable")
    return peaks


def mean(values):
    return sum(values) / len(values)


def true_peaks_um(passes):
    """Of the passes that count. On a busy host a pass may end before the emulator has written all of its rows: it has no true peak."""
    return [peak for peak in passes["truth"]["peak_um"][1:] if peak is not None]


def judge(case, found, state, truth):
    """A line of the table, and what is wrong."""
    wrong, cells, lost = [], [], 0
    for name in ("path", "check"):
        peaks_before = true_peaks_um(found["before"][name])
        peaks_after = true_peaks_um((found["after"] if found["kept"] else found["before"])[name])
        lost += 2 * PASSES - len(peaks_before) - len(peaks_after)
        before, after = mean(peaks_before), mean(peaks_after)
        best = mean(truth[name])
        spread = max(peaks_before) - min(peaks_before)
        cells.append((before, after, best))
        if after > before + max(spread, 0.01):
            wrong.append(f"{name} is higher than before")
        if best < before * 2 / 3 and after > before * 2 / 3:
            wrong.append(f"{name}: the truth would take a third")
    if found["machine_time_s"] > 900:
        wrong.append(f"{found['machine_time_s']:.0f} s of machine time")
    if state != "Idle":
        wrong.append(f"the machine is {state}")
    chosen = min(found["tried"], key=lambda t: (not t["better"], t["check"]["after_um"] / t["check"]["before_um"]), default=None)
    diagnosed = next((d for d in found["diagnosed"] if chosen and d["on"] == chosen["from"]), found["diagnosed"][-1])["diagnosis"]
    kinds = [c["kind"] for c in diagnosed["causes"]] or [diagnosed["verdict"]]
    line = f"| {case.name} | {', '.join(kinds)} | " + " | ".join(" - ".join(f"{v:.2f}" for v in c) for c in cells)
    line += f" | {'kept' if found['kept'] else 'not kept'}, {len(found['tried'])} tried | {found['machine_time_s']:.0f} | {'; '.join(wrong)} |"
    if lost:
        line += f" {lost} of {4 * PASSES} passes without a true path"
    return line, wrong


def improved(programs, case, options):
    """A line of the table, and what is wrong."""
    with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as two:
        try:
            said, found, state = improve(programs, case, one, options.extra)
            truth = with_truth(programs, case, two)
        except RuntimeError as e:
            return f"| {case.name} | failed | {str(e)[-3000:]} |", ["failed"]
        if options.keep:
            (options.keep / f"{case.name}.txt").write_text(said, encoding="utf-8")
            shutil.copy(Path(one) / "report" / "improve.json", options.keep / f"{case.name}.json")
    return judge(case, found, state, truth)


def what_truth_gives(programs, case, folder):
    """A line of the other table: largest errors of the table, model as stated and as it is, each drawn once from a cold start."""
    cells = []
    for name in case.programs:
        peaks = [simulated_peak_um(programs, case, model, name, folder) for model in (case.stated, case.truth)]
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
    parser.add_argument("--keep", type=Path, help="directory for what contour improve said and its improve.json, case by case")
    parser.add_argument("--table", type=Path, help="file for the table, beside the output")
    parser.add_argument("--only-truth", action="store_true", help="what the model as it is would give, and nothing else")
    options = parser.parse_args()
    programs = (Path(options.contourd).resolve(), Path(options.contour).resolve(), Path(options.machine_file).resolve())
    lines, failed = [HEAD], 0
    if options.keep:
        options.keep.mkdir(parents=True, exist_ok=True)
    print(TRUTH_HEAD if options.only_truth else HEAD, flush=True)
    for effect in options.effects:
        for seed in options.seeds:
            case = Case(options.machine_file, effect, seed, options.friction, options.scale)
            if options.only_truth:
                with tempfile.TemporaryDirectory() as one:
                    print(what_truth_gives(programs, case, one), flush=True)
                continue
            line, wrong = improved(programs, case, options)
            print(line, flush=True)
            lines.append(line)
            failed += bool(wrong)
    if options.table:
        options.table.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
