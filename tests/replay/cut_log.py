#!/usr/bin/env python3
"""A log that was cut short is no success: `contour replay` says so and ends with 1.

    cut_log.py CONTOUR MACHINE_FILE
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path


def main():
    contour, machine = sys.argv[1:]
    with tempfile.TemporaryDirectory() as scratch:
        program, log = Path(scratch, "hold.yaml"), Path(scratch, "run.lcmlog")
        program.write_text("{shape: hold, seconds: 0.5}", encoding="utf-8")
        subprocess.run([contour, "simulate", "--config", machine, "--program", program, "--out", Path(scratch, "out"), "--log", log],
                       check=True, capture_output=True)

        def replay(*options):
            return subprocess.run([contour, "replay", log, *options], capture_output=True, text=True)

        whole = replay()
        assert whole.returncode == 0 and "the same" in whole.stdout, (whole.returncode, whole.stdout, whole.stderr)
        content = log.read_bytes()
        log.write_bytes(content[:len(content) * 2 // 3])
        cut = replay()
        print(cut.stdout)
        assert cut.returncode == 1, (cut.returncode, cut.stdout)
        assert "was not closed" in cut.stdout, cut.stdout
        assert json.loads(replay("--json").stdout)["verdict"] == "cut_short"
        # Tolerance is for measures, not for what is missing.
        assert replay("--tolerance", "0.5").returncode == 1


if __name__ == "__main__":
    main()
