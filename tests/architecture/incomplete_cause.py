#!/usr/bin/env python3
"""A cause that leaves something out does not compile.

    incomplete_cause.py ROOT COMPILER INCLUDE...

Compiles the file of a cause as it is, which must pass, and without one member of its definition, of its extension and of its
specimen, which must not. Every member of these structs is of the type that makes it so; that is read in their headers.
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

CAUSES = "analysis/diagnosis/causes"
CAUSE = f"{CAUSES}/constant_torque.cc"
STRUCTS = {"CauseDefinition": "cause_definition.h", "ExtensionRule": "cause_definition.h", "Specimen": "specimen.h",
           "StrokeShape": "stroke_shapes.h", "WaveSource": "waves.h"}
LEFT_OUT = ["advice", "judged_at_scale", "number_of_the_model", "largest_size"]


def members_that_may_be_left_out(root):
    for struct, header in STRUCTS.items():
        text = (root / CAUSES / header).read_text(encoding="utf-8")
        body = re.search(rf"^struct {struct} {{\n(.*?)^}};", text, re.M | re.S).group(1)
        statements = re.sub(r"//.*", "", body).split(";")
        for statement in filter(None, (" ".join(s.split()) for s in statements)):
            if not re.match(r"Required<.*> [\w, ]+$", statement):
                yield f"{header}: {struct} may be made without `{statement}`"


def without(text, member):
    """The text without the initialiser of a member; it is written in one line."""
    shorter, count = re.subn(rf"^ *\.{member} = [^\n]*,\n", "", text, flags=re.M)
    if count != 1:
        sys.exit(f"{CAUSE}: .{member} is not there once in a line of its own")
    return shorter


def compiles(root, compiler, includes, text):
    with tempfile.NamedTemporaryFile("w", suffix=".cc", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        command = [compiler, "-std=c++20", "-fsyntax-only", f"-I{root}", *(f"-isystem{i}" for i in includes), file.name]
        return subprocess.run(command, capture_output=True, text=True, check=False)


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    root, compiler, includes = Path(sys.argv[1]).resolve(), sys.argv[2], sys.argv[3:]
    offences = list(members_that_may_be_left_out(root))
    text = (root / CAUSE).read_text(encoding="utf-8")
    whole = compiles(root, compiler, includes, text)
    if whole.returncode != 0:
        sys.exit(f"{CAUSE} does not compile as it is:\n{whole.stderr}")
    for member in LEFT_OUT:
        result = compiles(root, compiler, includes, without(text, member))
        if result.returncode == 0:
            offences.append(f"{CAUSE} compiles without .{member}")
        elif "Required" not in result.stderr:
            offences.append(f"{CAUSE} without .{member} fails for another reason:\n{result.stderr}")
    print("\n".join(offences) or "a cause is complete or does not compile")
    sys.exit(1 if offences else 0)


if __name__ == "__main__":
    main()
