#!/usr/bin/env python3
"""A second contourd on the bus of a moving machine: refused on the same computer, and where it comes from another one
(a network namespace of its own would not share the interface, so a process sends in its place) both see each other.

    second_master.py PROGRAMS CONFIG PROGRAM WAY

WAY: same_computer | starts_first | comes_later | service_tool
"""
import socket
import struct
import sys
import threading
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from machine_bench import MachineBench, expect, main  # noqa: E402

AXES = ("x", "y")
WELL_IN_MOTION_m_s = 0.03
SYNC, HEARTBEAT, SDO_REQUEST = 0x080, 0x77F, 0x601


def speed(row):
    return max(abs(row[f"{axis}_table_velocity_m_s"]) for axis in AXES)


class OtherMaster:
    """Sends one frame over and over."""

    def __init__(self, bus, can_id, data, period_s):
        self._socket = socket.socket(socket.PF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        self._socket.bind((bus,))
        self._frame = struct.pack("=IB3x8s", can_id, len(data), bytes(data))
        self._period_s = period_s
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._send, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._end.set()
        self._thread.join()
        self._socket.close()

    def _send(self):
        while not self._end.wait(self._period_s):
            self._socket.send(self._frame)


def start_moving(bench, program):
    bench.start_emulator()
    bench.start_daemon()
    bench.wait_for_state("Idle")
    bench.enable()
    bench.start("run", bench.programs / "contour", "run", program, "--socket", bench.socket)
    bench.wait_for("the axes to move", lambda: speed(bench.last_truth()) > WELL_IN_MOTION_m_s)


def same_computer(bench, program):
    start_moving(bench, program)
    first = bench.processes["contourd"].pid
    second = bench.start("second", bench.programs / "contourd", "--config", bench.config, "--bus", bench.bus, "--clock",
                         bench.clock, "--socket", bench.work / "second.sock")
    status = bench.wait_for_end("second")
    text = (bench.work / "second.log").read_text()
    print(f"the second contourd ended with {status}: {text.strip().splitlines()[-1] if text else ''}")
    state = bench.status()
    print(f"the first is {state['state']} ({state['reason']})")
    expect(status == 3, f"the second contourd ended with {status}, not with 3")
    expect(f"process {first}" in text, f"its message does not name the first, {first}: {text}")
    expect(second.pid != first and state["state"] == "Running", f"the first is {state['state']}: {state['reason_text']}")


def starts_first(bench, _program):
    bench.start_recording()
    bench.start_emulator()
    with OtherMaster(bench.bus, HEARTBEAT, [5], 0.5):
        bench.start_daemon()
        status = bench.wait_for_end("contourd", 60)
    text = (bench.work / "contourd.log").read_text()
    expect(status == 1, f"contourd ended with {status}, not with 1: {text}")
    expect("second_master" in text and "bus main" in text and "heartbeat" in text, f"it does not say why: {text}")
    time.sleep(0.2)
    ids = {line.split()[2].split("#")[0] for line in (bench.work / "candump.log").read_text().splitlines()}
    # The drives were there before, and beat; the heartbeat under the master's number is the other one's.
    expect(ids <= {"77F", "701", "702"}, f"frames beside the other master's were on the bus: {ids}")


def comes_later(bench, program):
    start_moving(bench, program)
    with OtherMaster(bench.bus, SYNC, [], 0.01):
        state = bench.wait_for_state("Faulted")
        expect(state["reason"] == "second_master", f"the reason is {state['reason']}: {state['reason_text']}")
        expect("SYNC" in state["reason_text"] and "bus main" in state["reason_text"], state["reason_text"])
        bench.wait_for("the axes to rest", lambda: speed(bench.last_truth()) < 1e-4)
        expect(not bench.try_ask("reset"), "the reset was carried out beside the other master")
        state = bench.wait_for_state("Faulted")
        expect(state["reason"] == "second_master", f"after the reset the reason is {state['reason']}")
    bench.ask("reset")
    bench.wait_for_state("Idle")
    bench.enable()


def service_tool(bench, program):
    start_moving(bench, program)
    read_position = [0x40, 0x64, 0x60, 0, 0, 0, 0, 0]
    with OtherMaster(bench.bus, SDO_REQUEST, read_position, 0.02):
        state = bench.wait_for("the requests to be counted",
                               lambda: (s := bench.status())["buses"][0]["foreign_sdo_requests"] > 5 and s)
    expect(state["state"] == "Running", f"the machine is {state['state']}: {state['reason_text']}")
    bench.wait_for_log("foreign_sdo")


def test(programs, out):
    config, program, way = sys.argv[2:5]
    with MachineBench(programs, config, out) as bench:
        globals()[way](bench, program)
    print(f"{way}: as it should be")


main(test)
