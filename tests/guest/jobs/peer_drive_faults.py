#!/usr/bin/env python3
"""Faults of a drive that is not ours: python drives with their own plant (peer_drive) follow the daemon in lock-step on vcan0, something
breaks, and their truth must stay within what `contour check` prints, with the reason it names.

    peer_drive_faults.py PROGRAMS [--cases NAME,...] [--before]

--before: prints what happens and asserts nothing, for a build that does not know these faults.
"""
import argparse
import os
import re
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from machine_bench import BenchError, expect  # noqa: E402

try:
    import canopen  # noqa: F401
except ImportError:
    print("SKIPPED: no python-canopen; tools/setup --all puts it into build/venv")
    sys.exit(77)

from peer_drive.bench import PeerBench  # noqa: E402
from peer_drive.printed_bounds import PrintedBounds  # noqa: E402

FIT_SYNCS = 100  # of the path before the fault
PATIENCE_SYNCS = 6000
AT_REST = ("feedback_frozen", "torque_without_motion")  # of a frozen encoder, where a stop is as good as none


class Case:
    """A fault of one axis while it moves at a feed, or at rest.

    row: what `contour check` calls it; stop: the way of stopping whose bound holds until the torque is off; reasons: what may be given as the reason. They are those of the fault campaign
    (tools/faults/expected_reasons.cc), written down before the first run; without any the machine may go on, or stop with one of AT_REST.
    """

    def __init__(self, name, fault, row, reasons, feed_mm_s, axis="x", mode="cst", stop="",
                 loses_reference=False):
        self.name, self.fault, self.row, self.reasons = name, fault, row, reasons
        self.feed_mm_s, self.axis, self.mode, self.stop, self.loses_reference = feed_mm_s, axis, mode, stop, loses_reference


def cases():
    slow = 0.2
    for mode in ("cst", "csp"):
        tail = "" if mode == "cst" else "_csp"
        yield Case(f"frozen_at_0.2{tail}", "freeze {}", "encoder frozen", ("feedback_frozen", "torque_without_motion"), slow, mode=mode)
        yield Case(f"flickering_at_0.2{tail}", "freeze {} flickering", "frozen, flickers", ("feedback_frozen", "torque_without_motion"),
                   slow, mode=mode)
        yield Case(f"frozen_at_0.01{tail}", "freeze {}", "encoder frozen", ("feedback_frozen", "torque_without_motion"), 0.01, mode=mode)
        yield Case(f"jump_of_0.2mm{tail}", "jump {} 0.2", "encoder jumps", ("feedback_jump",), slow, mode=mode)
        yield Case(f"jump_back_of_0.2mm{tail}", "jump {} -0.2", "encoder jumps", ("feedback_jump",), slow, mode=mode)
        yield Case(f"lost_torque_unseen{tail}", "lose_torque {} demand", "torque lost", ("torque_without_motion", "following_error"),
                   slow, mode=mode)
        yield Case(f"lost_torque_reported{tail}", "lose_torque {} true", "torque lost",
                   ("torque_not_delivered", "torque_without_motion"), slow, mode=mode)
        yield Case(f"reversed{tail}", "reverse {}", "encoder reversed", ("feedback_reversed", "feedback_jump"), 10.0, mode=mode)
        yield Case(f"frozen_at_10{tail}", "freeze {}", "encoder frozen", ("feedback_frozen", "torque_without_motion"), 10.0, mode=mode)
        # The drive's own loop may wind itself up on a standing count (csp), which is seen.
        yield Case(f"frozen_at_rest{tail}", "freeze {}", "encoder frozen", None, 0.0, mode=mode)
        yield Case(f"ignores_target{tail}", "ignore {}", "drive tells of it", ("drive_not_following", "torque_not_delivered"), 10.0,
                   mode=mode)
        yield Case(f"mode_changed{tail}", f"mode {{}} {8 if mode == 'cst' else 10}", "drive tells of it",
                   ("mode_changed", "drive_not_following", "torque_not_delivered", "torque_without_motion"), 10.0, mode=mode)
        yield Case(f"emcy_4210{tail}", "emcy {} 0x4210", "", ("drive_emergency",), 10.0, mode=mode, stop="operator stop")
        yield Case(f"restart_in_motion{tail}", "restart {} 0", "", ("drive_restarted", "stale_feedback"), 50.0, axis="y", mode=mode,
                   loses_reference=True)
        yield Case(f"slow_restart_in_motion{tail}", "restart {} 150", "", ("stale_feedback", "drive_restarted"), 50.0, axis="y",
                   mode=mode, loses_reference=True)


class Outcome:
    """What the machine really did, from the truth."""

    def __init__(self, rows, fault_sync, axis):
        begin = next(i for i, row in enumerate(rows) if row["sync"] >= fault_sync)
        own = [row[axis] for row in rows]
        before = own[max(0, begin - FIT_SYNCS):begin]
        self.feed_m_s = (before[-1].table_m - before[0].table_m) / (1e-3 * (len(before) - 1))
        origin_m = own[begin].table_m
        off = next((i for i in range(begin, len(own)) if not own[i].torque_is_on), None)
        end = off if off is not None else len(own) - 1

        def departure(i):
            return abs(own[i].table_m - origin_m - self.feed_m_s * 1e-3 * (i - begin))

        self.departure_mm = 1e3 * max(departure(i) for i in range(begin, end + 1))
        self.off_after_ms = None if off is None else off - begin
        rest = next((i for i in range(begin, len(own)) if all(abs(a.velocity_m_s) < 1e-4 for a in own[i:i + 50])), len(own) - 1)
        self.travel_mm = 1e3 * abs(own[rest].table_m - origin_m)
        self.speed_mm_s = 1e3 * max(abs(a.velocity_m_s) for a in own[begin:])
        self.torque_Nm = max(abs(a.torque_Nm) for a in own[begin:end + 1])
        self.rest_after_ms = rest - begin
        self.stays_off = off is None or not any(a.torque_is_on for a in own[off:])


def program_of(case):
    if case.feed_mm_s == 0.0:
        return {"shape": "hold", "seconds": 3}
    travel = min(120.0, max(1.0 if case.feed_mm_s >= 0.1 else 0.1, case.feed_mm_s * 3.0))
    return {"shape": "line", f"d{case.axis}_mm": travel, "feed_mm_min": 60.0 * case.feed_mm_s}


def inject(bench, case):
    """Starts the program and breaks something in it; the SYNC at which it broke."""
    done = len(bench.peer("status")["done"])
    words = case.fault.format(case.axis)
    if case.feed_mm_s == 0.0:
        bench.begin(bench.write_program(case.name, program_of(case)))
        bench.peer("in", 400, words)
    else:
        # Steady by then: past its ramp and past pre-sliding.
        bench.peer("past", case.axis, max(min(0.1, case.feed_mm_s), 0.35 * case.feed_mm_s, 0.03), words)
        bench.begin(bench.write_program(case.name, program_of(case)))
    def happened():
        status = bench.status()
        expect(status["state"] != "Faulted" or len(bench.peer("status")["done"]) > done,
               f"{case.name}: stopped before anything was broken, {status.get('reason')}")
        return len(bench.peer("status")["done"]) > done

    bench.wait_for("the fault to happen", happened, pause_s=0.1)
    return bench.peer("status")["done"][-1][0]


def wait_for_end(bench, case, sync):
    """Until the axis is off and at rest, or time stands still in another state, or far too late."""
    seen = {"sync": None, "times": 0}

    def ended():
        status = bench.peer("status")
        stands = status["sync_number"] == seen["sync"] and bench.processes["run"].poll() is not None
        seen.update(sync=status["sync_number"], times=seen["times"] + 1 if stands else 0)
        return (status["axes"][case.axis]["off_and_at_rest"] or status["sync_number"] > sync + PATIENCE_SYNCS
                or seen["times"] >= 10)

    bench.wait_for(f"{case.name}: the axis to rest", ended, pause_s=0.1)
    bench.wait_for("run to say how it ended", lambda: bench.processes["run"].poll() is not None, pause_s=0.1)


def displacement_mm(bench, case):
    """What the daemon believes less what is, of an axis whose count began where the truth does."""
    believed_m = next(axis["position_m"] for axis in bench.status()["axes"] if axis["name"] == case.axis)
    return 1e3 * (believed_m - bench.truth()[-1][case.axis].motor_m)


def recovers(bench, case):
    """`reset` and `enable` make it work again, and nothing but `enable` brings torque."""
    bench.peer("mend", case.axis)
    time.sleep(0.2)
    still = bench.peer("status")["axes"]
    expect(not any(axis["state"] == "Operation Enabled" for axis in still.values()), f"{case.name}: a drive was enabled again by itself")
    bench.ask("reset")
    bench.wait_for_state("Idle")
    still = bench.peer("status")["axes"]
    expect(not any(axis["state"] == "Operation Enabled" for axis in still.values()), f"{case.name}: reset enabled a drive")
    bench.enable()
    short = bench.write_program("short", {"shape": "line", "dx_mm": -0.5, "dy_mm": -0.5, "feed_mm_min": 600})
    if case.loses_reference:
        print(f"    {bench.status()['state']} again, {displacement_mm(bench, case):.3f} mm displaced", flush=True)
        expect(not bench.try_ask("run", short, "--from-here"), f"{case.name}: the axis lost its reference, and a program was accepted")
        bench.ask("disable")
        bench.wait_for_state("Idle")
        bench.ask("reference", f"{case.axis}={1e3 * bench.truth()[-1][case.axis].motor_m:.6f}")
        bench.enable()
        expect(abs(displacement_mm(bench, case)) < 0.01, f"{case.name}: {displacement_mm(bench, case):.3f} mm off after it was told")
    bench.ask("run", short, "--from-here")


def say(case, outcome, status, bound):
    off = "torque never off" if outcome.off_after_ms is None else f"torque off after {outcome.off_after_ms} ms"
    printed = "none printed" if bound is None else f"{bound[0]:g} mm, {bound[1] or 0:g} ms"
    print(f"{case.name}: {off}, departure {outcome.departure_mm:.4f} mm (bounds: {printed}), at rest after {outcome.rest_after_ms} ms "
          f"and {outcome.travel_mm:.3f} mm, at most {outcome.speed_mm_s:.1f} mm/s and {outcome.torque_Nm:.2f} Nm; {status['state']}, "
          f"{status.get('reason')}", flush=True)


def run_case(bench, case, bounds, before):
    bench.enable()
    sync = inject(bench, case)
    wait_for_end(bench, case, sync)
    status = bench.status()
    outcome = Outcome(bench.truth(sync - FIT_SYNCS - 1), sync, case.axis)
    bound = bounds.of(case.axis, case.row, case.feed_mm_s) if case.row else None
    say(case, outcome, status, bound)
    problems = judge(bench, case, outcome, status, bound)
    if before:
        try:
            if status["state"] == "Faulted":
                recovers(bench, case)
        except (BenchError, AssertionError) as error:
            print(f"    afterwards: {error}", flush=True)
        return []
    if not problems and status["state"] == "Faulted":
        recovers(bench, case)
    bench.peer("mend", case.axis)
    return problems


def judge(bench, case, outcome, status, bound):
    problems = []
    # The torque goes when the axis rests; what springs back afterwards is pre-sliding.
    if case.stop and outcome.off_after_ms is not None and outcome.off_after_ms > 1e3 * bench.stop_bound_s(case.stop):
        problems.append(f"torque off after {outcome.off_after_ms} ms; contour check bounds it by "
                        f"{1e3 * bench.stop_bound_s(case.stop):.1f} ms")
    if case.reasons is None:
        # Where nothing asks for motion a standing position is what it should be.
        if status["state"] != "Ready" and status.get("reason") not in AT_REST:
            problems.append(f"{status['state']} with reason {status['reason']!r}")
    else:
        if status["state"] != "Faulted" or status["reason"] not in case.reasons:
            problems.append(f"{status['state']} with reason {status['reason']!r}, not Faulted with one of {case.reasons}")
        if outcome.off_after_ms is None or not outcome.stays_off:
            problems.append("the torque did not go off and stay off")
    if case.row and bound is None:
        problems.append(f"contour check prints no bound for {case.row!r} at {case.feed_mm_s} mm/s")
    elif case.row:
        if outcome.departure_mm > bound[0]:
            problems.append(f"departure {outcome.departure_mm:.4f} mm is beyond the bound of {bound[0]:g} mm")
        # The mode is asked for in turn, ten times a second: only the departure is promised for it, and the torque of the wrong
        # loop may be seen sooner.
        timed = case.reasons and "mode_changed" not in case.reasons
        if timed and bound[1] and outcome.off_after_ms is not None and outcome.off_after_ms > bound[1]:
            problems.append(f"torque off after {outcome.off_after_ms} ms is beyond the bound of {bound[1]:g} ms")
    return problems


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("programs", type=Path)
    parser.add_argument("--cases", help="names or parts of them, with commas between")
    parser.add_argument("--before", action="store_true")
    arguments = parser.parse_args()
    keys = PeerBench(arguments.programs, os.environ["OUT"]).describe_keys()
    knows_references = "unreferenced_travel_mm" in keys
    wanted = arguments.cases.split(",") if arguments.cases else None
    chosen = [case for case in cases() if wanted is None or any(re.fullmatch(w, case.name) for w in wanted)]
    if not arguments.before:
        chosen = [case for case in chosen if knows_references or not case.loses_reference]
    failed = 0
    for mode in ("cst", "csp"):
        of_mode = [case for case in chosen if case.mode == mode]
        if not of_mode:
            continue
        with PeerBench(arguments.programs, os.environ["OUT"], mode=mode) as bench:
            bounds = PrintedBounds(bench.contour("check", bench.config, "--set", f"axes.x.drive.mode={mode}", "--set",
                                                 f"axes.y.drive.mode={mode}"))
            if not bounds.bounds and not arguments.before:
                print("SKIPPED: this build prints no bounds for faults of feedback and torque")
                sys.exit(77)
            up = False
            for case in of_mode:
                try:
                    if not up:
                        bench.stop_all()
                        bench.bring_up()
                        up = not arguments.before
                    problems = run_case(bench, case, bounds, arguments.before)
                except (BenchError, AssertionError) as error:
                    problems = [str(error)]
                for problem in problems:
                    print(f"FAILED {case.name}: {problem}", flush=True)
                failed += bool(problems)
                up = up and not problems
    print(f"{len(chosen)} cases, {failed} failed")
    sys.exit(1 if failed and not arguments.before else 0)


main()
