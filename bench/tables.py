"""Markdown tables, whole or row by row."""
from collections.abc import Iterable, Sequence


def line(cells: Iterable[object]) -> str:
    return "| " + " | ".join(map(str, cells)) + " |"


def head(columns: Sequence[str]) -> str:
    return line(columns) + "\n|" + "---|" * len(columns)


def markdown(columns: Sequence[str], rows: Iterable[Iterable[object]]) -> str:
    return "\n".join([head(columns), *map(line, rows)])


def show(columns: Sequence[str], rows: Iterable[Iterable[object]]) -> None:
    """Prints the table, each row as soon as it is there."""
    print(head(columns), flush=True)
    for row in rows:
        print(line(row), flush=True)
