#!/usr/bin/env python3
"""The same machines in every run: what diagnosis says of them stays what it was.

    fixed_seed_test.py CONTOUR_HIDDEN [--all]

Two of them, a clean one and one with backlash; with --all, as at night, all four. Cogging is found in every run by
diagnose.extended_gain_cogging.

Beside it hidden.effects_short draws others each time and can only be judged by counts. How often intervals of 95 % hold the
truth is judged there: one of them misses in one machine of twenty, and another build records another log. Here the truth
may lie as far outside as half of the interval, which one in ten thousand does.
"""
import csv
import re
import subprocess
import sys
import tempfile
from pathlib import Path

SEED = 4711
# Case: verdict and answer. The truth is near the interval of each cause.
EXPECTED = {
    f"clean_short_{SEED}": ("nothing_found", "nothing_found"),
    f"clean_short_{SEED + 1}": ("nothing_found", "nothing_found"),
    f"clear_backlash_short_{SEED}": ("cause_found", "backlash"),
    f"clear_cogging_short_{SEED}": ("cause_found", "cogging"),
}


def far_outside(text):
    """Of "amplitude_Nm 0.00376 not in 0.00379 [0.00377  0.00381]; ...": is one off by more than twice the interval's half width?"""
    number = r"(-?[0-9.]+(?:e[-+]?[0-9]+)?)"
    found = re.findall(rf"{number} not in {number} \[{number}\s+{number}\]", text)
    return not found or any(abs(float(true) - float(told)) > float(high) - float(low) for true, told, low, high in found)


IN_EVERY_RUN = {f"clean_short_{SEED}", f"clear_backlash_short_{SEED}"}


def main():
    every = "--all" in sys.argv[2:]
    kinds, clean = ("backlash,cogging", "2") if every else ("backlash", "1")
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.argv[1], "--short", "--compact", "--strengths", "clear", "--kinds", kinds, "--seeds", "1",
                        "--first-seed", str(SEED), "--clean", clean, "--out", folder], check=True, stdout=subprocess.DEVNULL)
        with open(Path(folder) / "results.csv", newline="", encoding="utf-8") as file:
            rows = {r["case"]: r for r in csv.DictReader(file)}
    wrong = [f"{name}: not there" for name in (EXPECTED.keys() if every else IN_EVERY_RUN) - rows.keys()]
    for name, row in rows.items():
        if (row["verdict"], row["answer"]) != EXPECTED.get(name):
            wrong.append(f"{name}: {row['verdict']}, {row['answer']}; expected {EXPECTED.get(name)}")
        elif row["hidden"] and ((row["inside"] != "1" and far_outside(row["outside"])) or float(row["gain"]) <= 0.0):
            wrong.append(f"{name}: truth far outside of its interval ({row['outside']}) or no gain ({row['gain']})")
    print("\n".join(wrong) or f"{len(rows)} cases are as they were")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
