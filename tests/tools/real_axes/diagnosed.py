"""`contour diagnose`, default options, on a real log cut to what it may see."""
import json
import subprocess
import sys
from pathlib import Path

SKIPPED = 77


def data_folder(argument, *files):
    """Where the recordings are; ends with status 77 where they are not: their licence does not let us keep them."""
    folder = Path(argument)
    missing = [name for name in files if not (folder / name).exists()]
    if missing:
        print(f"skipped: no {', '.join(missing)} in {folder}; set CONTOUR_REAL_AXES to where they are (docs/real_axes.md)")
        sys.exit(SKIPPED)
    return folder


def diagnose(contour, log, model, out, *options):
    command = [contour, "diagnose", log, "--model", model, "--out", out, "--threads", "1", *options]
    done = subprocess.run([str(x) for x in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout, json.loads((Path(out) / "diagnose.json").read_text(encoding="utf-8"))


def named(found):
    """Kinds in order, those of a verdict `unexplained` too."""
    return [c["kind"] for c in found["causes"] + found.get("partial_causes", [])]
