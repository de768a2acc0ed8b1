#!/usr/bin/env python3
"""Checks the units in systemd/: `systemd-analyze verify` finds nothing to say, and the service is as closed as it can be.

    units.py ROOT_OF_REPOSITORY

Ends with 77 (skipped) where systemd-analyze cannot do that.
"""
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

LARGEST_EXPOSURE = 1.8
# What the units start; empty programs do for a check.
PROGRAMS = ["usr/bin/contourd", "usr/bin/contour", "usr/sbin/ip", "usr/sbin/modprobe"]
UNITS = ["contourd.service", "can-up@can0.service", "vcan-up@vcan0.service"]


def analyze(*arguments):
    run = subprocess.run(["systemd-analyze", *arguments], capture_output=True, text=True, check=False)
    return run.returncode, (run.stdout + run.stderr).strip()


def check_verify(source, root):
    """Whatever systemd has to say of the units as installed in a root of their own."""
    units = root / "etc/systemd/system"
    units.mkdir(parents=True)
    for file in source.glob("*.service"):
        shutil.copy(file, units)
    for name in PROGRAMS:
        program = root / name
        program.parent.mkdir(parents=True, exist_ok=True)
        program.write_text("#!/bin/sh\n", encoding="utf-8")
        program.chmod(0o755)
    shutil.copytree("/usr/lib/systemd/system", root / "usr/lib/systemd/system", symlinks=True)
    for unit in UNITS:
        status, said = analyze("verify", "--man=no", "--recursive-errors=no", f"--root={root}", unit)
        # The host's own units are not ours to judge.
        ours = "\n".join(line for line in said.splitlines() if re.search("contourd|can-up|Failed", line))
        if ours or status != 0:
            yield f"verify {unit}: {ours or said}"


def check_exposure(source):
    status, said = analyze("security", "--no-pager", "--offline=true", str(source / "contourd.service"))
    found = re.search(r"exposure level.*?: ([0-9.]+)", said)
    if status != 0 or not found:
        yield f"security: {said[-200:]}"
    elif float(found.group(1)) > LARGEST_EXPOSURE:
        yield f"contourd.service: exposure {found.group(1)}, at most {LARGEST_EXPOSURE} is allowed"
    else:
        print(f"contourd.service: exposure {found.group(1)}")


def check_says(source):
    """What the documentation promises of the service."""
    text = (source / "contourd.service").read_text(encoding="utf-8")
    for line in ["Type=notify", "DynamicUser=yes", "StateDirectory=contourd", "LogsDirectory=contourd",
                 "RuntimeDirectory=contourd", "LimitMEMLOCK=infinity", "CapabilityBoundingSet=", "NoNewPrivileges=yes"]:
        if line not in text.splitlines():
            yield f"contourd.service: lacks {line}"
    for key in ["WatchdogSec", "LimitRTPRIO", "ExecReload"]:
        if not re.search(rf"^{key}=.+", text, re.MULTILINE):
            yield f"contourd.service: lacks {key}"
    if re.search(r"contour (enable|run|reset)", " ".join(re.findall(r"^Exec\w+=(.*)", text, re.MULTILINE))):
        yield "contourd.service: starts motion"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    if not shutil.which("systemd-analyze") or not Path("/usr/lib/systemd/system").is_dir():
        print("no systemd-analyze here")
        sys.exit(77)
    source = Path(sys.argv[1]) / "systemd"
    with tempfile.TemporaryDirectory() as root:
        offences = [*check_verify(source, Path(root)), *check_exposure(source), *check_says(source)]
    print("\n".join(offences) or "the units are sound")
    sys.exit(1 if offences else 0)


if __name__ == "__main__":
    main()
