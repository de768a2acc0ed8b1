#!/usr/bin/env python3
"""The memory of a running contourd (emulated machine, lock-step) grows neither with the length of its program nor with its lines.

    memory_through_daemon.py CONTOURD CONTOUR MACHINE_FILE

A subroutine of 400 chords, run a thousand times, and an arc of hundreds of turns. Resident memory is read from when the flight record and
everything else that has a window is full to the end. Then spirals of few and of many lines, each at the same time of its motion. Threads hand
blocks to each other, so readings come and go by some megabytes: medians are compared.
"""
import json
import math
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from free_port import free_port  # noqa: E402

FULL_S = 300        # of the program: all windows are full
ROUNDS = 1000       # 1257 s
TURNS = 900         # 1131 s
MAY_GROW_KB = 2048  # what a heap that is cut up by many threads still moves
FEW, MANY = 100_000, 800_000  # lines
AT_S = 20           # of the program: it is read, its text is given up
UNTIL_S = 40


def programs():
    chords = "".join(f"G1 X{10 * math.cos(0.005 * math.pi * k) - 10:.4f} Y{10 * math.sin(0.005 * math.pi * k):.4f}\n" for k in range(1, 401))
    yield "chords", f"F3000\nO1 repeat [{ROUNDS}]\n{chords}O1 endrepeat\nM2\n"
    yield "turns", f"F3000\nG3 I-10 P{TURNS}\nM2\n"


def resident_kb(pid):
    for line in Path(f"/proc/{pid}/status").read_text(encoding="ascii").splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1])
    raise AssertionError("no VmRSS")


def spiral(lines):
    text, angle = ["G21 G90 F3000\n"], 0.0
    for _ in range(lines):
        radius = 1 + 0.2 * angle / (2 * math.pi)
        angle += 0.025 / radius
        text.append(f"G1 X{radius * math.cos(angle) - 1:.4f} Y{radius * math.sin(angle):.4f}\n")
    return "".join(text) + "M2\n"


def grown_kb(contourd, contour, machine_file, scratch, text, at_s=None):
    """From the first to the last third of the program after FULL_S; or, with `at_s`, the resident memory from then to UNTIL_S."""
    socket = str(scratch / "control.sock")
    with open(scratch / "daemon.txt", "w", encoding="utf-8") as messages:
        daemon = subprocess.Popen([contourd, "--config", machine_file, "--clock", "lockstep", "--socket", socket, "--set", "io={}",
                                   "--set", f"emulator.io.port={free_port()}", "--set", "telemetry.publish=false"],
                                  stdout=messages, stderr=messages)

    def status():
        answer = subprocess.run([contour, "status", "--json", "--socket", socket], capture_output=True, text=True)
        assert daemon.poll() is None, (scratch / "daemon.txt").read_text(encoding="utf-8")
        return json.loads(answer.stdout) if answer.returncode == 0 else {"state": "none"}

    def wait(reached):
        while True:
            now = status()
            if reached(now):
                return now
            assert now["state"] != "Faulted", now["reason_text"]
            time.sleep(0.1)

    try:
        wait(lambda s: s["state"] == "Idle")
        subprocess.run([contour, "enable", "--socket", socket], check=True, capture_output=True)
        (scratch / "program.ngc").write_text(text, encoding="ascii")
        run = subprocess.Popen([contour, "run", str(scratch / "program.ngc"), "--socket", socket], stdout=subprocess.DEVNULL)
        if at_s is not None:
            readings = []
            wait(lambda s: s["state"] == "Running" and s["program"]["time_s"] > at_s)
            wait(lambda s: readings.append(resident_kb(daemon.pid)) or s["program"]["time_s"] > UNTIL_S)
            subprocess.run([contour, "stop", "--socket", socket], check=True, capture_output=True)
            run.wait()
            return statistics.median(readings)
        full = wait(lambda s: s["state"] == "Running" and s["program"]["time_s"] > FULL_S)
        assert full["program"]["left_s"] > FULL_S, "it is longer than what fills the windows"
        readings = []
        while run.poll() is None:
            readings.append(resident_kb(daemon.pid))
            time.sleep(0.1)
        assert run.returncode == 0
        third = len(readings) // 3
        return statistics.median(readings[-third:]) - statistics.median(readings[:third])
    finally:
        daemon.terminate()
        daemon.wait()


def main():
    contourd, contour, machine_file = sys.argv[1:]
    worst = 0
    for name, text in programs():
        with tempfile.TemporaryDirectory() as folder:
            grown = grown_kb(contourd, contour, machine_file, Path(folder), text)
        print(f"{name}: {grown} kB more in the last third of the program than in the first, after {FULL_S} s")
        worst = max(worst, grown)
    resident = {}
    for lines in (FEW, MANY):
        with tempfile.TemporaryDirectory() as folder:
            resident[lines] = grown_kb(contourd, contour, machine_file, Path(folder), spiral(lines), AT_S)
        print(f"{lines} lines: {resident[lines]} kB {AT_S} to {UNTIL_S} s after the begin")
    worst = max(worst, resident[MANY] - resident[FEW])
    return 0 if worst <= MAY_GROW_KB else 1


if __name__ == "__main__":
    sys.exit(main())
