#!/usr/bin/env python3
"""Puts source files that can be compiled together into groups.

    group_sources.py MOST < TARGETS

Each line of TARGETS is a target's name and its source files, with tabs between them. Prints a line
for each file: target, file and the number of its group, with tabs between them. Files of a group
define no type and no macro of the same name, and nothing of the same name in unnamed namespaces, so
that one file can include them all. A group has MOST files at most.
"""

import re
import sys

UNNAMED = re.compile(r"^namespace \{\n(.*?)^\}  // namespace$", re.MULTILINE | re.DOTALL)
MACRO = re.compile(r"^#define (\w+)", re.MULTILINE)
# clang-format puts what a namespace holds at the beginnings of lines, and nothing else.
TYPE = re.compile(r"^(?:template <.*>\s)?(?:struct|class|enum class|enum|union) (\w+)", re.MULTILINE)
# Files may have the same alias for the same type, and a using-declaration may be repeated.
ALIAS = re.compile(r"^(?:template <.*>\s)?using (\w+) = ([^;]*);", re.MULTILINE)
OTHER = re.compile(r"^(?:\[\[\w+\]\] )?(?!TEST|INSTANTIATE|static_assert|using |namespace |struct |class |enum |union )\w[^\n;={(]*?(\w+)\s*[;={(\[]",
                   re.MULTILINE)
CONSTANTS = re.compile(r"^constexpr .*$", re.MULTILINE)


def names(path):
    """What the file has for itself: by name what an alias stands for, nothing for all else."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    found = dict(ALIAS.findall(text))
    others = MACRO.findall(text) + TYPE.findall(text)
    for inner in UNNAMED.findall(text):
        others += OTHER.findall(inner)
        for line in CONSTANTS.findall(inner):
            others += re.findall(r"(\w+) =", line)
    return found | dict.fromkeys(others)


def clash(some, more):
    return any(some[name] != more[name] or some[name] is None for name in some.keys() & more.keys())


def groups_of(files, most):
    groups = []
    for file in files:
        own = names(file)
        for group in groups:
            if len(group["files"]) < most and not clash(group["names"], own):
                break
        else:
            group = {"files": [], "names": {}}
            groups.append(group)
        group["files"].append(file)
        group["names"].update(own)
    return groups


def main():
    most = int(sys.argv[1])
    for line in sys.stdin:
        target, *files = line.rstrip("\n").split("\t")
        for number, group in enumerate(groups_of(files, most)):
            for file in group["files"]:
                print(target, file, number, sep="\t")


if __name__ == "__main__":
    main()
