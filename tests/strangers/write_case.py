"""A case as a stranger would hand it in: a table, and a file with nothing but a model. The truth is for the judge alone."""
import json
from pathlib import Path

import numpy as np

from draw_axis import STATED, TICK_S


def model_text(axis, no_stribeck):
    """`axis`: as its owner states it."""
    r = axis["lever_m"]
    force, where = (1.0 / r, "table") if axis["friction_on_load"] and not axis["stated_rigid"] else (1.0, "motor")
    per_m = force / r if where == "table" else 1.0
    n, q = ("N", "m") if where == "table" else ("Nm", "rad")
    speed = "vs_mm_s" if where == "table" else "vs_rad_s"
    vs = axis["vs"] * r * 1e3 if where == "table" else axis["vs"]
    fs = axis["Fc"] if no_stribeck else axis["Fs"]
    lines = ["model:", f"  lead_mm: {axis['lead_mm']:g}", f"  motor_inertia_kgm2: {axis['motor_inertia']:.6g}",
             f"  load_inertia_kgm2: {axis['load_inertia']:.6g}"]
    if not axis["stated_rigid"]:
        damping = 2.0 * 0.03 * np.sqrt(axis["stiffness"] * axis["motor_inertia"] * axis["load_inertia"] / axis["inertia"])
        lines += [f"  stiffness_Nm_rad: {axis['stiffness']:.6g}", f"  damping_Nms_rad: {damping:.6g}"]
    lines += ["  friction:", f"    acts_on: {where}", f"    stribeck_exponent: {axis['stribeck_exponent']:g}"]
    for side in ("plus", "minus"):
        lines += [f"    Fc_{side}_{n}: {axis['Fc'] * force:.6g}", f"    Fs_{side}_{n}: {fs * force:.6g}"]
    lines += [f"    {speed}: {vs:.6g}", f"    sigma0_{n}_{q}: {axis['sigma0'] * per_m:.6g}",
              f"    sigma1_{n}s_{q}: {axis['sigma1'] * per_m:.6g}", f"    sigma2_{n}s_{q}: {axis['sigma2'] * per_m:.6g}",
              "  uncertainty:"]
    names = {"motor_inertia": "motor_inertia_kgm2", "load_inertia": "load_inertia_kgm2", "stiffness": "stiffness_Nm_rad",
             "Fc": f"Fc_plus_{n}", "Fs": f"Fs_plus_{n}", "vs": speed, "sigma0": f"sigma0_{n}_{q}", "sigma1": f"sigma1_{n}s_{q}",
             "sigma2": f"sigma2_{n}s_{q}", "lag_s": "lag_ms", "torque_constant": "torque_constant", "delay_s": "delay_ms"}
    for key, name in names.items():
        if key != "stiffness" or not axis["stated_rigid"]:
            lines.append(f"    {name}: {STATED[key]:g}")
    half = 0.5e3 * axis["stroke_m"] + 5.0
    lines += ["drive:", f"  delay_ms: {axis['delay_s'] * 1e3:.6g}", f"  lag_ms: {axis['lag_s'] * 1e3:.6g}",
              f"  encoder_counts_per_rev: {axis['counts']:g}", f"  torque_step_Nm: {axis['torque_step']:.6g}",
              f"  rated_torque_Nm: {axis['rated']:.6g}", f"  stroke_mm: [{-half:.6g}, {half:.6g}]"]
    return "\n".join(lines) + "\n"


def write_case(folder, axis, stated, columns, truth, no_stribeck):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    rows = len(columns["q"])
    table = {"time_s": np.arange(rows) * TICK_S, "torque_Nm": columns["torque"], "motor_angle_rad": columns["q"]}
    if axis["scale"]:
        table["table_position_m"] = columns["table"]
    if axis["thermometer"]:
        table["temperature_degC"] = np.round(columns["temperature"], 2)
    if axis["second_axis"]:
        table["axis2_position_m"] = columns["other"]
    np.savetxt(folder / "log.csv", np.stack(list(table.values()), 1), fmt="%.9g", delimiter=",", header=",".join(table), comments="")
    (folder / "model.yaml").write_text(model_text(stated, no_stribeck), encoding="utf-8")
    (folder / "truth.json").write_text(json.dumps(truth, indent=1, default=float), encoding="utf-8")
