"""What reconstructions ask of the device, and how long they would take on a GPU, by a model.

    python3 -m bench device_work [--scenes armadillo,templeRing] [--devices auto,software] [--threads 1,2,4]
        [--out FILE]

Launches, transfers and shader time are those that report.json counts (`device_work`), on the device that runs it. The
model adds up what a GPU would leave: the wall time beside launches as it is here, bytes over PCIe, a wait for each launch
and each download, and look-ups over the rate of textures. Its assumptions are constants of this file; it leaves out
arithmetic of the shaders, and threads that wait less on other processors. The table is in
docs/measurements/device_work.md."""
import argparse
import itertools
import os
from collections.abc import Iterator
from pathlib import Path

from bench import page
from bench.runner import Photohull, add_datasets, add_program, keep_json, listed, work_folder

PCIE = 12e9  # bytes a second, of a 16-lane PCIe 3 link in use
WAIT = 30e-6  # seconds that a launch or a download is waited for
LOOKUPS = 50e9  # a second, filtered: assumed


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    add_datasets(parser)
    parser.add_argument("--scenes", type=listed, default="armadillo,fandisk,plaster,templeRing")
    parser.add_argument("--devices", type=listed, default="auto", help="what reconstruct gets as --device, in turn")
    parser.add_argument("--threads", type=listed, default="0", help="the same as --threads; 0: as many as there are cores")
    parser.add_argument("--out", type=Path, help="file for the figures")


def row(scene: str, report: dict) -> dict:
    work, kernels = report["device_work"], report["device_work"]["kernels"]
    launches = sum(kernel["launches"] for kernel in kernels)
    shader_wall = sum(kernel["seconds"] for kernel in kernels)
    samples = sum(stage["samples"] for stage in report["stages"])
    host = report["wall_seconds"] - shader_wall
    moved = work["bytes_up"] + work["bytes_down"]
    return {"scene": scene, "device": report["device"], "shader_wall_s": shader_wall, "launches": launches,
            "downloads": work["downloads"], "up_mb": work["bytes_up"] / 1e6,
            "down_mb": work["bytes_down"] / 1e6, "lookups_m": samples / 1e6, "cpu_s": report["cpu_seconds"],
            "wall_s": report["wall_seconds"], "shader_cpu_s": sum(kernel["cpu_seconds"] for kernel in kernels),
            "host_wall_s": host, "pcie_s": moved / PCIE, "waits_s": WAIT * (launches + work["downloads"]),
            "lookups_s": samples / LOOKUPS,
            "model_s": host + moved / PCIE + WAIT * (launches + work["downloads"]) + samples / LOOKUPS}


def measure(options: argparse.Namespace, folder: Path) -> Iterator[dict]:
    photohull = Photohull(options.program)
    for scene in options.scenes:
        for device, threads in itertools.product(options.devices, options.threads):
            words = ["--device", device] + (["--threads", threads] if threads != "0" else [])
            done = photohull.reconstruct(options.datasets / scene, folder / f"{scene}-{device}-{threads}", *words)
            yield row(scene, done.report) | {"threads": threads if threads != "0" else str(os.cpu_count())}


def run(options: argparse.Namespace) -> None:
    with work_folder(None) as folder:
        rows = list(measure(options, folder))
    print(page.table_of(page.data("device_work")["work"], rows))
    keep_json(options.out, rows)
