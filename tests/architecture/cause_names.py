#!/usr/bin/env python3
"""A cause of diagnosis is known by name in its own file and nowhere else in analysis/ and tools/.

    cause_names.py ROOT

Takes the causes from analysis/diagnosis/causes/cause_list.inc and their names from their files, and looks for string literals and
enumerators of these names elsewhere. Also: every file of a cause is in the list, and the manual names every cause. Prints every offence as file:line and ends with 1 if there is one.
"""
import re
import sys
from pathlib import Path

CAUSES = "analysis/diagnosis/causes"
LIST = f"{CAUSES}/cause_list.inc"
FOLDERS = ["analysis", "tools"]
SUFFIXES = (".h", ".cc", ".inc", ".py")
# Pages that name every cause.
PAGES = ["docs/diagnosis.md", "docs/emulator.md"]
# Names that mean something else there.
OTHERWISE = {
    # Keys of the emulated machine's effects, in the struct that reads them.
    "tools/plant_emulator/effects_config.h": None,
    # A number of the base model, and the key of its stated uncertainty.
    "analysis/axis_model/stated_parameters.cc": {"torque_constant"},
    "analysis/prediction_error/common_factor.cc": {"torque_constant"},
    "analysis/prediction_error/model_terms.cc": {"torque_constant"},
    "analysis/prediction_error/base_terms.cc": {"torque_constant"},
    # Keys of the emulated machine's effects, which the rough machines of the family have.
    "tools/validation/family/family_machine.cc": {"input_delay", "pitch_error"},
    # The picture of a curve that identification fits.
    "tools/plots/plot_identification.py": {"stribeck"},
}

ENTRY = re.compile(r"^(CAUSE|OUTSIDE)\((\w+)\)$")
NAME = re.compile(r'constexpr std::string_view kName = "([^"]+)";')
LITERAL = re.compile(r"\"((?:[^\"\\\n]|\\.)*)\"|'((?:[^'\\\n]|\\.)*)'")
WORD = re.compile(r"[a-z0-9_]+")


def code_of(line, suffix):
    """The line without its comment."""
    mark = "#" if suffix == ".py" else "//"
    at = line.find(mark)
    return line if at < 0 else line[:at]


def is_name(text, name):
    """Whether a literal stands for the cause: the name alone, or the name as (a part of) a key, but not a word of a sentence."""
    return text == name or re.search(rf"(^|[.:]){re.escape(name)}([.:=]|$)", text) is not None and " " not in text.strip()


def enumerator(name):
    return re.compile(r"\bk" + "".join(part.capitalize() for part in WORD.findall(name.replace("_", " "))) + r"\b")


def listed(root):
    """Pairs of kind of entry and identifier."""
    entries = []
    for line in (root / LIST).read_text(encoding="utf-8").splitlines():
        match = ENTRY.match(line)
        if match:
            entries.append(match.groups())
    return entries


def names_of(root, offences):
    """The causes' names with their files."""
    names, files = {}, set()
    for kind, identifier in listed(root):
        file = f"{CAUSES}/{'outside_' if kind == 'OUTSIDE' else ''}{identifier}.cc"
        files.add(file)
        path = root / file
        found = NAME.findall(path.read_text(encoding="utf-8")) if path.exists() else []
        expected = "outside:" + identifier.replace("_", " ") if kind == "OUTSIDE" else identifier
        if found != [expected]:
            offences.append(f"{file}: defines {found or 'no cause'}, expected {expected}")
        elif kind == "CAUSE":
            names[expected] = file
    for path in sorted((root / CAUSES).glob("*.cc")):
        file = f"{CAUSES}/{path.name}"
        if file not in files and NAME.search(path.read_text(encoding="utf-8")):
            offences.append(f"{file}: defines a cause that is not in {LIST}")
    return names


def sources(root):
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in SUFFIXES:
                yield path


def offences_in(file, text, names):
    passed = OTHERWISE.get(file, set())
    if passed is None:
        return
    enumerators = {name: enumerator(name) for name in names}
    for number, line in enumerate(text.splitlines(), start=1):
        code = code_of(line, Path(file).suffix)
        literals = [a or b for a, b in LITERAL.findall(code)]
        for name, home in names.items():
            if file == home or name in passed:
                continue
            if any(is_name(text, name) for text in literals):
                yield f'{file}:{number}: "{name}" is named outside {home}'
            if enumerators[name].search(code):
                yield f"{file}:{number}: an enumerator for {name}, which is a cause: make it a property"


def check(root):
    offences = []
    names = names_of(root, offences)
    for path in sources(root):
        file = path.relative_to(root).as_posix()
        offences += offences_in(file, path.read_text(encoding="utf-8"), names)
    for page in PAGES:
        text = (root / page).read_text(encoding="utf-8") if (root / page).exists() else ""
        offences += [f"{page}: says nothing of `{name}`" for name in names if f"`{name}`" not in text]
    return offences, names


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    offences, names = check(Path(sys.argv[1]).resolve())
    print("\n".join(offences) or f"{len(names)} causes are named in their own files only")
    sys.exit(1 if offences or not names else 0)


if __name__ == "__main__":
    main()
