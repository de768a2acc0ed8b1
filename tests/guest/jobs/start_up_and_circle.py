#!/usr/bin/env python3
"""Daemon and emulated machine as two processes on vcan0: start-up as CANopen, enable, a circle, sane metrics, the torque frames of
virtual time, a clean end.

    start_up_and_circle.py PROGRAMS CONFIG CIRCLE
"""
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import canopen_trace  # noqa: E402
import lockstep_equality  # noqa: E402
import start_up_check  # noqa: E402
from machine_bench import MachineBench, expect, main  # noqa: E402

NODES = (1, 2)


def run_circle(bench, program):
    folder = bench.out / "run"
    bench.ask("run", program, "--out", folder, "--truth", bench.truth_path)
    metrics = json.loads((folder / "metrics.json").read_text(encoding="utf-8"))
    for where in ("encoder", "table"):
        contour = metrics["contour"][where]
        expect(contour["rms_um"] is not None and 0.0 < contour["rms_um"] <= contour["peak_um"] < 50.0,
               f"contour error at the {where} is no circle's: {contour}")
    expect(metrics["cycles"] > 1000, f"only {metrics['cycles']} cycles were scored")
    rows = (folder / "cycles.csv").read_text(encoding="utf-8").count("\n") - 1
    expect(rows >= metrics["cycles"], f"cycles.csv has {rows} rows for {metrics['cycles']} scored cycles")
    return metrics


def test(programs, out):
    config, program = sys.argv[2:4]
    with MachineBench(programs, config, out) as bench:
        virtual = lockstep_equality.virtual_torques(bench, config, program)
        bench.start_recording()
        bench.start_emulator()
        bench.start_daemon()
        bench.wait_for_state("Idle")
        idle = json.loads(bench.ask("status", "--json"))
        expect(not any(axis["drive_state"] == "Operation Enabled" for axis in idle["axes"]),
               "a drive was enabled before anybody asked")
        bench.enable()
        metrics = run_circle(bench, program)
        # Both end at rest some time after the program: the bus must get as far as virtual time did.
        bench.trace(max(virtual))
        bench.processes["contourd"].terminate()
        status = bench.wait_for_end("contourd")
        expect(status == 0, f"contourd ended with {status} after SIGTERM")
        frames = bench.trace()
    found = start_up_check.problems(frames, NODES)
    expect(not found, "the bus does not read as CANopen:\n  " + "\n  ".join(found))
    print(lockstep_equality.compare(frames, virtual))
    syncs = sum(1 for frame in frames if frame.id == canopen_trace.SYNC)
    print(f"{len(frames)} frames, {syncs} cycles; contour error at the table "
          f"{metrics['contour']['table']['rms_um']:.2f} um RMS, {metrics['contour']['table']['peak_um']:.2f} um peak")


main(test)
