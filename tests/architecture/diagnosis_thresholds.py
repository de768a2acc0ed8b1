#!/usr/bin/env python3
"""Every threshold of diagnosis stands in analysis/diagnosis/tuning, with its unit, reason, source and date.

    diagnosis_thresholds.py ROOT
    diagnosis_thresholds.py ROOT --markdown > docs/diagnosis_thresholds.md

Finds numeric literals in analysis/diagnosis outside of tuning/ and causes/ (a cause's grid and limits are the cause), entries of the
tuning that say too little or that nobody uses, and a page docs/diagnosis_thresholds.md that is not what --markdown prints. Counts the
constants by which a diagnosis is decided: numbers other than 0, 1 and 2 in the tuning that code in analysis/diagnosis uses. Those of
the machinery below it (prediction_tuning.h: priors, rows, noise, fits) are counted apart. Neither may become more. Prints every offence
as file:line and ends with 1 if there is one. It does not see a 0, 1, 2 or 0.5 in the code that is a threshold.
"""
import re
import sys
from pathlib import Path

DIAGNOSIS = "analysis/diagnosis"
TUNING = f"{DIAGNOSIS}/tuning"
USERS = ["analysis", "tools"]
PAGE = "docs/diagnosis_thresholds.md"
BELOW = "prediction_tuning.h"
# Numbers, not entries: a list of three counts three. To be lowered as they go.
MOST_SET_BY_HAND = 43
MOST_BELOW = 59
NOT_COUNTED = {0.0, 1.0, 2.0}

# Neither thresholds nor counts.
PLAIN = {0.0, 1.0, 2.0, 0.5, 1e3, 1e-3, 1e6, 1e-6, 1e9, 1e-9, 100.0}
# Keep a division or a logarithm from zero, a matrix from being singular; larger than any score.
SOLVERS = {"1e-300", "1e300", "1e-18", "1e-12"}
# What else is no threshold, by file.
NO_THRESHOLDS = {
    "adequacy/remaining_structure.cc": {"30.0": "where erfc's asymptotic form is exact", "9.0": "Wilson and Hilferty's formula"},
    "adequacy/structure_maps.cc": {"360.0": "degrees of a turn", "48": "characters"},
    "decision/chi_square.cc": {"60": "bisections of a double", "10.0": "where a search begins"},
    "decision/held_out.cc": {"1e12": "holds a parameter", "77": "seed"},
    "decision/score_threshold.cc": {"2654435761U": "seed", "99": "seed", "6.0": "variance of Gumbel's distribution"},
    "decision/verdict.cc": {"200": "characters"},
    "report/diagnosis_text.cc": {"3": "columns of indentation"},
    "report/draw.cc": {"127": "a shell's exit status", "128": "a shell's exit status"},
    "rounds.cc": {"0.2": "progress", "0.25": "progress", "0.3": "progress", "0.35": "progress"},
}

LITERAL = re.compile(r"(?<![\w.])(?:0x[0-9a-fA-F']+|\d[\d']*\.?[\d']*(?:[eE][-+]?\d+)?|\.\d+)[uUlLfF]*(?![\w.])")
STRUCT = re.compile(r"^struct (\w*Tuning|FitEffort) \{\n(.*?)^\};", re.M | re.S)
# Comment, type, then what is declared up to the semicolon.
MEMBER = re.compile(r"((?:^  ///[^\n]*\n)*)^  ((?:static constexpr )?[\w:<>, ]+?) (\w+ ?[={][^;]*);", re.M)
ENTRY = re.compile(r"^\[([^\]]+)\] (.+) Source: (.+?)\.? (\d{4}-\d{2}-\d{2})$")
COMPUTED = re.compile(r"((?:^///[^\n]*\n)+)^constexpr [\w:]+ (\w+)\([^)]*\) \{\s*return (.*?);\s*\}", re.M | re.S)
ABOUT = re.compile(r"((?:^///[^\n]*\n)+)\Z", re.M)


def code_of(line):
    """Without strings and comments."""
    return re.sub(r"//.*", "", re.sub(r'"(\\.|[^"\\])*"', '""', line))


def value_of(literal):
    bare = literal.replace("'", "").rstrip("uUlL")
    return float(int(bare, 16)) if bare.startswith("0x") else float(bare.rstrip("fF"))


def literals_in(text):
    return [m.group() for m in LITERAL.finditer(text)]


def offences_in(file, text):
    """Literals that stand for nothing that may stay where it is."""
    known = NO_THRESHOLDS.get(file.removeprefix(DIAGNOSIS + "/"), {})
    for number, line in enumerate(text.splitlines(), start=1):
        code = code_of(line)
        if code.lstrip().startswith("#"):
            continue
        for literal in literals_in(code):
            if literal not in known and literal not in SOLVERS and value_of(literal) not in PLAIN:
                yield f"{file}:{number}: {literal} belongs into {TUNING}"


def words_of(comment):
    return " ".join(line.strip().removeprefix("///").strip() for line in comment.splitlines()).strip()


class Entry:
    """One member of a struct of the tuning; several where they share a declaration."""

    def __init__(self, place, comment, declared):
        self.place, self.comment = place, words_of(comment)
        self.names = [re.match(r"\w+", declared).group()] + re.findall(r", (\w+) = ", declared)
        self.numbers = [n for n in literals_in(declared)]
        said = ENTRY.match(self.comment)
        self.unit, self.reason, self.source, self.date = said.groups() if said else (None, None, None, None)
        shown = re.sub(r"\s+", " ", declared)
        self.value = re.sub(r"[{}]|^\w+ ?=? ?", "", shown).strip(" ,") if len(self.names) == 1 else ", ".join(self.numbers)


def tables(root):
    """Title, name and entries of every struct."""
    for path in sorted((root / TUNING).glob("*.h")):
        text = path.read_text(encoding="utf-8")
        for struct in STRUCT.finditer(text):
            about = ABOUT.search(text[:struct.start()])
            entries = []
            for member in MEMBER.finditer(struct.group(2)):
                at = text.count("\n", 0, struct.start(2) + member.start(2)) + 1
                entry = Entry(f"{path.relative_to(root).as_posix()}:{at}", member.group(1), member.group(3))
                # A switch, a start at nought and what has no bound are no constants.
                if entry.unit or any(value_of(n) != 0.0 for n in entry.numbers):
                    entries.append(entry)
            yield path.name, struct.group(1), words_of(about.group(1)) if about else "", entries


def computed(root):
    """What follows from entries: name, formula and comment of every function of the tuning."""
    for path in sorted((root / TUNING).glob("*_tuning.h")):
        for comment, name, formula in COMPUTED.findall(path.read_text(encoding="utf-8")):
            yield name, re.sub(r"\s+", " ", formula), words_of(comment)


def used_names(root):
    names = set()
    for folder in USERS:
        for path in (root / folder).rglob("*"):
            if path.suffix in (".h", ".cc", ".inc"):
                names |= set(re.findall(r"\.(\w+)", path.read_text(encoding="utf-8")))
    return names


def markdown(root):
    lines = ["# Thresholds of diagnosis", "",
             f"Made by `tests/architecture/diagnosis_thresholds.py . --markdown` from `{TUNING}`; a test keeps it equal. What they decide: "
             "[diagnosis_method.md](diagnosis_method.md).", "",
             "Sources: *reasoning*, the reason given is all there is. *Archive*, set by hand while the verdicts on emulated machines were "
             "watched; not varied alone, no figure recorded. *Time*, chosen to save processor time or memory. "
             "*Custom*, as is usual. A date says when the value came into the repository. Counts in rows were set at 1 kHz.", "",
             f"Set by hand: {by_hand(root)} numbers other than 0, 1 and 2 decide; the priors, rows, noise and fits below have {below(root)} more. "
             "Grids and limits of single causes stand in `causes/`."]
    for file, name, about, entries in tables(root):
        lines += ["", f"## `{name}`", "", f"{about} `{TUNING}/{file}`", "", "| name | value | unit | reason | source | date |",
                  "| --- | --- | --- | --- | --- | --- |"]
        for e in entries:
            cells = [", ".join(f"`{n}`" for n in e.names), e.value, e.unit or "", e.reason or "", e.source or "", e.date or ""]
            lines.append("| " + " | ".join(c.replace("|", "\\|") for c in cells) + " |")
    lines += ["", "## Computed from these", "", "| function | formula | reason |", "| --- | --- | --- |"]
    lines += [f"| `{name}` | `{formula}` | {reason} |" for name, formula, reason in computed(root)]
    return "\n".join(lines) + "\n"


def numbers_of(root, wanted):
    return sum(value_of(n) not in NOT_COUNTED for file, _, _, entries in tables(root) if wanted(file) for e in entries for n in e.numbers)


def by_hand(root):
    return numbers_of(root, lambda file: file != BELOW)


def below(root):
    return numbers_of(root, lambda file: file == BELOW)


def check(root, most_by_hand=None, most_below=None):
    """All offences, as text, and the two counts."""
    offences = []
    for path in sorted((root / DIAGNOSIS).rglob("*")):
        file = path.relative_to(root).as_posix()
        if path.suffix in (".h", ".cc", ".inc") and not file.startswith((TUNING + "/", f"{DIAGNOSIS}/causes/")):
            offences += offences_in(file, path.read_text(encoding="utf-8"))
    used = used_names(root)
    for _, _, _, entries in tables(root):
        for e in entries:
            if e.unit is None:
                offences.append(f"{e.place}: {e.names[0]}: say \"[unit] reason. Source: source. date\"")
            offences += [f"{e.place}: {name}: nobody uses it" for name in e.names if name not in used]
    counts = by_hand(root), below(root)
    for what, count, most in (("set by hand", counts[0], MOST_SET_BY_HAND if most_by_hand is None else most_by_hand),
                              ("below", counts[1], MOST_BELOW if most_below is None else most_below)):
        if count > most:
            offences.append(f"{TUNING}: {count} constants are {what}, {most} at most")
    page = root / PAGE
    if not page.exists() or page.read_text(encoding="utf-8") != markdown(root):
        offences.append(f"{PAGE}:1: is not what --markdown prints")
    return offences, counts


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--markdown"]):
        sys.exit(__doc__)
    root = Path(sys.argv[1]).resolve()
    if sys.argv[2:]:
        sys.stdout.write(markdown(root))
        return
    offences, counts = check(root)
    print("\n".join(offences) or "thresholds of diagnosis stand in one place")
    print("by table: " + ", ".join(f"{name} {sum(len(e.numbers) for e in entries)}" for _, name, _, entries in tables(root)))
    print(f"set by hand: {counts[0]} (at most {MOST_SET_BY_HAND}); below: {counts[1]} (at most {MOST_BELOW})")
    sys.exit(1 if offences or counts[0] == 0 else 0)


if __name__ == "__main__":
    main()
