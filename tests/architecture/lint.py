#!/usr/bin/env python3
"""clang-tidy over the real-time side, with the checks of .clang-tidy.

    lint.py ROOT BUILD_DIR          runs it on every source file of FOLDERS
    lint.py ROOT BUILD_DIR --self-test   the checks named in .clang-tidy exist, and planted errors are found
"""
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "cmake"))
sys.dont_write_bytecode = True
import unity_groups  # noqa: E402

# Where a mistake moves the machine. The rest has the compiler's warnings and its tests.
FOLDERS = ["core", "drivers/can", "drivers/cia301", "drivers/cia402", "estimator", "control", "daemon/rt"]
# Files that are read together are headers to clang-tidy.
LINES_OF_ALL = r"--header-filter=/(core|drivers|estimator|control|config|daemon|tools)/.*\.(h|cc)$"


def translation_units(root, build):
    commands = json.loads(Path(build, "compile_commands.json").read_text(encoding="utf-8"))
    wanted = tuple(str(root / folder) + "/" for folder in FOLDERS)
    return {command["file"]: command for command in reversed(commands) if command["file"].startswith(wanted)}


def tidy(arguments):
    result = subprocess.run(["clang-tidy", "--quiet", *arguments], capture_output=True, text=True, check=False)
    # Counts of suppressed warnings of other people's headers go to stderr; findings and parse errors to stdout.
    return result.returncode, result.stdout.strip() or (result.stderr.strip() if result.returncode else "")


def read_as(source, unit, scratch, checks):
    """clang-tidy over a file in place of the unit whose command says how to compile it."""
    entry = dict(unit, file=str(source))
    entry["command"] = entry["command"].replace(f"-c {unit['file']}", f"-c {source}")
    Path(scratch, "compile_commands.json").write_text(json.dumps([entry]), encoding="utf-8")
    # What g++ knows and clang does not must not stop it; nor must functions with variants for vectors that were called before.
    extra = ["--extra-arg=-Wno-unknown-warning-option", "--extra-arg=-DCONTOUR_BASELINE_VECTORS"]
    return tidy([f"--checks={checks}", "-p", scratch, *extra, LINES_OF_ALL, str(source)])


def seeing_most(units):
    """The unit whose compiler looks for headers in the most places."""
    return max((units[name] for name in sorted(units)), key=lambda unit: unit["command"].count("-isystem"))


def without(text, names):
    """What clang-tidy said, less what it said of these files."""
    said = re.split(r"^(?=\S+?:\d+:\d+: (?:error|warning))", text, flags=re.MULTILINE)
    return "".join(part for part in said if part.partition(":")[0] not in names).strip()


def lint_together(root, units, scratch):
    """Findings of all files, read as one, and which these were: most of the time goes into headers, which are the same for all.

    Files whose own names collide with another's, or that do not compile behind another, are read in a further round; what was
    found in the rest is as true beside them, unless the compiler gave up.
    """
    findings, read, waiting = [], set(), sorted(units)
    while waiting:
        together, later = waiting, []
        while True:
            source = Path(scratch, "together.cc")
            source.write_text(unity_groups.text_of([unity_groups.Source(name) for name in together], root), encoding="utf-8")
            unit = seeing_most({name: units[name] for name in together})
            status, text = read_as(source, unit, scratch, "-bugprone-suspicious-include")
            blamed = set(re.findall(r"^(\S+?):\d+:\d+: error: .*\[clang-diagnostic-", text, re.MULTILINE)) if status else set()
            colliding = blamed & set(together[1:])
            together, later = [name for name in together if name not in colliding], later + sorted(colliding)
            text = without(text, colliding)
            if not colliding or "fatal error" not in text and "too many errors" not in text:
                break
        if text or status and not colliding:
            findings.append(text or "clang-tidy failed")
        read |= set(together)
        waiting = later
    return findings, read


def lint(root, build):
    units = translation_units(root, build)
    if not units:
        return [f"no source files of {', '.join(FOLDERS)} in {build}/compile_commands.json"]
    with tempfile.TemporaryDirectory() as scratch:
        Path(scratch, ".clang-tidy").write_text((root / ".clang-tidy").read_text(encoding="utf-8"), encoding="utf-8")
        findings, read = lint_together(root, units, scratch)
    findings += [f"{name}: not read" for name in sorted(set(units) - read)]
    if not findings:
        print(f"clang-tidy is content with {len(units)} files")
    return findings


def self_test(root):
    text = (root / ".clang-tidy").read_text(encoding="utf-8")
    patterns = re.search(r"Checks: >\n((?:  .*\n)+)", text).group(1).replace(",", " ").split()
    offences = []
    for pattern in patterns:
        listing = tidy([f"--checks=-*,{pattern.lstrip('-')}", "--list-checks"])[1] if pattern != "-*" else "all"
        if not re.search(r"^    \S|^all$", listing, re.MULTILINE):
            offences.append(f".clang-tidy: {pattern} matches no check")
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, ".clang-tidy").write_text(text, encoding="utf-8")
        sources = {"a.cc": "namespace { int One() { return 1; } }\nint A() { return One(); }\n",
                   "b.cc": "namespace { int One() { return 2; } }\nint* B() { return One() ? 0 : nullptr; }\n",
                   "c.cc": "int* C() { return 0; }\n",
                   "d.cc": "namespace {\nint Two() { return 1; }\n}  // namespace\nint D() { return Two(); }\n",
                   "e.cc": "namespace {\nint Two() { return 2; }\n}  // namespace\nint* E() { return Two() ? 0 : nullptr; }\n",
                   "f.cc": "int* F() { return 0; }\n"}
        units = {}
        for name, source in sources.items():
            path = Path(folder, "core", name)
            path.parent.mkdir(exist_ok=True)
            path.write_text(source, encoding="utf-8")
            units[str(path)] = {"directory": folder, "file": str(path), "command": f"c++ -std=c++20 -c {path}"}
        found = "\n".join(lint_together(Path(folder), units, folder)[0])
        for name in ("b.cc:2", "c.cc:1", "e.cc:4", "f.cc:1"):
            if not re.search(rf"{re.escape(name)}:.*modernize-use-nullptr", found):
                offences.append(f"the error planted in {name} was not found; clang-tidy said: {found!r}")
        if "redefinition" in found:
            offences.append(f"files whose names collide were read together: {found!r}")
    if not offences:
        print(f"{len(patterns)} patterns of .clang-tidy match checks; planted errors are found")
    return offences


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    root, build = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    offences = self_test(root) if "--self-test" in sys.argv else lint(root, build)
    print("\n".join(offences))
    sys.exit(1 if offences else 0)


if __name__ == "__main__":
    main()
