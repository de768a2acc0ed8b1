"""UR10e, joint 1: the current that its motion needs, by inverse dynamics on a grid of 100 Hz.

Scorer: current, position and velocity on a grid of 100 Hz by straight lines, 4th-order Butterworth at 10 Hz forward and
backward; acceleration by central difference of the velocity; rows with more than 0.05 rad/s; the halves are cut at row
2944 of the file, half a second on either side of the cut left out.
"""
from pathlib import Path

import numpy
from axis_model import AxisModel, butterworth, central_difference, rms

HALF = 2944
CORNER_HZ, SLIDES_RAD_S = 10.0, 0.05
MODEL = """model:
  motor_inertia_kgm2: 10
  gear_ratio: 101
"""


def read(path):
    data = numpy.genfromtxt(path, delimiter=",", names=True)
    time = numpy.arange(data["time_s"][0], data["time_s"][-1], 0.01)
    out = {"time": time, "cut": data["time_s"][HALF]}
    for name in ("position_rad", "velocity_rad_s", "current_A"):
        out[name] = butterworth(numpy.interp(time, data["time_s"], data[name]), CORNER_HZ, 100.0)
    out["acceleration"] = central_difference(out["velocity_rad_s"], 0.01)
    slides = numpy.abs(out["velocity_rad_s"]) > SLIDES_RAD_S
    out["first"] = slides & (time < out["cut"] - 0.5) & (time > 0.5)
    out["second"] = slides & (time > out["cut"] + 0.5) & (time < time[-1] - 0.5)
    return out


def write_first_half(source, target):
    lines = Path(source).read_text(encoding="utf-8").splitlines(keepends=True)
    Path(target).write_text("".join(lines[:1 + HALF]), encoding="utf-8")


def model_residual_A(model_path, data, half):
    """Of a model as it is written, no number fitted again; at the rows of one half."""
    model = AxisModel(model_path)
    q, v = data["position_rad"], data["velocity_rad_s"]
    torque = model.inertia * data["acceleration"] + model.resisting(q, v) - model.driving(q)
    return rms((data["current_A"] - torque / model.per_ampere)[data[half]])


def regression(data, terms):
    """Least squares on the first half; residual on both."""
    q, v, a = data["position_rad"], data["velocity_rad_s"], data["acceleration"]
    columns = [a, numpy.sign(v), v, numpy.ones_like(v)]
    if "viscous_nonlinear" in terms:
        columns += [v * numpy.abs(v), v ** 3]
    if "position" in terms:
        x = (q - q.mean()) / (numpy.ptp(q) / 2)
        columns += [x, x * x, x ** 3]
    if "order 2" in terms:
        columns += [numpy.sin(2 * 101 * q), numpy.cos(2 * 101 * q)]
    A = numpy.stack(columns, axis=1)
    x = numpy.linalg.lstsq(A[data["first"]], data["current_A"][data["first"]], rcond=None)[0]
    left = data["current_A"] - A @ x
    return rms(left[data["first"]]), rms(left[data["second"]])
