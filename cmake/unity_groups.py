"""Which sources of a target are compiled together: most of the time goes into templates of headers that each would instantiate anew.

    unity_groups.py ROOT OUT SOURCE...     writes OUT_1.cc, OUT_2.cc ... that include the sources; prints what to compile, with ; between

What a source declares for itself alone (in an anonymous namespace, static, a macro, a using) is not seen by another source of its
group: either the word does not occur there, or a macro gives it another name while the one source is read. Headers are read before.
So each source means what it means when it is compiled alone.
"""
import re
import sys
from pathlib import Path

# More than this, and a change of one source waits for many others, and the last compiler of a build works alone.
MOST_SOURCES = 10
MOST_LINES = 2000
# What is said to be a member or of a namespace is found there, not among the names of a file.
WORD = re.compile(r"(?<![.\w])(?<!->)(?<!::)[A-Za-z_]\w*")
QUALIFIED = re.compile(r"(?:\.|->|::)\s*([A-Za-z_]\w*)")
TEST_MACRO = re.compile(r"\b(?:TEST|TYPED_TEST|INSTANTIATE)\w*\(([^()]*)")
# Found by argument from within headers.
FOUND_BY_OTHERS = {"PrintTo"}


def code(text):
    """Without comments, includes and what strings say; the end of an anonymous namespace stays one."""
    text = re.sub(r"^\}  // namespace$", "namespace }", text, flags=re.MULTILINE)
    text = re.sub(r"^#include.*$|//[^\n]*", "", text, flags=re.MULTILINE)
    return re.sub(r'"(?:[^"\\\n]|\\.)*"', '""', text)


def declared(line):
    """The names that a line at the left margin declares."""
    match = re.match(r"(?:template <.*> )?(?:struct|class|enum class|enum|union) (\w+)(?! \w+\()", line)
    if match:
        return {match[1]}
    head = re.split(r"[=;{\[(]", line)[0]
    words = re.findall(r"(?:::)?\w+", re.sub(r"<[^()]*>", "", head))
    further = set(re.findall(r", (\w+) = ", line))  # constexpr double kA = 1.0, kB = 2.0;
    return further | {word for word in words[-1:] if not re.match(r"::|operator$|template$|[A-Z_]+$", word)}


class Source:
    def __init__(self, name):
        text = Path(name).read_text(encoding="utf-8")
        stripped = code(text)
        self.name, self.lines = name, text.count("\n")
        self.includes = re.findall(r"^#include (?:<.*>|\".*\.h\")", text, re.MULTILINE)
        # What it includes may be under a condition, too; and nobody here knows what an enum has in it.
        self.alone = bool(re.search(r"^(?:#if|using enum )", text, re.MULTILINE))
        self.words = set(WORD.findall(stripped))
        self.names, self.renamable, self.usings = set(), set(), {}
        self._read(stripped)
        fixed = set(QUALIFIED.findall(stripped)) | set(re.findall(r"\w+", " ".join(TEST_MACRO.findall(stripped)))) | FOUND_BY_OTHERS
        self.renamable = {name for name in self.renamable if re.match(r"k?[A-Z]\w*[a-z]", name)} - fixed
        self.namespaces = [line for line in self.usings.values() if line.startswith("using namespace")]

    def _read(self, text):
        anonymous = False
        for line in text.splitlines():
            using = re.match(r"using (?:namespace )?(?:[\w:]+::)?(\w+)(?: = .*)?;?", line)
            macro = re.match(r"#define (\w+)", line)
            if line.startswith("namespace"):
                anonymous = line == "namespace {"
            elif macro:
                self.names.add(macro[1])
            elif using:
                self.usings[using[1]] = line
            elif line[:1].isalpha() and (anonymous or line.startswith(("static ", "constexpr ", "inline "))):
                self.names |= declared(line)
                if anonymous:
                    self.renamable |= declared(line)

    def imposes_on(self, other):
        return self.alone or bool((self.names - self.renamable) & other.words) or self.namespaces != other.namespaces or any(
            name in other.words and other.usings.get(name) != line for name, line in self.usings.items())


def groups_of(sources):
    groups = []
    for source in sources:
        for group in groups:
            if (len(group) < MOST_SOURCES and sum(s.lines for s in group) + source.lines <= MOST_LINES
                    and not any(source.imposes_on(s) or s.imposes_on(source) for s in group)):
                group.append(source)
                break
        else:
            groups.append([source])
    return groups


def text_of(group, root):
    """Paths from the root: the text, and with it what a compiler cache knows, is the same in every checkout."""
    lines = sorted({include for source in group for include in source.includes})
    for source in group:
        path = Path(source.name).absolute().relative_to(root)
        shared = sorted(name for name in source.renamable if any(name in other.words for other in group if other is not source))
        lines += [f"#define {name} {name}_of_{path.stem}" for name in shared]
        lines += [f'#include "{path}"'] + [f"#undef {name}" for name in shared]
    return "\n".join(lines) + "\n"


def main():
    root, out = Path(sys.argv[1]), Path(sys.argv[2])
    out.parent.mkdir(parents=True, exist_ok=True)
    compiled = []
    for number, group in enumerate(groups_of([Source(name) for name in sys.argv[3:]]), 1):
        if len(group) == 1:
            compiled.append(group[0].name)
            continue
        text, file = text_of(group, root), Path(f"{out}_{number}.cc")
        if not file.exists() or file.read_text(encoding="utf-8") != text:
            file.write_text(text, encoding="utf-8")
        compiled.append(str(file))
    print(";".join(compiled))


if __name__ == "__main__":
    main()
