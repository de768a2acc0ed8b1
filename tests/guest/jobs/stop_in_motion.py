#!/usr/bin/env python3
"""The machine is stopped in motion, in one of many ways: it comes to rest without torque within the bound that
`contour check` prints, says why, and works again afterwards.

    stop_in_motion.py PROGRAMS CONFIG PROGRAM WAY
"""
import signal
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import canopen_trace  # noqa: E402
from machine_bench import MachineBench, expect, main, write_modbus_coil  # noqa: E402

AXES = {"x": 1, "y": 2}
OPEN_EMERGENCY_STOP_COIL = 100
IN_MOTION_m_s = 0.02
WELL_IN_MOTION_m_s = 0.03  # of the program's 0.05
AT_REST_m_s = 1e-4  # below this friction's spring-back still rings, a fraction of a micrometre
NO_TORQUE_Nm = 1e-6
CONTROLWORD_MASK, CONTROLWORD_ENABLED = 0x0F, 0x0F


# What the records say ------------------------------------------------------------------------------------------

def speed(row):
    return max(abs(row[f"{axis}_table_velocity_m_s"]) for axis in AXES)


def torque(row):
    return max(abs(row[f"{axis}_{name}"]) for axis in AXES for name in ("torque_Nm", "command_Nm"))


def is_stopped(row):
    return speed(row) < AT_REST_m_s and torque(row) < NO_TORQUE_Nm


def is_off(row):
    return is_stopped(row) and all(row[f"{axis}_drive_state"] != "Operation Enabled" for axis in AXES)


def rest_after(rows, start):
    """The first row from which on the machine rests with its drives off, to the end of the rows."""
    expect(rows[start:], "the truth log ends where the stop should begin")
    expect(is_off(rows[-1]), f"the machine does not rest without torque in the end: {rows[-1]}")
    index = len(rows) - 1
    while index > start and is_off(rows[index - 1]):
        index -= 1
    return index


def row_of_sync(rows, sync_number):
    return next(i for i, row in enumerate(rows) if row["sync_number"] >= sync_number and not row["free_running"])


def last_row_before_silence(rows):
    return max(i for i, row in enumerate(rows) if not row["free_running"])


def first_sync_without_enable(frames, after):
    """Number of the SYNC with which the first controlword acted that takes the enable back."""
    syncs = 0
    for frame in frames:
        if frame.id == canopen_trace.SYNC:
            syncs += 1
        elif frame.id - 0x200 in AXES.values() and syncs >= after:
            if frame.data[0] & CONTROLWORD_MASK != CONTROLWORD_ENABLED:
                return syncs + 1
    raise AssertionError("no controlword ever took the enable back")


def syncs_in(frames):
    return sum(1 for frame in frames if frame.id == canopen_trace.SYNC)


def torque_command(frame):
    return int.from_bytes(frame.data[2:4], "little", signed=True)


# The ways to stop ----------------------------------------------------------------------------------------------

class Way:
    bound = ""  # name of the way in the output of `contour check`
    reasons = ()  # what status may give as the reason
    new_daemon = False  # the daemon is gone afterwards
    silent = False  # the drives are to notice by themselves that their master is

    def act(self, bench):
        raise NotImplementedError

    def mend(self, bench):
        """Takes the cause away."""

    def begin(self, bench, rows, syncs_before):
        """Index of the truth row from which on the time counts."""
        del bench, syncs_before
        return last_row_before_silence(rows)


class LinkDown(Way):
    bound = "bus lost (interface down)"
    silent = True
    reasons = ("bus_down", "send_failed")

    def act(self, bench):
        subprocess.run(["ip", "link", "set", bench.bus, "down"], check=True)

    def mend(self, bench):
        subprocess.run(["ip", "link", "set", bench.bus, "up"], check=True)


class EmergencyStop(Way):
    # From the cycle that sees the input: how long Modbus takes is wall time, which a lock-step run has none of.
    bound = "fault (quick stop)"
    reasons = ("emergency_stop",)

    def act(self, bench):
        write_modbus_coil(bench.modbus_port, OPEN_EMERGENCY_STOP_COIL, True)

    def mend(self, bench):
        write_modbus_coil(bench.modbus_port, OPEN_EMERGENCY_STOP_COIL, False)

    def begin(self, bench, rows, syncs_before):
        return row_of_sync(rows, first_sync_without_enable(bench.trace(rows[-1]["sync_number"]), syncs_before))


class Terminate(Way):
    bound = "SIGTERM, SIGINT"
    new_daemon = True

    def act(self, bench):
        bench.processes["contourd"].send_signal(signal.SIGTERM)
        status = bench.wait_for_end("contourd")
        expect(status == 0, f"contourd ended with {status} after SIGTERM")

    def begin(self, bench, rows, syncs_before):
        """Where the path's speed, which is constant on a circle, begins to fall."""
        start = row_of_sync(rows, syncs_before)

        def path_speed(row):
            return sum(row[f"{axis}_table_velocity_m_s"]**2 for axis in AXES)**0.5

        nominal = max(path_speed(row) for row in rows[start:])
        return max(i for i in range(start, len(rows)) if path_speed(rows[i]) > 0.98 * nominal)


class Kill(Way):
    bound = "master silent (killed, hung)"
    new_daemon = True
    silent = True

    def act(self, bench):
        bench.processes["contourd"].kill()
        bench.wait_for_end("contourd")


WAYS = {"link_down": LinkDown(), "emergency_stop": EmergencyStop(), "terminate": Terminate(), "kill": Kill()}


# The test ------------------------------------------------------------------------------------------------------

def start_moving(bench, program):
    """Runs the program in the background; returns when the axes really move, with the SYNCs counted so far."""
    bench.start("run", bench.programs / "contour", "run", program, "--socket", bench.socket)
    bench.wait_for("the axes to move", lambda: speed(bench.last_truth()) > WELL_IN_MOTION_m_s)
    return syncs_in(bench.trace())


def check_reason(bench, way):
    status = bench.wait_for_state("Faulted")
    expect(status["reason"] in way.reasons, f"status gives {status['reason']!r} as the reason, not {way.reasons}")
    expect(status["reason_text"], "status has no sentence on the reason")
    # What is said later of how the drives stopped is not in the first line.
    bench.wait_for_log(status["reason_text"].split(". Axis ")[0])


def check_works_again(bench, way, short_program):
    way.mend(bench)
    if way.new_daemon:
        bench.start_daemon()
    else:
        bench.wait_for("the reset to be accepted", lambda: bench.try_ask("reset"))
    bench.wait_for_state("Idle")
    bench.enable()
    bench.ask("run", short_program, "--from-here")


def test(programs, out):
    config, program, short_program, name = sys.argv[2:6]
    way = WAYS[name]
    with MachineBench(programs, config, out) as bench:
        bound_s = bench.stop_bound_s(way.bound)
        if not way.silent:
            # Between a daemon that has ended and the next one there may be seconds on a busy host. Drives that notice then
            # go by the clock until the next SYNC, and a daemon in lock-step is brought up by cycles.
            bench.patience_ms = 60000
        bench.start_recording()
        bench.start_emulator()
        bench.start_daemon()
        bench.wait_for_state("Idle")
        bench.enable()
        syncs_before = start_moving(bench, program)
        way.act(bench)
        bench.wait_for("the machine to rest without torque", lambda: is_off(bench.last_truth()))
        rows = bench.truth()
        start = way.begin(bench, rows, syncs_before)
        rest = rest_after(rows, start)
        taken_s = rows[rest]["time_s"] - rows[start]["time_s"]
        expect(speed(rows[start]) > IN_MOTION_m_s, "the machine did not move when the stop began")
        expect(taken_s <= bound_s, f"at rest after {1e3 * taken_s:.1f} ms; contour check bounds it by {1e3 * bound_s:.1f} ms")
        if not way.new_daemon:
            check_reason(bench, way)
        check_works_again(bench, way, short_program)
    print(f"{name}: from {1e3 * speed(rows[start]):.0f} mm/s at rest without torque after {1e3 * taken_s:.1f} ms, "
          f"bound {1e3 * bound_s:.1f} ms; works again")


main(test)
