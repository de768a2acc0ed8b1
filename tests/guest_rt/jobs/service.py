"""contourd as a service under systemd on PREEMPT_RT: started, watched, killed, hung, refused.

    service.py MACHINE PROGRAM

The drives run on the clock, as real ones do: when their master falls silent they stop by themselves.
"""
import ctypes
import os
import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

from guest_machine import (AT_REST_m_s, AXES, MACHINE, bring_to_motion, contour, enabled, expect, last_truth, late, main, run,
                           silent_master_bound, speed, start_drives, state, truth, wait_for, write_machine)

UNITS = [f"/etc/systemd/system/{name}.service" for name in ("contourd", "can-up@", "vcan-up@")]


def unit(key):
    return run("systemctl", "show", "--value", "-p", key, "contourd").strip()


def journal():
    return run("journalctl", "-u", "contourd", "-o", "cat", "--no-pager")


# What is tested ------------------------------------------------------------------------------------------------

def check_units():
    said = subprocess.run(["systemd-analyze", "verify", *UNITS], capture_output=True, text=True, check=False)
    expect(said.returncode == 0 and not said.stdout + said.stderr, f"systemd-analyze verify says: {said.stdout}{said.stderr}")
    said = run("systemd-analyze", "security", "--offline=true", "--threshold=18", "--no-pager", UNITS[0])
    print("systemd-analyze verify: silent; security:", said.strip().splitlines()[-1].removeprefix("→ "))


def check_started():
    run("systemctl", "start", "contourd")
    expect(unit("ActiveState") == "active", f"the unit is {unit('ActiveState')} after its start")
    expect(unit("StatusText") == "Idle", f"STATUS says {unit('StatusText')!r} after the start, expected Idle")
    expect(not any(enabled(row) for row in truth()), "a drive was enabled though nobody asked")
    pid = unit("MainPID")
    threads = {Path(task, "comm").read_text().strip(): task.name for task in Path(f"/proc/{pid}/task").iterdir()}
    scheduling = run("chrt", "-p", threads["contour-rt"])
    expect("SCHED_FIFO" in scheduling and "80" in scheduling, f"the cycle's thread runs as {scheduling}")
    said = Path(f"/proc/{pid}/status").read_text()
    expect(re.search(r"CapEff:\s*0+\n", said) and not re.search(r"Uid:\s*0\s", said), "it has capabilities or is root")
    locked_kB = int(re.search(r"VmLck:\s*(\d+)", said)[1])
    expect(locked_kB > 0, "no memory is locked")
    print(f"started: active, READY at Idle, cycle at SCHED_FIFO 80, no capabilities, {locked_kB // 1024} MB locked")


def check_reload(program):
    """A gain changes in motion and no cycle is late; what may not change is refused by name, and nothing happens."""
    text = MACHINE.read_text(encoding="utf-8")
    softer, changes = re.subn(r"(?m)^(  full: \{contour_bandwidth_Hz: )[\d.]+", r"\g<1>20", text)
    expect(changes == 1, "the machine file is not as this test wants to change it")
    before = bring_to_motion(program)
    started = late()
    time.sleep(0.5)
    MACHINE.write_text(softer, encoding="utf-8")
    run("systemctl", "reload", "contourd")
    time.sleep(1.0)
    expect(enabled(last_truth()), "the machine did not go on after the reload")
    contour("stop")
    wait_for("state Ready", lambda: state() == "Ready")
    ended = late()
    said = [line for line in journal().splitlines() if "full.contour_bandwidth_Hz" in line]
    expect(said, "the journal does not say which gain was changed")
    expect(ended == started, f"not every cycle of the reload was in time: {started}, then {ended}")
    expect(any(speed(row) > 0.03 for row in truth(before)), "the machine did not move")
    MACHINE.write_text(text.replace("\n  cycle_us: 1000\n", "\n  cycle_us: 2000\n"), encoding="utf-8")
    run("systemctl", "reload", "contourd", check=False)
    wait_for("the refusal", lambda: any("machine.cycle_us" in line for line in journal().splitlines()))
    expect(state() == "Ready", f"after a reload that was refused the machine is {state()}")
    MACHINE.write_text(text, encoding="utf-8")
    run("systemctl", "reload", "contourd")
    contour("disable")
    wait_for("state Idle", lambda: state() == "Idle")
    print(f"reload in motion: {said[-1].strip()}; no cycle late, without feedback or missed; another cycle refused")


def check_silence(name, program, bound, silence, restarts):
    """The master falls silent in motion: the drives stop by themselves, systemd starts it again, nothing is enabled."""
    before = bring_to_motion(program)
    silence()
    wait_for("systemd to start it again", lambda: unit("NRestarts") == str(restarts), 60)
    wait_for("the unit to be active", lambda: unit("ActiveState") == "active", 60)
    wait_for("a state", lambda: state() in ("Idle", "Faulted"))
    time.sleep(3.0)
    rows = truth(before)
    moving = [i for i, row in enumerate(rows) if enabled(row)]
    last = moving[-1]
    expect(not any(enabled(row) for row in rows[last + 1:]) and not enabled(rows[-1]), "a drive was enabled again by itself")
    # From the last SYNC of the old master; the new one's begin seconds later.
    numbers = [row["sync_number"] for row in rows[:last + 1]]
    start = max(i for i in range(1, last + 1) if numbers[i] != numbers[i - 1])
    rest = next(i for i in range(len(rows) - 1, start, -1) if speed(rows[i]) > AT_REST_m_s and rows[i]["time_s"] <
                rows[start]["time_s"] + 1.0) + 1
    expect(speed(rows[start]) > 0.02, f"{name}: the machine did not move when its master fell silent")
    said = []
    for axis in AXES:
        path_m = [row[f"{axis}_table_position_m"] for row in rows[start:rest + 1]]
        travel_m, (time_s, bound_m) = max(abs(p - path_m[0]) for p in path_m), bound[axis]
        taken_s = rows[rest]["time_s"] - rows[start]["time_s"]
        expect(travel_m <= bound_m, f"{name}: {axis} travelled {travel_m * 1e3:.2f} mm; contour check says {bound_m * 1e3:.2f} mm")
        expect(taken_s <= time_s, f"{name}: at rest after {taken_s * 1e3:.1f} ms; contour check says {time_s * 1e3:.1f} ms")
        said.append(f"{axis} {travel_m * 1e3:.2f} of {bound_m * 1e3:.2f} mm")
    print(f"{name}: from {speed(rows[start]) * 1e3:.0f} mm/s at rest by themselves after {taken_s * 1e3:.1f} ms, {', '.join(said)}; "
          f"started again, {state()}, nothing enabled")


def kill():
    run("systemctl", "kill", "--signal=KILL", "--kill-whom=main", "contourd")


def stop_process():
    os.kill(int(unit("MainPID")), signal.SIGSTOP)


class StoppedThread:
    """Holds the cycle's thread as a debugger does, while all others go on."""

    SEIZE, INTERRUPT = 0x4206, 0x4207
    WAIT_FOR_ANY = 0x40000000  # threads, too

    def __call__(self):
        libc = ctypes.CDLL(None, use_errno=True)
        tasks = Path(f"/proc/{unit('MainPID')}/task").iterdir()
        thread = next(int(task.name) for task in tasks if Path(task, "comm").read_text().strip() == "contour-rt")
        for request in (self.SEIZE, self.INTERRUPT):
            expect(libc.ptrace(request, thread, None, None) == 0, f"ptrace: {os.strerror(ctypes.get_errno())}")
        # A thread that is traced is not gone before its tracer has seen it end.
        threading.Thread(target=self._see_its_end, args=(thread,), daemon=True).start()

    def _see_its_end(self, thread):
        while os.WIFSTOPPED(os.waitpid(thread, self.WAIT_FOR_ANY)[1]):
            pass


def check_refused():
    """Real time refused: the message names what refused it, and trying again is no help."""
    run("systemctl", "stop", "contourd")
    expect(unit("Result") == "success", f"the stop ended in {unit('Result')}")
    folder = Path("/etc/systemd/system/contourd.service.d")
    folder.mkdir()
    (folder / "refuse.conf").write_text("[Service]\nLimitRTPRIO=0\n")
    run("systemctl", "daemon-reload")
    run("systemctl", "start", "contourd", check=False)
    expect(unit("ActiveState") == "failed", f"with LimitRTPRIO=0 the unit is {unit('ActiveState')}")
    expect(unit("ExecMainStatus") == "3", f"it ended with {unit('ExecMainStatus')}, not with 3")
    line = [line for line in journal().splitlines() if "the kernel refused real time" in line][-1]
    expect("RLIMIT_RTPRIO is 0" in line and "LimitRTPRIO=80" in line, f"the message does not name the limit: {line}")
    time.sleep(4.0)
    expect(unit("ActiveState") == "failed", "it was started again though that cannot help")
    (folder / "refuse.conf").unlink()
    run("systemctl", "daemon-reload")
    run("systemctl", "reset-failed", "contourd")
    print(f"refused: {line}")


def test():
    write_machine(sys.argv[1])
    bound = silent_master_bound(MACHINE)
    check_units()
    run("systemctl", "start", "vcan-up@vcan0")
    start_drives("vcan0")
    check_started()
    check_reload(sys.argv[2])
    check_silence("SIGKILL", sys.argv[2], bound, kill, 1)
    check_silence("thread held", sys.argv[2], bound, StoppedThread(), 2)
    expect("Watchdog timeout" in journal(), "systemd's watchdog did not act")
    check_silence("SIGSTOP", sys.argv[2], bound, stop_process, 3)
    check_refused()


main(test)
