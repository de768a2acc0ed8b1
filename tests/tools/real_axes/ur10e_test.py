#!/usr/bin/env python3
"""Joint 1 of a UR10e by `contour diagnose` alone, from the first half of its recording and a model of nothing but an inertia
and a gear: nonlinear viscous friction comes first, then the wave of order 2 per motor turn or friction along the stroke, and
the model file as written foresees the current of the second half.

    ur10e_test.py CONTOUR FOLDER [--strict]

With --strict it has to foresee it as least squares with the same friction do, too.
"""
import sys
import tempfile
from pathlib import Path

import diagnosed
import ur10e

UNSEEN_A = 0.118


def main():
    folder = diagnosed.data_folder(Path(sys.argv[2]) / "ur10e", "joint_1.csv")
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        ur10e.write_first_half(folder / "joint_1.csv", work / "half.csv")
        (work / "model.yaml").write_text(ur10e.MODEL, encoding="utf-8")
        text, found = diagnosed.diagnose(sys.argv[1], work / "half.csv", work / "model.yaml", work / "out", "--resample", "94")
        data = ur10e.read(folder / "joint_1.csv")
        left = ur10e.model_residual_A(work / "out" / "extended_model.yaml", data, "second")
        linear, curved = (ur10e.regression(data, terms)[1] for terms in ([], ["viscous_nonlinear"]))
        kinds = diagnosed.named(found)
        print(f"{found['verdict']}: {kinds}; current residual on the second half {left:.4f} A "
              f"(least squares on the first half: {linear:.4f} A with linear, {curved:.4f} A with nonlinear viscous friction)")
        errors = []
        if kinds[:1] != ["viscous_nonlinear"]:
            errors.append("nonlinear viscous friction is not first")
        if not {"cogging", "friction_ripple", "position_friction", "cable_spring"} & set(kinds[1:]):
            errors.append("neither the wave nor the position is named")
        # As good as least squares with the same terms, to a fifth of what the second is worth.
        if left > (min(UNSEEN_A, curved + 0.2 * (linear - curved)) if "--strict" in sys.argv else UNSEEN_A):
            errors.append("the model file does not foresee the second half")
        if errors:
            sys.exit("\n".join(errors) + "\n" + text)


if __name__ == "__main__":
    main()
