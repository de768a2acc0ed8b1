"""What `contour diagnose --out` wrote for the report: report_data.json and report_traces.bin."""
import json
from pathlib import Path

import numpy as np


class DataError(Exception):
    """A directory without the data of a diagnosis."""


class Finding:
    def __init__(self, directory):
        self.directory = Path(directory)
        try:
            self.data = json.loads((self.directory / "report_data.json").read_text(encoding="utf-8"))
            values = np.fromfile(self.directory / "report_traces.bin")
        except (OSError, ValueError) as error:
            raise DataError(f"{directory}: {error}") from error
        self.traces = {}
        at = 0
        for name, length in self.data["traces"]:
            self.traces[name] = values[at:at + length]
            at += length
        if at != len(values):
            raise DataError(f"{directory}: report_traces.bin has {len(values)} values, expected {at}")
        self.linear = self.data["linear"]
        self.unit = "N" if self.linear else "Nm"

    def has(self, name):
        return len(self.traces.get(name, ())) > 1

    def __getitem__(self, name):
        return self.traces[name]

    @property
    def effort(self):
        return "force" if self.linear else "torque"

    @property
    def period_s(self):
        return float(np.median(np.diff(self["time_s"])))

    @property
    def position_mm(self):
        return 1e3 * self.data["table_per_q"] * self["position"]

    @property
    def motion(self):
        """Label and values of position, velocity and acceleration: of the table, or of the axis where it only turns."""
        if not self.linear and self.data["lead_m"] == 0:
            return [("position (rad)", self["position"]), ("velocity (rad/s)", self["velocity"]),
                    ("acceleration (rad/s²)", self["acceleration"])]
        per_q = self.data["table_per_q"]
        return [("position (mm)", self.position_mm), ("velocity (mm/s)", 1e3 * per_q * self["velocity"]),
                ("acceleration (m/s²)", per_q * self["acceleration"])]

    @property
    def turns(self):
        """Motor turns, or None where no lead is known."""
        if not self.linear:
            return self["position"] * self.data["gear_ratio"] / (2 * np.pi)
        return self["position"] / self.data["lead_m"] if self.data["lead_m"] > 0 else None

    def moving(self):
        """Direction where the axis clearly moves: 1, -1, or 0."""
        v = self["velocity"]
        slow = 0.005 * np.nanmax(np.abs(v)) if len(v) else 0.0
        return np.where(v > slow, 1, np.where(v < -slow, -1, 0))
