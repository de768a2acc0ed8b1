#!/usr/bin/env python3
"""Writes docs/real_axes.md: what `contour diagnose` says of real axes, and what independent least squares say.

    report.py CONTOUR FOLDER > docs/real_axes.md
"""
import sys
import tempfile
from pathlib import Path

import diagnosed
import emps
import numpy
import ur10e
from axis_model import butterworth, central_difference, rms

HEAD = """# Real axes

Made by `tests/tools/real_axes/report.py build/release/bin/contour FOLDER > docs/real_axes.md`, where FOLDER holds `emps/` and `ur10e/`. The recordings are their authors' and not part of this repository; tests that need them
look in `CONTOUR_REAL_AXES` (a CMake variable; `../shared/data` next to the sources unless said otherwise) and are skipped, with a message, where they are not.

`contour diagnose` is given the first half of a recording, a model, and no option but how the columns are spelt. What comes out is scored by scripts that share nothing with it (`tests/tools/real_axes`).
"""


def causes_table(found):
    causes = found["causes"] + found.get("partial_causes", [])
    if not causes:
        return "No cause is named.\n\n"
    out = "| named | size | gain on blocks not seen |\n| --- | --- | --- |\n"
    for c in causes:
        sizes = ", ".join(f"{name} {p['value']:.4g}" for name, p in c["parameters"].items())
        kinds = " or ".join(f"`{k}`" for k in [c["kind"], *c["indistinguishable_from"]])
        out += f"| {kinds} | {sizes} | {100 * c['heldout_gain']:.0f} % ({100 * c['heldout_gain_ci95'][0]:.0f} to {100 * c['heldout_gain_ci95'][1]:.0f}) |\n"
    return out + "\n"


def errors_table(found, unit, factor):
    errors = found["model_errors"]
    out = f"| model | one step, used | not used | free run of {errors['free_run_s']:g} s, used | not used |\n| --- | --- | --- | --- | --- |\n"
    for name in ("stated", "refitted", "extended"):
        if name in errors:
            e = errors[name]
            row = [e["one_step"]["used"], e["one_step"]["unseen"], e["free_run"]["used"], e["free_run"]["unseen"]]
            out += f"| {name} | " + " | ".join(f"{factor * x:.3g} {unit}" for x in row) + " |\n"
    return "By its own account, on the half that it saw (`model_errors`):\n\n" + out + "\n"


def emps_regression(data):
    """Force of inverse dynamics above 2 mm/s, all filtered at 50 Hz; fitted on rows 100 to 12420, scored to 24700."""
    q = butterworth(data["raw"], 50.0, 1000.0)
    v = central_difference(q, 1e-3)
    a = central_difference(v, 1e-3)
    force = data["force"].copy()
    force[1:] = 0.5 * (data["force"][1:] + data["force"][:-1])
    force = butterworth(force, 50.0, 1000.0)
    up, down = (v > 0) * 1.0, (v < 0) * 1.0
    sets = {"one Coulomb and one viscous coefficient": [a, up - down, v, numpy.ones_like(v)],
            "of either direction": [a, up, -down, v * up, v * down]}
    turn = 2 * numpy.pi * q / 2.5e-3
    waves = [f(n * turn) * s for n in (1, 2) for f in (numpy.sin, numpy.cos) for s in (1.0, up - down)]
    sets["and waves once and twice per turn"] = sets["of either direction"] + waves
    rows = numpy.abs(v) > 2e-3
    first, second = rows.copy(), rows.copy()
    first[:100] = first[12420:] = False
    second[:12420] = second[24700:] = False
    out = "| least squares | first half | second half |\n| --- | --- | --- |\n"
    levels = None
    for name, columns in sets.items():
        A = numpy.stack(columns, axis=1)
        x = numpy.linalg.lstsq(A[first], force[first], rcond=None)[0]
        left = force - A @ x
        out += f"| {name} | {rms(left[first]):.2f} N | {rms(left[second]):.2f} N |\n"
        levels = x if name == "of either direction" else levels
    return out + (f"\nOf either direction: mass {levels[0]:.1f} kg, Coulomb {levels[1]:.1f} and {levels[2]:.1f} N, viscous {levels[3]:.0f} and "
                  f"{levels[4]:.0f} N s/m, which is a difference of {2 * (levels[3] - levels[4]) / (levels[3] + levels[4]):.2f} of the mean.\n\n")


def emps_part(contour, folder, work):
    emps.write_first_half(folder / "emps_train.csv", work / "half.csv")
    (work / "model.yaml").write_text(emps.MODEL, encoding="utf-8")
    _, found = diagnosed.diagnose(contour, work / "half.csv", work / "model.yaml", work / "emps", "--columns", emps.COLUMNS)
    train, pulses = emps.read(folder / "emps_train.csv"), emps.read(folder / "emps_pulses.csv")
    model = work / "emps" / "extended_model.yaml"
    return (f"""## EMPS, a ball-screw axis

A. Janot, M. Gautier, M. Brunot, "Data Set and Reference Models of EMPS", 2019 ([nonlinearbenchmark.org](https://www.nonlinearbenchmark.org)). Rows 1 to {emps.HALF} of `emps_train.csv`, the authors' symmetric model:

```
{emps.MODEL}```

Verdict: `{found['verdict']}`.

""" + causes_table(found) + errors_table(found, "um", 1e6)
            + f"""The model file as written, run by the scorer: windows of 1 s back to back, begun at the position filtered forward and backward (4th-order Butterworth, 150 Hz) and its central difference, against the raw position:
**{emps.free_run_um(model, train, emps.SECOND_HALF):.0f} um** on the second half of train (rows 12420 to 24700), **{emps.free_run_um(model, pulses, emps.PULSES):.0f} um** on pulses (100 to 24700). The authors' models have, by the same
scorer as their README states it, 1787 and 2171 um (symmetric), 418 and 1535 um (of either direction).

Independent least squares on the force of inverse dynamics, above 2 mm/s, everything filtered at 50 Hz:

""" + emps_regression(train))


def ur10e_part(contour, folder, work):
    ur10e.write_first_half(folder / "joint_1.csv", work / "half.csv")
    (work / "model.yaml").write_text(ur10e.MODEL, encoding="utf-8")
    _, found = diagnosed.diagnose(contour, work / "half.csv", work / "model.yaml", work / "ur", "--resample", "94")
    data = ur10e.read(folder / "joint_1.csv")
    model = work / "ur" / "extended_model.yaml"
    out = f"""## UR10e, joint 1: a robot's joint by its current

S. Mamedov, `shamilmamedov/dynamic_calibration`. 94 Hz in steps of 10 and 12 ms, so `--resample 94`; `current_A`; a model with nothing but a made-up inertia and the gear:

```
{ur10e.MODEL}```

Verdict: `{found['verdict']}`.

""" + causes_table(found) + errors_table(found, "mrad", 1e3)
    out += (f"The model file as written, no number fitted again: current residual **{ur10e.model_residual_A(model, data, 'first'):.4f} A** on the half that it saw, "
            f"**{ur10e.model_residual_A(model, data, 'second'):.4f} A** on the other.\n\n"
            f"Scorer: all signals on 100 Hz, 4th-order Butterworth at {ur10e.CORNER_HZ:g} Hz forward and backward, rows above {ur10e.SLIDES_RAD_S:g} rad/s, cut at row {ur10e.HALF}, half a second on either side left out. "
            "Independent least squares by the same rows:\n\n| terms | first half | second half |\n| --- | --- | --- |\n")
    for name, terms in (("inertia, Coulomb, viscous, constant", []), ("and nonlinear viscous", ["viscous_nonlinear"]),
                        ("and position", ["viscous_nonlinear", "position"]), ("and order 2 per motor turn", ["viscous_nonlinear", "position", "order 2"])):
        first, second = ur10e.regression(data, terms)
        out += f"| {name} | {first:.4f} A | {second:.4f} A |\n"
    return out


def main():
    contour, root = sys.argv[1], Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        emps_folder = diagnosed.data_folder(root / "emps", "emps_train.csv", "emps_pulses.csv")
        ur_folder = diagnosed.data_folder(root / "ur10e", "joint_1.csv")
        print(HEAD + "\n" + emps_part(contour, emps_folder, work) + ur10e_part(contour, ur_folder, work), end="")


if __name__ == "__main__":
    main()
