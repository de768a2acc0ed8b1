#!/usr/bin/env python3
"""Makes cycles of a running contourd late from outside, and looks whether `contour status --json` names what did it.

    late_from_outside.py CONTOURD CONTOUR MACHINE_FILE CAUSE

CAUSE is what is brought in: nothing, stop (SIGSTOP), debugger (ptrace), preemption (a thread of higher real-time priority on
the same processor), page_fault (the kernel is told to drop contourd's memory) or slow_drive (the emulator's). What this
computer does by itself besides is counted by contourd as well, rightly; it is not held against it. Ends with 77 (skipped)
where the kernel does not allow what is to be brought in.
"""
import ctypes
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TIMES = 12
PRIORITY = 40
libc = ctypes.CDLL(None, use_errno=True)
libc.ptrace.restype = ctypes.c_long
libc.ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]


class Refused(Exception):
    """The kernel does not allow it here."""


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Daemon:
    """contourd on the emulated machine, by the wall clock; killed at the end whatever comes."""

    def __init__(self, contourd, contour, machine_file, overrides):
        self.scratch = tempfile.TemporaryDirectory()
        control_socket = f"{self.scratch.name}/control.sock"
        port = free_port()  # other tests may run beside this one
        self.ask = [contour, "status", "--json", "--socket", control_socket]
        self.messages = Path(self.scratch.name, "daemon.txt")
        # A program file of its own, on the disk already: the kernel does not drop pages that another process has mapped as
        # well, nor such as are still to be written.
        program = shutil.copy(contourd, self.scratch.name)
        with open(program, "rb") as file:
            os.fsync(file.fileno())
        command = [program, "--config", machine_file, "--controller", "pid", "--socket", control_socket]
        for override in ["telemetry.publish=false", "realtime.required=false", f"realtime.priority={PRIORITY}",
                         "realtime.cpu=0", f"io.modbus.port={port}", f"emulator.io.port={port}", *overrides]:
            command += ["--set", override]
        self.process = subprocess.Popen(command, stdout=self.messages.open("w"), stderr=subprocess.STDOUT)

    def __enter__(self):
        for _ in range(600):
            if self.process.poll() is not None:
                break
            answer = subprocess.run(self.ask, capture_output=True, text=True, check=False)
            if answer.returncode == 0 and json.loads(answer.stdout)["state"] == "Idle":
                return self
            time.sleep(0.1)
        said = self.messages.read_text(encoding="utf-8")
        self.__exit__()
        sys.exit(f"contourd did not get to Idle:\n{said}")

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        self.scratch.cleanup()

    def status(self):
        return json.loads(subprocess.run(self.ask, capture_output=True, text=True, check=True).stdout)

    def causes(self):
        return self.status()["late"]["causes"]

    def loop_thread(self):
        for task in Path(f"/proc/{self.process.pid}/task").iterdir():
            if (task / "comm").read_text().strip() == "contour-rt":
                return int(task.name)
        raise AssertionError("no thread contour-rt")


def stop(daemon):
    for _ in range(TIMES):
        daemon.process.send_signal(signal.SIGSTOP)
        time.sleep(0.01)
        daemon.process.send_signal(signal.SIGCONT)
        time.sleep(0.03)


def ptrace(request, thread):
    if libc.ptrace(request, thread, None, None) < 0:
        raise Refused(f"ptrace: {os.strerror(ctypes.get_errno())}")


def debugger(daemon):
    seize, interrupt, detach = 0x4206, 0x4207, 17
    thread = daemon.loop_thread()
    for _ in range(TIMES):
        ptrace(seize, thread)
        ptrace(interrupt, thread)
        os.waitpid(thread, 0x40000000)  # __WALL
        time.sleep(0.01)
        ptrace(detach, thread)
        time.sleep(0.03)


def preemption(daemon):
    """Runs on the loop's processor, above it, for 10 ms at a time."""
    thread = daemon.loop_thread()
    if os.sched_getscheduler(thread) != os.SCHED_FIFO:
        raise Refused("contourd has no real-time priority")
    hog = """
import os, time
os.sched_setaffinity(0, {0})
os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(%d))
for _ in range(%d):
    end = time.monotonic() + 0.01
    while time.monotonic() < end:
        pass
    time.sleep(0.04)
""" % (PRIORITY + 10, TIMES)
    run = subprocess.run([sys.executable, "-c", hog], capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise Refused(run.stderr.strip().splitlines()[-1])


def page_fault(daemon):
    """The kernel is told that contourd's code is not needed now (process_madvise, MADV_PAGEOUT), over and over."""
    pidfd = os.pidfd_open(daemon.process.pid)
    ranges = []
    for line in Path(f"/proc/{daemon.process.pid}/maps").read_text().splitlines():
        where, mode, *rest = line.split()
        if mode.startswith("r-x") and rest[-1].startswith("/"):
            begin, end = (int(x, 16) for x in where.split("-"))
            ranges.append((begin, end - begin))
    iovec = (ctypes.c_size_t * (2 * len(ranges)))(*[x for r in ranges for x in r])
    for _ in range(40 * TIMES):
        if libc.syscall(440, pidfd, ctypes.byref(iovec), len(ranges), 21, 0) < 0:
            raise Refused(f"process_madvise: {os.strerror(ctypes.get_errno())}")
        time.sleep(0.01)


def nothing(_):
    time.sleep(3)


# What is brought in, with which settings, and the cause that must come of it.
CASES = {
    "nothing": (nothing, [], None),
    "stop": (stop, [], "stopped"),
    "debugger": (debugger, [], "stopped"),
    "preemption": (preemption, [], "preempted"),
    "page_fault": (page_fault, ["realtime.lock_memory=false"], "page_fault"),
}


def slow_drive(programs):
    """In the time of the in-process bus: exact whatever this computer is busy with."""
    with Daemon(*programs, ["emulator.axes.y.answer_delay_us=1200", "emulator.axes.y.answer_delay_every=50"]) as daemon:
        time.sleep(2)
        x, y = (axis["feedback"] for axis in daemon.status()["axes"])
        print("x:", x, "\ny:", y)
        assert y["stale_cycles"] > 0, "the slow drive was not seen"
        assert x["stale_cycles"] == 0, "the wrong drive is blamed"


def main():
    *programs, case = sys.argv[1:]
    if case == "slow_drive":
        slow_drive(programs)
        return
    bring_in, overrides, expected = CASES[case]
    with Daemon(*programs, overrides) as daemon:
        before = daemon.causes()
        try:
            bring_in(daemon)
        except (Refused, PermissionError) as e:
            print(f"skipped: {e}")
            sys.exit(77)
        time.sleep(0.3)
        after = daemon.causes()
        new = {cause: after[cause] - before[cause] for cause in after}
    print(f"{case}: {new}")
    if expected is None:
        # Wake-ups late and the processor taken away are this computer's doing, and named so; nobody stopped anything.
        for cause in ("stopped", "page_fault", "throttled"):
            assert new[cause] == 0, f"{cause}: nothing of the kind was brought in"
    else:
        assert new[expected] >= TIMES // 2, f"{expected} was brought in {TIMES} times"
        for cause in {"stopped", "page_fault", "preempted"} - {expected, "preempted"}:
            assert new[cause] <= TIMES // 4, f"{cause}: not what was brought in"


if __name__ == "__main__":
    main()
