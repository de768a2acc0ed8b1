"""One look for all pictures: colours that the colour-blind tell apart (Okabe and Ito), units on every axis."""
import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402  the backend comes first

PLAIN = "#D55E00"  # MPC only
COMPENSATED = "#0072B2"
TRUTH = "#000000"
QUIET = "#8A8A8A"
WINDOW = "#E69F00"

LABELS = {
    "pid": "PID with feed-forward",
    "csp": "drive's own cascade (CSP)",
    "mpc": "MPC only",
    "mpc_observer": "MPC + disturbance observer",
    "mpc_srukf4": "MPC + 4-state SRUKF",
    "mpc_ekf7": "MPC + 7-state EKF",
    "mpc_srukf7": "MPC + 7-state SRUKF",
    "cnc": "numerical control as sold",
    "full": "MPC compensated (full)",
}


def label(run):
    return LABELS.get(run.controller, run.controller)


def apply():
    pyplot.rcParams.update({
        "figure.dpi": 120,
        "figure.constrained_layout.use": True,
        "font.size": 10,
        "axes.titlesize": 11,
        "figure.titlesize": 13,
        "axes.grid": True,
        "grid.color": "#D8D8D8",
        "grid.linewidth": 0.6,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "legend.frameon": False,
        "lines.linewidth": 1.3,
    })
    return pyplot
