#!/usr/bin/env python3
"""Runs clang-tidy over the files of src/ and cli/, as a build folder compiles them (`.clang-tidy` has the checks).

    scripts/check_tidy.py BUILD [JOBS]

What was found clean is kept by its contents in the user's cache folder (below XDG_CACHE_HOME or ~/.cache), as ccache keeps
objects: by those of all files that the compiler read for it, the command, the checks and clang-tidy's version. Prints what is
wrong, or, where nothing is, how many files were looked at; fails where anything is wrong."""
import concurrent.futures
import functools
import hashlib
import json
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def output(*command: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


@functools.cache
def digest(path: Path) -> bytes:
    """Of a file's contents, wherever the checkout lies."""
    return hashlib.sha256(path.read_bytes().replace(str(ROOT).encode(), b"")).digest()


def read_files(build: Path) -> dict[str, list[Path]]:
    """By each object the files that its compiler read, as ninja has written them down."""
    files: dict[str, list[Path]] = {}
    for line in output("ninja", "-C", str(build), "-t", "deps").splitlines():
        if line.endswith("(VALID)"):
            files[line.split(":")[0]] = current = []
        elif line.startswith(" "):
            current.append(build / line.strip())
        else:
            current = []
    return files


def is_newest(made: Path, files: list[Path]) -> bool:
    """Whether the object was made from these files as they are now; else ninja's list may be an older one."""
    paths = [made, *files]
    return bool(files) and all(path.exists() for path in paths) and all(path.stat().st_mtime_ns <= made.stat().st_mtime_ns for path in files)


def key_of(unit: dict, files: list[Path], checks: bytes) -> str:
    key = hashlib.sha256(checks + unit["command"].replace(str(ROOT), "").encode())
    for path in files:
        key.update(digest(path))
    return key.hexdigest()


def main() -> None:
    build, jobs = ROOT / sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else os.cpu_count() or 1
    cache = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "photohull-tidy"
    cache.mkdir(parents=True, exist_ok=True)
    checks = output("clang-tidy", "--version").encode() + (ROOT / ".clang-tidy").read_bytes()
    read, ours = read_files(build), (ROOT / "src", ROOT / "cli", build / "src", build / "cli")
    units = [unit for unit in json.loads((build / "compile_commands.json").read_text())
             if any(Path(unit["file"]).is_relative_to(folder) for folder in ours)]

    def look_at(unit: dict) -> tuple[bool, str]:
        """Whether it was looked at anew, and what is wrong."""
        made = re.search(r" -o (\S+)", unit["command"])[1]
        files = read.get(made, [])
        clean = cache / key_of(unit, files, checks) if is_newest(build / made, files) else None
        if clean and clean.exists():
            return False, ""
        done = subprocess.run(["clang-tidy", "-p", str(build), "--quiet", unit["file"]], capture_output=True, text=True, check=False)
        if done.returncode:
            return True, done.stdout + done.stderr or f"{unit['file']}: clang-tidy ended with {done.returncode}"
        if clean:
            clean.touch()
        return True, ""

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        results = list(pool.map(look_at, units))
    wrong = [said for _, said in results if said]
    print("\n".join(wrong) or f"{sum(anew for anew, _ in results)} of {len(units)} files looked at, the others as they were: clean")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
