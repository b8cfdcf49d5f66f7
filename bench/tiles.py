"""What processes that help with one scene's tiles save: time, memory, and whether the result is the same.

    python3 -m bench tiles [--scene FOLDER] [--resolutions 256,512] [--tiles 32] [--repeat 2] [--out FILE]

A plan of one scene with tiles is made by one process, by two and by four, each with one thread, on a machine that does
nothing else and has as many cores. The table is in docs/measurements/benchmarks.md: wall time beside that of one process
with one thread, processor time and peak memory of the process that has the scene and of each helper, and whether mesh.ply
has the bytes of that of `reconstruct`."""
import argparse
import os
import resource
import shutil
import subprocess
import time
from pathlib import Path
from statistics import mean, median

from bench import page
from bench.runner import DATASETS, Photohull, add_program, keep_json, listed, work_folder

PROCESSES = (1, 2, 4)
OPTIONS = ("--report-page", "off")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("--scene", type=Path, default=DATASETS / "armadillo", help="(default: the shared armadillo)")
    parser.add_argument("--resolutions", type=listed, default=["256", "512"], help="voxels along the longest side")
    parser.add_argument("--tiles", type=int, default=32)
    parser.add_argument("--repeat", type=int, default=2, help="runs of each, of which the median counts")
    parser.add_argument("--out", type=Path, help="file for the figures")


def make(photohull: Photohull, job: Path, count: int) -> tuple[float, list[resource.struct_rusage]]:
    """Wall seconds of a plan, and what its processes used, that with the scene first."""
    start = time.perf_counter()
    running = [subprocess.Popen([photohull.program, "run", job, "--threads", "1"], stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL) for _ in range(count)]
    used = [os.wait4(process.pid, 0)[2] for process in running]
    wall = time.perf_counter() - start
    return wall, sorted(used, key=lambda one: one.ru_utime, reverse=True)


def cpu(used: resource.struct_rusage) -> float:
    return used.ru_utime + used.ru_stime


def rows(photohull: Photohull, options: argparse.Namespace, resolution: str, folder: Path) -> list[dict]:
    alone = folder / "alone"
    photohull.call("reconstruct", options.scene, "--resolution", resolution, "--out", alone, *OPTIONS)
    runs: dict[int, list[tuple[float, list[resource.struct_rusage]]]] = {count: [] for count in PROCESSES}
    same = {count: True for count in PROCESSES}
    for _ in range(options.repeat):  # in turn, for the machine's speed changes
        for count in PROCESSES:
            job = folder / "job"
            shutil.rmtree(job, ignore_errors=True)
            photohull.call("plan", options.scene, "--resolution", resolution, "--tiles", options.tiles, "--out", job, *OPTIONS)
            runs[count].append(make(photohull, job, count))
            same[count] &= (job / options.scene.name / "mesh.ply").read_bytes() == (alone / "mesh.ply").read_bytes()
    return [{"resolution": int(resolution), "processes": count, "wall_s": median(wall for wall, _ in runs[count]),
             "ratio": median(wall / one for (wall, _), (one, _) in zip(runs[count], runs[1])),
             "owner_cpu_s": median(cpu(used[0]) for _, used in runs[count]),
             "owner_mib": median(used[0].ru_maxrss / 1024 for _, used in runs[count]),
             "helper_cpu_s": median(mean(map(cpu, used[1:])) for _, used in runs[count]) if count > 1 else 0,
             "helper_mib": median(max(one.ru_maxrss / 1024 for one in used[1:]) for _, used in runs[count]) if count > 1 else 0,
             "same": "yes" if same[count] else "no"} for count in PROCESSES]


def run(options: argparse.Namespace) -> None:
    photohull = Photohull(options.program)
    with work_folder(None) as folder:
        found = [row for resolution in options.resolutions for row in rows(photohull, options, resolution, folder)]
    print(page.table_of(page.data("benchmarks")["tiles"], found))
    keep_json(options.out, found)
