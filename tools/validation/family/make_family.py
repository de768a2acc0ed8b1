#!/usr/bin/env python3
"""The family of emulated machines: from machines.csv and drive_gains.csv to config/family/*.yaml. docs/laboratory/family.md has the rules.

    make_family.py              writes the files
    make_family.py --check      exit 1 when a file is not what the tables say
    make_family.py --out DIR [--model near]
                                writes them elsewhere, to be tuned there; near: with the near models in place of the catalogue's
"""
import argparse
import csv
import math
import random
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
FAMILY = ROOT / "config" / "family"

ENCODER_COUNTS = 1048576
MOST_RAMP_RAD_S2 = 0.99 * 2 * math.pi * 2**32 / ENCODER_COUNTS  # 0x6085 has 32 bits, in counts/s^2
# What the emulated axes are, of their friction F, the mean of break-away and Coulomb levels over directions and axes: the shipped machine's
# levels for 45 N. Bristles bend by 9 um under F.
LEVELS = {"x": {"Fs_plus_N": 52, "Fs_minus_N": 47, "Fc_plus_N": 42, "Fc_minus_N": 36},
          "y": {"Fs_plus_N": 48, "Fs_minus_N": 53, "Fc_plus_N": 37, "Fc_minus_N": 43}}
MEAN_FC_OF_45, FS_OVER_FC = 39.5, 1.25
PRESLIDING_M, SIGMA1_PER_45N, SIGMA2_PER_45N = 9e-6, 3000.0, 500.0
ZETA = 0.03
# How wrong a catalogue is at most; drawn evenly on a logarithmic scale.
CATALOGUE = {"stiffness": 0.2, "masses": 0.1, "friction": 0.5}
# A model that was identified, for plants without effects: K 2 %, inertias 5 %, friction 20 %, damping half.
NEAR = {"stiffness": 0.98, "masses": 1.05, "friction": 0.8, "damping": 0.5}


def number(value, digits=3):
    text = f"{float(f'{value:.{digits}g}'):g}"
    if "e" in text:
        mantissa, exponent = text.split("e")
        return f"{mantissa}e{int(exponent)}"
    return text


class Machine:
    def __init__(self, row, gains):
        self.row, self.gains = row, gains
        self.name, self.what = row["name"], row["what"]
        for key in ("lead_mm", "motor_inertia_kgm2", "table_mass_kg", "screw_stiffness_N_um", "friction_N", "rated_torque_Nm", "stroke_mm",
                    "scale_counts_per_mm"):
            setattr(self, key, float(row[key]))
        self.radius_m = self.lead_mm * 1e-3 / (2 * math.pi)
        self.motor_kg = self.motor_inertia_kgm2 / self.radius_m**2
        self.mass_kg = self.motor_kg + self.table_mass_kg
        self.per_mass = 1 / self.motor_kg + 1 / self.table_mass_kg
        self.stiffness = self.screw_stiffness_N_um * 1e6
        self.mode_Hz = math.sqrt(self.stiffness * self.per_mass) / (2 * math.pi)
        self.damping = 2 * ZETA * math.sqrt(self.stiffness / self.per_mass)
        self.size = self.friction_N / 45

    def catalogue(self):
        """Factors of the model, by a generator that is seeded by a name: with and without a scale a machine has one catalogue."""
        draw = random.Random("catalogue " + self.row["catalogue"])
        return {key: math.exp(draw.uniform(-1, 1) * math.log(1 + error)) for key, error in sorted(CATALOGUE.items())}

    def limits(self):
        """Limits of an axis by what its motor and screw can do, see the record."""
        torque_Nm = 2.35 * self.rated_torque_Nm
        force_N = torque_Nm / self.radius_m
        heaviest, lightest = self.mass_kg * (1 + CATALOGUE["masses"]), self.mass_kg / (1 + CATALOGUE["masses"])
        acceleration = 0.5 * self.rated_torque_Nm / self.radius_m / self.mass_kg
        jerk = acceleration / max(0.025, 2.5 / self.mode_Hz)
        ramp = 0.75 * force_N / heaviest
        # At the torque limit until the drive has noticed a dead master, then down its ramp.
        slam = force_N / lightest
        safe_mm = 1e3 * 0.5 * slam * 0.0085**2 * (1 + slam / ramp)
        velocity = min(50 * self.lead_mm, self.stroke_mm / 1.6)
        return {"torque_Nm": torque_Nm, "acceleration_mm_s2": 1e3 * acceleration, "jerk_mm_s3": 1e3 * jerk, "velocity_mm_s": velocity,
                "ramp_rad_s2": min(ramp / self.radius_m, MOST_RAMP_RAD_S2), "safe_travel_mm": max(2.0, self.lead_mm / 2, math.ceil(2.2 * safe_mm) / 2),
                "following_error_mm": max(0.2, min(self.lead_mm / 10, 2.0))}


def friction_lines(levels, size, indent, more=()):
    lines = [f"{key}: {number(value * size)}" for key, value in levels.items()]
    return [" " * indent + line for line in [*lines, *more]]


def model_lines(m, factors, levels, sigma, indent):
    """`axes.<name>.model` with every number off by its factor."""
    k, masses, f = factors["stiffness"], factors["masses"], factors["friction"]
    size = m.size * f
    head = [f"lead_mm: {number(m.lead_mm)}", f"motor_inertia_kgm2: {number(m.motor_inertia_kgm2 * masses, 4)}",
            f"table_mass_kg: {number(m.table_mass_kg * masses, 4)}", f"screw_stiffness_N_um: {number(m.screw_stiffness_N_um * k, 4)}",
            f"screw_damping_Ns_m: {number(m.damping * factors['damping'])}", "friction:"]
    more = ["vs_mm_s: 2", f"sigma0_N_m: {number(m.friction_N * f / PRESLIDING_M)}", f"sigma1_Ns_m: {number(SIGMA1_PER_45N * size)}",
            "sigma1_decay_mm_s: 2", f"sigma2_Ns_m: {number(SIGMA2_PER_45N * size)}"]
    tail = ["uncertainty:", *(f"  {key}: {number(value, 2)}" for key, value in sigma.items())]
    pad = " " * indent
    return [*(pad + line for line in head), pad + "  acts_on: table", pad + "  stribeck_exponent: 1", *friction_lines(levels, size, indent + 2, more),
            *(pad + line for line in tail)]


def sigmas(k, masses, friction):
    return {"motor_inertia_kgm2": masses, "table_mass_kg": masses, "screw_stiffness_N_um": k, "Fc_plus_N": friction, "Fc_minus_N": friction,
            "sigma0_N_m": friction, "sigma2_Ns_m": friction}


def catalogue_model(m, indent):
    factors = {**m.catalogue(), "damping": 2 / 3}  # a catalogue has no damping: 0.02 of critical
    levels = {key: MEAN_FC_OF_45 * (FS_OVER_FC if key.startswith("Fs") else 1.0) for key in LEVELS["x"]}
    even = [CATALOGUE[key] / math.sqrt(3) for key in ("stiffness", "masses", "friction")]  # of an even distribution
    return model_lines(m, factors, levels, sigmas(*even), indent)


def near_model(m, axis):
    return "\n".join([f"# Axis {axis} of the machine {m.name}, as if identified: K 2 %, inertias 5 %, friction 20 % off. Written by make_family.py.",
                      *model_lines(m, NEAR, LEVELS[axis], sigmas(0.02, 0.05, 0.2), 0)]) + "\n"


def drive_lines(m, node):
    limits = m.limits()
    scale = [f"linear_scale: {{counts_per_mm: {number(m.scale_counts_per_mm, 9)}}}"] if m.scale_counts_per_mm else []
    lines = ["drive:", "  bus: main", f"  node_id: {node}", "  mode: cst", f"  rated_torque_Nm: {number(m.rated_torque_Nm, 4)}",
             f"  peak_torque_Nm: {number(3 * m.rated_torque_Nm, 4)}", f"  encoder_counts_per_rev: {ENCODER_COUNTS}", "  absolute_encoder: true",
             "  identity: {vendor_id: 0xC0D, product_code: 0x402}", *("  " + line for line in scale), "  delay_cycles: 1", "  lag_ms: 0.2",
             "  notice_ms: 6", f"  quick_stop_deceleration_rad_s2: {number(limits['ramp_rad_s2'])}",
             "limits:", f"  position_mm: [{number(-m.stroke_mm / 2, 6)}, {number(m.stroke_mm / 2, 6)}]",
             *(f"  {key}: {number(limits[key])}" for key in ("velocity_mm_s", "acceleration_mm_s2", "jerk_mm_s3", "torque_Nm", "following_error_mm",
                                                             "safe_travel_mm"))]
    return ["    " + line for line in lines]


def emulated_lines(m, axis):
    g = m.gains
    notch = f", notch_Hz: {g['notch_Hz']}, notch_width: {g['notch_width']}, notch_depth: {g['notch_depth']}" if float(g["notch_Hz"]) else ""
    more = ["vs_mm_s: 2", f"sigma0_N_m: {number(m.friction_N / PRESLIDING_M)}", f"sigma1_Ns_m: {number(SIGMA1_PER_45N * m.size)}",
            "sigma1_decay_mm_s: 2", f"sigma2_Ns_m: {number(SIGMA2_PER_45N * m.size)}", "position_amplitude_rel: 0.2", "ripple_amplitude_rel: 0.08"]
    lines = [f"motor_inertia_kgm2: {number(m.motor_inertia_kgm2)}", f"table_mass_kg: {number(m.table_mass_kg)}",
             f"screw_stiffness_N_um: {number(m.screw_stiffness_N_um)}", f"screw_damping_Ns_m: {number(m.damping)}", "encoder_noise_lsb: 0.3",
             f"stroke_mm: {number(m.stroke_mm, 6)}",
             f"cascade: {{position_gain_1_s: {g['position_gain_1_s']}, velocity_gain_1_s: {g['velocity_gain_1_s']}, velocity_integral_1_s: "
             f"{g['velocity_integral_1_s']}, velocity_filter_Hz: 3000{notch}, rest_window_counts: 3}}", "friction:", "  law: lugre",
             "  stribeck_exponent: 1"]
    return ["      " + line for line in lines] + friction_lines(LEVELS[axis], m.size, 8, more)


LOOP_KEYS = ("loop", "scale_loop")


def loop_numbers(m, model, which):
    """What tune_loops.py has found, or None."""
    if not (HERE / "loops.csv").exists():
        return None
    rows = [row for row in read(HERE / "loops.csv") if (row["name"], row["model"], row["key"]) == (m.name, model, which)]
    return {key: value for key, value in rows[0].items() if key not in ("name", "model", "key")} if rows else None


def near_loop(m, which):
    numbers = ", ".join(f"{key}: {value}" for key, value in loop_numbers(m, "near", which).items())
    return f"# The {which} of {m.name} in torque mode with its near models, as contour tune --from-model finds it.\n{{{numbers}}}\n"


def machine_file(m, near=False, with_loops=True):
    lines = [f"# {m.name}: {m.what}. One of the family (docs/laboratory/family.md), written by tools/validation/family/make_family.py: change the tables there.",
             f"# Motor {number(m.motor_kg)} kg at the table, mode {number(m.mode_Hz)} Hz, F/K {number(1e6 * m.friction_N / m.stiffness)} um.", "",
             f"machine: {{name: {m.name}, cycle_us: 1000, controller: full}}", # A scale's reading makes the frames longer.
             f"realtime: {{priority: 80, cpu: 1, required: true, send_deadline_us: {70 if m.scale_counts_per_mm else 200}}}",
             "memory: {friction_map: false}    # the emulated machine is another one with every seed", "buses:",
             "  main: {interface: loopback, bitrate_bit_s: 1000000}", "", "axes:"]
    for node, axis in enumerate(LEVELS, start=1):
        lines += [f"  {axis}:", *drive_lines(m, node)]
        if near:
            lines += [f"    model: near/{m.name}_{axis}.yaml"]
        else:
            lines += ["    # From catalogues: masses, stiffness of the screw, friction by preload; nothing was measured.", "    model:", *catalogue_model(m, 6)]
        for which in LOOP_KEYS if with_loops else ():
            if loop := loop_numbers(m, "near" if near else "catalogue", which):
                lines += [f"    {which}:", *(f"      {key}: {value}" for key, value in loop.items())]
    lines += ["", "# What the emulated machine really is.", "emulator:", "  seed: 1", "  axes:"]
    for axis in LEVELS:
        lines += [f"    {axis}:", *emulated_lines(m, axis)]
    return "\n".join(lines) + "\n"


def read(path):
    with path.open(encoding="utf-8", newline="") as text:
        return list(csv.DictReader(text))


def files(folder=FAMILY, near=False, with_loops=True):
    gains = {row["name"]: row for row in read(HERE / "drive_gains.csv")}
    for row in read(HERE / "machines.csv"):
        m = Machine(row, gains[row["name"]])
        yield folder / f"{m.name}.yaml", machine_file(m, near, with_loops)
        for which in LOOP_KEYS if with_loops else ():
            if loop_numbers(m, "near", which):
                yield folder / "near" / f"{m.name}_{which}.yaml", near_loop(m, which)
        for axis in LEVELS:
            yield folder / "near" / f"{m.name}_{axis}.yaml", near_model(m, axis)


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--check", action="store_true")
    arguments.add_argument("--out", type=Path, default=FAMILY)
    arguments.add_argument("--model", choices=("catalogue", "near"), default="catalogue")
    options = arguments.parse_args()
    if options.model == "near" and options.out == FAMILY:
        arguments.error("--model near needs --out: the family's own files have the catalogue's models")
    wanted = dict(files(options.out, options.model == "near"))
    if not options.check:
        (options.out / "near").mkdir(parents=True, exist_ok=True)
        for path, text in wanted.items():
            path.write_text(text, encoding="utf-8")
        return 0
    there = set(options.out.glob("**/*.yaml"))
    wrong = [path for path, text in wanted.items() if path not in there or path.read_text(encoding="utf-8") != text]
    wrong += sorted(there - set(wanted))
    for path in wrong:
        print(f"{path.relative_to(ROOT) if path.is_relative_to(ROOT) else path}: not what machines.csv and drive_gains.csv say; run make_family.py")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
