#!/usr/bin/env python3
"""Spindle, coolant and lengths of tools of a program on a running contourd (emulated machine, lock-step), seen by another client of the Modbus server.

    outputs_through_daemon.py CONTOURD CONTOUR MACHINE_FILE

What a program switches on is on before it moves on, stays on while it waits, and is off after a stop, after its end and when the daemon ends.
"""
import socket
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from pause_through_daemon import Operator, free_port

FORWARD, FLOOD, SPEED = 21, 22, 5
OUTPUTS = (f"{{program: {{spindle_forward: {{coil: {FORWARD}, settle_s: 1}}, flood: {{coil: {FLOOD}}}, "
           f"spindle_speed: {{address: {SPEED}, largest_rpm: 6000}}, silence_s: 60}}}}")


class Modbus:
    """Reads coils and holding registers of a Modbus TCP server."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=60)

    def ask(self, function, address):
        self.socket.sendall(struct.pack(">HHHBBHH", 1, 0, 6, 1, function, address, 1))
        head = self.read(9)
        assert head[7] == function, head
        return int.from_bytes(self.read(head[8]), "big")

    def read(self, count):
        data = b""
        while len(data) < count:
            piece = self.socket.recv(count - len(data))
            assert piece, "the server is gone"
            data += piece
        return data

    def outputs(self):
        return (self.ask(1, FORWARD), self.ask(1, FLOOD), self.ask(3, SPEED))

    def wait(self, wanted):
        until = time.monotonic() + 60
        while self.outputs() != wanted:
            assert time.monotonic() < until, (self.outputs(), wanted)
            time.sleep(0.02)


def check(operator, modbus):
    ngc = operator.scratch / "spindle.ngc"
    ngc.write_text("G21 F3000\nG0 X0 Y0\nG1 X4\nS1500 M3 G1 X8\nM8\nM0\nG1 X4\nM9\nM0\nG1 X0\n", encoding="utf-8")
    modbus.wait((0, 0, 0))

    def start():
        return subprocess.Popen([operator.contour, "run", str(ngc), "--socket", operator.socket],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def halted(line):
        return operator.wait(f"line {line}", lambda s: (s["program"]["halt"] or {}).get("line") == line)
    run = start()
    status = halted(4)
    while status["program"]["halt"] and status["program"]["halt"]["line"] == 4:
        at_mm = 1e3 * status["axes"][0]["reference_position_m"] - status["zero_mm"]["x"]
        assert status["program"]["halt"]["word"] in ("S1500", "M3") and not status["program"]["halt"]["for_operator"]
        assert abs(at_mm - 4) < 1e-3, (at_mm, "before its time is over the spindle's block does not move")
        status = operator.status()
    halted(6)
    assert modbus.outputs() == (1, 1, 1500), modbus.outputs()
    operator.ask("pause")
    operator.ask("resume")
    halted(9)
    assert modbus.outputs() == (1, 0, 1500), modbus.outputs()
    operator.ask("resume")
    out, errors = run.communicate()
    assert run.returncode == 0 and "warning" not in errors, (out, errors)
    modbus.wait((0, 0, 0))
    # A stop takes all of it off.
    run = start()
    halted(6)
    assert modbus.outputs() == (1, 1, 1500), modbus.outputs()
    operator.ask("stop")
    run.communicate()
    modbus.wait((0, 0, 0))
    # What the spindle cannot do is refused by line, before anything moves.
    ngc.write_text("G21 F3000\nG1 X1\nS9000\nG1 X0\n", encoding="utf-8")
    refused = operator.call("run", str(ngc))
    assert refused.returncode != 0 and "spindle.ngc:3: S9000 is beyond" in refused.stderr, refused.stderr
    # Tools have their lengths, read anew for each program.
    for length_mm in (3, 7):
        (operator.scratch / "tools.tbl").write_text(f"T2 X{length_mm} ;a table without Z\n", encoding="utf-8")
        ngc.write_text("G21 F3000\nG0 X0 Y0\nG43 H2\nG1 X1\n", encoding="utf-8")
        operator.ask("run", str(ngc))
        status = operator.status()
        at_mm = 1e3 * status["axes"][0]["reference_position_m"] - status["zero_mm"]["x"]
        assert abs(at_mm - 1 - length_mm) < 1e-3, (at_mm, length_mm)
    ngc.write_text("G0 X0\nG43 H3\n", encoding="utf-8")
    refused = operator.call("run", str(ngc))
    assert refused.returncode == 2 and "spindle.ngc:2:5: G43 of tool 3: it is not in" in refused.stderr, refused.stderr
    # The daemon ends while a program has it on.
    ngc.write_text("G21 F3000\nM3 S100\nG1 X1\nM0\nG1 X0\n", encoding="utf-8")
    run = start()
    halted(4)
    assert modbus.outputs() == (1, 0, 100), modbus.outputs()


def main():
    port = free_port()
    settings = (f"io.modbus.port={port}", f"emulator.io.port={port}", "io.modbus.timeout_ms=5000",
                "io.modbus.accept_blind_travel=true", f"io.modbus.outputs={OUTPUTS}")
    with tempfile.TemporaryDirectory() as scratch:
        (Path(scratch) / "tools.tbl").write_text("", encoding="utf-8")
        settings += (f"machine.tool_table={scratch}/tools.tbl",)
        operator = Operator(*sys.argv[1:], scratch, settings)
        try:
            modbus = Modbus(port)
            operator.ask("enable")
            check(operator, modbus)
        finally:
            operator.daemon.terminate()
            operator.daemon.wait()
        replay = subprocess.run([operator.contour, "replay", str(operator.log)], capture_output=True, text=True)
        assert replay.returncode == 0, (replay.returncode, replay.stdout, replay.stderr)


if __name__ == "__main__":
    main()
