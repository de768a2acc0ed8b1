"""Times of planned motion against independent solvers, on the planner's own smooth paths.

  motion_oracle.py DUMP_STRETCHES [--all] [--strangers FROM TO]

CasADi with IPOPT finds the fastest motion with velocity, acceleration and jerk of every axis limited, by a
transcription of its own: a triple integrator along the path from place to place, the times between them unknown. toppra finds the bound
without a limit of jerk. Both look at the limits at discrete places only, so they are a little faster than is allowed. Beside ours stands
how long the optimum itself takes against that bound: where that is more than 1.3, no motion that keeps the jerk can be within 1.3 of it.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import casadi
import numpy as np
import toppra
import toppra.algorithm
import toppra.constraint
from toppra.interpolator import AbstractGeometricPath

import sample_programs

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "strangers"))
import cam_programs  # noqa: E402

TIME_RATIO = 1.10      # of the optimum with jerk
BOUND_RATIO = 1.30     # of the bound without
NEAR = 1.02
LONGEST_MOVES = 200    # for the optimum
PLACES = 150           # of a stretch, for every ten moves
MOST_PLACES = 600


class Path:
    """A piecewise cubic by the way, with its derivatives."""

    def __init__(self, stretch):
        self.breaks = np.array(stretch["breaks"])
        self.pieces = np.array(stretch["pieces"])  # [piece][axis][derivative]
        self.feeds = stretch["feeds"]
        self.length = self.breaks[-1]

    def derivatives(self, way, side=None):
        """Orders 0 to 3, [order][axis]; at a break those of the piece to the right, or in which `side` lies."""
        i = np.searchsorted(self.breaks, way if side is None else side, side="right") - 1
        i = np.clip(i, 0, len(self.pieces) - 1)
        x = (way - self.breaks[i])[..., None]
        p, d1, d2, d3 = (self.pieces[i][..., k] for k in range(4))
        return np.array([p + x * (d1 + x * (d2 / 2 + x * d3 / 6)), d1 + x * (d2 + x * d3 / 2), d2 + x * d3, d3])

    def feed(self, way):
        values = [f if f > 0 else 1e3 for _, f in self.feeds]
        return np.array(values)[np.clip(np.searchsorted([b for b, _ in self.feeds], way, side="right") - 1, 0, None)]


class WithWay(AbstractGeometricPath):
    """The path for toppra, its arc length as another joint, whose speed is the feed."""

    def __init__(self, path):
        self.path = path

    def __call__(self, ways, order=0):
        d = self.path.derivatives(np.asarray(ways, dtype=float))
        norm = np.linalg.norm(d[1], axis=-1)
        extra = {0: np.asarray(ways), 1: norm,
                 2: np.sum(d[1] * d[2], axis=-1) / np.maximum(norm, 1e-12)}[order]
        return np.concatenate([d[order], extra[..., None]], axis=-1)

    @property
    def dof(self):
        return self.path.pieces.shape[1] + 1

    @property
    def path_interval(self):
        return np.array([0.0, self.path.length])

    @property
    def waypoints(self):
        return None


def bound_without_jerk(path, limits):
    axes = path.pieces.shape[1]
    n = max(400, 4 * len(path.breaks))
    grid = np.unique(np.concatenate([np.linspace(0, path.length, n), path.breaks]))
    grid = grid[np.concatenate([[True], np.diff(grid) > 1e-10])]
    grid[-1] = path.length
    velocity = np.array([limits["velocity"]] * axes)

    def speeds(way):
        top = np.append(velocity, path.feed(way))
        return np.stack([-top, top], axis=-1)

    acceleration = np.append([limits["acceleration"]] * axes, 1e6)
    constraints = [toppra.constraint.JointVelocityConstraintVarying(speeds),
                   toppra.constraint.JointAccelerationConstraint(np.stack([-acceleration, acceleration], axis=-1))]
    solver = toppra.algorithm.TOPPRA(constraints, WithWay(path), gridpoints=grid, solver_wrapper="seidel")
    _, speed, _ = solver.compute_parameterization(0, 0)
    return float(np.sum(2 * np.diff(grid) / (speed[1:] + speed[:-1])))


def optimum_with_jerk(path, stretch, limits, places):
    """The fastest triple integrator from place to place, started from the planner's own motion."""
    samples = np.array(stretch["samples"])
    t = np.linspace(0, samples[-1, 0], places)
    way = np.interp(t, samples[:, 0], samples[:, 1])
    way = np.unique(np.concatenate([way, path.breaks]))
    way = way[np.concatenate([[True], np.diff(way) > 1e-7 * path.length / places])]
    way[0], way[-1] = 0.0, path.length
    at = np.interp(way, samples[:, 1] + np.arange(len(samples)) * 1e-15, samples[:, 0])
    n = len(way) - 1
    middle = 0.5 * (way[1:] + way[:-1])
    problem = casadi.Opti()
    time, speed = problem.variable(n), problem.variable(n + 1)
    acceleration, jerk = problem.variable(n + 1), problem.variable(n)
    unit = path.length
    problem.subject_to((speed[:-1] * time + acceleration[:-1] * time**2 / 2 + jerk * time**3 / 6) / unit ==
                       np.diff(way) / unit)
    problem.subject_to(speed[1:] == speed[:-1] + acceleration[:-1] * time + jerk * time**2 / 2)
    problem.subject_to(acceleration[1:] == acceleration[:-1] + jerk * time)
    problem.subject_to(speed >= 0)
    problem.subject_to(time >= 1e-9)
    problem.subject_to([speed[0] == 0, speed[-1] == 0, acceleration[0] == 0, acceleration[-1] == 0])
    for begin in (True, False):
        here = way[:-1] if begin else way[1:]
        d = path.derivatives(here, middle)
        v, a = (speed[:-1], acceleration[:-1]) if begin else (speed[1:], acceleration[1:])
        problem.subject_to(v * np.linalg.norm(d[1], axis=-1) <= path.feed(middle))
        for i in range(d.shape[2]):
            if np.max(np.abs(d[1][:, i])) < 1e-9:
                continue
            problem.subject_to(problem.bounded(-1, d[1][:, i] * v / limits["velocity"], 1))
            problem.subject_to(problem.bounded(-1, (d[2][:, i] * v**2 + d[1][:, i] * a) / limits["acceleration"], 1))
            problem.subject_to(problem.bounded(
                -1, (d[3][:, i] * v**3 + 3 * d[2][:, i] * v * a + d[1][:, i] * jerk) / limits["jerk"], 1))
    problem.minimize(casadi.sum1(time))
    problem.set_initial(time, np.maximum(np.diff(at), 1e-6))
    problem.set_initial(speed, np.interp(at, samples[:, 0], samples[:, 2]))
    problem.set_initial(acceleration, np.interp(at, samples[:, 0], samples[:, 3]))
    problem.solver("ipopt", {"print_time": False, "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-6, "max_iter": 500}})
    try:
        return float(casadi.sum1(problem.solve().value(time)))
    except RuntimeError:
        return None  # the solver gave up


def judge(dump, name, program, limits, folder):
    file = pathlib.Path(folder) / "program.ngc"
    file.write_text(program)
    numbers = [limits[k] for k in ("velocity", "acceleration", "jerk", "tolerance")]
    out = subprocess.run([dump, file, *map(str, numbers)], check=True, capture_output=True, text=True).stdout
    plan = json.loads(out)
    planned = bound = optimum = compared = compared_bound = 0.0
    for stretch in plan["stretches"]:
        path = Path(stretch)
        planned += stretch["duration_s"]
        own_bound = bound_without_jerk(path, limits)
        bound += own_bound
        if sum(s["moves"] for s in plan["stretches"]) <= LONGEST_MOVES:
            fastest = optimum_with_jerk(path, stretch, limits, min(MOST_PLACES, PLACES * max(1, stretch["moves"] // 10)))
            if fastest is not None:
                optimum += fastest
                compared += stretch["duration_s"]
                compared_bound += own_bound
    return {"name": name, "moves": sum(s["moves"] for s in plan["stretches"]), "planned_s": planned,
            "bound_s": bound, "optimum_s": optimum, "compared_s": compared, "compared_bound_s": compared_bound}


class Worst:
    """Of all programs that were judged."""

    def __init__(self):
        self.to_optimum = self.to_bound = self.long_to_bound = self.optimum_to_bound = 0.0
        self.failed = self.count = 0

    def add(self, machine, result):
        self.count += 1
        to_bound = result["planned_s"] / result["bound_s"]
        line = f"{machine:10} {result['name']:26} {result['moves']:6} moves {result['planned_s']:9.4f} s, " \
               f"{to_bound:.3f} of the bound without jerk"
        good = to_bound <= BOUND_RATIO
        self.to_bound = max(self.to_bound, to_bound)
        if result["compared_s"] > 0:
            # Where jerk alone costs more than that, the optimum decides.
            to_optimum = result["compared_s"] / result["optimum_s"]
            own = result["optimum_s"] / result["compared_bound_s"]
            part = result["compared_s"] / result["planned_s"]
            line += f" (the optimum itself {own:.3f}{'' if part > 0.999 else f' on {part:.0%} of the time'}), {to_optimum:.3f} of the optimum"
            # IPOPT may end in a local optimum that is slower than ours; whether limits are kept is judged by other tests.
            line += ", which is slower: a local one" if to_optimum < 0.98 else ""
            good = (good or to_optimum <= NEAR) and to_optimum <= TIME_RATIO
            self.to_optimum = max(self.to_optimum, to_optimum)
            self.optimum_to_bound = max(self.optimum_to_bound, own)
        else:
            self.long_to_bound = max(self.long_to_bound, to_bound)
        self.failed += not good
        print(line, "" if good else "  <- beyond", flush=True)


def all_programs(options):
    """(machine, name, text); strangers as long as the optimum is found for, and longer ones for the bound alone."""
    for machine in sample_programs.MACHINES:
        for name, program in sample_programs.programs(everything=options.all):
            if not options.strangers and (options.all or (machine, name) in sample_programs.SHORT):
                yield machine, name, program
        if options.strangers:
            for seed in range(options.strangers[0], options.strangers[1] + 1):
                for kind in cam_programs.KINDS:
                    yield machine, f"{kind} {seed}", cam_programs.program(kind, seed)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dump")
    parser.add_argument("--all", action="store_true", help="all programs on all machines")
    parser.add_argument("--strangers", nargs=2, type=int, help="programs of tests/daemon/program/strangers instead, seeds from, to")
    options = parser.parse_args()
    toppra.setup_logging("ERROR")
    worst = Worst()
    with tempfile.TemporaryDirectory() as folder:
        for machine, name, program in all_programs(options):
            worst.add(machine, judge(options.dump, name, program, sample_programs.MACHINES[machine], folder))
    print(f"{worst.count} programs: at most {worst.to_optimum:.3f} of the optimum, {worst.to_bound:.3f} of the bound without jerk "
          f"({worst.long_to_bound:.3f} where no optimum was sought), the optimum itself {worst.optimum_to_bound:.3f} of it; {worst.failed} beyond")
    return 1 if worst.failed else 0


if __name__ == "__main__":
    sys.exit(main())
