#!/usr/bin/env python3
"""Units of analysis/ and design/ stay small: files, functions, parameter lists; members without `_` where public.

    unit_sizes.py ROOT

Reads sources as clang-format writes them: a function begins at the margin of its scope and ends with a `}` there. Prints every
offence as file:line and ends with 1 if there is one. LARGER has what is larger still, by its present size: it may shrink, not grow,
and what has become small enough must leave the list.
"""
import re
import sys
from pathlib import Path

FOLDERS = ["analysis", "design"]
MOST_LINES_OF_FILE = 400
MOST_LINES_OF_FUNCTION = 60
MOST_PARAMETERS = 6
# What is still larger: "file", "file:Function" (lines), "file:Function()" (parameters), "file:member_".
LARGER = {}

NO_FUNCTION = re.compile(
    r"^\s*(#|//|\}|(namespace|struct|class|enum|union|using|typedef|template|extern|public|private|protected|return|if|for|while"
    r"|switch|else|do|case|try|catch)\b)")
NAME = re.compile(r"([~\w:]+|operator[^\s(]+)\s*\(")
SCOPE = re.compile(r"^(\s*)(struct|class)\s+(\w+)[^;]*\{\s*$")
MEMBER = re.compile(r"^\s+[\w:<>,&*\s\[\]]+?\b(\w+_)\s*(=[^;]*|\{[^;]*\})?;")


def parameters(signature):
    """How many a signature has: commas outside of brackets, plus one."""
    begin = NAME.search(signature)
    text, depth, count = signature[begin.end():], 0, 0
    inside = ""
    for c in text:
        if c == ")" and depth == 0:
            break
        depth += c in "(<[{"
        depth -= c in ")>]}"
        if c == "," and depth == 0:
            count += 1
        inside += c
    return count + 1 if inside.strip() else 0


def functions(lines):
    """Name, first line, number of lines and signature of every function with a body."""
    k = 0
    while k < len(lines):
        line = lines[k]
        indent = len(line) - len(line.lstrip())
        if not line.strip() or indent > 4 or NO_FUNCTION.match(line) or not NAME.search(line):
            k += 1
            continue
        signature, end = line, k
        while not re.search(r"[;{}]\s*(//.*)?$", lines[end]) and end + 1 < len(lines) and end - k < 20:
            end += 1
            signature += " " + lines[end].strip()
        if not lines[end].rstrip().endswith("{") or "=" in signature.split("(")[0]:
            k = end + 1
            continue
        last = end + 1
        closing = " " * indent + "}"
        while last < len(lines) and not lines[last].startswith(closing):
            last += 1
        yield NAME.search(signature).group(1), k + 1, last - k + 1, signature
        k = last + 1


def public_members(lines):
    """Name and line of public data members that end in `_`."""
    scopes = []
    for number, line in enumerate(lines, start=1):
        begin = SCOPE.match(line)
        if begin:
            scopes.append([begin.group(1) + "}", begin.group(2) == "struct"])
        elif scopes and line.startswith(scopes[-1][0]):
            scopes.pop()
        elif scopes and re.match(r"^\s+(public|private|protected):", line):
            scopes[-1][1] = "public" in line
        elif scopes and scopes[-1][1] and len(line) - len(line.lstrip()) == len(scopes[-1][0]) + 1 and MEMBER.match(line):
            yield MEMBER.match(line).group(1), number


def sizes_in(name, lines):
    """What exceeds a limit: its name, its place, its size and the limit."""
    if len(lines) > MOST_LINES_OF_FILE:
        yield name, f"{name}:1", len(lines), MOST_LINES_OF_FILE, "lines"
    for function, number, size, signature in functions(lines):
        if size > MOST_LINES_OF_FUNCTION:
            yield f"{name}:{function}", f"{name}:{number}", size, MOST_LINES_OF_FUNCTION, "lines"
        if parameters(signature) > MOST_PARAMETERS:
            yield f"{name}:{function}()", f"{name}:{number}", parameters(signature), MOST_PARAMETERS, "parameters"
    for member, number in public_members(lines):
        yield f"{name}:{member}", f"{name}:{number}", 1, 0, "public member that ends in _"


def check(root, larger=None):
    """All offences below root, as text."""
    known = dict(LARGER if larger is None else larger)
    offences = []
    files = 0
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in (".h", ".cc", ".inc"):
                continue
            files += 1
            name = path.relative_to(root).as_posix()
            for key, place, size, limit, what in sizes_in(name, path.read_text(encoding="utf-8").splitlines()):
                if size > known.pop(key, limit):
                    offences.append(f"{place}: {key.removeprefix(name + ':')}: {size} {what}, {limit} at most")
    offences += [f"{key}: is small enough now, or gone: take it off the list" for key in known]
    return offences, files


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    offences, files = check(Path(sys.argv[1]).resolve())
    print("\n".join(offences) or f"{files} files are small enough, {len(LARGER)} units of them not yet")
    sys.exit(1 if offences or files == 0 else 0)


if __name__ == "__main__":
    main()
