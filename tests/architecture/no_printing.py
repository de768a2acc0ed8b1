#!/usr/bin/env python3
"""Libraries print nothing: what users are to see goes through a result, an error or the log.

    no_printing.py ROOT
    no_printing.py --self-test

Prints every offence as file:line and ends with 1 if there is one.
"""
import re
import sys
from pathlib import Path

LIBRARIES = ["core", "drivers", "estimator", "control", "config", "daemon", "analysis"]
PROGRAMS = {"daemon/main.cc"}
PRINTS = re.compile(r"\b(?:printf|fprintf|puts|fputs|putchar|perror)\s*\(|\bstd::(?:cout|cerr|clog)\b")


def prints(line):
    return PRINTS.search(line.split("//")[0]) is not None


def offences(root):
    for library in LIBRARIES:
        for file in sorted((root / library).rglob("*")):
            name = file.relative_to(root).as_posix()
            if file.suffix not in {".cc", ".h"} or name in PROGRAMS:
                continue
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                if prints(line):
                    yield f"{name}:{number}: {line.strip()}"


def self_test():
    assert prints('  std::fprintf(stderr, "now %g\\n", now);')
    assert prints("std::cerr << x;") and prints('puts("x");')
    assert not prints("std::snprintf(text.data(), text.size(), format);")
    assert not prints("return 0;  // printf() would be wrong here")


if __name__ == "__main__":
    if sys.argv[1] == "--self-test":
        self_test()
    else:
        found = list(offences(Path(sys.argv[1])))
        print("\n".join(found))
        sys.exit(1 if found else 0)
