"""Reconstructions judged by photographs that were not used.

    python3 -m bench held_out [--scenes templeRing,dinoRing] [--out FILE] [--keep FOLDER]

Holds out every eighth view, reconstructs by each method, and predicts the held-out views from the mesh (photohull
evaluate --photos), with colours from all other views and with those at least 20 degrees away only, which is stricter.
Prints the table of docs/measurements/benchmarks.md. Scenes that do have a true surface (gt.ply) get a row for that
surface itself, which no mesh should beat, and F-scores at 0.25 % among the figures. --keep leaves meshes and
pictures of the worst views in a folder."""
import argparse
import sys
from pathlib import Path

from bench import page
from bench.runner import Photohull, add_datasets, add_keep, add_program, keep_json, listed, work_folder

METHODS = ("hull", "space-carving", "refine", "truth")
ANGLES = (0, 20)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    add_datasets(parser)
    parser.add_argument("--scenes", type=listed, default="templeRing,dinoRing")
    parser.add_argument("--resolution", type=int, default=256)
    parser.add_argument("--out", type=Path, help="file for the figures")
    add_keep(parser)


def predict(photohull: Photohull, mesh: Path, scene: Path, held_out: str, angle: int, out: Path) -> dict:
    """How well the mesh predicts the held-out views, of which those with masks count where only some have them:
    without a mask, a whole photograph is foreground."""
    def predicted(views: str) -> dict:
        photos = photohull.evaluate(mesh, "--photos", scene, "--views", views, "--least-angle", angle, "--picture",
                                    out / f"worst_{angle}.png")["photos"]
        return photos | {"scene": scene.name}  # whose folder differs between machines
    photos = predicted(held_out)
    masked = [i for i, view in zip(held_out.split(","), photos["views"]) if view["masked"]]
    return predicted(",".join(masked)) if 0 < len(masked) < len(photos["views"]) else photos


def judge(photohull: Photohull, scene: Path, method: str, folder: Path, resolution: int) -> dict | None:
    truth, out = scene / "gt.ply", folder / f"{scene.name}_{method}"
    held_out = photohull.every_eighth_view(scene)
    row = {"scene": scene.name, "method": method, "held_out": held_out, "angles": {}}
    if method == "truth":
        if not truth.is_file():
            return None
        out.mkdir(parents=True, exist_ok=True)
        mesh = truth
    else:
        report = photohull.reconstruct(scene, out, "--method", method, "--resolution", resolution, "--hold-out",
                                       held_out).report
        row.update(resolution=resolution, cpu_s=report["cpu_seconds"], triangles=report["mesh"]["triangles"])
        mesh = out / "mesh.ply"
    for angle in ANGLES:
        row["angles"][str(angle)] = predict(photohull, mesh, scene, held_out, angle, out)
    if truth.is_file():
        row["f"] = photohull.seen_f(mesh, scene)
    return row


def run(options: argparse.Namespace) -> None:
    photohull, rows = Photohull(options.program), []
    with work_folder(options.keep) as folder:
        for scene in options.scenes:
            for method in METHODS:
                print(scene, method, file=sys.stderr, flush=True)
                row = judge(photohull, options.datasets / scene, method, folder, options.resolution)
                rows += [row] if row else []
    print(page.table_of(page.data("benchmarks")["held-out"], rows))
    keep_json(options.out, rows)
