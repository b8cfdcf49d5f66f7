"""What many small scenes cost in one process of `photohull batch`, and each in a process of its own.

    python3 -m bench batch [--scenes 200] [--out FILE]

One rendered scene stands for all of them. The overhead is what a scene takes beyond what its own report tells: its
files looked up, digests, the table. Peaks of memory are those of the process while it worked at a scene; flat memory
means that they do not grow. The table is in
docs/measurements/benchmarks.md."""
import argparse
import csv
import json
from pathlib import Path
from statistics import mean, median

from bench import page
from bench.runner import SYNTHETIC, Photohull, add_program, keep_json, work_folder

OPTIONS = ("--resolution", 64, "--report-page", "off")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("--scenes", type=int, default=200, help="scenes of the batch of hulls; the refinement gets a fifth")
    parser.add_argument("--alone", type=int, default=10, help="processes of one scene each, to compare with")
    parser.add_argument("--out", type=Path, help="file for the figures")


def measure(options: argparse.Namespace, folder: Path, method: str, count: int) -> dict:
    photohull = Photohull(options.program)
    scene = photohull.synthesize(SYNTHETIC / "pawn.json", folder / "pawn", "--size", "320x240")
    words = ("--method", method, *OPTIONS)
    scenes = folder / f"{method}.txt"
    scenes.write_text("".join(f'"{scene}" --name s{i}\n' for i in range(count)), encoding="utf-8")
    out = folder / f"batch-{method}"
    run = photohull.call("batch", "--list", scenes, "--out", out, "--fresh", *words)
    reports = [json.loads((out / f"s{i}/report.json").read_text(encoding="utf-8")) for i in range(count)]
    with open(out / "batch.csv", encoding="utf-8", newline="") as table:
        peaks = [int(row["peak_memory_bytes"]) / 2**20 for row in csv.DictReader(table)]
    alone = [photohull.call("reconstruct", scene, "--out", folder / f"{method}-{i}", "--json", *words)
             for i in range(options.alone)]
    tenth = max(1, count // 10)
    return {"method": method, "scenes": count, "cpu_s": run.cpu_seconds / count,
            "wall_s": run.wall_seconds / count,
            "overhead_s": run.wall_seconds / count - mean(r["wall_seconds"] for r in reports),
            "alone_cpu_s": mean(a.cpu_seconds for a in alone), "alone_wall_s": mean(a.wall_seconds for a in alone),
            "first_mb": median(peaks[:tenth]), "last_mb": median(peaks[-tenth:])}


def run(options: argparse.Namespace) -> None:
    with work_folder(None) as folder:
        rows = [measure(options, folder, "hull", options.scenes), measure(options, folder, "refine", max(1, options.scenes // 5))]
    print(page.table_of(page.data("benchmarks")["batch"], rows))
    keep_json(options.out, rows)
