#!/usr/bin/env python3
"""Every C++ file of ours reads as clang-format writes it.

    format_check.py ROOT

Changes nothing; `clang-format -i FILE` mends what it names.
"""
import subprocess
import sys
from pathlib import Path

FOLDERS = ["core", "drivers", "estimator", "control", "config", "daemon", "analysis", "design", "tools", "tests"]


def sources(root):
    """Our C++ files: those git knows, or all when this is no clone."""
    listing = subprocess.run(["git", "-C", root, "ls-files", *FOLDERS], capture_output=True, text=True, check=False)
    names = [Path(root, line) for line in listing.stdout.splitlines()]
    if listing.returncode != 0:
        names = [path for folder in FOLDERS for path in Path(root, folder).rglob("*")]
    return sorted(path for path in names if path.suffix in (".h", ".cc") and path.exists())


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    files = sources(sys.argv[1])
    result = subprocess.run(["clang-format", "--dry-run", "-Werror", "--ferror-limit=1", *files], capture_output=True,
                            text=True, check=False)
    offenders = [line for line in result.stderr.splitlines() if ": error:" in line]
    print("\n".join(offenders) or result.stderr or f"{len(files)} files are as clang-format writes them")
    sys.exit(1 if result.returncode != 0 or not files else 0)


if __name__ == "__main__":
    main()
