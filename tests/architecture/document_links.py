#!/usr/bin/env python3
"""Every link of our pages to a file, and to a heading of one, leads somewhere; so does every source named by a page about the code.

    document_links.py ROOT
"""

import re
import sys
from pathlib import Path

LINK = re.compile(r"\]\(([^)\s]*)\)")


def anchors(page):
    """The anchors of a page's headings, as Git servers make them."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def broken_links(pages):
    for page in pages:
        for link in LINK.findall(page.read_text(encoding="utf-8")):
            if re.match(r"\w+:", link):
                continue
            path, _, anchor = link.partition("#")
            target = page.parent / path if path else page
            if not target.exists():
                yield f"{page}: {link}: no such file"
            elif anchor and target.suffix == ".md" and anchor not in anchors(target):
                yield f"{page}: {link}: no such heading"


# Pages that say where in the code a thing is, and the folders that their paths may begin in.
NAMING_SOURCES = ["docs/glossary.md", "docs/diagnosis_method.md"]
FOLDERS = ["", "analysis/diagnosis", "analysis/diagnosis/adequacy", "analysis/prediction_error"]


def missing_sources(root):
    for page in NAMING_SOURCES:
        for source in re.findall(r"`([\w/]+\.(?:cc|h|inc))`", (root / page).read_text(encoding="utf-8")):
            if not any((root / folder / source).exists() for folder in FOLDERS):
                yield f"{page}: {source}: no such file"


def main():
    root = Path(sys.argv[1])
    pages = sorted(root.glob("*.md")) + sorted((root / "docs").rglob("*.md"))
    broken = list(broken_links(pages)) + list(missing_sources(root))
    print("\n".join(broken) or f"{len(pages)} pages, all links lead somewhere")
    return 1 if broken or not pages else 0


sys.exit(main())
