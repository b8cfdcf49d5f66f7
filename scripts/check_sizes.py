#!/usr/bin/env python3
"""Checks that files and functions fit a head: no C++ file of src/, cli/ and tests/ and no shader has more than 400 lines,
no function of src/, cli/ and shaders/ has more than 60 between its braces, and none of src/refine and shaders/ more than 6
parameters. Relies on the layout that clang-format gives, and that shaders have as well: a function's head starts at the
column of its scope (0, or 2 more for each class around it) and its body ends with a brace there. Prints what is too long
and fails; needs the standard library only.

    scripts/check_sizes.py [ROOT]    # of another checkout than this one
"""
import re
import sys
from pathlib import Path

MOST_FILE_LINES = 400
MOST_FUNCTION_LINES = 60
MOST_PARAMETERS = 6
TYPE = re.compile(r"(template <.*> )?(class|struct|union)\b[^()]*\{$")
NO_FUNCTION = re.compile(r"(namespace|enum|extern)\b")


def files_of(root, folders):
    for folder in folders:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".cpp", ".h", ".glsl"):
                yield path


def functions(lines):
    """Of each function: the number of the line that its head starts at, the head, and the lines between its braces."""
    column = 0  # of the scope
    head, start = "", 0
    body = None  # the line that opened the function whose end is looked for
    for number, line in enumerate(lines, 1):
        text, indent = line.strip(), len(line) - len(line.lstrip(" "))
        if body is not None:
            if indent == column and text.startswith("}"):
                yield start, head, number - body - 1
                head, body = "", None
        elif column and indent == column - 2 and text.startswith("}"):
            column, head = column - 2, ""  # the end of a class
        elif not text or text.startswith(("//", "#")) or text.endswith(":") and indent < column:
            head = ""
        elif indent >= column:
            if not head:
                start = number
            head = f"{head} {text}".strip()
            if not text.endswith("{"):
                if text.endswith((";", "}")):
                    head = ""
            elif TYPE.match(head):
                column, head = column + 2, ""
            elif NO_FUNCTION.match(head):
                head = ""
            else:
                body = number


def parameters(head):
    """How many parameters a function with this head has."""
    count, depth, text = 1, 0, ""
    for letter in head.partition("(")[2]:
        depth += (letter in "([{<") - (letter in ")]}>")
        if depth < 0:
            break
        count += letter == "," and depth == 0
        text += letter
    return count if text.strip() else 0


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    faults = []
    checked = 0
    for path in files_of(root, ("src", "cli", "tests", "shaders")):
        lines = path.read_text().splitlines()
        name = path.relative_to(root)
        if len(lines) > MOST_FILE_LINES:
            faults.append(f"{name} has {len(lines)} lines, {MOST_FILE_LINES} at most: take out a part that does one thing")
        if name.parts[0] == "tests":
            continue
        for start, head, length in functions(lines):
            checked += 1
            if length > MOST_FUNCTION_LINES:
                faults.append(f"{name}:{start}: {length} lines, {MOST_FUNCTION_LINES} at most: {head[:80]}")
            if (name.parts[0] == "shaders" or name.parts[:2] == ("src", "refine")) and parameters(head) > MOST_PARAMETERS:
                faults.append(f"{name}:{start}: {parameters(head)} parameters, {MOST_PARAMETERS} at most: {head[:80]}")
    if not checked:
        faults.append(f"no function found below {root}")
    print("\n".join(faults) or f"{checked} functions checked")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
