"""contourd on an emulated CAN controller (SJA1000 of a kvaser_pci): bring-up at 1 Mbit/s, run, bus-off, restart, link down and up; then
all that was recorded of it, computed again.

    can_controller.py MACHINE PROGRAM SHORT_PROGRAM

can0 is the daemon's, can1 the drives', both controllers on one bus. QEMU's controllers know no bus errors. So that the kernel's
driver sees a bus-off, the registers of a serial port are put for a moment where those of can0 were: of a port set up for that
the driver reads 'bus-off' in the place of the status, 'error warning' in that of the interrupts. From there on all is as with a
real one: the driver leaves the bus, reports it, and starts again after restart-ms.
"""
import json
import os
import re
import socket
import struct
import subprocess
import sys
import time
from pathlib import Path

from guest_machine import (AXES, LATE, MACHINE, Failed, bring_to_motion, contour, enabled, expect, last_truth, main, run,
                           silent_master_bound, speed, start_drives, state, status, truth, wait_for, write_machine)

LOG = Path("/tmp/run.lcmlog")
FLIGHT = Path("/tmp/flight")
RESTART_ms = 100
SERIAL_PORT = ("0x1b36", "0x0002")
BAR0, BAR1 = 0x10, 0x14
# Of the 16550, by the place of the SJA1000's register: 0 mode, 1 command, 2 status, 3 interrupts, 4 interrupt enable.
FIFO_CONTROL, LINE_CONTROL, MODEM_CONTROL = 2, 3, 4
FIFO_ENABLED = 0x01  # then its interrupt identification reads 0xC1; in the status 0x80 is bus-off
ERROR_WARNING = 0x04
SPARE_PORTS = 0xE800


def link(interface):
    return json.loads(run("ip", "-details", "-json", "link", "show", interface))[0]


def can_state(interface):
    return link(interface)["linkinfo"]["info_data"]["state"]


def pci_device(vendor, device):
    for folder in Path("/sys/bus/pci/devices").iterdir():
        if ((folder / "vendor").read_text().strip(), (folder / "device").read_text().strip()) == (vendor, device):
            return folder
    raise Failed(f"no PCI device {vendor}:{device}")


class Ports:
    """A range of I/O ports of a PCI device, which can be moved."""

    def __init__(self, folder, bar):
        self.config = os.open(folder / "config", os.O_RDWR)
        self.bar = bar
        self.home = struct.unpack("<I", os.pread(self.config, 4, bar))[0] & ~3
        command = struct.unpack("<H", os.pread(self.config, 2, 4))[0]
        os.pwrite(self.config, struct.pack("<H", command | 1), 4)  # it answers to its ports

    def move(self, place):
        os.pwrite(self.config, struct.pack("<I", place | 1), self.bar)


def poke(place, value):
    with open("/dev/port", "r+b", buffering=0) as ports:
        ports.seek(place)
        ports.write(bytes([value]))


def force_bus_off(interface):
    controller = Ports(Path(f"/sys/class/net/{interface}/device").resolve(), BAR1)
    serial = Ports(pci_device(*SERIAL_PORT), BAR0)
    for register, value in ((FIFO_CONTROL, FIFO_ENABLED), (LINE_CONTROL, ERROR_WARNING), (MODEM_CONTROL, 0x03)):
        poke(serial.home + register, value)
    # A frame from the other end, so that the controller asks for its driver at once.
    other = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
    other.bind(("can1",))
    # Before everything else on this computer, the driver's interrupt thread apart from the moment it is let in.
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(95))
    controller.move(SPARE_PORTS)
    serial.move(controller.home)
    other.send(struct.pack("=IB3x8s", 0x7FF, 0, b""))
    time.sleep(0.001)
    serial.move(serial.home)
    controller.move(controller.home)
    os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


def bring_up(interface):
    run("ip", "link", "set", interface, "type", "can", "bitrate", 1000000, "restart-ms", RESTART_ms)
    run("ip", "link", "set", interface, "txqueuelen", 128, "up")


def check_rest(name, before, bound):
    """The machine has come to rest by itself, within the bound of a master that falls silent."""
    wait_for("the drives to be off", lambda: not enabled(last_truth()))
    time.sleep(1.0)
    rows = truth(before)
    last = max(i for i, row in enumerate(rows) if enabled(row))
    # The emulated machine stands still a while after all drives are off and no SYNC comes.
    expect(rows[-1]["time_s"] - rows[last]["time_s"] > 0.2, f"{name}: drives are enabled again")
    numbers = [row["sync_number"] for row in rows[:last + 1]]
    start = max(i for i in range(1, last + 1) if numbers[i] != numbers[i - 1])
    moved = [f"{axis} {1e3 * max(abs(row[f'{axis}_table_position_m'] - rows[start][f'{axis}_table_position_m']) for row in rows[start:last + 1]):.2f}"
             f" of {1e3 * bound[axis][1]:.2f} mm" for axis in AXES]
    for axis in AXES:
        place = [row[f"{axis}_table_position_m"] for row in rows[start:]]
        expect(max(abs(p - place[0]) for p in place) <= bound[axis][1], f"{name}: {axis} travelled too far: {moved}")
    print(f"{name}: from {speed(rows[start]) * 1e3:.0f} mm/s at rest, {', '.join(moved)}")


def check_works_again(short_program):
    wait_for("the reset to be accepted", lambda: "Idle" in (contour("reset", check=False), state()))
    contour("enable")
    wait_for("state Ready", lambda: state() == "Ready")
    contour("run", short_program)


def check_replays():
    """The whole run, faults and all, and each flight record come out again bit for bit."""
    records = sorted(FLIGHT.iterdir())
    expect(len(records) == 2, f"two faults left {len(records)} flight records")
    for file in (LOG, *records):
        said = json.loads(run("contour", "replay", "--json", file))
        expect(said["verdict"] == "same" and said["same_build"] and not said["differences"], f"{file} does not come out again: {said}")
        print(f"{file.name}: {said['cycles']} cycles, {said['first_cycle']} to {said['last_cycle']}: computed again, every output the same")


def test():
    write_machine(sys.argv[1])
    program, short_program = sys.argv[2:4]
    bound = silent_master_bound(MACHINE)
    for interface in ("can0", "can1"):
        bring_up(interface)
    found = link("can0")["linkinfo"]["info_data"]
    expect(found["bittiming"]["bitrate"] == 1000000, f"can0 runs at {found['bittiming']}")
    start_drives("can1")
    Path("/run/contourd").mkdir(exist_ok=True)
    log = open("/tmp/contourd.log", "w", encoding="utf-8")
    daemon = subprocess.Popen(["contourd", "--config", MACHINE, "--bus", "can0", "--socket", "/run/contourd/control.sock", "--log", LOG,
                               "--set", f"telemetry.flight_directory={FLIGHT}"], stdin=subprocess.DEVNULL, stdout=log, stderr=log)
    before = bring_to_motion(program)
    time.sleep(2.0)
    running = status()
    late = {key: running[key] for key in LATE}
    print(f"can0 at 1 Mbit/s ({found['bittiming_const']['name']}): {running['cycles']} cycles, {late}, "
          f"frames sent at most {running['timing']['sent']['max_us']:.0f} us after the grid point")
    expect(running["state"] == "Running" and not any(late.values()), f"it does not run as it should: {running['state']}, {late}")

    force_bus_off("can0")
    wait_for("state Faulted", lambda: state() == "Faulted")
    expect(status()["reason"] == "bus_off", f"status gives {status()['reason']!r} as the reason, not bus_off")
    print(f"bus-off: {status()['reason_text']}")
    check_rest("bus-off", before, bound)
    expect(can_state("can0") == "ERROR-ACTIVE", f"after restart-ms can0 is {can_state('can0')}")
    restarts = re.search(r"re-started.*\n\s+(\d+)", run("ip", "-details", "-statistics", "link", "show", "can0"))
    expect(restarts is not None and int(restarts[1]) == 1, "the kernel counts no restart")
    check_works_again(short_program)
    print("restarted by the kernel after 100 ms; reset, enabled and run by the operator")

    before = bring_to_motion(program)
    run("ip", "link", "set", "can0", "down")
    wait_for("state Faulted", lambda: state() == "Faulted")
    said = status()
    # The driver is silent for some milliseconds before the interface counts as down.
    expect(said["reason"] in ("bus_down", "send_failed", "stale_feedback"), f"status gives {said['reason']!r} as the reason")
    wait_for("the status to say that the bus is down", lambda: not status()["buses"][0]["up"])
    print(f"link down: {said['reason']}: {said['reason_text']}")
    check_rest("link down", before, bound)
    run("ip", "link", "set", "can0", "up")
    time.sleep(1.0)
    expect(not enabled(last_truth()), "a drive was enabled when the link came up")
    check_works_again(short_program)
    print("link up again; reset, enabled and run by the operator")
    daemon.terminate()
    expect(daemon.wait(60) == 0, f"contourd ended with {daemon.returncode}")
    check_replays()


main(test)
