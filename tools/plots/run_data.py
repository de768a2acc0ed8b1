"""Runs as `contour simulate` and `contour run --out` leave them: cycles.csv and metrics.json in a directory."""
import csv
import json
from pathlib import Path

import numpy as np

RUNNING = "Running"


class RunError(Exception):
    """A directory that holds no run that could be drawn."""


class Run:
    """One run. Columns are numpy arrays over the cycles in which the program moved; NaN where a field is empty."""

    def __init__(self, directory):
        self.directory = Path(directory)
        try:
            self.metrics = json.loads((self.directory / "metrics.json").read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise RunError(f"{self.directory}: metrics.json cannot be read: {error}") from error
        self.controller = self.metrics["controller"]
        self.program = self.metrics["program"]
        self._columns = {}
        self._rows = self._read()
        self.axes = [name[: -len("_reference_position_m")] for name in self._header
                     if name.endswith("_reference_position_m")]

    def _read(self):
        path = self.directory / "cycles.csv"
        try:
            with open(path, newline="", encoding="utf-8") as file:
                reader = csv.reader(file)
                self._header = next(reader)
                state = self._header.index("state")
                rows = [row for row in reader if row[state] == RUNNING]
        except (OSError, StopIteration, ValueError, IndexError) as error:
            raise RunError(f"{path}: cannot be read: {error}") from error
        if not rows:
            raise RunError(f"{path}: no cycle in which a program ran")
        return rows

    def has(self, name):
        return name in self._header and bool(np.isfinite(self.column(name)).any())

    def column(self, name):
        if name not in self._columns:
            if name not in self._header:
                raise RunError(f"{self.directory / 'cycles.csv'}: no column {name}")
            place = self._header.index(name)
            values = np.array([float(row[place]) if row[place] else np.nan for row in self._rows])
            self._columns[name] = values
        return self._columns[name]

    @property
    def name(self):
        """The program's name without folders and ending."""
        return Path(self.program).stem

    @property
    def is_circle(self):
        return self.metrics["contour"]["encoder"]["circular_deviation_um"] is not None

    def best_position(self):
        """Where the table was, by the truth or a linear scale, or else by the encoder; and which it is."""
        for ending in ("table_position_truth_m", "table_position_m"):
            if all(self.has(f"{axis}_{ending}") for axis in self.axes[:2]):
                return [self.column(f"{axis}_{ending}") for axis in self.axes[:2]], "table"
        return [self.column(f"{axis}_position_m") for axis in self.axes[:2]], "encoder"

    def circle(self):
        """The commanded circle: centre x, centre y, radius in m, from the reference."""
        x, y = [self.column(f"{axis}_reference_position_m") for axis in self.axes[:2]]
        # x^2 + y^2 = 2 cx x + 2 cy y + c, about the middle for the sake of rounding.
        mx, my = x.mean(), y.mean()
        u, v = x - mx, y - my
        matrix = np.column_stack([2 * u, 2 * v, np.ones_like(u)])
        cx, cy, c = np.linalg.lstsq(matrix, u * u + v * v, rcond=None)[0]
        return cx + mx, cy + my, float(np.sqrt(c + cx * cx + cy * cy))

    def turns(self):
        """Turns that the reference has completed, per cycle."""
        cx, cy, _ = self.circle()
        x, y = [self.column(f"{axis}_reference_position_m") for axis in self.axes[:2]]
        angle = np.unwrap(np.arctan2(y - cy, x - cx))
        return np.abs(angle - angle[0]) / (2 * np.pi)

    def scored(self):
        """Mask of the cycles that metrics.json scores."""
        time = self.column("path_time_s")
        moving = np.concatenate([[True], np.diff(time) > 0])
        return moving & ((self.turns() >= 1) if self.is_circle else (time >= 1))

    def radial(self):
        """Angle and radial error (m) about the commanded centre over the scored cycles, and where it was seen."""
        (x, y), where = self.best_position()
        cx, cy, radius = self.circle()
        mask = self.scored()
        u, v = x[mask] - cx, y[mask] - cy
        return np.arctan2(v, u), np.hypot(u, v) - radius, where


def by_program(runs):
    """Runs grouped by program, in the order in which they came."""
    groups = {}
    for run in runs:
        groups.setdefault(run.name, []).append(run)
    return groups


def pair(runs):
    """The run without compensation and the compensated one: `mpc`, and `full` or else the last of the others."""
    plain = next((run for run in runs if run.controller == "mpc"), None)
    others = [run for run in runs if run is not plain]
    full = next((run for run in others if run.controller == "full"), others[-1] if others else None)
    return plain, full
