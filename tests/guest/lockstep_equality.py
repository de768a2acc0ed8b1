"""The same program sends the same torque frames on vcan0, in lock-step, as in virtual time: cycle by cycle, bit by bit."""
import csv
from pathlib import Path

import canopen_trace
import yaml
from machine_bench import expect

AXES = {"x": 1, "y": 2}
TARGET_TORQUE = 0x6071


def torques_on_the_bus(frames):
    """{number of the SYNC with which it acts: {node: target torque in per mille}}"""
    transfers = canopen_trace.sdo_transfers(frames)
    fields = {node: canopen_trace.pdo_layout(transfers, node, 0x1600)[TARGET_TORQUE] for node in AXES.values()}
    found, syncs, current = {}, 0, {}
    for frame in frames:
        node = frame.id - 0x200
        if node in fields:
            current[node] = fields[node].of(frame.data)
        elif frame.id == canopen_trace.SYNC:
            syncs += 1
            found[syncs] = current
            current = {}
    return found


def torques_in_virtual_time(path, rated_torque_Nm):
    """The same from cycles.csv, where torque is what was sent."""
    found = {}
    with open(path, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            if row["sync_number"] != "0":
                found[int(row["sync_number"])] = {
                    node: round(float(row[f"{axis}_torque_Nm"]) / rated_torque_Nm * 1000) for axis, node in AXES.items()}
    return found


def rated_torque_Nm(config):
    axes = yaml.safe_load(Path(config).read_text(encoding="utf-8"))["axes"]
    values = {axis["drive"]["rated_torque_Nm"] for axis in axes.values()}
    expect(len(values) == 1, f"the axes have different rated torques: {values}")
    return values.pop()


def first_difference(real, virtual):
    for sync in sorted(virtual):
        if real.get(sync) != virtual[sync]:
            return sync
    return None


def virtual_torques(bench, config, program):
    """What `contour simulate` sends, by the number of the SYNC."""
    bench.contour("simulate", "--config", config, "--program", program, "--out", bench.work / "virtual")
    virtual = torques_in_virtual_time(bench.work / "virtual" / "cycles.csv", rated_torque_Nm(config))
    expect(len(virtual) > 1000, f"virtual time has {len(virtual)} cycles only")
    loud = sum(1 for torques in virtual.values() if any(torques.values()))
    expect(loud > 1000, f"only {loud} cycles have any torque at all")
    return virtual


def compare(frames, virtual):
    """A sentence on frames that are the same."""
    real = torques_on_the_bus(frames)
    different = first_difference(real, virtual)
    if different is not None:
        around = range(different - 2, different + 3)
        raise AssertionError(
            f"torque frames differ first at SYNC {different}, of {max(virtual)}:\n"
            + "\n".join(f"  SYNC {sync}: bus {real.get(sync)}, virtual time {virtual.get(sync)}" for sync in around))
    return f"{len(virtual)} cycles: every torque frame on vcan0 equals the one of virtual time"
