"""Many reconstructions in one Python process: does its memory grow, does it leave files or threads open?

    python3 -m bench python_memory [--runs 1000] [--out FILE]

Photographs of a small sphere, as arrays, are reconstructed again and again; each result's mesh is read, its volume made
dense and its sizes measured. Every tenth of the runs the process tells its resident memory, its open descriptors and its
threads. The table is in docs/measurements/benchmarks.md."""
import argparse
import json
import os
import subprocess
from pathlib import Path

from bench import page
from bench.runner import add_program, keep_json, work_folder

SCRIPT = """import gc, json, os, resource, sys, time
import photohull

folder, runs = sys.argv[1], int(sys.argv[2])
photohull.synthesize({"name": "sphere", "geometry": {"shape": "sphere"}, "image": {"width": 64, "height": 48, "samples": 1, "maps": False},
                      "cameras": {"rings": [{"count": 8, "elevation": 10}, {"count": 8, "elevation": 45, "phase": 0.5}]}}, folder)
read = photohull.load(folder)
views = range(len(read))
images, masks = [read.image(view) for view in views], [read.mask(view) for view in views]
started = time.perf_counter()
for run in range(1, runs + 1):
    scene = photohull.scene(images, read.K, read.R, read.t, masks=masks, box=read.box)
    result = photohull.reconstruct(scene, method="hull", resolution=24, report_page="off", refine_cameras="off")
    assert result.mesh.vertices.size > 0 and result.volume.dense().size > 0 and result.measure()["volume"]["value"] > 0
    del scene, result
    if run in (1, 10) or run % max(1, runs // 10) == 0:
        gc.collect()
        with open("/proc/self/statm", encoding="ascii") as file:
            resident = int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
        used = resource.getrusage(resource.RUSAGE_SELF)
        print(json.dumps({"runs": run, "resident_mb": resident / 2**20, "peak_mb": used.ru_maxrss / 1024,
                          "files": len(os.listdir("/proc/self/fd")), "threads": len(os.listdir("/proc/self/task")),
                          "cpu_s": used.ru_utime + used.ru_stime, "wall_s": time.perf_counter() - started}), flush=True)
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("--python", default="/usr/bin/python3", help="default: %(default)s")
    parser.add_argument("--package", type=Path, help="folder of the package photohull (default: python beside the program)")
    parser.add_argument("--runs", type=int, default=1000, help="default: %(default)s")
    parser.add_argument("--out", type=Path, help="file for the figures")


def run(options: argparse.Namespace) -> None:
    package = (options.package or options.program.parent / "python").resolve()
    rows = []
    with work_folder(None) as folder:
        words = [options.python, "-c", SCRIPT, folder / "sphere", str(options.runs)]
        with subprocess.Popen(words, env=os.environ | {"PYTHONPATH": str(package)}, stdout=subprocess.PIPE, text=True) as child:
            for line in child.stdout:
                print(line, end="", flush=True)
                rows.append(json.loads(line))
    if child.returncode:
        raise SystemExit(f"the process ended with {child.returncode}")
    print(page.table_of(page.data("benchmarks")["python-memory"], rows))
    keep_json(options.out, rows)
