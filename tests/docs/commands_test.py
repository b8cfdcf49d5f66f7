#!/usr/bin/env python3
"""Runs the commands of the manual on small inputs: commands_test.py PROGRAM SOURCE PAGES ...

PAGES are pages and folders of pages. Every `photohull ...` in them is run in the order of its page, in a folder of that
page, at the size of a draft (draft.py), with stand-ins for what it reads (stand_ins.py). It must end with 0, or with 3
where a draft fails its own checks. In a synopsis, parts in brackets are left out, their options sought in the help, and
the first alternative is taken; a command without arguments is asked for help. What cannot be run stands in exceptions.py. Of `python3 -m bench ...` the
studies and their options must exist."""
import functools
import os
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

from draft import drafted, optional_options, shell_commands
from exceptions import FRAGMENTS, WITHOUT_INPUT
from extract import Command, commands_of
from stand_ins import make_page_folder, make_scene

DONE = (0, 3)
WRONG_USAGE = 2


def matching(patterns: dict[str, str], text: str) -> set[str]:
    return {pattern for pattern in patterns if re.search(pattern, text)}


@functools.cache
def run_once(program: str, words: tuple[str, ...], variables: tuple[tuple[str, str], ...], folder: Path,
             ) -> subprocess.CompletedProcess:
    return subprocess.run([program, *words], cwd=folder, env=os.environ | dict(variables), capture_output=True,
                          text=True, timeout=900, check=False)


def fault_of_run(program: str, text: str, folder: Path) -> str | None:
    """What is wrong with one command of the program, or nothing."""
    environment, words = drafted(text)
    done = run_once(program, tuple(words), tuple(environment.items()), folder)
    missing = matching(WITHOUT_INPUT, text)
    if done.returncode in DONE and not missing or missing and done.returncode == 1:
        return None
    said = (done.stderr or done.stdout).strip().splitlines()
    return f"exit code {done.returncode}, run as: photohull {shlex.join(words)}\n    {said[-1] if said else ''}"


def fault_of_options(program: str, text: str) -> str | None:
    """The options in the brackets of a synopsis are run with none of its commands: they must stand in the help."""
    options = optional_options(text)
    if not options:
        return None
    command = text.partition("photohull ")[2].split()[0]
    help_text = subprocess.run([program, command, "--help"], capture_output=True, text=True, check=True).stdout
    unknown = sorted(option for option in options if not re.search(rf"{option}\b", help_text))
    return f"{command} has no option {', '.join(unknown)}" if unknown else None


def fault_of_study(text: str, source: Path) -> str | None:
    words = text.split("bench", 1)[1].split()
    module = source / "bench" / f"{words[0]}.py"
    if not module.is_file():
        return f"bench has no study {words[0]}"
    known = module.read_text(encoding="utf-8") + (source / "bench/runner.py").read_text(encoding="utf-8")
    unknown = [word for word in words if word.startswith("--") and f'"{word}"' not in known]
    return f"bench {words[0]} has no option {', '.join(unknown)}" if unknown else None


def faults_of(page: list[Command], program: str, source: Path, folder: Path) -> list[str]:
    faults = []
    for command in page:
        if matching(FRAGMENTS, command.text):
            continue
        if command.is_study:
            found = [fault_of_study(command.text, source)]
        else:
            found = [fault_of_run(program, text, folder) for text in shell_commands(command.text)]
            found.append(fault_of_options(program, command.text))
        faults += [f"{command.page}:{command.line}: {command.text}\n    {fault}" for fault in found if fault]
    return faults


def main() -> int:
    program, source = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    pages = [source / "README.md", *sorted((source / "docs").rglob("*.md"))]
    everything = {page: commands_of(page, str(page.relative_to(source))) for page in pages}
    wanted = [source / name for name in sys.argv[3:]]
    chosen = [page for page in pages if any(page.is_relative_to(name) for name in wanted)]
    faults = [f"exceptions.py: no page has a command {pattern}" for pattern in (FRAGMENTS | WITHOUT_INPUT)
              if not any(re.search(pattern, command.text) for page in everything.values() for command in page)]
    with tempfile.TemporaryDirectory() as name:
        scene = make_scene(program, Path(name))
        for page in chosen:
            if everything[page]:
                folder = Path(name) / f"{page.parent.name}-{page.stem}"
                project = make_page_folder(folder, source, scene, page.read_text(encoding="utf-8"))
                faults += faults_of(everything[page], program, source, project)
    count = sum(len(everything[page]) for page in chosen)
    print("\n".join(faults) if faults else f"{count} commands of {len(chosen)} pages work")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
