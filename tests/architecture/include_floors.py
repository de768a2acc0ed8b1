#!/usr/bin/env python3
"""Keeps the floors of the house: each folder includes only what lies below it.

    include_floors.py ROOT

Prints every offence as file:line and ends with 1 if there is one.
"""
import re
import sys
from pathlib import Path

# A folder, and the folders it may include besides itself. The longest matching folder counts.
RT_DRIVERS = ["drivers/can", "drivers/cia301", "drivers/cia402"]
FLOOR_1 = ["core", "drivers", "estimator", "control"]
BELOW_ANALYSIS = [*FLOOR_1, "config", "daemon"]
SIMULATED = ["tools/plant_emulator", "tools/machine", "tools/simulate"]
# The floors of analysis/, lowest first.
MODEL = ["analysis/recording", "analysis/axis_model"]
PREDICTION = [*MODEL, "analysis/prediction_error", "analysis/prediction_error/simd"]
DIAGNOSIS = ["tuning", "result", "causes", "screening", "adequacy", "decision", "quantification"]


def diagnosis_floors(names):
    return [f"analysis/diagnosis/{name}" for name in names]


ANALYSIS = {
    "analysis/text": [],
    "analysis/parallel": [],
    "analysis/recording": BELOW_ANALYSIS,
    "analysis/drive_loop": ["core"],
    "analysis/metrics": BELOW_ANALYSIS,
    "analysis/axis_model": ["core", "estimator", "config"],
    "analysis/circle_test": ["core", "estimator", "config"],
    "analysis/prediction_error/simd": [],
    "analysis/prediction_error": ["analysis/parallel", *PREDICTION, "analysis/diagnosis/tuning"],
    "analysis/rough_fit": ["config", *PREDICTION],
    "analysis/identification/simd": ["analysis/prediction_error/simd"],
    "analysis/identification": ["core", "config", "estimator", "analysis/parallel", "analysis/text",
                                "analysis/identification/simd", *PREDICTION],
    "analysis/diagnosis/result": [*MODEL, "analysis/diagnosis/tuning"],
    "analysis/diagnosis/tuning": [],
    "analysis/diagnosis/causes": ["config", "estimator", *PREDICTION, *diagnosis_floors(["result", "tuning"])],
    **{f"analysis/diagnosis/{name}": ["config", *PREDICTION, *diagnosis_floors(DIAGNOSIS[:i])]
       for i, name in enumerate(DIAGNOSIS) if i >= DIAGNOSIS.index("screening")},
    "analysis/diagnosis": ["config", *PREDICTION, *diagnosis_floors(DIAGNOSIS)],
    "analysis/diagnosis/report": ["core", "config", "estimator", *MODEL, *diagnosis_floors(["result", "tuning", "causes"])],
}
MAY_INCLUDE = {
    # floor 0: plain data
    "core": [],
    # floor 1: the wire, belief, decision; blind to each other
    "drivers": ["core"],
    "drivers/can": ["core"],
    "drivers/cia301": ["core", "drivers/can"],
    "drivers/cia402": ["core", "drivers/can", "drivers/cia301"],
    "estimator": ["core"],
    "control": ["core"],
    # floor 2: the cycle, and YAML into the config structs of floor 1
    "daemon/rt": ["core", *RT_DRIVERS, "estimator", "control"],
    "config": FLOOR_1,
    # floor 3
    "daemon": [*FLOOR_1, "daemon/rt", "config"],
    # What works on recorded data. It does not know the emulated machine, nor the machine it.
    **ANALYSIS,
    # What is designed offline
    "design": [*BELOW_ANALYSIS, "analysis"],
    # The emulated machine shares no code with the estimator it is to test, nor with what judges its recordings.
    "tools/plant_emulator": ["core", "drivers", "config"],
    "tools/machine": ["core", "drivers", "config", "design", "tools/plant_emulator"],
    "tools/doctor": ["core"],
    "tools/replay": [*BELOW_ANALYSIS, "design"],
    "tools/simulate": [*BELOW_ANALYSIS, "analysis/metrics", "tools/plant_emulator", "tools/machine"],
    "tools/faults": [*BELOW_ANALYSIS, "analysis/parallel", *SIMULATED],
    # Each way of validation is blind to the others.
    "tools/validation/contest": [*BELOW_ANALYSIS, "analysis/metrics", "design", *SIMULATED],
    "tools/validation/emps": [*BELOW_ANALYSIS, "analysis"],
    # The family has the contest's way with assignments and costs.
    "tools/validation/family": [*BELOW_ANALYSIS, "analysis", "design", "tools/validation/contest", *SIMULATED],
    "tools/validation/hidden": [*BELOW_ANALYSIS, "analysis", *SIMULATED],
    "tools/validation/commissioning": [*BELOW_ANALYSIS, "analysis", "design", *SIMULATED],
    "tools/contour_gain": [*BELOW_ANALYSIS, "analysis", "tools/validation/contest", *SIMULATED],
    # What improving a model on the running machine decides; it does not know the machine it runs on.
    "tools/improve": [*BELOW_ANALYSIS, "analysis", "design"],
    # The programs know everything.
    "tools/bench": [*BELOW_ANALYSIS, *SIMULATED],
    "tools/contour": [*BELOW_ANALYSIS, "analysis", "design", "tools"],
    "tests": [*BELOW_ANALYSIS, "analysis", "design", "tools"],
}
# The daemon's program joins the parts: these files alone know the emulated machine, for the bus `loopback`.
EMULATED_MACHINE = ["tools/plant_emulator", "tools/machine"]
PROGRAM_FILES = ["daemon/main.cc", "daemon/daemon.cc", "daemon/machine_buses.cc", "daemon/machine_buses.h", "daemon/start_file.cc",
                 "daemon/start_file.h", "daemon/truth_relay.h"]
PROGRAMS_MAY_INCLUDE = {name: EMULATED_MACHINE for name in PROGRAM_FILES}
# A machine file without loops gets them, and those that it has are judged, before the cycle is made.
for program_file in ("daemon/daemon.cc", "daemon/start_file.cc"):
    PROGRAMS_MAY_INCLUDE[program_file] = [*EMULATED_MACHINE, "design"]

# The real-time side: what would allocate, lock, wait or talk stays out.
REALTIME = ["core", *RT_DRIVERS, "estimator", "control", "daemon/rt"]
FORBIDDEN_IN_REALTIME = re.compile(
    r"^(yaml-cpp/|lcm/|modbus|spdlog/|fmt/|nlohmann/|CLI/|systemd/"
    r"|(mutex|shared_mutex|condition_variable|future|iostream|fstream|ostream|print|regex|filesystem)$)")
# Runs once, before the first cycle, and reads what the kernel allows.
SETS_UP_REALTIME = ["daemon/rt/thread_setup.cc"]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
TOP_FOLDERS = {folder.split("/")[0] for folder in MAY_INCLUDE}


def home_of(path):
    """The folder of MAY_INCLUDE that a path lies in, or None."""
    parts = path.split("/")
    for length in range(len(parts) - 1, 0, -1):
        folder = "/".join(parts[:length])
        if folder in MAY_INCLUDE:
            return folder
    return None


def lies_in(path, folder):
    return path.startswith(folder + "/")


def is_allowed(includer, included):
    home = home_of(includer)
    allowed = MAY_INCLUDE[home] + PROGRAMS_MAY_INCLUDE.get(includer, [])
    return home_of(included) == home or any(lies_in(included, folder) for folder in allowed)


def is_realtime(path):
    return path not in SETS_UP_REALTIME and any(lies_in(path, folder) for folder in REALTIME)


def offences_in(root, path):
    name = path.relative_to(root).as_posix()
    if home_of(name) is None:
        yield f"{name}: lies on no floor"
        return
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        match = INCLUDE.match(line)
        if not match:
            continue
        bracket, included = match.groups()
        where = f"{name}:{number}"
        if is_realtime(name) and FORBIDDEN_IN_REALTIME.match(included):
            yield f"{where}: <{included}> has no place on the real-time side"
        if bracket == "<":
            continue
        if included.split("/")[0] not in TOP_FOLDERS:
            yield f'{where}: "{included}" is not written from the root of the repository'
        elif home_of(included) is None:
            yield f'{where}: "{included}" lies on no floor'
        elif not is_allowed(name, included):
            yield f'{where}: {home_of(name)} may not include "{included}"'


def check(root):
    """All offences below root, as text."""
    offences = []
    for top in sorted(TOP_FOLDERS):
        for path in sorted((root / top).rglob("*")):
            if path.suffix in (".h", ".cc", ".hpp", ".cpp", ".c", ".inc"):
                offences += offences_in(root, path)
    return offences


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    root = Path(sys.argv[1]).resolve()
    offences = check(root)
    files = sum(1 for top in TOP_FOLDERS for suffix in ("*.h", "*.cc") for _ in (root / top).rglob(suffix))
    print("\n".join(offences) or f"{files} files keep the floors")
    sys.exit(1 if offences or files == 0 else 0)


if __name__ == "__main__":
    main()
