#!/usr/bin/env python3
"""require_results.py passes what a diagnoser to specification has, and nothing that is much worse."""
import require_results as r


def row(case, type_="effect", right="1", **other):
    fields = {"case": case, "type": type_, "hidden": "cogging" if type_ == "effect" else "", "strength": "clear", "misfit": "none",
              "rate": "0.05", "usable": "1", "right": right, "itself": right, "inside": right, "gain": "0.2"}
    return {**fields, **other}


def rows(clear=100, wrong=0, clean=300, alarms=15):
    effects = [row(f"clear_{i}", right="0" if i < wrong else "1") for i in range(clear)]
    return effects + [row(f"clean_{i}", "clean", right="0" if i < alarms else "1") for i in range(clean)]


def main():
    assert r.least_credible(10, 0.99, 0.00025) == 8
    assert r.least_credible(5, 0.999, 0.00025) == 4
    assert r.check(rows())[1]
    assert not r.check(rows(wrong=20))[1], "a fifth of the effects is missed"
    assert not r.check(rows(alarms=60))[1], "alarms at four times the rate"
    outside = [row(f"clear_{i}", inside="0") for i in range(50)]
    assert not r.check(outside)[1], "no truth inside its interval"
    assert not r.check([])[1], "nothing was looked at"
    assert not r.check([row("clear_1", usable="0")])[1], "nothing usable was looked at"
    # What is asked again at the strict rate is the alarms alone: no sample of clean machines.
    again = [row(f"clean_{i}", "clean", right="0", rate="0.01") for i in range(15)]
    assert r.check(rows() + again)[1]
    print("require_results: done")


if __name__ == "__main__":
    main()
