#!/usr/bin/env python3
"""clang-tidy over the real-time side, with the checks of .clang-tidy.

    lint.py ROOT BUILD_DIR          runs it on every source file of FOLDERS
    lint.py ROOT BUILD_DIR --self-test   the checks named in .clang-tidy exist, and a planted error is found
"""
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

# Where a mistake moves the machine. The rest has the compiler's warnings and its tests.
FOLDERS = ["core", "drivers/can", "drivers/cia301", "drivers/cia402", "estimator", "control", "daemon/rt"]


def translation_units(root, build):
    commands = json.loads(Path(build, "compile_commands.json").read_text(encoding="utf-8"))
    wanted = tuple(str(root / folder) + "/" for folder in FOLDERS)
    return sorted({command["file"] for command in commands if command["file"].startswith(wanted)})


def tidy(arguments):
    result = subprocess.run(["clang-tidy", "--quiet", *arguments], capture_output=True, text=True, check=False)
    # Counts of suppressed warnings of other people's headers go to stderr; findings and parse errors to stdout.
    return result.returncode, result.stdout.strip() or (result.stderr.strip() if result.returncode else "")


def lint(root, build):
    files = translation_units(root, build)
    if not files:
        return [f"no source files of {', '.join(FOLDERS)} in {build}/compile_commands.json"]
    # What g++ knows and clang does not must not stop it.
    flags = ["--extra-arg=-Wno-unknown-warning-option"]
    findings = []
    for name in files:
        status, text = tidy(["-p", str(build), *flags, name])
        if status:
            findings.append(text or f"{name}: clang-tidy failed")
    if not findings:
        print(f"clang-tidy is content with {len(files)} files")
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
        planted = Path(folder, "planted.cc")
        planted.write_text("int* Nothing() { return 0; }\n", encoding="utf-8")
        status, found = tidy([f"--config-file={root}/.clang-tidy", str(planted), "--", "-std=c++20"])
        if status == 0 or "modernize-use-nullptr" not in found:
            offences.append(f"a planted error was not found; clang-tidy said: {found!r}")
    if not offences:
        print(f"{len(patterns)} patterns of .clang-tidy match checks; a planted error is found")
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
