#!/usr/bin/env python3
"""Judges an archive of recorded cases with two builds of contour and says what differs.

    compare_diagnoses.py ARCHIVE OLD NEW [--only PATTERN]... [--keep FOLDER] [--within REL] [--jobs N]

ARCHIVE is a folder of cases as `contour_hidden --record ARCHIVE --compact` writes them: each has log.csv and model.yaml. OLD and
NEW are programs `contour`. For every case both diagnose the log, and diagnose.json must be equal byte by byte, or, with --within,
in every word and within REL in every number. What OLD found is kept in FOLDER and not made again, which saves half of the time
of the next comparison; FOLDER must be emptied when OLD changes. Prints the cases that differ, key by key, and the processor
time of NEW over that of OLD. Ends with 0 when nothing differs, 1 when something does, 2 for bad usage.
"""
import argparse
import concurrent.futures
import fnmatch
import json
import math
import os
import sys
import tempfile
from pathlib import Path


def cases_in(archive, patterns):
    names = sorted(p.parent.name for p in archive.glob("*/log.csv") if (p.parent / "model.yaml").exists())
    return [n for n in names if not patterns or any(fnmatch.fnmatch(n, p) for p in patterns)]


def diagnose(program, case, result):
    """Runs one diagnosis; its processor time goes beside the result. A failure is a result, too: its text."""
    command = [program, "diagnose", case / "log.csv", "--model", case / "model.yaml", "--threads", "1", "--json", result]
    pid = os.posix_spawn(program, [str(word) for word in command], os.environ, file_actions=[
        (os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0),
        (os.POSIX_SPAWN_OPEN, 2, f"{result}.err", os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)])
    _, status, usage = os.wait4(pid, 0)
    code = os.waitstatus_to_exitcode(status)
    if code != 0:
        said = Path(f"{result}.err").read_text(encoding="utf-8")
        Path(result).write_text(json.dumps({"failed": code, "error": said}), encoding="utf-8")
    Path(f"{result}.time").write_text(f"{usage.ru_utime + usage.ru_stime:.3f}", encoding="utf-8")


def differences(old, new, within, where=""):
    """Pairs that are not equal, as text, key by key."""
    if isinstance(old, dict) and isinstance(new, dict):
        for key in sorted(old.keys() | new.keys()):
            place = f"{where}.{key}" if where else key
            if key not in old or key not in new:
                yield f"{place}: only in {'old' if key in old else 'new'}"
            else:
                yield from differences(old[key], new[key], within, place)
    elif isinstance(old, list) and isinstance(new, list):
        if len(old) != len(new):
            yield f"{where}: {len(old)} elements, now {len(new)}"
        for i, (a, b) in enumerate(zip(old, new)):
            yield from differences(a, b, within, f"{where}[{i}]")
    elif is_number(old) and is_number(new):
        if not math.isclose(old, new, rel_tol=within, abs_tol=0.0):
            yield f"{where}: {old!r}, now {new!r}"
    elif old != new:
        yield f"{where}: {old!r}, now {new!r}"


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def compared(name, old_result, new_result, within):
    """What differs in one case, as text."""
    old_text, new_text = old_result.read_text(encoding="utf-8"), new_result.read_text(encoding="utf-8")
    if old_text == new_text:
        return []
    found = list(differences(json.loads(old_text), json.loads(new_text), within))
    if not found and within == 0.0:
        found = ["equal in every value, but written differently"]
    return [f"{name}: {f}" for f in found]


def run_case(options, keep, scratch, name):
    case = options.archive / name
    old_result, new_result = keep / f"{name}.json", scratch / f"{name}.json"
    if not Path(f"{old_result}.time").exists():
        diagnose(options.old, case, old_result)
    diagnose(options.new, case, new_result)
    seconds = [float(Path(f"{r}.time").read_text(encoding="utf-8")) for r in (old_result, new_result)]
    return compared(name, old_result, new_result, options.within), seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("archive", type=Path)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--within", type=float, default=0.0)
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    names = cases_in(options.archive, options.only)
    if not names:
        parser.error(f"{options.archive}: no case with log.csv and model.yaml")
    with tempfile.TemporaryDirectory() as folder:
        scratch = Path(folder)
        keep = options.keep or scratch / "old"
        keep.mkdir(parents=True, exist_ok=True)
        total, differing = [0.0, 0.0], 0
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            for found, seconds in pool.map(lambda name: run_case(options, keep, scratch, name), names):
                total = [a + b for a, b in zip(total, seconds)]
                differing += bool(found)
                if found:
                    print("\n".join(found), flush=True)
    print(f"{len(names)} cases, {differing} differ; processor time old {total[0]:.1f} s, new {total[1]:.1f} s, "
          f"ratio {total[1] / total[0] if total[0] else math.nan:.3f}")
    sys.exit(1 if differing else 0)


if __name__ == "__main__":
    main()
