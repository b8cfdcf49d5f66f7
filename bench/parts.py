"""What models in parts cost and how they differ: time, memory, accuracy, and what lies where parts meet.

    python3 -m bench parts [--scene FOLDER] [--resolutions 256,512,1024] [--parts 1,2,4] [--repeat 1] [--out FILE]

A scene is reconstructed at once, and by `batch --parts` in each number of parts. The table is in
docs/measurements/benchmarks.md: processor time of all pieces together and of `reconstruct`, the largest peak of memory of
a piece, texture samples of the parts beside those of one part, which is what the halo costs, F-scores at 0.1 % and 0.25 %
of the diagonal over seen surface, how much of the joined surface lies within a tenth of a voxel of that of one part, and
the edges that stay open where parts meet."""
import argparse
import json
from pathlib import Path
from statistics import median

from bench import page
from bench.runner import DATASETS, Photohull, add_program, keep_json, listed, work_folder

OPTIONS = ("--report-page", "off")
THRESHOLDS = ("0.001", "0.0025")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("--scene", type=Path, default=DATASETS / "armadillo", help="(default: the shared armadillo)")
    parser.add_argument("--resolutions", type=listed, default=["256", "512", "1024"], help="voxels along the longest side")
    parser.add_argument("--parts", type=listed, default=["1", "2", "4"], help="numbers of parts, 1 among them")
    parser.add_argument("--repeat", type=int, default=1, help="runs of each, of which the median counts")
    parser.add_argument("--out", type=Path, help="file for the figures")


def score(photohull: Photohull, mesh: Path, scene: Path) -> list[float]:
    told = photohull.call("evaluate", mesh, "--truth", scene, "--thresholds", ",".join(THRESHOLDS), "--json").report
    return [100 * at["f"] for at in told["seen"]["f"]]


def near(photohull: Photohull, mesh: Path, other: Path, voxel: float) -> float:
    """Percent of the mesh that lies within a tenth of a voxel of the other one."""
    told = photohull.call("evaluate", mesh, "--truth", other, "--absolute", f"{voxel / 10:.9g}", "--json").report
    return 100 * told["f_absolute"][0]["precision"]


def report_of(folder: Path) -> dict:
    return json.loads((folder / "report.json").read_text(encoding="utf-8"))


def at_once(photohull: Photohull, options: argparse.Namespace, resolution: str, folder: Path) -> dict:
    runs = [photohull.call("reconstruct", options.scene, "--resolution", resolution, "--out", folder, *OPTIONS)
            for _ in range(options.repeat)]
    fine, coarse = score(photohull, folder / "mesh.ply", options.scene)
    return {"resolution": int(resolution), "parts": "at once", "cpu_s": median(run.cpu_seconds for run in runs), "ratio": 1,
            "mib": report_of(folder)["peak_memory_bytes"] / 2**20, "samples": 0, "f_fine": fine, "f_coarse": coarse,
            "near": 100, "open": 0}


def in_parts(photohull: Photohull, options: argparse.Namespace, resolution: str, count: str, folder: Path) -> dict:
    runs = [photohull.call("batch", options.scene, "--resolution", resolution, "--parts", count, "--out", folder / str(run),
                           "--json", *OPTIONS) for run in range(options.repeat)]
    pieces = [json.loads(line) for line in runs[0].output.splitlines()]
    job, name = folder / "0", options.scene.name
    parts = [report_of(job / name / part["folder"]) for part in report_of(job / name)["parts"]]
    fine, coarse = score(photohull, job / name / "mesh.ply", options.scene)
    return {"resolution": int(resolution), "parts": count, "cpu_s": median(run.cpu_seconds for run in runs),
            "mib": max(piece["peak_memory_bytes"] for piece in pieces) / 2**20,
            "samples": sum(level["samples"] for part in parts for level in part["refine"]), "f_fine": fine,
            "f_coarse": coarse, "open": report_of(job / name)["mesh"]["open_edges"],
            "mesh": job / name / "mesh.ply", "voxel": parts[0]["grid"]["voxel_size"]}


def rows(photohull: Photohull, options: argparse.Namespace, resolution: str, folder: Path) -> list[dict]:
    whole = at_once(photohull, options, resolution, folder / "whole")
    found = [in_parts(photohull, options, resolution, count, folder / count) for count in options.parts]
    one = next(row for row in found if row["parts"] == "1")
    samples, mesh = one["samples"], one["mesh"]
    for row in found:
        row["near"] = near(photohull, row["mesh"], mesh, row.pop("voxel"))
        row["ratio"] = row["cpu_s"] / whole["cpu_s"]
        row["samples"] /= samples
    for row in found:
        del row["mesh"]
    return [whole, *found]


def run(options: argparse.Namespace) -> None:
    photohull = Photohull(options.program)
    found = []
    for resolution in options.resolutions:
        with work_folder(None) as folder:
            found += rows(photohull, options, resolution, folder)
    print(page.table_of(page.data("benchmarks")["parts"], found))
    keep_json(options.out, found)
