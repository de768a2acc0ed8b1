#!/usr/bin/env python3
"""docs/configuration_keys.md says what the program says.

    configuration_keys.py CONTOUR ROOT           compares
    configuration_keys.py CONTOUR ROOT --write   writes it anew
"""
import difflib
import subprocess
import sys
from pathlib import Path


def main():
    contour, root = sys.argv[1], Path(sys.argv[2])
    manual = root / "docs" / "configuration_keys.md"
    says = subprocess.run([contour, "check", "--markdown"], capture_output=True, text=True, check=True).stdout
    if "--write" in sys.argv:
        manual.write_text(says, encoding="utf-8")
        return
    held = manual.read_text(encoding="utf-8")
    if held == says:
        return
    sys.stdout.writelines(difflib.unified_diff(held.splitlines(True), says.splitlines(True), str(manual), "contour check --markdown"))
    sys.exit(f"mend it: {contour} check --markdown > docs/configuration_keys.md")


if __name__ == "__main__":
    main()
