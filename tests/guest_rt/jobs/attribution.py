"""contourd disturbed from outside, in a guest where nothing else disturbs it: `contour status --json` names what was brought in and
nothing else; without it no cycle is late.

    attribution.py MACHINE VCAN_MACHINE

What can be brought in on any computer is late_from_outside.py's. Two more need this guest: memory behind a lock that somebody holds
(elsewhere how long that takes is the host's affair), and a bus on which sending takes long.
"""
import contextlib
import socket
import subprocess
import sys
import time
from pathlib import Path

import late_from_outside as outside

PROGRAMS = ("/usr/bin/contourd", "/usr/bin/contour")
# A client that begins or ends on the only processor (contour status) costs up to 145 us; it is no disturbance that is looked for.
CALM = ["realtime.send_deadline_us=350"]
SYNC = 0x80
LISTENERS = 300


def write_protected(daemon):
    """All its memory, as a tool that makes checkpoints does it: the next write faults, and waits until the tool is through."""
    for _ in range(outside.TIMES):
        Path(f"/proc/{daemon.process.pid}/clear_refs").write_text("4", encoding="utf-8")
        time.sleep(0.03)


@contextlib.contextmanager
def bus(machine, listeners):
    """The emulated machine on vcan0, whose drives answer whatever else the computer does; and so many who listen to SYNC alone. Each
    of them is handed a copy, one after the other, while contourd sends it."""
    only_sync = SYNC.to_bytes(4, "little") + (0x7FF).to_bytes(4, "little")
    opened = contextlib.ExitStack()
    for _ in range(listeners):
        listener = opened.enter_context(socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW))
        listener.setsockopt(socket.SOL_CAN_RAW, socket.CAN_RAW_FILTER, only_sync)
        listener.bind(("vcan0",))
    with open("/tmp/emulator.log", "w", encoding="utf-8") as log:
        process = subprocess.Popen([PROGRAMS[1], "emulate", "--config", machine, "--bus", "vcan0", "--clock", "wall"], stdout=log, stderr=log)
    try:
        while "ready" not in Path("/tmp/emulator.log").read_text(encoding="utf-8"):
            time.sleep(0.1)
        subprocess.run(["chrt", "-f", "-p", "70", str(process.pid)], check=True)
        with opened:
            yield
    finally:
        process.kill()
        process.wait()


ON_VCAN = ["io.modbus.port=1502"]  # where the machine file says that the emulated machine is
# What is brought in, what is around, with which settings; the only cause that must come of it.
CASES = {
    "nothing": (outside.nothing, None, [], None),
    "stopped process": (outside.stop, None, [], "stopped"),
    "stopped thread": (outside.debugger, None, [], "stopped"),
    "preemption": (outside.preemption, None, [], "preempted"),
    "page fault": (write_protected, None, [], "page_fault"),
    "slow drive": (outside.nothing, None, ["emulator.axes.y.answer_delay_us=1200", "emulator.axes.y.answer_delay_every=50"], None),
    "nothing, on vcan0": (outside.nothing, 0, ON_VCAN, None),
    "delay on the bus": (outside.nothing, LISTENERS, ON_VCAN, "send"),
}


def check(name, machine, bring_in, overrides, expected):
    """Whether the status names what is expected; says what it named."""
    with outside.Daemon(*PROGRAMS, machine, [*overrides, *CALM]) as daemon:
        bring_in(daemon)
        time.sleep(0.3)
        status = daemon.status()
    late = status["late"]
    named = {cause: count for cause, count in late["causes"].items() if count}
    stale = {axis["name"]: axis["feedback"]["stale_cycles"] for axis in status["axes"]}
    print(f"{name}: sent at most {status['timing']['sent']['max_us']:.0f} us after a grid point; {named or 'no cycle late'} of {status['cycles']}; newest {late['last'] and late['last']['cause']}; "
          f"cycles without an answer {stale}", flush=True)
    if set(named) != ({expected} if expected else set()):
        return False
    if name == "slow drive":
        return stale["x"] == 0 and stale["y"] > 0
    if expected is None:
        return late["last"] is None and status["skipped_grid_points"] == 0 and not any(stale.values())
    return named[expected] >= outside.TIMES // 2 and late["last"]["cause"] == expected


def main():
    machine, vcan_machine = sys.argv[1:]
    subprocess.run(["ip", "link", "add", "dev", "vcan0", "type", "vcan"], check=True)
    subprocess.run(["ip", "link", "set", "vcan0", "up"], check=True)
    wrong = []
    for name, (bring_in, listeners, overrides, expected) in CASES.items():
        in_process = listeners is None
        with contextlib.nullcontext() if in_process else bus(vcan_machine, listeners):
            if not check(name, machine if in_process else vcan_machine, bring_in, overrides, expected):
                wrong.append(name)
    if wrong:
        print(f"FAILED: {', '.join(wrong)}")
        sys.exit(1)


main()
