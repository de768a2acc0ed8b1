#!/usr/bin/env python3
"""Our reader of G-code and LinuxCNC's, on random programs: the same canonical moves to a nanometre, and the same lines refused.

    gcode_agrees.py CONTOUR [COUNT [SEED]]

Skipped (77) where LinuxCNC (Debian package linuxcnc-uspace) is not installed.
"""
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from interpreters import EVENTS, by_module, by_program, tool_table
from random_programs import programs

NANOMETRE = 1e-6    # in mm
PRINTED = 4 * 25.4e-4  # rs274 prints positions and offsets to 1e-4 inch
FEED = 1e-9         # relative


def ours(contour, program, tools):
    """(moves, line of the error or None, its text)."""
    done = subprocess.run([contour, "check", "--no-block-delete", "--tool-table", str(tools), "--canon", str(program)], capture_output=True, text=True, timeout=60)
    if done.returncode == 2:
        message = done.stderr.strip().splitlines()[-1]
        place = message.split(str(program) + ":", 1)[1].split(":")
        assert place[1].isdigit(), f"no column: {message}"
        return [], int(place[0]), message
    assert done.returncode == 0, done.stderr
    return [read(line) for line in done.stdout.splitlines()], None, ""


def read(line):
    words = line.split()
    move = {"line": int(words[0]), "move": words[1]}
    if move["move"] == "DWELL":
        move["seconds"] = float(words[2][1:])
    elif move["move"] == "EVENT":
        move["name"] = words[2]
    else:
        move["to"] = [float(w[1:]) for w in words[2:8]]
        move["feed"] = next((float(w[1:]) for w in words[8:] if w[0] == "F"), None)
        if move["move"] == "ARC_FEED":
            move["plane"] = words[8]
            move["centre"] = [float(words[10]), float(words[11])]
            move["turns"] = int(words[13])
    return move


def near(a, b, tolerance):
    return all(abs(x - y) <= tolerance for x, y in zip(a, b))


def difference(mine, other, tolerance, axes):
    """What differs between two moves, or nothing."""
    if mine["move"] != other["move"]:
        return "another move"
    if mine["move"] == "DWELL":
        return "" if abs(mine["seconds"] - other["seconds"]) <= 1e-4 else "seconds"
    if mine["move"] == "EVENT":
        return "" if mine["name"] == other["name"] else "another event"
    if not near(mine["to"][:axes], other["to"][:axes], tolerance):
        return "where it ends"
    if other["feed"] is not None and abs(mine["feed"] - other["feed"]) > FEED * other["feed"] + (1e-9 if axes == 6 else PRINTED):
        return "feed"
    if mine["move"] == "ARC_FEED":
        if not near(mine["centre"], other["centre"], tolerance):
            return "centre"
        if mine["turns"] != other["turns"] or mine["plane"] != other["plane"]:
            return "turns or plane"
    return ""


def compare(mine, theirs, tolerance, axes):
    for k, (m, t) in enumerate(zip(mine, theirs)):
        what = difference(m, t, tolerance, axes)
        if what:
            return f"move {k}: {what}\n  ours:     {m}\n  LinuxCNC: {t}"
    if len(mine) != len(theirs):
        return f"{len(mine)} moves, LinuxCNC {len(theirs)}"
    return ""


def has_uvw(text):
    return any(letter in text.lower() for letter in "uvw")


def check(gcode, contour, program, tools, scratch):
    """(what is wrong or nothing, whether both refuse the program, moves compared)"""
    text = program.read_text()
    moves, line, message = ours(contour, program, tools)
    printed, refused = ([], None) if has_uvw(text) else by_program(program, scratch)
    by = by_module(gcode, program, scratch)
    if by is None:
        return "", False, 0  # LinuxCNC crashed
    theirs, their_line, their_message = by
    if (line is None) != (their_line is None):
        return f"{message or 'we take it'}; LinuxCNC: {their_message or 'takes it'} (line {their_line})", False, 0
    if line is not None:
        here = text.splitlines()[line - 1].strip()
        same = here == refused if refused else their_line - line in (0, 1)
        return "" if same else f"{message}\n  LinuxCNC refuses line {their_line} ({their_message}): {refused}", same, 0
    wrong = compare([m for m in moves if m["move"] != "EVENT"], theirs, NANOMETRE, 6)
    if not wrong and not has_uvw(text) and printed is not None:
        heard = [m for m in moves if m["move"] != "EVENT" or m["name"] in EVENTS.values()]
        wrong = f"rs274 refuses {refused}" if refused else compare(heard, printed, PRINTED, 3)
    return wrong, False, len(theirs)


def main():
    contour = sys.argv[1]
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 200
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 19
    try:
        import gcode
    except ImportError:
        gcode = None
    if gcode is None or shutil.which("rs274") is None:
        print("skipped: LinuxCNC's interpreter is not installed (Debian package linuxcnc-uspace)")
        return 77
    failed = refused = moves = 0
    with tempfile.TemporaryDirectory() as scratch:
        tools = Path(scratch) / "lengths.tbl"
        tools.write_text(tool_table(1.0))
        for number, text in programs(count, seed):
            program = Path(scratch) / f"random_{number}.ngc"
            program.write_bytes(text.encode())
            wrong, both_refuse, compared = check(gcode, contour, program, tools, scratch)
            refused += both_refuse
            moves += compared
            if wrong:
                failed += 1
                print(f"program {number} of seed {seed}: {wrong}\n{text}")
    print(f"{count} programs, {refused} refused by both in the same line, {moves} moves compared, {failed} programs differ")
    return 1 if failed or moves == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
