"""What the same reconstruction costs from Python and from the command line, in CPU and wall seconds.

    python3 -m bench python_overhead

Both write the same folder, in turn. What is printed is the median of --repeat rounds, and of the quotients of each round's two
jobs: other programs that run beside them slow both of a round alike."""
import argparse
import os
import statistics
import subprocess
import time
from pathlib import Path

from bench.runner import PROGRAM, ROOT, add_keep, add_program, work_folder

SCRIPT = """import sys, photohull
scene, out, *resolution = sys.argv[1:]
photohull.reconstruct(scene, **({"resolution": int(resolution[0])} if resolution else {})).write(out)"""

# What photohull sets for itself, so that the C library keeps freed memory.
KEPT_MEMORY = {"GLIBC_TUNABLES": "glibc.malloc.hugetlb=1:glibc.malloc.mmap_threshold=33554432:"
                                 "glibc.malloc.trim_threshold=268435456"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    add_keep(parser)
    parser.add_argument("--python", default="/usr/bin/python3", help="default: %(default)s")
    parser.add_argument("--package", type=Path, default=PROGRAM.parent / "python", help="default: build/release/python")
    parser.add_argument("--scene", type=Path, default=ROOT / "datasets/templeSparseRing")
    parser.add_argument("--resolution", help="voxels along the longest side; default: what the scene has by default")
    parser.add_argument("--repeat", type=int, default=7)


def cost(words: list, environment: dict) -> tuple[float, float]:
    before, started = os.times(), time.perf_counter()
    subprocess.run(words, env=os.environ | environment, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = os.times()
    return (after.children_user + after.children_system - before.children_user - before.children_system,
            time.perf_counter() - started)


def run(options: argparse.Namespace) -> int:
    resolution = [options.resolution] if options.resolution else []
    python = {"PYTHONPATH": str(options.package)} | KEPT_MEMORY
    with work_folder(options.keep) as folder:
        ways = {
            "command line": ([options.program, "reconstruct", options.scene, "--out", folder / "cli", "--fresh",
                              *(["--resolution", *resolution] if resolution else [])], {}),
            "Python": ([options.python, "-c", SCRIPT, options.scene, folder / "python", *resolution], python),
            "command line, start alone": ([options.program.with_name("photohull-main"), "--version"], {}),
            "Python, start alone": ([options.python, "-c", "import photohull"], python),
        }
        costs = {way: [] for way in ways}
        for _ in range(options.repeat):
            for way, (words, environment) in ways.items():
                costs[way].append(cost(words, environment))
    print("| from | CPU s | wall s |\n|---|---|---|")
    for way, all_of_it in costs.items():
        cpu, wall = (statistics.median(values) for values in zip(*all_of_it))
        print(f"| {way} | {cpu:.2f} | {wall:.2f} |")
    quotients = [python[0] / line[0] for python, line in zip(costs["Python"], costs["command line"])]
    print(f"\nPython's CPU seconds are {statistics.median(quotients):.3f} of the command line's (from {min(quotients):.3f} to {max(quotients):.3f}).")
    return 0
