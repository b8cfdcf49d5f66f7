"""`photohull evaluate` against another program that computes the same figures, ../shared/tools/evaluate.py.

    python3 -m bench compare_judges [--scenes bunny,...] [--methods hull,space-carving] [--resolution 128]

Reconstructs scenes with exact truth, judges every mesh with both, and prints the table of docs/guide/evaluate.md: some
figures of both side by side, the greatest relative difference over all figures that both give (save the maxima, which
hang on single samples), the same between two seeds of evaluate.py for comparison, and the seconds that each took. The
Python that runs this needs numpy and scipy for evaluate.py."""
import argparse
import json
import subprocess
import sys
import time
from pathlib import Path

from bench import tables
from bench.runner import SHARED, Photohull, add_keep, add_program, listed, work_folder

DISTANCES = ("mean", "median", "rms", "q95")
COLUMNS = ["mesh", "accuracy, seen (% of diagonal)", "completeness (%)", "F 0.1 %, seen", "F 0.5 %, seen",
           "greatest difference", "between seeds", "seconds"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("--data", type=Path, default=SHARED, help="has tools/evaluate.py and datasets/")
    parser.add_argument("--scenes", type=listed, default="bunny,armadillo,fandisk,trellis,plaster")
    parser.add_argument("--methods", type=listed, default="hull,space-carving")
    parser.add_argument("--resolution", type=int, default=128)
    parser.add_argument("--samples", type=int, default=200000)
    add_keep(parser)


def reference(options: argparse.Namespace, mesh: Path, scene: Path, seed: int) -> tuple[dict, float]:
    out = mesh.with_name(f"{mesh.name}.{seed}.json")
    start = time.perf_counter()
    subprocess.run([sys.executable, options.data / "tools/evaluate.py", mesh, scene, "--json", out, "--samples",
                    str(options.samples), "--seed", str(seed)], check=True, stdout=subprocess.DEVNULL)
    return json.loads(out.read_text(encoding="utf-8")), time.perf_counter() - start


def figures(r: dict) -> dict[str, float]:
    """Every figure that both judges give, by name."""
    f = {k: r[k] for k in ("accuracy", "completeness", "hausdorff95", "chamfer_mean")}
    for side in ("recon_to_gt", "gt_to_recon"):
        f.update({f"{side}.{k}": r[side][k] for k in DISTANCES})
    f.update({f"seen.{k}": r["seen"][k] for k in ("share", "accuracy", "median")})
    for part, name in ((r, ""), (r["seen"], "seen.")):
        for row in part.get("f") or part["thresholds"]:
            f.update({f"{name}{k}@{100 * row['t']:g}%": row[k] for k in ("precision", "recall", "f")})
    return f


def greatest(a: dict[str, float], b: dict[str, float]) -> tuple[str, float]:
    """Name and relative difference of the figure that differs most."""
    def apart(k: str) -> float:
        return abs(a[k] - b[k]) / abs(b[k]) if b[k] else float(a[k] != b[k])
    name = max(a, key=apart)
    return name, apart(name)


def compare(options: argparse.Namespace, photohull: Photohull, mesh: Path, scene: Path) -> list[str]:
    theirs, their_seconds = reference(options, mesh, scene, 1)
    other, _ = reference(options, mesh, scene, 2)
    ours = photohull.call("evaluate", mesh, "--truth", scene, "--json", "--samples", options.samples)
    x, y, z = figures(ours.report), figures(theirs), figures(other)
    if set(x) != set(y):
        raise SystemExit(f"the judges give different figures: {sorted(set(x) ^ set(y))}")
    d = 100 / theirs["gt_diagonal"]
    pairs = [f"{scale * x[k]:.4g} / {scale * y[k]:.4g}" for k, scale in
             (("seen.accuracy", d), ("completeness", 100), ("seen.f@0.1%", 100), ("seen.f@0.5%", 100))]
    name, worst = greatest(x, y)
    return [*pairs, f"{100 * worst:.2f} % ({name})", f"{100 * greatest(z, y)[1]:.2f} %",
            f"{ours.wall_seconds:.1f} / {their_seconds:.1f}"]


def rows(options: argparse.Namespace, folder: Path):
    photohull = Photohull(options.program)
    for name in options.scenes:
        scene = options.data / "datasets" / name
        for method in options.methods:
            out = folder / f"{name}_{method}_{options.resolution}"
            photohull.reconstruct(scene, out, "--method", method, "--resolution", options.resolution)
            yield [f"{name}, {method}", *compare(options, photohull, out / "mesh.ply", scene)]


def run(options: argparse.Namespace) -> None:
    with work_folder(options.keep) as folder:
        tables.show(COLUMNS, rows(options, folder))
