#!/usr/bin/env python3
"""An operator's controls while the log goes into a pipe that nobody reads, and what is said to stderr into another.

    with_a_blocked_log.py CONTOURD CONTOUR MACHINE_FILE CLOCK

Enable, run, stop, disable, status and SIGTERM must work as if nothing were the matter, and what could not be written is counted.
No time is measured: each step ends, or the test is ended. By the wall clock a busy host may hold the cycle up until the machine
stops for that, as it must: then it is begun anew, and in the end skipped (77); in lock-step nothing of the kind can happen.
"""
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from free_port import free_port  # noqa: E402

TRIES = 10
# What a busy host looks like; that none of it comes of the blocked log is seen in lock-step, where nothing is begun anew.
BUSY_HOST = ("grid_points_skipped", "path_underrun", "io_stale", "stale_feedback", "enable_timeout")
PROGRAM = "{shape: circle, radius_mm: 20, feed_mm_min: 600, turns: 50}"


class HeldUp(Exception):
    """The host took the processor for too long, and the machine stopped for it."""


def full_pipe():
    """A pipe that takes not one byte more, and that nobody reads."""
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    try:
        while True:
            os.write(writer, b"." * 4096)
    except BlockingIOError:
        pass
    os.set_blocking(writer, True)
    return reader, writer


class Machine:
    def __init__(self, contourd, contour, machine_file, clock, scratch, stderr):
        self.contour, self.clock, self.socket = contour, clock, str(scratch / "control.sock")
        fifo = scratch / "log.fifo"
        os.mkfifo(fifo)
        self.reader = os.open(fifo, os.O_RDONLY | os.O_NONBLOCK)  # is there, and never reads
        port = free_port()
        command = [contourd, "--config", machine_file, "--clock", clock, "--socket", self.socket, "--log", str(fifo)]
        for override in ["telemetry.publish=false", "realtime.required=false", "telemetry.flight_recorder_s=0",
                         f"io.modbus.port={port}", f"emulator.io.port={port}"]:
            command += ["--set", override]
        if clock != "wall":
            # Modbus goes by the clock in lock-step, too: the longest time-out that there is.
            command += ["--set", "io.modbus.timeout_ms=5000", "--set", "io.modbus.accept_blind_travel=true"]
        self.process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=stderr)

    def ask(self, *words, expected=0):
        done = subprocess.run([self.contour, *words, "--socket", self.socket], capture_output=True, text=True, check=False)
        if done.returncode != expected:
            self.look_for_a_busy_host()
            if self.clock == "wall" and "no fresh data from the Modbus I/O" in done.stderr:
                raise HeldUp
        assert done.returncode == expected, (words, done.returncode, done.stdout, done.stderr)
        return done.stdout

    def look_for_a_busy_host(self):
        """Only the cycle's own word counts, and only by the wall clock."""
        asked = subprocess.run([self.contour, "status", "--json", "--socket", self.socket], capture_output=True, text=True, check=False)
        if asked.returncode == 0 and self.clock == "wall" and json.loads(asked.stdout)["reason"] in BUSY_HOST:
            raise HeldUp

    def status(self):
        return json.loads(self.ask("status", "--json"))

    def wait_for(self, state):
        while True:
            assert self.process.poll() is None, f"contourd ended with {self.process.returncode}"
            done = subprocess.run([self.contour, "status", "--json", "--socket", self.socket], capture_output=True, text=True, check=False)
            if done.returncode == 0:
                status = json.loads(done.stdout)
                if status["state"] == state:
                    return status
                if status["state"] == "Faulted" or status["reason"] == "path_underrun":
                    self.look_for_a_busy_host()
                assert status["state"] != "Faulted", status["reason_text"]
            time.sleep(0.05)


def operate(machine, program):
    machine.wait_for("Idle")
    machine.ask("enable")
    machine.wait_for("Ready")
    run = subprocess.Popen([machine.contour, "run", str(program), "--socket", machine.socket], stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL)
    machine.wait_for("Running")
    before = machine.status()["cycle"]
    while machine.status()["cycle"] == before:  # the status goes with the cycle, not with what is written
        pass
    # A stop is obeyed while everything behind the cycle is blocked, and the machine then holds.
    machine.ask("stop")
    stopped = machine.wait_for("Ready")
    assert stopped["reason"] == "operator_stop", stopped["reason"]
    assert run.wait() == 1, run.returncode
    machine.ask("enable")
    machine.ask("disable")
    log = machine.wait_for("Idle")["log"]
    assert log["waiting_cycles"] + log["lost_cycles"] > 0, f"the pipe was to be blocked: {log}"
    return log


def one_case(contourd, contour, machine_file, clock, folder, blocked_stderr):
    program, messages = folder / "circle.yaml", folder / "messages.txt"
    program.write_text(PROGRAM, encoding="utf-8")
    pipe = full_pipe()
    with open(messages, "w", encoding="utf-8") as file:
        machine = Machine(contourd, contour, machine_file, clock, folder, pipe[1] if blocked_stderr else file)
    try:
        log = operate(machine, program)
        machine.process.send_signal(signal.SIGTERM)
        assert machine.process.wait() == 0, machine.process.returncode
    finally:
        machine.process.kill()
        machine.process.wait()
        for end in (*pipe, machine.reader):
            os.close(end)
    said = messages.read_text(encoding="utf-8")
    print(f"{clock}, stderr {'blocked' if blocked_stderr else 'free'}: {log}")
    assert blocked_stderr or "notes are not in the log" in said, said


def main():
    *machine, clock = sys.argv[1:]
    with tempfile.TemporaryDirectory() as scratch:
        for blocked_stderr in (False, True):
            for attempt in range(TRIES):
                folder = Path(scratch, f"{blocked_stderr}{attempt}")
                folder.mkdir()
                try:
                    one_case(*machine, clock, folder, blocked_stderr)
                    break
                except HeldUp:
                    print(f"the host held the cycle up: begun anew ({attempt + 1} of {TRIES})", flush=True)
            else:
                print("skipped: this host is too busy for a machine by the wall clock")
                sys.exit(77)


if __name__ == "__main__":
    main()
