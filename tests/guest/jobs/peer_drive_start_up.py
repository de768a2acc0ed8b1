#!/usr/bin/env python3
"""Python drives as they come from a shop: settings that are read-only and right, a fixed PDO mapping, a boot of 2.5 s; and ones that
cannot be right, where the daemon must say which object holds what, and which key waits too short.

    peer_drive_start_up.py PROGRAMS [--before] [--short]

--short leaves out what another case has in it.
"""
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from machine_bench import BenchError, expect  # noqa: E402

try:
    import canopen  # noqa: F401
except ImportError:
    print("SKIPPED: no python-canopen; tools/setup --all puts it into build/venv")
    sys.exit(77)

from peer_drive.bench import PeerBench  # noqa: E402

FIXED = "common.node.read_only"


class StartUp:
    """What the drives are like; what the daemon is to make of it: None for a machine that runs, else words of its refusal."""

    def __init__(self, name, machine, refused=None, settings=(), part_of_another=False):
        self.name, self.machine, self.refused, self.settings = name, machine, refused, settings
        self.part_of_another = part_of_another


CASES = (
    StartUp("read-only and right", [f"{FIXED}={{0x6007: 3, 0x605A: 2, 0x60C2: 1}}"], part_of_another=True),
    StartUp("fixed PDOs that are right", ["common.node.fixed_pdos=true"], part_of_another=True),
    StartUp("everything fixed and right", [f"{FIXED}={{0x6007: 3, 0x605A: 2, 0x60C2: 1, 0x1006: 1000, 0x1016: 0x7F0006, 0x6072: 625}}",
                                           "common.node.fixed_pdos=true"]),
    StartUp("a boot of 2.5 s", ["common.node.boot_ms=2500", "axes.y.boot_ms=2500"],
            settings=["axes.x.drive.boot_up_ms=20000", "axes.y.drive.boot_up_ms=20000"]),
    StartUp("a boot longer than its key", ["common.node.boot_ms=600000", "axes.y.boot_ms=600000"], refused=["boot_up_ms"],
            settings=["axes.x.drive.boot_up_ms=300", "axes.x.drive.sdo_ms=200", "axes.y.drive.boot_up_ms=300"]),
    StartUp("read-only and different", [f"{FIXED}={{0x6007: 1}}"], refused=["0x6007", "expected 3", "found 1"]),
)


def start_up(bench, case):
    bench.machine_settings = list(case.machine)
    bench.settings += case.settings
    bench.start_emulator()
    bench.start_daemon()
    state, said = bench.start_outcome()
    print(f"{case.name}: {state}; {bench.last_words(said)}", flush=True)
    if case.refused is None:
        expect(state == "Idle", f"{case.name}: {state}, not Idle")
        bench.enable()
        bench.ask("run", bench.write_program("short", {"shape": "line", "dx_mm": 0.5, "feed_mm_min": 600}))
        return
    expect(state != "Idle", f"{case.name}: accepted")
    for word in case.refused:
        expect(word in said, f"{case.name}: nothing says {word!r}")


def main():
    programs, before, short = Path(sys.argv[1]), "--before" in sys.argv, "--short" in sys.argv
    failed = 0
    chosen = [case for case in CASES if not (short and case.part_of_another)]
    for case in chosen:
        try:
            with PeerBench(programs, os.environ["OUT"]) as bench:
                start_up(bench, case)
        except (BenchError, AssertionError) as error:
            print(f"{'    wanted otherwise' if before else 'FAILED'}: {error}", flush=True)
            failed += 1
    print(f"{len(chosen)} cases, {failed} failed")
    sys.exit(1 if failed and not before else 0)


main()
