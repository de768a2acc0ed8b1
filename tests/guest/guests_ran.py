#!/usr/bin/env python3
"""Says which tests in guests did not run, from CTest's JUnit file: a green run without them has proved less.

    guests_ran.py RESULTS.xml

Ends with 1 if there is one and CONTOUR_GUESTS_REQUIRED is set to 1, or if the file holds no test at all.
"""
import os
import sys
import xml.etree.ElementTree as ElementTree


def not_run(text):
    """Names of the guests' tests that were skipped or not begun, and how many tests there are."""
    cases = list(ElementTree.fromstring(text).iter("testcase"))
    missing = [c.get("name") for c in cases
               if c.get("name").startswith(("guest.", "guest_rt.")) and (c.get("status") == "notrun" or c.find("skipped") is not None)]
    return missing, len(cases)


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    with open(sys.argv[1], encoding="utf-8") as file:
        missing, count = not_run(file.read())
    if missing:
        print(f"{len(missing)} tests in guests DID NOT RUN:\n  " + "\n  ".join(missing))
    sys.exit(1 if count == 0 or missing and os.environ.get("CONTOUR_GUESTS_REQUIRED") == "1" else 0)


if __name__ == "__main__":
    main()
