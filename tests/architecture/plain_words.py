#!/usr/bin/env python3
"""The code of analysis/ uses the terms of docs/glossary.md and not the words it once had for them.

    plain_words.py ROOT
    plain_words.py --self-test

Prints every offence as file:line, in comments, strings and identifiers, and ends with 1 if there is one.
"""

import re
import sys
from pathlib import Path

# A word as part of an identifier or a sentence, whatever its case, and what to say instead.
WORDS = {
    r"rivals?": "candidate hypothesis",
    r"left-?overs?": "remaining structure, or residual leakage",
    r"margins?": "model-error allowance",
    r"sought": "searched",
    r"vague": "say by what number: a variance ratio, a standard error",
    r"showing": "overdispersion, or say what scales the score",
    r"beside": "in addition to, next to",
    r"valleys?": "basin",
    r"luck": "chance",
    r"ways?": "travel for a distance, direction for a sign",
}
# Two words in a row.
PAIRS = {
    r"firm slides?": "gross sliding",
    r"another law": "friction-model mismatch",
}
# Keys of result files are an interface.
KEYS = '"way_m"'
PARTS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+(?:-[a-z]+)?")


def offences(text):
    """(word, instead) of every bad word in a line; CamelCase and snake_case are words, too."""
    words = [m.group(0).lower() for m in PARTS.finditer(text.replace(KEYS, ""))]
    pairs = [f"{a} {b}" for a, b in zip(words, words[1:])]
    for units, table in ((words, WORDS), (pairs, PAIRS)):
        for unit in units:
            for bad, instead in table.items():
                if re.fullmatch(bad, unit):
                    yield unit, instead


def self_test():
    for bad in ("FitRivals(problem)", "// What is left-over.", "double way = 0.0;", "FirmSlides(p)", '"the way since"', "kNoLuck", "OfAnotherLaw"):
        assert list(offences(bad)), bad
    for good in ("always", "// besides", "a showcase", "const double travel = 0.0;", "hypotheses", "marginal"):
        assert not list(offences(good)), good


def main():
    if sys.argv[1] == "--self-test":
        self_test()
        return 0
    root = Path(sys.argv[1])
    files = sorted(f for f in (root / "analysis").rglob("*") if f.suffix in (".h", ".cc", ".inc"))
    found = [f"{f.relative_to(root)}:{n}: '{word}': {instead}"
             for f in files
             for n, line in enumerate(f.read_text(encoding="utf-8").splitlines(), 1)
             for word, instead in offences(line)]
    print("\n".join(found) or f"{len(files)} files use plain words")
    return 1 if found or not files else 0


sys.exit(main())
