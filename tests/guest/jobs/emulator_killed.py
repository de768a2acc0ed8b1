#!/usr/bin/env python3
"""The drives vanish in motion: Faulted within three cycles, no torque command from then on; works again when they are back.

    emulator_killed.py PROGRAMS CONFIG PROGRAM SHORT_PROGRAM
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import canopen_trace  # noqa: E402
from machine_bench import MachineBench, expect, main  # noqa: E402

NODES = (1, 2)
REASONS = ("stale_feedback", "heartbeat_lost")


def commands_after_last_feedback(frames):
    """Setpoints sent after the last SYNC that any drive answered: a list of cycles, each {node: (controlword, torque)}."""
    last = max(i for i, frame in enumerate(frames) if frame.id - 0x180 in NODES)
    cycles, current = [], {}
    for frame in frames[last + 1:]:
        if frame.id - 0x200 in NODES:
            current[frame.id - 0x200] = (int.from_bytes(frame.data[0:2], "little"),
                                         int.from_bytes(frame.data[2:4], "little", signed=True))
        elif frame.id == canopen_trace.SYNC:
            cycles.append(current)
            current = {}
    return cycles


def cycles_now(bench):
    return commands_after_last_feedback(bench.trace())


def first_without_enable(cycles):
    return next((i for i, cycle in enumerate(cycles) if all(word & 0x0F != 0x0F for word, _ in cycle.values())), None)


def test(programs, out):
    config, program, short_program = sys.argv[2:5]
    with MachineBench(programs, config, out) as bench:
        bench.start_recording()
        bench.start_emulator()
        bench.start_daemon()
        bench.wait_for_state("Idle")
        bench.enable()
        bench.start("run", bench.programs / "contour", "run", program, "--socket", bench.socket)
        bench.wait_for("the axes to move", lambda: bench.last_truth()["x_table_velocity_m_s"] > 0.02)
        bench.processes["emulator"].kill()
        bench.wait_for_end("emulator")
        status = bench.wait_for_state("Faulted")
        expect(status["reason"] in REASONS, f"status gives {status['reason']!r} as the reason, not {REASONS}")
        bench.wait_for_log(status["reason_text"])

        # The recording may be a moment behind the machine.
        bench.wait_for("the drives to be told to stop", lambda: first_without_enable(cycles_now(bench)) is not None)
        cycles = cycles_now(bench)
        quick_stop = first_without_enable(cycles)
        # Cycle 0 still has the last feedback; 3 is the third one without.
        expect(quick_stop <= 3, f"the enable was taken back {quick_stop} cycles after the last feedback")
        loud = [i for i, cycle in enumerate(cycles[quick_stop:]) if any(torque for _, torque in cycle.values())]
        expect(not loud, f"{len(loud)} cycles had torque commands after the fault")

        bench.start_emulator()
        bench.ask("reset")
        bench.wait_for_state("Idle")
        bench.enable()
        bench.ask("run", short_program, "--from-here")
    print(f"drives gone: {status['reason']}, enable taken back in cycle {quick_stop}, torque 0 from then on; works again")


main(test)
