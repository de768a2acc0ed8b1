#!/usr/bin/env python3
"""Every unit of analysis/ has a test beside it: analysis/A/b.cc is tested by tests/analysis/A/b_test.cc.

    unit_tests.py ROOT

The test must be there and hold a TEST, and every test of the tree must be named in the CMakeLists.txt of its folder or of the one above. Prints
what is not so and ends with 1 if there is anything. WITHOUT has those that have none yet, as files or as folders (with a / at the end): what has got its tests, or is
gone, must leave the list.
"""
import re
import sys
from pathlib import Path

# Translations of one set of loops for several instruction sets have one test.
SHARED = {f"analysis/prediction_error/simd/lane_run_{name}.cc": "tests/analysis/prediction_error/simd/lane_loops_test.cc"
          for name in ("avx2", "avx512", "baseline")}
SHARED |= {f"analysis/identification/simd/axis_lanes_{name}.cc": "tests/analysis/identification/simd/axis_loops_test.cc"
           for name in ("avx2", "baseline")}
WITHOUT = set()


def test_of(unit, shared):
    name = unit.as_posix()
    return Path(shared.get(name) or f"tests/{name.removesuffix('.cc')}_test.cc")


def why_untested(root, test):
    if not (root / test).is_file():
        return f"has no test {test}"
    if not re.search(r"^TEST(_[FP])?\(", (root / test).read_text(encoding="utf-8"), re.MULTILINE):
        return f"has a test without TEST: {test}"
    return ""


def built(root, test):
    return any(test.stem in (root / folder / "CMakeLists.txt").read_text(encoding="utf-8")
               for folder in (test.parent, test.parent.parent) if (root / folder / "CMakeLists.txt").is_file())


def check(root, without=None, shared=None):
    """Offences, as text, and how many units there are."""
    without = WITHOUT if without is None else without
    shared = SHARED if shared is None else shared
    units = sorted(p.relative_to(root) for p in (root / "analysis").rglob("*.cc"))
    offences = []
    untested = set()
    for unit in units:
        why = why_untested(root, test_of(unit, shared))
        if not why:
            continue
        listed = {w for w in without if unit.as_posix() == w or w.endswith("/") and unit.as_posix().startswith(w)}
        untested |= listed
        if not listed:
            offences.append(f"{unit}: {why}")
    offences += [f"{test.relative_to(root)}: no CMakeLists.txt builds it" for test in sorted((root / "tests").rglob("*_test.cc"))
                 if not built(root, test.relative_to(root))]
    offences += [f"{name}: has its tests or is gone, and must leave WITHOUT" for name in sorted(without - untested)]
    return offences, len(units)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    offences, units = check(Path(sys.argv[1]))
    print("\n".join(offences) if offences else f"{units} units; not looked at: {', '.join(sorted(WITHOUT)) or 'none'}")
    sys.exit(1 if offences else 0)


if __name__ == "__main__":
    main()
