"""For jobs in the guest: the emulated machine as one can look at it from outside, and the daemon as an operator sees it."""
import csv
import json
import re
import subprocess
import sys
import time
from pathlib import Path

AXES = ("x", "y")
IN_MOTION_m_s = 0.03
AT_REST_m_s = 1e-4
ENABLED = "Operation Enabled"
SOCKET = "/run/contourd/control.sock"
TRUTH = Path("/tmp/truth.csv")
MACHINE = Path("/etc/contourd/machine.yaml")


class Failed(Exception):
    """A demand is not met; the message says which."""


def expect(condition, message):
    if not condition:
        raise Failed(message)


def run(*command, check=True):
    result = subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
                            timeout=120)
    if check and result.returncode != 0:
        raise Failed(f"{' '.join(map(str, command))} ended with {result.returncode}: {result.stderr or result.stdout}")
    return result.stdout


def contour(*words, check=True):
    return run("contour", *words, "--socket", SOCKET, check=check)


def state():
    try:
        return json.loads(contour("status", "--json"))["state"]
    except Failed:
        return None


def status():
    return json.loads(contour("status", "--json"))


LATE = ("late_cycles", "skipped_grid_points", "stale_cycles")


def late():
    """How many cycles were late, missed or without feedback so far."""
    said = status()
    return {key: said[key] for key in LATE}


def wait_for(what, condition, seconds=30.0):
    end = time.monotonic() + seconds
    while True:
        value = condition()
        if value:
            return value
        expect(time.monotonic() < end, f"waited {seconds:g} s in vain for {what}")
        time.sleep(0.1)


# The machine ---------------------------------------------------------------------------------------------------

def number(text):
    try:
        return float(text)
    except ValueError:
        return text


def truth_so_far():
    """A mark: what comes after it is what truth(mark) gives."""
    return TRUTH.stat().st_size


def truth(mark=0):
    """Rows of the emulated machine's truth from a mark on."""
    with open(TRUTH, "rb") as file:
        header = file.readline().decode()
        file.seek(max(mark, len(header)))
        lines = file.read().decode().split("\n")[:-1]
    if mark > len(header):
        lines = lines[1:]  # most likely the rest of a row
    return [{key: number(value) for key, value in row.items()} for row in csv.DictReader([header, *lines])]


def last_truth():
    return truth(truth_so_far() - 4096)[-1]


def speed(row):
    return max(abs(row[f"{axis}_table_velocity_m_s"]) for axis in AXES)


def enabled(row):
    return any(row[f"{axis}_drive_state"] == ENABLED for axis in AXES)


def silent_master_bound(machine):
    """{axis: (s, m)} from a silent master to rest, as `contour check` prints it."""
    for line in run("contour", "check", machine).splitlines():
        name, *columns = re.split(r"\s{2,}", line.strip())
        if name.startswith("master silent") and len(columns) == 2 * len(AXES):
            values = [float(re.sub(r"\s*(ms|mm)$", "", column)) * 1e-3 for column in columns]
            return {axis: (values[2 * i], values[2 * i + 1]) for i, axis in enumerate(AXES)}
    raise Failed("contour check prints no bound for a silent master")


def bring_to_motion(program):
    """Enabled by an operator, running the program and moving; a mark in the truth before that."""
    if state() == "Faulted":
        wait_for("the reset to be accepted", lambda: "Idle" in (contour("reset", check=False), state()))
    wait_for("state Idle or Ready", lambda: state() in ("Idle", "Ready"))
    before = truth_so_far()
    if state() == "Idle":
        contour("enable")
    wait_for("state Ready", lambda: state() == "Ready")
    subprocess.Popen(["contour", "run", program, "--socket", SOCKET], stdin=subprocess.DEVNULL,
                     stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wait_for("the axes to move", lambda: speed(last_truth()) > IN_MOTION_m_s)
    return before


# The guest -----------------------------------------------------------------------------------------------------

def write_machine(example):
    """The example's machine file for a computer with one processor, where the service looks for it."""
    text = Path(example).read_text(encoding="utf-8")
    expect("\n  cpu: 1\n" in text, "the machine file has no 'cpu: 1'")
    MACHINE.parent.mkdir()
    MACHINE.write_text(text.replace("\n  cpu: 1\n", "\n  cpu: 0\n"), encoding="utf-8")


def start_drives(interface):
    """The emulated machine on the clock, as real drives are: when their master falls silent they stop by themselves."""
    log = open("/tmp/emulator.log", "w", encoding="utf-8")
    drives = subprocess.Popen(["contour", "emulate", "--config", MACHINE, "--bus", interface, "--clock", "wall", "--truth", TRUTH],
                              stdin=subprocess.DEVNULL, stdout=log, stderr=log)
    wait_for("the emulated machine", lambda: "ready" in Path("/tmp/emulator.log").read_text())
    # They answer whatever else the computer does: the first thread, the one on the bus.
    run("chrt", "-f", "-p", "70", drives.pid)


def main(test):
    """Runs the test; a failure is one message and what the service said."""
    try:
        test()
    except Failed as failure:
        print(f"FAILED: {failure}")
        print(run("journalctl", "-u", "contourd", "-o", "short-precise", "--no-pager", "-n", "40", check=False))
        for log in sorted(Path("/tmp").glob("*.log")):
            print(f"-- {log}:", *log.read_text().splitlines()[-20:], sep="\n")
        sys.exit(1)
