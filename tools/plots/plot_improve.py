#!/usr/bin/env python3
"""Draws what `contour improve` left in its report.

    plot_improve.py DIR

DIR holds improve.json and path_before.csv, path_after.csv, check_before.csv, check_after.csv. Writes path.png, check.png (distance
from the path over time, before and after), passes.png (largest error of each pass) and report.html, one page with all of them.
Prints the files it wrote, one per line.
"""
import argparse
import base64
import csv
import html
import json
import math
import sys
from pathlib import Path

from style import COMPENSATED, PLAIN, QUIET, apply

PLACES = {"scale": "at the scale", "believed_table": "at the encoder less the screw's wind-up", "encoder": "at the encoder",
          "truth": "true place of the table"}


def read(file):
    """Time, and per axis reference, encoder, scale."""
    with file.open(encoding="utf-8", newline="") as text:
        rows = list(csv.reader(text))
    axes = [name[:-len("_reference_m")] for name in rows[0] if name.endswith("_reference_m")]
    times, references, places = [], [], []
    for row in rows[1:]:
        values = [float(v) if v else math.nan for v in row]
        times.append(values[0])
        references.append([values[1 + 3 * i] for i in range(len(axes))])
        places.append([values[2 + 3 * i] for i in range(len(axes))])
    return times, references, places


def across(references, places):
    """Signed distance from the path, um: across the way the reference goes; on one axis the following error."""
    errors = []
    for k, (reference, place) in enumerate(zip(references, places)):
        off = [p - r for p, r in zip(place, reference)]
        if len(off) == 1:
            errors.append(1e6 * off[0])
            continue
        before, after = references[max(k - 1, 0)], references[min(k + 1, len(references) - 1)]
        way = [a - b for a, b in zip(after, before)]
        length = math.hypot(*way)
        if length == 0:
            errors.append(math.nan)
            continue
        along = sum(o * w for o, w in zip(off, way)) / length
        rest = [o - along * w / length for o, w in zip(off, way)]
        side = 1 if len(off) != 2 or way[0] * rest[1] - way[1] * rest[0] <= 0 else -1
        errors.append(1e6 * side * math.hypot(*rest))
    return errors


def draw_program(pyplot, folder, name, title):
    figure, pane = pyplot.subplots(figsize=(10, 3.6))
    for when, colour in (("before", PLAIN), ("after", COMPENSATED)):
        file = folder / f"{name}_{when}.csv"
        if file.exists():
            times, references, places = read(file)
            pane.plot(times, across(references, places), color=colour, linewidth=0.8, label=when)
    pane.set_xlabel("time (s)")
    pane.set_ylabel("off the path at the encoder (um)")
    pane.set_title(title)
    pane.legend()
    figure.savefig(folder / f"{name}.png")
    return f"{name}.png"


def draw_passes(pyplot, folder, data):
    figure, panes = pyplot.subplots(1, 2, figsize=(10, 3.6), sharey=False)
    place = data["compared_at"]
    for pane, name in zip(panes, ("path", "check")):
        for when, colour in (("before", PLAIN), ("after", COMPENSATED)):
            if when in data:
                peaks = data[when][name][place]["peak_um"]
                pane.plot(range(len(peaks)), peaks, "o-", color=colour, label=when)
        pane.axvspan(-0.4, 0.4, color=QUIET, alpha=0.2)
        pane.set_xlabel("pass (0: estimators settle)")
        pane.set_ylabel("largest error (um)")
        pane.set_ylim(bottom=0)
        pane.set_title(data[name])
        pane.legend()
    figure.suptitle(PLACES[place])
    figure.savefig(folder / "passes.png")
    return "passes.png"


def write_page(folder, data, pictures):
    found = data["diagnosed"][-1]["diagnosis"]["causes"] if data.get("diagnosed") else []
    kinds = ", ".join(cause["kind"] for cause in found) or "nothing"
    lines = [f"<p>Found: {html.escape(kinds)}. {'Kept' if data['kept'] else 'Not kept'}: {html.escape(data['why'])}.</p>",
             f"<p>Machine time: {data['machine_time_s']:.0f} s.</p>"]
    for picture in pictures:
        code = base64.b64encode((folder / picture).read_bytes()).decode()
        lines.append(f'<img src="data:image/png;base64,{code}" alt="{picture}">')
    title = f"Axis {html.escape(data['axis'])}: the model before and after"
    page = f"<!doctype html><html lang=en><meta charset=utf-8><title>{title}</title><h1>{title}</h1>{''.join(lines)}</html>\n"
    (folder / "report.html").write_text(page, encoding="utf-8")
    return "report.html"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    try:
        data = json.loads((folder / "improve.json").read_text(encoding="utf-8"))
    except OSError as problem:
        sys.exit(str(problem))
    apply()
    from matplotlib import pyplot
    pictures = [draw_passes(pyplot, folder, data)]
    for name in ("path", "check"):
        pictures.append(draw_program(pyplot, folder, name, data[name]))
    for file in (*pictures, write_page(folder, data, pictures)):
        print(folder / file)


if __name__ == "__main__":
    main()
