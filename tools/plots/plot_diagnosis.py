#!/usr/bin/env python3
"""Draws the report of `contour diagnose --out DIR`: pictures as PNG, and report.html with all of them in it.

    plot_diagnosis.py DIR
"""
import argparse
import base64
import sys
from html import escape
from pathlib import Path

from diagnosis_data import DataError, Finding
from style import apply
import picture_diagnosis

CSS = """body{font-family:system-ui,sans-serif;max-width:62rem;margin:2rem auto;padding:0 1rem;color:#1a1a1a;line-height:1.45}
h1{font-size:1.5rem}h2{font-size:1.15rem;margin-top:2rem}.verdict{font-size:1.2rem;font-weight:600;padding:.8rem 1rem;
background:#eef4fa;border-left:5px solid #0072B2}.cause{border:1px solid #d8d8d8;border-radius:6px;padding:.6rem 1rem;margin:1rem 0}
table{border-collapse:collapse;margin:.5rem 0}td,th{padding:.15rem .8rem .15rem 0;text-align:left;vertical-align:top}
th{border-bottom:1px solid #999}img{max-width:100%}pre{background:#f5f5f5;padding:.6rem;overflow:auto}.quiet{color:#666}"""


NOTHING = 1e-12  # of any quantity here, in its unit: rounding


def number(value, digits=3):
    if value is None:
        return "–"
    return "0" if abs(value) < NOTHING else f"{value:.{digits}g}"


def percent(value):
    return "–" if value is None else f"{100 * value:.0f} %"


def change(gain):
    """A gain in words: a residual that grows is so much more, not less than less."""
    if gain is None:
        return "–"
    return f"{percent(abs(gain))} {'less' if gain >= 0 else 'more'}"


def table(head, rows):
    top = "".join(f"<th>{escape(h)}</th>" for h in head)
    body = "".join("<tr>" + "".join(f"<td>{escape(str(c))}</td>" for c in row) + "</tr>" for row in rows)
    return f"<table><tr>{top}</tr>{body}</table>"


def cause_html(cause, place):
    kind, _, words = cause["words"].partition(": ")
    parts = [f"<div class='cause'><h2>{place}. {'Part of it: ' if cause.get('part_of_it') else ''}{escape(kind.replace('_', ' '))}: {escape(words)}</h2>"]
    parts.append(table(["", "value", "95 % interval"],
                       [[p["name"], p["value"], f"{p['low']} to {p['high']}"] for p in cause["parameters"]]))
    parts.append(f"<p><b>How sure:</b> log evidence {number(cause['evidence'], 4)} nats over the model without it.</p>")
    if cause["before"]:
        parts.append(f"<p><b>What it gains</b> on data that the fit has not seen: residual {number(cause['before'])} to "
                     f"{number(cause['after'])} {escape(cause['unit'])}, {change(cause['gain'])} "
                     f"(95 %: {change(cause['gain_low'])} to {change(cause['gain_high'])}).</p>")
    if cause["indistinguishable_from"]:
        parts.append("<p><b>This log cannot tell it from</b> " + escape(", ".join(cause["indistinguishable_from"])) + ".</p>")
    if cause["experiment"]:
        parts.append(f"<p><b>What would decide:</b> {escape(cause['experiment'])}</p>")
    if cause["program"]:
        parts.append(f"<p>As a program for <code>contour run</code>:</p><pre>{escape(cause['program'])}</pre>")
    parts.append(f"<p><b>What to do next:</b> {escape(cause['advice'])}</p></div>")
    return "".join(parts)


def summary_html(data):
    parts = [f"<h1>Diagnosis of {escape(data['log'])}</h1><p class='quiet'>Model: {escape(data['model'])}</p>",
             f"<p class='verdict'>{escape(data['verdict_text'])}</p>"]
    parts += [cause_html(c, i + 1) for i, c in enumerate(data["causes"])]
    gain = data["contour_gain"]
    if gain:
        less = 1 - gain["after_um"] / gain["before_um"] if gain["before_um"] else None
        parts.append(f"<p><b>What it gains on the path:</b> simulated on {escape(gain['program'])} with the controller full, the table's "
                     f"largest contour error goes from {number(gain['before_um'])} um to {number(gain['after_um'])} um, "
                     f"{change(less)}, once the model is extended.</p>")
    if data["extended_model"]:
        parts.append(f"<p>The model with what was found: <code>{escape(data['extended_model'])}</code></p>")
    q = data["quality"]
    parts.append(f"<p class='quiet'>Data: {q['rows']} rows, {q['missing']} missing, {q['stale']} stale, {q['outliers']} outliers. "
                 f"False-alarm rate asked for: {percent(data['false_alarm_rate'])}.</p>")
    parts += [f"<p class='quiet'>Note: {escape(n)}</p>" for n in data["notes"]]
    return "".join(parts)


def limits_html(data):
    parts = []
    if data["not_excited"]:
        parts.append("<h2>Not tested: this log does not excite it</h2><p>" + escape(", ".join(data["not_excited"]).replace("_", " ")) + "</p>")
    if data["detectable"]:
        parts.append("<h2>Smallest size that would have been found</h2>")
        parts.append(table(["cause", "", "size"], [[d["kind"].replace("_", " "), d["name"], d["size"]] for d in data["detectable"]]))
    if data["base"]:
        parts.append("<h2>The model's own numbers, as fitted</h2>")
        rows = []
        for p in data["base"]:
            moved = (p["fitted"] - p["stated"]) / p["sigma"] if p["sigma"] and p["sigma"] > NOTHING else None
            rows.append([p["name"], number(p["stated"], 4), number(p["fitted"], 4), number(p["sigma"], 2), number(moved, 2)])
        parts.append(table(["", "stated", "fitted", "± 1σ", "change (σ)"], rows))
    return "".join(parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("directory", metavar="DIR")
    directory = Path(parser.parse_args().directory)
    try:
        finding = Finding(directory)
    except DataError as error:
        print(f"plot_diagnosis.py: {error}", file=sys.stderr)
        return 2
    pyplot = apply()
    pictures = []
    for name, draw, title in picture_diagnosis.ALL if finding.has("time_s") else []:
        figure = draw(pyplot, finding)
        if figure is None:
            continue
        path = directory / f"{name}.png"
        figure.savefig(path)
        pyplot.close(figure)
        inline = base64.b64encode(path.read_bytes()).decode("ascii")
        pictures.append(f"<h2>{escape(title)}</h2><img alt='{escape(title)}' src='data:image/png;base64,{inline}'>")
    page = (f"<!doctype html><html lang='en'><meta charset='utf-8'><title>Diagnosis</title><style>{CSS}</style><body>"
            + summary_html(finding.data) + "".join(pictures) + limits_html(finding.data) + "</body></html>\n")
    (directory / "report.html").write_text(page, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
