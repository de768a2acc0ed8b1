#!/usr/bin/env python3
"""EMPS by `contour diagnose` alone, from rows 1 to 12420 of its recording: direction-dependent viscous friction and the
ripple are named, and the model file as written foresees what it has not seen.

    emps_test.py CONTOUR FOLDER [--strict]

Without --strict, free runs of 405 and 1360 um are asked for in print only; what fails is a cause that is not named, or a
model that is worse by more than a twentieth than the authors' own of either direction (418 and 1535 um).
"""
import sys
import tempfile
from pathlib import Path

import diagnosed
import emps

SECOND_HALF_UM, PULSES_UM = 405.0, 1360.0
EITHER_DIRECTION_UM = 418.0, 1535.0


def main():
    folder = diagnosed.data_folder(Path(sys.argv[2]) / "emps", "emps_train.csv", "emps_pulses.csv")
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        emps.write_first_half(folder / "emps_train.csv", work / "half.csv")
        (work / "model.yaml").write_text(emps.MODEL, encoding="utf-8")
        text, found = diagnosed.diagnose(sys.argv[1], work / "half.csv", work / "model.yaml", work / "out", "--columns", emps.COLUMNS)
        kinds = diagnosed.named(found)
        model = work / "out" / "extended_model.yaml"
        second = emps.free_run_um(model, emps.read(folder / "emps_train.csv"), emps.SECOND_HALF)
        pulses = emps.free_run_um(model, emps.read(folder / "emps_pulses.csv"), emps.PULSES)
        print(f"{found['verdict']}: {kinds}; free run of 1 s: {second:.0f} um on the second half, {pulses:.0f} um on pulses")
        errors = []
        if "asymmetric_viscous" not in kinds:
            errors.append("asymmetric_viscous is not named")
        if not {"cogging", "friction_ripple"} & set(kinds):
            errors.append("the ripple is not named")
        if second > SECOND_HALF_UM or pulses > PULSES_UM:
            errors.append(f"expected {SECOND_HALF_UM:.0f} and {PULSES_UM:.0f} um at most")
        if errors and "--strict" not in sys.argv:
            print("\n".join(f"not reached: {e}" for e in errors))
            errors = [e for e in errors if not e.startswith("expected")]
            if second > 1.05 * EITHER_DIRECTION_UM[0] or pulses > 1.05 * EITHER_DIRECTION_UM[1]:
                errors.append("worse than the authors' model of either direction")
        if errors:
            sys.exit("\n".join(errors) + "\n" + text)


if __name__ == "__main__":
    main()
