#!/usr/bin/env python3
"""Runs clang-tidy over the files of src/ and cli/, as a build folder compiles them (`.clang-tidy` has the checks).

    scripts/check_tidy.py BUILD [JOBS]

clang-tidy goes through all headers that a file includes, the precompiled ones, too. So it looks at as many files of a
target at once as one file can include (cmake/group_sources.py).

What was found clean is kept by its contents in the user's cache folder (below XDG_CACHE_HOME or ~/.cache), as ccache keeps
objects: by those of all files that the compiler read for it, the command, the checks and clang-tidy's version. Prints what is
wrong, or, where nothing is, how many groups were looked at; fails where anything is wrong."""
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
sys.path.insert(0, str(ROOT / "cmake"))

import group_sources  # noqa: E402


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


def larger_groups(build: Path, units: list[dict], read: dict[str, list[Path]]) -> list[dict]:
    """The units, those of a target that hold several files joined; each has `made`, the objects that hold its files, and
    `read`, what their compiler read."""
    targets: dict[str, list[dict]] = {}
    for unit in units:
        unit["made"] = [re.search(r" -o (\S+)", unit["command"])[1]]
        unit["read"] = read.get(unit["made"][0], [])
        name = re.search(r"/(\w+)\.dir/Unity/", unit["file"])
        targets.setdefault(name[1] if name else unit["file"], []).append(unit)
    groups = []
    for name, parts in targets.items():
        if len(parts) == 1:
            groups += parts
            continue
        part_of = {file: part for part in parts for file in re.findall(r'#include "(.*)"', Path(part["file"]).read_text(encoding="utf-8"))}
        for number, group in enumerate(group_sources.groups_of(list(part_of), len(part_of))):
            held = {part["file"]: part for part in (part_of[file] for file in group["files"])}.values()
            file = build / "tidy" / f"{name}_{number}.cpp"
            write_if_new(file, "".join(f'#include "{source}"\n' for source in group["files"]))
            groups.append({"directory": parts[0]["directory"], "file": str(file),
                           "command": parts[0]["command"].replace(parts[0]["file"], str(file)),
                           "made": sorted(made for part in held for made in part["made"]),
                           "read": sorted({path for part in held for path in part["read"]})})
    return groups


def write_if_new(file: Path, text: str) -> None:
    file.parent.mkdir(exist_ok=True)
    if not file.exists() or file.read_text(encoding="utf-8") != text:
        file.write_text(text, encoding="utf-8")


def main() -> None:
    build, jobs = ROOT / sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else os.cpu_count() or 1
    cache = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "photohull-tidy"
    cache.mkdir(parents=True, exist_ok=True)
    checks = output("clang-tidy", "--version").encode() + (ROOT / ".clang-tidy").read_bytes()
    read, ours = read_files(build), (ROOT / "src", ROOT / "cli", build / "src", build / "cli")
    units = [unit for unit in json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
             if any(Path(unit["file"]).is_relative_to(folder) for folder in ours)]
    units = larger_groups(build, units, read)
    write_if_new(build / "tidy/compile_commands.json",
                 json.dumps([{key: unit[key] for key in ("directory", "file", "command")} for unit in units], indent=1))

    def look_at(unit: dict) -> tuple[bool, str]:
        """Whether it was looked at anew, and what is wrong."""
        files = unit["read"]
        newest = files and all(is_newest(build / made, read.get(made, [])) for made in unit["made"])
        clean = cache / key_of(unit, [Path(unit["file"]), *files], checks) if newest else None
        if clean and clean.exists():
            return False, ""
        done = subprocess.run(["clang-tidy", "-p", str(build / "tidy"), "--quiet", unit["file"]], capture_output=True, text=True, check=False)
        if done.returncode:
            return True, done.stdout + done.stderr or f"{unit['file']}: clang-tidy ended with {done.returncode}"
        if clean:
            clean.touch()
        return True, ""

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        results = list(pool.map(look_at, units))
    wrong = [said for _, said in results if said]
    print("\n".join(wrong) or f"{sum(anew for anew, _ in results)} of {len(units)} groups of files looked at, the others as they were: clean")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
