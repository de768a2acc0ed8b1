#!/usr/bin/env python3
"""The loops with CONTOUR_WIDE_VECTORS give the same bits translated for the baseline and for AVX2: two programs, one of which
has the baseline only, print the same.

    vector_bits.py BASELINE_PROBE PROBE
"""
import subprocess
import sys
from pathlib import Path

SKIPPED = 77

if " avx2 " not in Path("/proc/cpuinfo").read_text():
    print("SKIPPED: this processor has no AVX2")
    sys.exit(SKIPPED)
said = [subprocess.run([program], capture_output=True, text=True, check=True).stdout for program in sys.argv[1:3]]
print(*said, sep="\n")
if said[0] != said[1] or "digest" not in said[0]:
    sys.exit("the baseline and AVX2 differ")
