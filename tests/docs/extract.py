"""Command lines of the program and of its studies in Markdown pages: in blocks of code and in code within sentences."""
import re
from dataclasses import dataclass
from pathlib import Path

STUDY = re.compile(r"\S*python3 -m bench [a-z]")
COMMAND = re.compile(r"(?:[A-Z_]+=\S+ )*(?:\S*/)?photohull [a-z.-]|" + STUDY.pattern)


@dataclass(frozen=True)
class Command:
    page: str
    line: int
    text: str

    @property
    def is_study(self) -> bool:
        return STUDY.match(self.text) is not None


def blocks_and_prose(text: str) -> tuple[list[tuple[int, str]], str]:
    """The lines of blocks of code with their numbers, and the page without them, line for line."""
    code, rest = [], []
    fenced = indented = False
    before = ""
    for number, line in enumerate(text.splitlines(), 1):
        if re.match(r"\s*(```|~~~)", line):
            fenced = not fenced
            rest.append("")
            continue
        indented = line.startswith("    ") and (indented or not before.strip())
        before = line
        if fenced or indented:
            code.append((number, line.strip()))
        rest.append("" if fenced or indented else line)
    return code, "\n".join(rest)


def commands_of(page: Path, name: str) -> list[Command]:
    code, prose = blocks_and_prose(page.read_text(encoding="utf-8"))
    found = []
    joined, start = "", 0
    for number, line in code:
        if line.startswith("[") and found:  # a synopsis goes on
            found[-1] = Command(name, found[-1].line, f"{found[-1].text} {line}")
            continue
        start = start if joined else number
        joined += line.removesuffix("\\")
        if not line.endswith("\\"):
            found.append(Command(name, start, joined))
            joined = ""
    for span in re.finditer(r"(?<!`)`([^`]+)`(?!`)", prose):
        found.append(Command(name, prose.count("\n", 0, span.start()) + 1, " ".join(span[1].split())))
    found.sort(key=lambda command: command.line)
    return [Command(c.page, c.line, re.sub(r"\s+#\s.*", "", c.text).strip()) for c in found if COMMAND.match(c.text)]
