#!/usr/bin/env python3
"""Prints runs of `contour simulate` or `contour run --out` as a table, a row per run, a block per program.

    compare_runs.py DIR...
"""
import json
import sys
from pathlib import Path

HEADER = ("controller", "clock", "enc. rms", "enc. peak", "table rms", "table peak", "circ. dev.", "quadrants +X +Y -X -Y",
          "friction x/y")


def number(value):
    return "-" if value is None else f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"


def row(metrics):
    encoder, table = metrics["contour"]["encoder"], metrics["contour"]["table"]
    quadrants = table["quadrant_peak_um"] or [None] * 4
    friction = metrics["friction_estimate_error_rms_N"].values()
    clock = "virtual" if metrics["late_cycles"] is None else "real time"
    return (metrics["controller"], clock, number(encoder["rms_um"]), number(encoder["peak_um"]), number(table["rms_um"]),
            number(table["peak_um"]), number(table["circular_deviation_um"]), " ".join(map(number, quadrants)),
            " / ".join(map(number, friction)))


def table_text(metrics_of_runs):
    """The table of runs given by the contents of their metrics.json."""
    programs = {}
    for metrics in metrics_of_runs:
        programs.setdefault(Path(metrics["program"]).stem, []).append(row(metrics))
    rows = [r for group in programs.values() for r in group]
    widths = [max(len(r[i]) for r in [HEADER, *rows]) for i in range(len(HEADER))]

    def line(cells):
        padded = [c.ljust(w) if i < 2 else c.rjust(w) for i, (c, w) in enumerate(zip(cells, widths))]
        return "  ".join(padded).rstrip()

    lines = []
    for program, group in programs.items():
        lines += [f"{program}: contour errors in um, friction estimate error (rms) in N", line(HEADER),
                  "  ".join("-" * w for w in widths), *map(line, group), ""]
    return "\n".join(lines).rstrip()


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__.strip())
        return 0 if len(sys.argv) > 1 else 2
    try:
        contents = [json.loads((Path(d) / "metrics.json").read_text(encoding="utf-8")) for d in sys.argv[1:]]
    except (OSError, ValueError) as error:
        print(f"compare_runs.py: {error}", file=sys.stderr)
        return 2
    print(table_text(contents))
    return 0


if __name__ == "__main__":
    sys.exit(main())
