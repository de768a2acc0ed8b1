"""EMPS: what is in its files, and how its README scores free runs."""
from pathlib import Path

import numpy
from axis_model import AxisModel, butterworth, central_difference, rms

HALF = 12420
SECOND_HALF, PULSES = (12420, 24700), (100, 24700)
COLUMNS = "time_s=t_s,force_N=force_N,position_m=qm_m"
# The authors' symmetric model. They write their offset on the other side of the equation.
MODEL = """model:
  mass_kg: 95.1089
  lead_mm: 2.5
  constant_force_N: 3.1648
  friction: {Fc_plus_N: 20.3935, Fc_minus_N: 20.3935, sigma2_Ns_m: 203.5034}
drive: {position_step_um: 0.05}
"""


def read(path):
    data = numpy.genfromtxt(path, delimiter=",", names=True)
    slow = butterworth(data["qm_m"], 150.0, 1000.0)
    return {"raw": data["qm_m"], "slow": slow, "velocity": central_difference(slow, 1e-3), "force": data["force_N"]}


def write_first_half(source, target):
    lines = Path(source).read_text(encoding="utf-8").splitlines(keepends=True)
    Path(target).write_text("".join(lines[:1 + HALF]), encoding="utf-8")


def free_run_um(model_path, data, rows):
    """Windows of 1000 rows back to back, from the filtered measurement; against the raw position."""
    starts = numpy.arange(rows[0], rows[1] - 999, 1000)
    run = AxisModel(model_path).free_runs(data["slow"], data["velocity"], data["force"], starts, 1000, 1e-3)
    return 1e6 * rms(run - data["raw"][starts[:, None] + numpy.arange(1000)])
