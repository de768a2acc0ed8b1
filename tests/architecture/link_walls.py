#!/usr/bin/env python3
"""Keeps the walls at link time: what the real-time libraries must not pull in, and who must not know whom.

    link_walls.py LINKS.json

LINKS.json is written when CMake configures: {"library": {"links": [...], "file": "lib....a"}}.
"""
import json
import re
import subprocess
import sys
from pathlib import Path

REALTIME = ["contour_core", "contour_can", "contour_cia301", "contour_cia402", "contour_estimator", "contour_control",
            "contour_rt"]
FORBIDDEN_LINK = re.compile(r"yaml|lcm|modbus|spdlog|fmt|nlohmann|CLI11|systemd|ceres", re.IGNORECASE)
# Mangled or plain names of what would be called on the far side of the wall.
FORBIDDEN_SYMBOL = re.compile(r"^(_ZNK?4YAML|_ZNK?3lcm|lcm_|modbus_|_ZNK?6spdlog|_ZNK?3fmt|sd_notify|sd_journal)")
# Libraries that may neither link nor refer to each other, in either direction.
STRANGERS = [("contour_estimator", "contour_emulator"), ("contour_control", "contour_emulator"),
             ("contour_estimator", "contour_control"),
             *((analysis, "contour_emulator") for analysis in (
                 "contour_recording", "contour_axis_model", "contour_metrics", "contour_prediction_error", "contour_identification",
                 "contour_diagnosis", "contour_diagnosis_report", "contour_design")),
             ("contour_identification", "contour_diagnosis")]


def closure(links, library):
    """Everything that a library links, directly or not."""
    seen, waiting = set(), list(links[library]["links"])
    while waiting:
        name = waiting.pop()
        if name not in seen:
            seen.add(name)
            waiting += links.get(name, {"links": []})["links"]
    return seen


def symbols(archive, kinds):
    """Names in a static library whose kind, as nm says it, is one of `kinds`."""
    listing = subprocess.run(["nm", "--format=posix", archive], check=True, capture_output=True, text=True).stdout
    words = (line.split() for line in listing.splitlines())
    return {word[0] for word in words if len(word) >= 2 and word[1] in kinds}


def check_links(links):
    for library in REALTIME:
        for name in sorted(closure(links, library)):
            if FORBIDDEN_LINK.search(name):
                yield f"{library} links {name}, which has no place on the real-time side"
    for one, other in STRANGERS:
        for library, stranger in ((one, other), (other, one)):
            if stranger in closure(links, library):
                yield f"{library} links {stranger}"


def check_symbols(links):
    def file_of(library):
        return links[library].get("file")

    for library in filter(file_of, REALTIME):
        for name in sorted(symbols(file_of(library), "U")):
            if FORBIDDEN_SYMBOL.match(name):
                yield f"{library} refers to {name}"
    for one, other in STRANGERS:
        for library, stranger in ((one, other), (other, one)):
            # Strong definitions only: inline functions of core are in both.
            for name in sorted(symbols(file_of(library), "U") & symbols(file_of(stranger), "TDBR")):
                yield f"{library} refers to {name} of {stranger}"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    links = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    wanted = set(REALTIME) | {name for pair in STRANGERS for name in pair}
    offences = [f"there is no library {name}" for name in sorted(wanted - links.keys())]
    if not offences:
        offences = [*check_links(links), *check_symbols(links)]
    print("\n".join(offences) or f"{len(links)} libraries keep the walls")
    sys.exit(1 if offences else 0)


if __name__ == "__main__":
    main()
