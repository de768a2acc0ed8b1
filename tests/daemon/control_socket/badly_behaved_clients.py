#!/usr/bin/env python3
"""Clients that flood, fall silent or send nonsense, and an operator who wants to stop the machine beside them.

    badly_behaved_clients.py CONTOURD CONTOUR MACHINE_FILE [flood] [nonsense] [silence]

The operator's stop is answered while the others stand there, and the daemon's memory stays bounded. Times are printed, not judged.
"""
import json
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from free_port import free_port  # noqa: E402

FLOODED_MB = 64  # what the daemon may take more: rows, programs and lines of all clients together


class Client:
    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.connect(path)
        self.lines = self.socket.makefile("r", encoding="utf-8")

    def ask(self, line):
        self.socket.sendall(line.encode() + b"\n")
        answer = self.lines.readline()
        assert answer, "the daemon hung up"
        return json.loads(answer)

    def request(self, kind):
        return self.ask(json.dumps({"request": kind}))


def resident_MB(pid):
    for line in Path(f"/proc/{pid}/status").read_text(encoding="utf-8").splitlines():
        if line.startswith("VmRSS"):
            return int(line.split()[1]) / 1024
    raise AssertionError("no VmRSS")


def timed(what, ask):
    begin = time.monotonic()
    answer = ask()
    print(f"{what}: {time.monotonic() - begin:.3f} s", flush=True)
    return answer


def flood(path, pid):
    """A client that asks and asks and never reads."""
    before = resident_MB(pid)
    deaf = socket.socket(socket.AF_UNIX)
    deaf.connect(path)
    sent = [0]

    def send():
        try:
            while True:
                sent[0] += deaf.send(b'{"request": "status"}\n' * 1000)
        except OSError:
            pass

    thread = threading.Thread(target=send)
    thread.start()
    for _ in range(40):
        time.sleep(0.05)  # so that there is a flood; nothing depends on how large
    answer = timed("stop beside a client that floods and never reads", lambda: Client(path).request("stop"))
    grown = resident_MB(pid) - before
    print(f"sent {sent[0] / 1e6:.1f} MB of requests, the daemon grew by {grown:.0f} MB")
    deaf.shutdown(socket.SHUT_RDWR)
    thread.join()
    assert answer["ok"], answer
    assert grown < FLOODED_MB, grown


def nonsense(path):
    """A line of brackets, 8 MB of them: refused, and nobody waits for it."""
    bad = socket.socket(socket.AF_UNIX)
    bad.connect(path)

    def send():
        try:
            bad.sendall(b"[" * (8 << 20) + b"\n")
        except OSError:
            pass

    thread = threading.Thread(target=send)
    thread.start()
    time.sleep(0.2)
    answer = timed("stop beside a line of 8 MB", lambda: Client(path).request("stop"))
    assert answer["ok"], answer
    refused = timed("refusing that line", lambda: json.loads(bad.makefile("r").readline()))
    assert not refused["ok"], refused
    bad.shutdown(socket.SHUT_RDWR)
    thread.join()


def silence(path):
    """Clients that take all places and say nothing, and more of them."""
    idle = [Client(path) for _ in range(40)]
    answer = timed("stop beside 40 idle clients", lambda: Client(path).request("stop"))
    assert answer["ok"], answer
    assert Client(path).request("disable")["ok"]
    assert not Client(path).request("enable")["ok"], "there is no place for that"
    assert idle[0].request("status")["ok"], "who came first keeps the place"


def main():
    contourd, contour, machine_file, *chosen = sys.argv[1:]
    cases = {"flood": lambda: flood(path, daemon.pid), "nonsense": lambda: nonsense(path), "silence": lambda: silence(path)}
    with tempfile.TemporaryDirectory() as scratch:
        path, port = str(Path(scratch, "control.sock")), free_port()
        with open(Path(scratch, "messages.txt"), "w", encoding="utf-8") as messages:
            command = [contourd, "--config", machine_file, "--clock", "lockstep", "--socket", path]
            for override in ["telemetry.publish=false", "telemetry.flight_recorder_s=0", f"io.modbus.port={port}",
                             f"emulator.io.port={port}"]:
                command += ["--set", override]
            daemon = subprocess.Popen(command, stdout=messages, stderr=messages)
        try:
            while subprocess.run([contour, "status", "--socket", path], capture_output=True, check=False).returncode != 0:
                assert daemon.poll() is None, Path(scratch, "messages.txt").read_text(encoding="utf-8")
                time.sleep(0.05)
            failed = []
            for case in chosen or cases:
                try:
                    cases[case]()
                except AssertionError as e:
                    failed.append(f"{e}")
            daemon.send_signal(signal.SIGTERM)
            assert daemon.wait() == 0, daemon.returncode
            assert not failed, failed
        finally:
            daemon.kill()
            daemon.wait()


if __name__ == "__main__":
    main()
