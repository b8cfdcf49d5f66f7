"""Time and memory of the hull of templeRing at two resolutions, from photographs to files.

    python3 -m bench temple_hull [--out FILE]

Each run is a process of its own; CPU seconds are user + system of the whole process. Run it twice on a new machine: the
first run of a shader compiles it, later ones read it from the driver's cache. The table is in
docs/measurements/benchmarks.md."""
import argparse
from collections.abc import Iterator
from pathlib import Path

from bench import page
from bench.runner import Photohull, add_datasets, add_program, keep_json, work_folder


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    add_datasets(parser)
    parser.add_argument("--out", type=Path, help="file for the figures")
    parser.add_argument("--repeat", type=int, default=5, help="runs; the median counts")


def measure(options: argparse.Namespace, folder: Path) -> Iterator[dict]:
    photohull = Photohull(options.program)
    for resolution in (256, 512):
        reports = [photohull.reconstruct(options.datasets / "templeRing", folder / f"{resolution}-{i}", "--method", "hull",
                                         "--resolution", resolution).report for i in range(options.repeat)]
        r = sorted(reports, key=lambda report: report["cpu_seconds"])[len(reports) // 2]
        hull = next(s["cpu_seconds"] for s in r["stages"] if s["name"] == "hull")
        yield {"scene": "templeRing", "resolution": resolution, "hull_cpu_s": hull, "process_cpu_s": r["cpu_seconds"],
               "wall_s": r["wall_seconds"], "peak_mb": r["peak_memory_bytes"] / 2**20}


def run(options: argparse.Namespace) -> None:
    with work_folder(None) as folder:
        rows = list(measure(options, folder))
    print(page.table_of(page.data("benchmarks")["hull"], rows))
    keep_json(options.out, rows)
