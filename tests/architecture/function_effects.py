#!/usr/bin/env python3
"""Clang's -Wfunction-effects over the cycle: nothing that Cycle::Step calls may wait, take memory or throw.

    function_effects.py ROOT CLANG EIGEN

The compiler looks into every function that it sees; so all sources of the cycle are read as one. Only virtual functions say of
themselves that they are CONTOUR_NONBLOCKING (core/nonblocking.h), and their overriders are held to it.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

FOLDERS = ["drivers/cia301", "drivers/cia402", "estimator", "control"]
CYCLE = ["daemon/rt/cycle.cc", "daemon/rt/path_follower.cc", "daemon/rt/transitions.cc"]
PLANTED = """
#include <vector>
#include "core/nonblocking.h"
inline void Deeper(std::vector<int>& numbers) noexcept { numbers.push_back(1); }
void Planted(std::vector<int>& numbers) noexcept CONTOUR_NONBLOCKING { Deeper(numbers); }
"""


def effects(root, clang, eigen, text):
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder, "all.cc")
        source.write_text(text, encoding="utf-8")
        # One translation of functions that have several (core/wide_vectors.h): another must not follow its first use.
        run = subprocess.run([clang, "-std=c++20", "-DCONTOUR_BASELINE_VECTORS", f"-I{root}", "-isystem", eigen,
                              "-march=x86-64-v2", "-fsyntax-only",
                              "-Werror=function-effects", str(source)], capture_output=True, text=True, check=False)
        return run.returncode, run.stderr


def main():
    root, clang, eigen = sys.argv[1:]
    sources = [str(f.relative_to(root)) for folder in FOLDERS for f in sorted(Path(root, folder).glob("*.cc"))]
    sources += CYCLE
    status, said = effects(root, clang, eigen, "".join(f'#include "{s}"\n' for s in sources))
    if status != 0:
        sys.exit(said)
    status, said = effects(root, clang, eigen, PLANTED)
    if status == 0 or "Deeper" not in said:
        sys.exit(f"a planted call that takes memory was not found: {said}")
    print(f"{len(sources)} files: nothing below Cycle::Step waits, takes memory or throws; a planted call is found")


if __name__ == "__main__":
    main()
