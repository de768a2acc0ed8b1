#!/usr/bin/env python3
"""Ends with 1 when results of contour_hidden are such as a diagnoser to specification hardly ever has.

    require_results.py RESULTS.csv

Prints each count with the least that is credible. The specification is that of hidden_effects_test.cc. Chance: one run in 1000.
"""
import csv
import math
import sys

NAMED, INSIDE, GAINED = 0.99, 0.90, 0.95  # of clear effects; of those that are named, truth inside and a gain
CHANCE_OF_ALL = 0.001


def least_credible(count, probability, chance):
    """The smallest number of hits that is not below what one run in 1/chance has."""
    below = 0.0
    for hits in range(count + 1):
        below += math.comb(count, hits) * probability**hits * (1.0 - probability) ** (count - hits)
        if below >= chance:
            return hits
    return count


def counts_of(rows):
    """Name of a count: hits, all, probability. What the machine could not show is no question."""
    usable = [r for r in rows if r["usable"] == "1" and r["misfit"] == "none"]
    clear = [r for r in usable if r["type"] == "effect" and r["strength"] == "clear" and not r["hidden"].startswith("outside")]
    told = [r for r in clear if r["right"] == "1" and r["itself"] == "1"]
    counts = {}
    if clear:
        counts["clear effects named"] = (sum(r["right"] == "1" for r in clear), len(clear), NAMED)
    if told:
        counts["truth inside"] = (sum(r["inside"] == "1" for r in told), len(told), INSIDE)
        counts["gain"] = (sum(float(r["gain"]) > 0.0 for r in told), len(told), GAINED)
    for rate in sorted({r["rate"] for r in usable if r["type"] == "clean"}):
        clean = [r for r in usable if r["type"] == "clean" and r["rate"] == rate]
        # Machines are asked at the stricter rate only where the looser one alarmed.
        if len(clean) == len({r["case"] for r in usable if r["type"] == "clean"}):
            counts[f"clean machines quiet at {rate}"] = (sum(r["right"] == "1" for r in clean), len(clean), 1.0 - float(rate))
    return counts


def check(rows):
    """Text of each count, and whether all are credible."""
    counts = counts_of(rows)
    lines, good = [], bool(counts)
    for name, (hits, count, probability) in counts.items():
        least = least_credible(count, probability, CHANCE_OF_ALL / len(counts))
        good = good and hits >= least
        lines.append(f"{name}: {hits} of {count}, at least {least}{'' if hits >= least else ': TOO FEW'}")
    return lines or ["no usable case: nothing was looked at"], good


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    with open(sys.argv[1], newline="", encoding="utf-8") as file:
        lines, good = check(list(csv.DictReader(file)))
    print("\n".join(lines))
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
