#!/usr/bin/env python3
"""Installs, and looks into the installed contourd: it starts, and nothing that tests break machines with is in it.

    installed.py BUILD_DIR TEST_PROGRAM

TEST_PROGRAM breaks machines: what is looked for must be found there, or this test finds nothing anywhere.
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

# Faults of drives, links taken down, disturbed buses, scripted failures.
HOOK = re.compile(r"Inject|DriveFaults|SetLink|DisturbedBus|Sabotage|FaultHook|AllocationGuard|testing::", re.IGNORECASE)
TEXT = re.compile(rb"inject|sabotage|fault_hook|LD_PRELOAD", re.IGNORECASE)


def hooks(program):
    symbols = subprocess.run(["nm", "--demangle", "--defined-only", program], check=True, capture_output=True, text=True)
    lines = symbols.stdout.splitlines()
    return len(lines), [line for line in lines if HOOK.search(line)]


def main():
    build, test_program = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["cmake", "--install", build, "--prefix", folder], check=True, capture_output=True)
        contourd = Path(folder, "bin/contourd")
        subprocess.run([contourd, "--version"], check=True, capture_output=True)
        count, found = hooks(contourd)
        if count < 1000:
            sys.exit(f"{contourd} has {count} symbols only: has it been stripped?")
        found += [text.decode() for text in TEXT.findall(contourd.read_bytes())]
    if not hooks(test_program)[1]:
        sys.exit(f"nothing was found in {test_program} either, where it must be")
    print("\n".join(found) or f"none of {count} symbols")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
