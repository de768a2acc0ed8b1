#!/usr/bin/env python3
"""Pauses, feeds, M0 and program zero on a running contourd (emulated machine, lock-step), as an operator uses them.

    pause_through_daemon.py CONTOURD CONTOUR MACHINE_FILE

A program that was paused, slowed down and resumed ends where it would have, with the error that it would have had; a
program that was stopped half-way draws its figure in the same place when it is run again; and the log of all of it
replays bit for bit.
"""
import csv
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from free_port import free_port  # noqa: E402


class Operator:
    def __init__(self, contourd, contour, machine_file, scratch, settings=None):
        self.contour, self.scratch = contour, Path(scratch)
        self.socket = str(self.scratch / "control.sock")
        self.log, self.messages = self.scratch / "run.lcmlog", self.scratch / "daemon.txt"
        command = [contourd, "--config", machine_file, "--clock", "lockstep", "--socket", self.socket, "--log",
                   str(self.log), "--set", "telemetry.publish=false"]
        # The emulated machine serves its I/O on a port, whoever asks.
        settings = settings or ("io={}", f"emulator.io.port={free_port()}")
        command += [word for setting in settings for word in ("--set", setting)]
        with open(self.messages, "w", encoding="utf-8") as file:
            self.daemon = subprocess.Popen(command, stdout=file, stderr=file)
        self.wait("Idle", lambda s: s["state"] == "Idle")

    def call(self, *arguments):
        return subprocess.run([self.contour, *arguments, "--socket", self.socket], capture_output=True, text=True)

    def ask(self, *arguments):
        done = self.call(*arguments)
        assert done.returncode == 0, (arguments, done.stdout, done.stderr, self.messages.read_text(encoding="utf-8"))
        return done.stdout

    def status(self):
        answer = self.call("status", "--json")
        assert self.daemon.poll() is None, self.messages.read_text(encoding="utf-8")
        return json.loads(answer.stdout) if answer.returncode == 0 else {"state": "none"}

    def wait(self, what, reached):
        while True:
            status = self.status()
            if reached(status):
                return status
            assert status["state"] != "Faulted", (what, status["reason_text"])
            time.sleep(0.05)

    def start(self, program, *more):
        """In the background, until it moves."""
        run = subprocess.Popen([self.contour, "run", str(program), *more, "--socket", self.socket],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.wait("Running", lambda s: s["state"] == "Running" and s["program"]["time_s"] > 0.5)
        return run

    def table(self, directory):
        with open(directory / "cycles.csv", newline="", encoding="utf-8") as file:
            return [(float(r["x_reference_position_m"]), float(r["y_reference_position_m"]))
                    for r in csv.DictReader(file)]


def largest_error_um(directory):
    return json.loads((directory / "metrics.json").read_text(encoding="utf-8"))["contour"]["encoder"]["peak_um"]


def extent(points):
    return [f(p[axis] for p in points) for axis in (0, 1) for f in (min, max)]


def check_pause(operator, circle, short):
    plain = operator.scratch / "plain"
    said = operator.ask("run", str(short), "--out", str(plain))
    assert "contour error peak" in said and "0 faults, log " in said, said
    assert "program zero" in said, said
    paused = operator.scratch / "paused"
    run = operator.start(circle, "--out", str(paused))
    assert "paused" in operator.ask("pause")
    at = operator.status()
    assert at["state"] == "Running" and at["program"]["paused"] and at["program"]["pace"] == 0, at["program"]
    assert at["program"]["left_s"] is None, at["program"]
    refused = operator.call("run", str(circle))
    assert refused.returncode == 1 and "Running" in refused.stderr, refused.stderr
    assert operator.call("feed", "201").returncode == 1
    assert "runs at 100 percent of its feed, not at 120" in operator.ask("feed", "120"), "a circle is as fast as it is"
    slow = operator.call("feed", "1e-9")
    assert slow.returncode == 1 and "more than three years" in slow.stderr, slow.stderr
    assert operator.status()["program"]["feed_percent"] == 120, "what is refused changes nothing"
    operator.ask("feed", "40")
    operator.ask("pause")
    again = operator.status()
    assert again["program"]["time_s"] == at["program"]["time_s"], "it stands"
    assert ", paused" in operator.ask("status") and "feed 40 %" in operator.ask("status")
    operator.ask("resume")
    operator.wait("40 %", lambda s: s["state"] != "Running" or abs(s["program"]["pace"] - 0.4) < 1e-9)
    operator.ask("feed", "100")
    out, errors = run.communicate()
    assert run.returncode == 0, (out, errors)
    assert largest_error_um(paused) < 1.3 * largest_error_um(plain) + 0.1, (largest_error_um(paused),
                                                                          largest_error_um(plain))
    for one, other in zip(extent(operator.table(plain)), extent(operator.table(paused))):
        assert abs(one - other) < 1e-7, (one, other)
    refused = operator.call("pause")
    assert refused.returncode == 1 and "no program to pause" in refused.stderr, refused.stderr
    return plain


def check_zero(operator, circle, short, plain):
    run = operator.start(circle)
    operator.ask("stop")
    run.communicate()
    assert run.returncode == 1
    again = operator.scratch / "again"
    said = operator.ask("run", str(short), "--out", str(again))
    assert "from program zero and goes there first" in said, said
    for one, other in zip(extent(operator.table(plain)), extent(operator.table(again))):
        assert abs(one - other) < 1e-7, (one, other)
    assert largest_error_um(again) < 1.3 * largest_error_um(plain) + 0.1
    # G-code says itself where it goes, from wherever it starts.
    ngc = operator.scratch / "part.ngc"
    ngc.write_text("G21 G61\nG0 X2 Y1\nG1 X5 F3000\n", encoding="utf-8")
    first, second = operator.scratch / "first", operator.scratch / "second"
    operator.ask("run", str(ngc), "--out", str(first))
    operator.ask("run", str(ngc), "--out", str(second))
    begin, end = operator.table(first)[0], operator.table(first)[-1]
    assert abs(end[0] - begin[0] - 5e-3) < 1e-7 and abs(end[1] - begin[1] - 1e-3) < 1e-7, (begin, end)
    points = operator.table(second)
    assert abs(points[0][0] - end[0]) < 1e-7 and abs(points[-1][0] - end[0]) < 1e-7, (points[0], points[-1], end)
    assert abs(min(p[0] for p in points) - begin[0] - 2e-3) < 1e-7, "it went to X2 first"
    # From where the machine stands, on request; then zero set there.
    operator.ask("run", str(ngc), "--from-here", "--out", str(first))
    assert abs(operator.table(first)[-1][0] - end[0] - 5e-3) < 1e-7
    operator.ask("zero")
    zero_mm = operator.status()["zero_mm"]
    assert abs(zero_mm["x"] - 1e3 * operator.table(first)[-1][0]) < 1e-4, zero_mm


def check_faster(operator):
    """G-code goes as fast as it is told while it runs, and a feed stays for the programs to come."""
    ngc = operator.scratch / "faster.ngc"
    ngc.write_text("G21 F1200\nG0 X0 Y0\n" + "G1 X30\nG1 X0\n" * 6, encoding="utf-8")
    took = []
    for feed in ("100", "200"):
        operator.ask("feed", feed)
        took.append(float(operator.ask("run", str(ngc)).split("faster.ngc: ")[1].split(" s")[0]))
    assert took[1] < 0.6 * took[0], took
    ngc.write_text("G21 F1200\nG0 X0 Y0\n" + "G1 X30\nG1 X0\n" * 30, encoding="utf-8")
    run = operator.start(ngc)
    status = operator.wait("200 %", lambda s: s["state"] != "Running" or s["program"]["pace"] > 1.95)
    assert status["program"]["feed_percent"] == 200 and not status["program"]["feed_fixed"], status["program"]
    operator.ask("pause")
    operator.ask("feed", "130")
    operator.ask("resume")
    operator.wait("130 %", lambda s: s["state"] != "Running" or abs(s["program"]["pace"] - 1.3) < 0.01)
    operator.ask("feed", "200")
    out, errors = run.communicate()
    assert run.returncode == 0, (out, errors)
    operator.ask("feed", "150")
    said = operator.ask("run", str(operator.scratch / "circle.yaml"))
    assert "runs at 100 percent of its feed, not at 150" in said, said
    operator.ask("feed", "100")


def check_endless(operator, circle):
    """A feed that was set while nothing ran is asked when a program begins."""
    ngc = operator.scratch / "short.ngc"
    ngc.write_text("G21 F1200\nG0 X0 Y0\nG1 X3\nX0\n", encoding="utf-8")
    operator.ask("feed", "1e-9")
    for program in (ngc, circle):
        refused = operator.call("run", str(program))
        assert refused.returncode == 1 and "program would take more than three years" in refused.stderr, refused
        assert operator.status()["state"] == "Ready"
    operator.ask("feed", "100")
    operator.ask("run", str(ngc))
    refused = operator.call("run", "nowhere.ngc")
    assert refused.returncode == 2 and "nowhere.ngc: cannot be read" in refused.stderr, refused


def check_lines(operator):
    """Single block, and a line to begin with."""
    ngc = operator.scratch / "lines.ngc"
    ngc.write_text("G21 F3000\nG0 X0 Y0\nG1 X4\nG91 G1 Y3\nG90 X0 Y0\n", encoding="utf-8")
    run = subprocess.Popen([operator.contour, "run", str(ngc), "--single-block", "--socket", operator.socket],
                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    seen = []
    zero_mm = operator.status()["zero_mm"]
    while run.poll() is None:
        status = operator.wait("the end of a line", lambda s: s["state"] == "Ready" and s["reason"] == "program_end"
                               or s["program"]["paused"])
        if status["program"]["paused"]:
            seen.append(tuple(round(1e3 * a["reference_position_m"] - zero_mm[a["name"]], 4) for a in status["axes"]))
            operator.ask("resume")
        time.sleep(0.05)
    assert run.returncode == 0, run.communicate()
    assert (4.0, 0.0) in seen and (4.0, 3.0) in seen, seen
    # The words of the lines before hold: line 4 is incremental, in millimetres, and begins at X4 Y0.
    refused = operator.call("run", str(ngc), "--from-line", "4")
    assert refused.returncode == 2 and ":4: it begins at X4.0000 Y0.0000" in refused.stderr, refused.stderr
    out = operator.scratch / "from_line"
    operator.ask("run", str(ngc), "--from-line", "4", "--go-there", "--out", str(out))
    largest = [max(abs(1e3 * p[a] - zero_mm["xy"[a]]) for p in operator.table(out)) for a in (0, 1)]
    assert abs(largest[0] - 4.0) < 0.01 and abs(largest[1] - 3.0) < 0.02, largest  # less the tolerance at corners


def check_warnings(operator):
    """Words without an output are named, also where a program counts from the machine's zero; skipped lines are not."""
    zero_mm = operator.status()["zero_mm"]["x"]
    ngc = operator.scratch / "machine_zero.ngc"
    ngc.write_text(f"G21 F3000\nG53 G0 X{zero_mm:.4f}\nM3 S100\n/M8\nG1 X1\n", encoding="utf-8")
    for more, words in (([], "M3, S:"), (["--no-block-delete"], "M3, M8, S:")):
        run = subprocess.run([operator.contour, "run", str(ngc), *more, "--socket", operator.socket],
                             capture_output=True, text=True, check=False)
        assert run.returncode == 0 and f"machine_zero.ngc:3: no output listens to {words}" in run.stderr, run.stderr


def check_halts(operator):
    """M0 waits for the operator, M1 where that was asked for; a stop ends a program that waits."""
    ngc = operator.scratch / "halts.ngc"
    ngc.write_text("G21 F3000\nG0 X0 Y0\nM3 S100\nG1 X4\nM0\nY3\nM1\nX0 Y0\n", encoding="utf-8")

    def start(*more):
        return subprocess.Popen([operator.contour, "run", str(ngc), *more, "--socket", operator.socket],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def halted(line):
        return operator.wait(f"line {line}", lambda s: s["state"] == "Running" and s["program"]["halt"]
                             and s["program"]["halt"]["line"] == line)
    run = start("--optional-stop")
    status = halted(5)
    assert status["program"]["halt"]["word"] == "M0" and status["program"]["pace"] == 0, status["program"]
    said = operator.ask("status")
    assert "holding at line 5: M0" in said, said
    operator.ask("feed", "0")
    operator.ask("feed", "50")
    operator.ask("pause")
    assert halted(5)["program"]["time_s"] == status["program"]["time_s"], "only the operator lets it go on"
    assert "Running" in operator.ask("resume")
    assert halted(7)["program"]["halt"]["word"] == "M1"
    operator.ask("feed", "100")
    operator.ask("resume")
    out, errors = run.communicate()
    assert run.returncode == 0 and "no output listens to M3, S" in errors, (out, errors)
    # Without the switch M1 is passed; a stop at M0 is a stop.
    run = start()
    halted(5)
    operator.ask("stop")
    out, errors = run.communicate()
    assert run.returncode == 1 and "did not end by itself" in errors, (out, errors)
    assert operator.status()["program"]["halt"] is None
    refused = operator.call("resume")
    assert refused.returncode == 1, refused.stdout
    run = start()
    halted(5)
    operator.ask("resume")
    out, errors = run.communicate()
    assert run.returncode == 0 and "M1 does not wait without --optional-stop" in errors, (out, errors)


def main():
    with tempfile.TemporaryDirectory() as scratch:
        operator = Operator(*sys.argv[1:], scratch)
        circle = operator.scratch / "circle.yaml"
        # Long enough for a busy host to pause and stop it; short is the same figure, for where nobody has to be in time.
        circle.write_text("{shape: circle, radius_mm: 10, frequency_hz: 1, turns: 40}", encoding="utf-8")
        short = operator.scratch / "short.yaml"
        short.write_text("{shape: circle, radius_mm: 10, frequency_hz: 1, turns: 3}", encoding="utf-8")
        try:
            operator.ask("enable")
            plain = check_pause(operator, circle, short)
            check_zero(operator, circle, short, plain)
            circle.write_text("{shape: circle, radius_mm: 1, frequency_hz: 1, turns: 2}", encoding="utf-8")
            check_faster(operator)
            check_endless(operator, circle)
            check_lines(operator)
            check_warnings(operator)
            check_halts(operator)
        finally:
            operator.daemon.terminate()
            operator.daemon.wait()
        replay = subprocess.run([operator.contour, "replay", str(operator.log)], capture_output=True, text=True)
        print(replay.stdout)
        assert replay.returncode == 0, (replay.returncode, replay.stdout, replay.stderr)


if __name__ == "__main__":
    main()
