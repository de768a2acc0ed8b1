#!/usr/bin/env python3
"""Two masters at one bus of python drives: a second contourd, frames of a foreign master in motion and at rest, a foreign master that
was there first, a vendor tool's SDO.

    peer_drive_masters.py PROGRAMS [--before] [--cases NAME,...]
"""
import argparse
import os
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
from peer_drive.foreign_master import ForeignMaster  # noqa: E402

FEED_mm_s = 10.0
NODE = 5
LINE = {"shape": "line", "dx_mm": 30, "dy_mm": 5, "feed_mm_min": 60 * FEED_mm_s}


def say(name, text):
    print(f"{name}: {text}", flush=True)


def describe(bench, since_sync):
    """What the status says, and what the axis really did since."""
    status = bench.status()
    rows = [row for row in bench.truth() if row["sync"] >= since_sync]
    off = next((i for i, row in enumerate(rows) if not row["x"].torque_is_on), None)
    nmt = sorted({row["x"].nmt for row in rows})
    fast = max(abs(row["x"].velocity_m_s) for row in rows) * 1e3
    return status, off, (f"{status['state']}, {status.get('reason')}; torque "
                         f"{'never off' if off is None else f'off after {off} ms'}, NMT states {nmt}, at most {fast:.1f} mm/s")


def start_moving(bench):
    bench.enable()
    start_m = bench.peer("status")["axes"]["x"]["table_m"]
    bench.begin(bench.write_program("line", LINE))
    bench.wait_for("x to move", lambda: abs(bench.peer("status")["axes"]["x"]["table_m"] - start_m) > 2e-3, pause_s=0.05)


def wait_for_run(bench):
    bench.wait_for("run to end", lambda: bench.processes["run"].poll() is not None, pause_s=0.1)
    return bench.processes["run"].returncode


def recover(bench):
    still = bench.peer("status")["axes"]
    expect(not any(axis["state"] == "Operation Enabled" for axis in still.values()), "a drive was enabled again by itself")
    bench.ask("reset")
    bench.wait_for_state("Idle")
    bench.enable()
    bench.ask("run", bench.write_program("short", {"shape": "line", "dx_mm": -0.5, "feed_mm_min": 600}))


def foreign_frame(bench, kind, moving):
    """One frame: a fault of its own, and the axes off within the quick stop's bound."""
    if moving:
        start_moving(bench)
    else:
        bench.enable()
    foreign = ForeignMaster(bench.bus)
    sync = bench.peer("status")["sync_number"]
    foreign.send(kind, NODE)
    foreign.close()
    if not moving:
        # At rest lock-step time stands still: what has come is looked at when it goes on.
        bench.begin(bench.write_program("hold", {"shape": "hold", "seconds": 0.2}))
    wait_for_run(bench)
    bench.wait_for("the axes to rest", lambda: bench.status()["state"] != "Running", seconds=30, pause_s=0.2)
    time.sleep(0.3)
    status, off, text = describe(bench, sync)
    say(f"{kind} {'in motion' if moving else 'at rest'}", text)
    expect(status["state"] == "Faulted" and status["reason"] == "second_master",
           f"a foreign {kind} frame: {status['state']}, {status.get('reason')}")
    # The frame may have been sent some SYNCs after the number was asked for.
    bound_ms = 1e3 * bench.stop_bound_s("fault (quick stop)") + 100
    expect(off is not None and off <= bound_ms, f"a foreign {kind} frame: torque off after {off} ms, bound {bound_ms:.0f} ms")
    recover(bench)


def foreign_sdo(bench):
    start_moving(bench)
    sync = bench.peer("status")["sync_number"]
    foreign = ForeignMaster(bench.bus)
    for _ in range(5):
        foreign.send("sdo", NODE)
    foreign.close()
    code = wait_for_run(bench)
    status, _, text = describe(bench, sync)
    said = "foreign_sdo" in str(status) or "foreign" in (bench.work / "contourd.log").read_text().lower()
    say("sdo in motion", f"{text}; run ended with {code}, {'noticed' if said else 'not noticed'}")
    expect(code == 0 and status["state"] == "Ready", f"a vendor tool's SDO stopped the machine: {status['state']}, {status.get('reason')}")
    expect(said, "a vendor tool's SDO was not noticed")


def second_daemon(bench):
    start_moving(bench)
    sync = bench.peer("status")["sync_number"]
    bench.start_daemon(name="second", sock=bench.work / "second.sock")
    try:
        bench.wait_for("the second contourd to give up", lambda: bench.processes["second"].poll() is not None, seconds=20)
    except BenchError:
        pass
    second = bench.processes["second"]
    code = second.poll()
    if code is None:
        second.kill()
        second.wait()
    run = wait_for_run(bench)
    words = (bench.work / "second.log").read_text().strip().splitlines()
    status, _, text = describe(bench, sync)
    say("second contourd", f"the second {'ran on' if code is None else f'ended with {code}'}: {words[-1] if words else ''!r}; the first: "
        f"{text}; run ended with {run}")
    expect(code not in (None, 0), "the second contourd was not refused")
    expect(run == 0 and status["state"] == "Ready", f"the first was disturbed: {status['state']}, {status.get('reason')}")


def was_there_first(bench):
    """A master on another computer sends SYNC: ours must not send a single frame."""
    bench.stop_all()
    bench.start_emulator()
    bench.start_recording()
    bench.start("foreign", bench.python, Path(__file__).resolve().parent.parent / "peer_drive" / "foreign_master.py", "sync", "--bus",
                bench.bus, "--times", "100000", "--period-ms", "5")
    bench.wait_for("the foreign SYNC", lambda: len(bench.trace()) > 5)
    bench.start_daemon()
    state, said = bench.start_outcome()
    time.sleep(0.3)
    bench.processes["foreign"].kill()
    bench.processes["candump"].terminate()
    bench.processes["candump"].wait()
    ours = [frame for frame in bench.trace() if frame.id in (0x000, 0x77F, 0x200 + NODE, 0x600 + NODE)]
    say("a master was there first", f"{state}, {len(ours)} frames sent; {bench.last_words(said)}")
    expect(state != "Idle" and not ours, f"{state} with {len(ours)} frames sent, the first {ours[:1]}")
    expect("second_master" in said or "another master" in said, f"nothing tells of another master: {bench.last_words(said)}")


CASES = {
    "second_daemon": second_daemon,
    "foreign_sdo": foreign_sdo,
    "sync_in_motion": lambda bench: foreign_frame(bench, "sync", True),
    "nmt_in_motion": lambda bench: foreign_frame(bench, "nmt", True),
    "rpdo_in_motion": lambda bench: foreign_frame(bench, "rpdo", True),
    "heartbeat_in_motion": lambda bench: foreign_frame(bench, "heartbeat", True),
    "rpdo_at_rest": lambda bench: foreign_frame(bench, "rpdo", False),
    "was_there_first": was_there_first,
}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("programs", type=Path)
    parser.add_argument("--cases")
    parser.add_argument("--before", action="store_true")
    arguments = parser.parse_args()
    names = arguments.cases.split(",") if arguments.cases else list(CASES)
    failed, up = 0, False
    with PeerBench(arguments.programs, os.environ["OUT"]) as bench:
        if "listen_ms" not in bench.describe_keys() and not arguments.before:
            print("SKIPPED: this build does not look for other masters")
            sys.exit(77)
        for name in names:
            try:
                if not up:
                    bench.stop_all()
                    bench.bring_up()
                    up = not arguments.before
                CASES[name](bench)
            except (BenchError, AssertionError) as error:
                print(f"{'    wanted otherwise' if arguments.before else 'FAILED'} {name}: {error}", flush=True)
                failed, up = failed + 1, False
    print(f"{len(names)} cases, {failed} failed")
    sys.exit(1 if failed and not arguments.before else 0)


main()
