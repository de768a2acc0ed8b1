#!/usr/bin/env python3
"""Runs a program again and again on a running contourd (emulated machine, lock-step), as an operator would.

    learning_through_daemon.py CONTOURD CONTOUR MACHINE_FILE

From the second pass on the path is shifted by what the scales saw, after other gains it begins anew, and the log
of all of it replays bit for bit.
"""
import csv
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from free_port import free_port  # noqa: E402

LEARNT = "passes learnt from: "


def wait_until_up(contour, socket, daemon, messages):
    while True:
        answer = subprocess.run([contour, "status", "--socket", socket], capture_output=True, text=True)
        if answer.returncode == 0 and ": Idle" in answer.stdout:
            return
        assert daemon.poll() is None, messages.read_text(encoding="utf-8")
        time.sleep(0.1)


def references(directory):
    with open(directory / "cycles.csv", newline="", encoding="utf-8") as file:
        rows = {row["path_time_s"]: row for row in csv.DictReader(file)}
    return {time_s: (float(r["x_reference_position_m"]), float(r["y_reference_position_m"])) for time_s, r in rows.items()}


def largest_shift_um(one, other):
    return 1e6 * max(abs(a - b) for time_s in one for a, b in zip(one[time_s], other[time_s]))


def main():
    contourd, contour, machine_file = sys.argv[1:]
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        machine, program, log = scratch / "machine.yaml", scratch / "circle.yaml", scratch / "run.lcmlog"
        socket, messages = str(scratch / "control.sock"), scratch / "daemon.txt"
        machine.write_text(Path(machine_file).read_text(encoding="utf-8"), encoding="utf-8")
        program.write_text("{shape: circle, radius_mm: 0.1, frequency_hz: 2, turns: 3}", encoding="utf-8")
        command = [contourd, "--config", str(machine), "--clock", "lockstep", "--socket", socket, "--log", str(log)]
        for override in ["io={}", f"emulator.io.port={free_port()}", "telemetry.publish=false", "learning.enabled=true", "axes.y.drive.bus=second",
                         "buses.second={interface: loopback, bitrate_bit_s: 1000000}",
                         *(f"axes.{axis}.drive.linear_scale={{counts_per_mm: 10000}}" for axis in "xy")]:
            command += ["--set", override]
        with open(messages, "w", encoding="utf-8") as file:
            daemon = subprocess.Popen(command, stdout=file, stderr=file)
        try:
            wait_until_up(contour, socket, daemon, messages)

            def ask(*arguments):
                done = subprocess.run([contour, *arguments, "--socket", socket], capture_output=True, text=True)
                assert done.returncode == 0, (arguments, done.stdout, done.stderr, messages.read_text(encoding="utf-8"))

            def run(name, *more):
                ask("run", str(program), "--out", str(scratch / name), *more)
                return references(scratch / name)

            ask("enable")
            first, second, third = run("first"), run("second"), run("third")
            assert len(first) > 1000, len(first)
            for later in (second, third):
                shift_um = largest_shift_um(first, later)
                assert 0.005 < shift_um < 5, shift_um
            said = messages.read_text(encoding="utf-8")
            assert LEARNT + "1;" in said and LEARNT + "2;" in said, said

            assert largest_shift_um(first, run("forgotten", "--forget")) < 1e-6
            assert largest_shift_um(first, run("learnt_again")) > 0.005

            text = machine.read_text(encoding="utf-8").replace("full: {contour_bandwidth_Hz: 46", "full: {contour_bandwidth_Hz: 40")
            machine.write_text(text, encoding="utf-8")
            ask("reload")
            assert largest_shift_um(first, run("after_reload")) < 1e-6
        finally:
            daemon.terminate()
            daemon.wait()
        replay = subprocess.run([contour, "replay", str(log)], capture_output=True, text=True)
        print(replay.stdout)
        assert replay.returncode == 0, (replay.returncode, replay.stdout, replay.stderr)


if __name__ == "__main__":
    main()
