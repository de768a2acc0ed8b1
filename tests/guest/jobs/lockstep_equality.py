#!/usr/bin/env python3
"""The same program sends the same torque frames on vcan0, in lock-step, as in virtual time: cycle by cycle, bit by bit.

    lockstep_equality.py PROGRAMS CONFIG PROGRAM
"""
import csv
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import canopen_trace  # noqa: E402
from machine_bench import MachineBench, expect, main  # noqa: E402

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
    import yaml
    axes = yaml.safe_load(Path(config).read_text(encoding="utf-8"))["axes"]
    values = {axis["drive"]["rated_torque_Nm"] for axis in axes.values()}
    expect(len(values) == 1, f"the axes have different rated torques: {values}")
    return values.pop()


def first_difference(real, virtual):
    for sync in sorted(virtual):
        if real.get(sync) != virtual[sync]:
            return sync
    return None


def test(programs, out):
    config, program = sys.argv[2:4]
    with MachineBench(programs, config, out) as bench:
        bench.contour("simulate", "--config", config, "--program", program, "--out", bench.work / "virtual")
        virtual = torques_in_virtual_time(bench.work / "virtual" / "cycles.csv", rated_torque_Nm(config))
        bench.start_recording()
        bench.start_emulator()
        bench.start_daemon()
        bench.wait_for_state("Idle")
        bench.enable()
        bench.ask("run", program)
        # Both end at rest some time after the program: the bus must get as far as virtual time did.
        real = torques_on_the_bus(bench.trace(max(virtual)))
    expect(len(virtual) > 1000, f"virtual time has {len(virtual)} cycles only")
    loud = sum(1 for sync in virtual if any(virtual[sync].values()))
    expect(loud > 1000, f"only {loud} cycles have any torque at all")
    different = first_difference(real, virtual)
    if different is not None:
        around = range(different - 2, different + 3)
        raise AssertionError(
            f"torque frames differ first at SYNC {different}, of {max(virtual)}:\n"
            + "\n".join(f"  SYNC {sync}: bus {real.get(sync)}, virtual time {virtual.get(sync)}" for sync in around))
    print(f"{len(virtual)} cycles, {loud} with torque: every torque frame on vcan0 equals the one of virtual time")


main(test)
