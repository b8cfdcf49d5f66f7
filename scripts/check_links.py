#!/usr/bin/env python3
"""Checks that the pages of this repository can be followed: every relative link of a Markdown file leads to a file or
folder that exists, every #anchor to a heading, every page below docs/ has its line in docs/README.md or in a README.md
that it lists, every page that a comment, a script or a help text names as docs/... exists, and so does every source file that a page names with its folder.
Prints what is broken and fails; needs the standard library only.

    scripts/check_links.py
"""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CODE = ("src", "shaders", "cli", "tests", "bench", "scripts", "cmake", ".ci")


def prose(page):
    """The page's lines without blocks and spans of code, in which brackets are no links."""
    fenced = indented = False
    before = ""
    for line in page.read_text().splitlines():
        indented = line.startswith("    ") and (indented or not before.strip())
        before = line
        if re.match(r"\s*(```|~~~)", line):
            fenced = not fenced
        elif not fenced and not indented:
            yield re.sub(r"(`+).*?\1", lambda code: code[0] if line.startswith("#") else "", line)


def anchors(page):
    """The anchors of a page's headings, as GitHub makes them: a heading that comes again gets a number."""
    found = set()
    for line in prose(page):
        heading = re.match(r"#{1,6}\s+(.*?)\s*#*$", line)
        if not heading:
            continue
        text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1]).lower()
        anchor = re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
        count = 1
        unique = anchor
        while unique in found:
            unique = f"{anchor}-{count}"
            count += 1
        found.add(unique)
    return found


def links(page):
    text = "\n".join(prose(page))
    inline = re.findall(r"\]\(<?([^()\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)", text)
    return inline + re.findall(r"^\[[^\]]+\]:\s*(\S+)$", text, re.M)


def targets(page):
    return {(page.parent / link.partition("#")[0]).resolve() for link in links(page)}


def broken_link(page, link):
    """What is wrong with a link, or nothing."""
    if re.match(r"[a-z]+:", link):
        return None
    path, _, anchor = link.partition("#")
    target = (page.parent / path).resolve() if path else page
    if not target.exists():
        return f"{link} leads nowhere"
    if anchor and (target.suffix != ".md" or anchor not in anchors(target)):
        return f"{link}: {target.relative_to(ROOT)} has no heading #{anchor}"
    return None


def files(folder):
    return sorted(path for path in folder.rglob("*") if path.is_file() and "__pycache__" not in path.parts)


def main():
    docs = [path for path in files(ROOT / "docs") if path.suffix == ".md"]
    pages = sorted(ROOT.glob("*.md")) + docs
    pages += [path for name in ("datasets", "third_party") for path in files(ROOT / name) if path.suffix == ".md"]
    faults = [f"{page.relative_to(ROOT)}: {fault}"
              for page in pages for link in links(page) if (fault := broken_link(page, link))]

    index = ROOT / "docs" / "README.md"
    listed = targets(index)
    for below in [path for path in listed if path.name == "README.md" and (ROOT / "docs") in path.parents]:
        listed |= targets(below)
    faults += [f"docs/README.md has no line for {page.relative_to(ROOT)}"
               for page in docs if page != index and page not in listed]

    # What names a page in words: code, and pages, outside of links too.
    named_in = pages + [ROOT / "CMakeLists.txt"] + [path for name in CODE for path in files(ROOT / name)]
    for path in named_in:
        for name in re.findall(r"(?<![\w/.-])docs/[\w/-]+\.md", path.read_text(errors="replace")):
            if not (ROOT / name).exists():
                faults.append(f"{path.relative_to(ROOT)} names {name}, which does not exist")

    # Source files by their place in the repository, or below the folders that include lines count from.
    for page in docs:
        for name in re.findall(r"`([\w./-]+/[\w.-]+\.(?:h|cpp|glsl|py|sh|cmake))`", page.read_text()):
            if not any((ROOT / base / name).exists() for base in ("", "src", "shaders")):
                faults.append(f"{page.relative_to(ROOT)} names {name}, which does not exist")

    print("\n".join(dict.fromkeys(faults)) if faults else f"{len(pages)} pages: all links and names of pages resolve")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
