"""Whether a plan ends as it would undisturbed when its processes are killed, with each engine.

    python3 -m bench engines [--runs 50] [--engines local,parallel,mpi,slurm] [--out FILE]

A plan of 16 hulls of one rendered scene is submitted to each engine, with three processes. At random moments one of the
processes, or two at once, are killed (SIGKILL); the seed is the run's number. The same command submits it once more where
it did not end well. What is there at the end is compared with an undisturbed batch, byte by byte, without reports, which
tell the time. As seeds are the same for all engines, so are the numbers of kills where runs last long enough. Where FILE
is there, the study goes on from the runs that it has, which must be of the same program. Slurm runs on this machine
alone, by tests/cli/with_slurm.sh; OpenMPI's mpirun, GNU parallel and Slurm have to be installed.

The table is in docs/measurements/benchmarks.md. With --processes, another one has the wall time of the same plan by one
process with two threads, and by 2 and 4 processes with one thread each, on a machine that does nothing else."""
import argparse
import json
import os
import random
import shutil
import signal
import subprocess
import threading
import time
from pathlib import Path
from statistics import median

from bench import page, tables
from bench.runner import ROOT, SYNTHETIC, Photohull, add_program, keep_json, listed, work_folder

PIECES = 16
FILES = ("volume.vdb", "mesh.ply", "preview.png")
ENGINES = ("local", "parallel", "mpi", "slurm")
SLURM = ROOT / "tests/cli/with_slurm.sh"
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("--runs", type=int, default=50, help="disturbed runs of each engine")
    parser.add_argument("--processes", type=int, default=0, metavar="REPEAT", help="runs of each number of processes (default: none)")
    parser.add_argument("--engines", type=listed, default=list(ENGINES), help=f"of {', '.join(ENGINES)}")
    parser.add_argument("--out", type=Path, help="file for the figures")


def plan(photohull: Photohull, scene: Path, out: Path) -> Path:
    """A new plan of PIECES hulls, which differ in their voxels."""
    shutil.rmtree(out, ignore_errors=True)
    pieces = out.parent / "pieces.txt"
    pieces.write_text("".join(f'"{scene}" --name s{i} --resolution {24 + 2 * i}\n' for i in range(PIECES)), encoding="utf-8")
    photohull.call("plan", "--list", pieces, "--out", out, "--method", "hull", "--refine-cameras", "off", "--report-page", "off")
    return out


def results(out: Path) -> dict[str, bytes]:
    return {f"s{i}/{name}": (out / f"s{i}" / name).read_bytes() for i in range(PIECES) for name in FILES}


def workers(job: Path) -> list[int]:
    """Processes that run the job's pieces."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                words = (entry / "cmdline").read_bytes().split(b"\0")
            except OSError:
                continue
            if b"run" in words and str(job).encode() in words and b"photohull" in words[0]:
                found.append(int(entry.name))
    return found


def disturb(job: Path, seed: int, ended: threading.Event, kills: list[int]) -> None:
    """Kills a process, or two at once, at a few random moments."""
    dice = random.Random(seed)
    while not workers(job):
        if ended.wait(0.05):
            return
    for _ in range(dice.randint(1, 3)):
        if ended.wait(dice.uniform(0.3, 3.0)):
            return
        for process in dice.sample(found := workers(job), min(len(found), dice.randint(1, 2))):
            try:
                os.kill(process, signal.SIGKILL)
                kills.append(process)
            except ProcessLookupError:
                pass


def submit(photohull: Photohull, engine: str, job: Path, folder: Path) -> int:
    words = [photohull.program, "submit", job, "--with", engine, "--workers", "3"]
    if engine == "slurm":
        shutil.rmtree(folder / "cluster", ignore_errors=True)
        words = [SLURM, folder / "cluster", *words]
    return subprocess.run(list(map(str, words)), env=os.environ | MPI, capture_output=True, check=False).returncode


def disturbed_run(photohull: Photohull, scene: Path, folder: Path, calm: dict[str, bytes], row: dict) -> None:
    """One more run of an engine, added to what its row counts; the seed is its number."""
    kills: list[int] = []
    job = plan(photohull, scene, folder / row["engine"])
    ended = threading.Event()
    killer = threading.Thread(target=disturb, args=(job, row["runs"], ended, kills))
    killer.start()
    submit(photohull, row["engine"], job, folder)
    ended.set()
    killer.join()
    if not photohull.json("status", job)["complete"]:
        row["again"] += 1
        submit(photohull, row["engine"], job, folder)
    row["different"] += results(job) != calm
    row["kills"] += len(kills)
    row["runs"] += 1


def rows_so_far(options: argparse.Namespace) -> list[dict]:
    known = json.loads(options.out.read_text(encoding="utf-8")) if options.out and options.out.is_file() else []
    return [next((row for row in known if row["engine"] == engine), {"engine": engine, "runs": 0, "kills": 0, "again": 0, "different": 0})
            for engine in options.engines]


def processes(photohull: Photohull, scene: Path, folder: Path, count: int, threads: int) -> float:
    """Wall seconds of a whole plan."""
    job = plan(photohull, scene, folder / "processes")
    start = time.perf_counter()
    running = [subprocess.Popen([photohull.program, "run", job, "--threads", str(threads)], stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL) for _ in range(count)]
    for process in running:
        process.wait()
    return time.perf_counter() - start


def show_processes(photohull: Photohull, scene: Path, folder: Path, repeat: int) -> None:
    layouts = [(1, 2), (2, 1), (4, 1)]
    times: dict[tuple[int, int], list[float]] = {layout: [] for layout in layouts}
    for _ in range(repeat):  # in turn, for the machine's speed changes
        for layout in layouts:
            times[layout].append(processes(photohull, scene, folder, *layout))
    tables.show(("processes", "threads of each", "wall s", "of one process's"),
                ((count, threads, f"{median(times[count, threads]):.1f}",
                  f"{median(t / one for t, one in zip(times[count, threads], times[layouts[0]])):.2f}")
                 for count, threads in layouts))


def run(options: argparse.Namespace) -> None:
    photohull = Photohull(options.program)
    with work_folder(None) as folder:
        scene = photohull.synthesize(SYNTHETIC / "pawn.json", folder / "pawn", "--size", "320x240")
        if options.processes:
            show_processes(photohull, scene, folder, options.processes)
        photohull.call("run", plan(photohull, scene, folder / "calm"))
        calm = results(folder / "calm")
        rows = rows_so_far(options)
        for row in rows:
            while row["runs"] < options.runs:
                disturbed_run(photohull, scene, folder, calm, row)
                keep_json(options.out, rows)
    print(page.table_of(page.data("benchmarks")["kills"], rows))
