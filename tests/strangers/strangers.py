#!/usr/bin/env python3
"""Axes that share nothing with contourd: made here, diagnosed by `contour diagnose`, counted.

    strangers.py --make FOLDER [--seed 1] [--clean 20] [--each 2] [--strength clear] [--kinds a,b] [--law lugre] [--nominal]
    strangers.py --judge FOLDER --contour build/release/bin/contour [--out results.csv] [--rate 0.05] [--answered]

--make writes a folder a case: log.csv, model.yaml, truth.json. --judge diagnoses what stands there and prints a table: right, wrong
name, unexplained, false alarms, intervals that hold the truth. The same seed makes the same cases; several, by commas, each with the
strength at its place, are made side by side. Effects are sized by the share of the residual that they leave (share.py); --nominal sizes
them by a formula, as was done until 2026-11-24.
"""
import argparse
import csv
import json
import resource
import subprocess
from pathlib import Path

from effects import HIDE
from sizing import Case, sized
from write_case import write_case

BATCH = 128
# Found on a friction of another law, it names what is wrong.
MISMATCH = {"presliding_hysteresis"}
MEANT_TOGETHER = {"friction_ripple": {"ball_ripple"}, "ball_ripple": {"friction_ripple"}}


def cases_of(options):
    """Of every seed, with the strength of the same place."""
    kinds = options.kinds.split(",") if options.kinds else list(HIDE)
    seeds, strengths = options.seed.split(","), options.strength.split(",")
    out = []
    for seed, strength in zip((int(s) for s in seeds), strengths * len(seeds) if len(strengths) == 1 else strengths):
        out += [Case("clean", seed * 100000 + i, strength, options.law) for i in range(options.clean)]
        for number, kind in enumerate(HIDE):
            if kind in kinds:
                out += [Case(kind, seed * 100000 + 1000 * (number + 1) + i, strength, options.law) for i in range(options.each)]
    return out


def write(folder, case, log):
    said = {"kind": case.kind, "seed": case.seed, "law": case.law, "strength": case.strength, "size": case.size, "share": case.share,
            "parameters": case.truth, "axis": dict(case.axis)}
    write_case(Path(folder) / case.name, case.axis, case.stated, log, said, case.kind == "stribeck")


def make(options):
    cases = cases_of(options)
    for at in range(0, len(cases), BATCH):
        for case, log in sized(cases[at:at + BATCH], not options.nominal):
            if log is not None:
                write(options.make, case, log)
            said = "share" if log is not None else f"left out, {case.why_not}; share"
            print(f"{case.name}: {said} {case.share:.4f}, size {case.size:.4g}, {case.truth}", flush=True)
    for why in sorted({c.why_not for c in cases if c.why_not}):
        print(f"left out, {why}: {sum(c.why_not == why for c in cases)} of {len(cases)}")


def diagnose(folder, options):
    if options.answered:
        there = folder / "answer.json"
        return (json.loads(there.read_text(encoding="utf-8")) if there.exists() else {"verdict": "failed"}), 0.0
    command = [options.contour, "diagnose", str(folder / "log.csv"), "--model", str(folder / "model.yaml"), "--json",
               str(folder / "answer.json"), "--false-alarm-rate", str(options.rate)]
    began = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    used_s = ended.ru_utime + ended.ru_stime - began.ru_utime - began.ru_stime
    if done.returncode != 0:
        return {"verdict": "failed", "causes": [], "said": done.stderr.strip()}, used_s
    return json.loads((folder / "answer.json").read_text(encoding="utf-8")), used_s


def inside(cause, truth):
    """Whether every size that is known lies in its interval; None where none is."""
    told = [(p, truth[p]) for p in cause["parameters"] if truth.get(p) is not None]
    if not told:
        return None
    return all(cause["parameters"][p]["ci95"][0] <= value <= cause["parameters"][p]["ci95"][1] for p, value in told)


def is_there(cause, truth):
    """Whether it names something that nobody hid, and that is there: another law of friction, a coupling of an axis stated as rigid."""
    if cause["kind"] == truth["kind"]:
        return False
    axis = truth["axis"]
    if cause["kind"] == "compliance" and axis["stated_rigid"]:
        antiresonance_Hz = axis["mode_Hz"] * (axis["motor_inertia"] / axis["inertia"]) ** 0.5
        return abs(cause["parameters"]["antiresonance_Hz"]["value"] / antiresonance_Hz - 1.0) < 0.25
    return truth["law"] != "lugre" and cause["kind"] in MISMATCH


def judged(folder, options):
    truth = json.loads((folder / "truth.json").read_text(encoding="utf-8"))
    answer, used_s = diagnose(folder, options)
    # Where most is unexplained, what is known of it is no verdict.
    causes = [c for c in answer.get("causes", []) if not c.get("part_of_it")]
    names = [c["kind"] for c in causes]
    there = {c["kind"] for c in causes if is_there(c, truth)}
    counted = [n for n in names if n not in there]
    kind, verdict = truth["kind"], answer["verdict"]
    held, first = None, None
    if kind == "clean":
        mismatch = (there or truth["law"] != "lugre") and verdict in ("unexplained", "cause_found", "ambiguous")
        result = "failed" if verdict == "failed" else "right" if not counted and (verdict == "nothing_found" or mismatch) else "alarm"
    else:
        first = next((c for c in causes if c["kind"] in counted), None)
        meant = {kind} | MEANT_TOGETHER.get(kind, set())
        said = set() if first is None else {first["kind"], *first.get("indistinguishable_from", [])}
        result = ("failed" if verdict == "failed" else "unexplained" if verdict == "unexplained" else "missed" if not said else
                  "right" if said & meant and len(said) <= 2 else "wrong")
        own = next((c for c in causes if c["kind"] == kind), None)
        held = inside(own, truth["parameters"]) if own else None
    return {"case": folder.name, "kind": kind, "result": result, "verdict": verdict, "names": "+".join(names), "inside": held,
            "set": "|".join([] if first is None else first.get("indistinguishable_from", [])), "cpu_s": round(used_s, 2),
            "gain": round(causes[0]["heldout_gain"] or 0.0, 3) if causes else ""}


def judge(options):
    folders = sorted(p.parent for p in Path(options.judge).glob("*/truth.json") if options.only in p.parent.name)
    rows = []
    for folder in folders:
        rows.append(judged(folder, options))
        print(rows[-1], flush=True)
    if options.out:
        with open(options.out, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, rows[0].keys())
            writer.writeheader()
            writer.writerows(rows)
    print_table(rows)
    return rows


def print_table(rows):
    hidden_rows = [r for r in rows if r["kind"] != "clean"]
    clean = [r for r in rows if r["kind"] == "clean"]
    held = [r["inside"] for r in hidden_rows if r["inside"] is not None]
    print("| hidden | right | wrong name | unexplained | nothing | failed | truth inside | alarms, clean | s/log |\n" + "| --- " * 9 + "|")
    counts = [sum(r["result"] == x for r in hidden_rows) for x in ("right", "wrong", "unexplained", "missed")]
    failed = sum(r["result"] == "failed" for r in rows)
    mean_s = sum(r["cpu_s"] for r in rows) / max(1, len(rows))
    print(f"| {len(hidden_rows)} | {counts[0]} | {counts[1]} | {counts[2]} | {counts[3]} | {failed} | {sum(held)} of {len(held)} | "
          f"{sum(r['result'] == 'alarm' for r in clean)} of {len(clean)} | {mean_s:.1f} |")


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, otherwise in (("make", None), ("judge", None), ("contour", "build/release/bin/contour"), ("out", None), ("kinds", ""),
                            ("law", "lugre"), ("strength", "clear"), ("seed", "1"), ("only", "")):
        p.add_argument("--" + name, default=otherwise)
    for name, otherwise in (("clean", 20), ("each", 2)):
        p.add_argument("--" + name, type=int, default=otherwise)
    p.add_argument("--rate", type=float, default=0.05)
    p.add_argument("--nominal", action="store_true", help="sizes of a formula; their shares are measured only")
    p.add_argument("--answered", action="store_true", help="judge the answer.json that stand there")
    options = p.parse_args()
    if not options.make and not options.judge:
        p.error("say --make or --judge")
    if options.make:
        make(options)
    if options.judge:
        judge(options)


if __name__ == "__main__":
    main()
