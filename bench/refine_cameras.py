"""What refined cameras are worth, against the exact cameras and the exact surface.

    python3 -m bench refine_cameras [--scenes block,pawn] [--noise 1,2] [--size 640x480]
        [--out bench/results/refine_cameras.json] [--keep FOLDER] [--no-surface]

Synthesizes scenes of datasets/synthetic (or spec files by path) with poses put off by so many pixels (root mean square
over the object, each view by itself), and refines them. Prints a table for docs/guide/cameras.md and keeps the figures
as JSON. Columns:
  px      error of the cameras before and after: points of gt_visible.ply, as the exact cameras see them, are
          triangulated by the cameras in question; the similarity that brings them nearest to the exact points is taken
          off [Umeyama91]; what is left is the distance in pixels between the projections by both, root mean square.
  world   the same without taking the similarity off: what the photographs cannot tell is in it.
  auto    whether 'reconstruct --refine-cameras auto' used the result (the row "0" is the clean scene, where it should
          not, or must not harm).
  F       at 0.25 % of the diagonal, of the surface that cameras see: exact cameras, noisy ones (off), and auto.
--no-surface leaves the reconstructions out. Needs numpy."""
import argparse
import json
import math
import sys
from pathlib import Path

import numpy as np

from bench import ply, tables
from bench.runner import (RESULTS, SYNTHETIC, Photohull, add_keep, add_program, keep_json, listed, read_spec,
                          work_folder)

POINTS = 1000
COLUMNS = ["scene", "noise, px", "tracks", "px before", "px after", "world before", "world after"]
SURFACE_COLUMNS = ["auto", "F exact cameras", "F off", "F auto"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("--scenes", type=listed, default="block,pawn")
    parser.add_argument("--noise", type=listed, default="0,1,2")
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--out", type=Path, default=RESULTS / "refine_cameras.json")
    add_keep(parser)
    parser.add_argument("--no-surface", action="store_true")
    parser.add_argument("--options", default="", help="further options of refine-cameras, for experiments")


def cameras(folder: Path) -> dict[str, np.ndarray]:
    """Name to 3x4 matrix, pixel centre of the top-left pixel at (0, 0)."""
    scene = json.loads((folder / "transforms.json").read_text(encoding="utf-8"))
    found = {}
    for frame in scene["frames"]:
        fx, fy, cx, cy = (frame.get(key, scene.get(key)) for key in ("fl_x", "fl_y", "cx", "cy"))
        world = np.array(frame["transform_matrix"])
        world[:, 1:3] *= -1  # OpenGL's axes
        k = np.array([[fx, 0, cx - 0.5], [0, fy, cy - 0.5], [0, 0, 1]])
        found[Path(frame["file_path"]).name] = k @ np.linalg.inv(world)[:3]
    return found


def visible_points(path: Path) -> np.ndarray:
    """Points of gt_visible.ply that three views see, thinned evenly."""
    data = ply.vertices(path)
    data = data[data["views"] >= 3]
    return ply.positions(data[::max(1, len(data) // POINTS)])


def project(p: np.ndarray, x: np.ndarray) -> np.ndarray:
    h = x @ p[:, :3].T + p[:, 3]
    return h[:, :2] / h[:, 2:]


def triangulate(matrices: list[np.ndarray], pixels: list[np.ndarray]) -> np.ndarray:
    """Linear, each view's rows scaled by its depth, twice."""
    points = None
    for _ in range(3):
        a = []
        for p, u in zip(matrices, pixels):
            w = np.ones(len(u)) if points is None else 1 / (points @ p[2, :3] + p[2, 3])
            for i in range(2):
                a.append((u[:, i:i + 1] * p[2] - p[i]) * w[:, None])
        a = np.stack(a, 1)
        ata = a[:, :, :3].transpose(0, 2, 1) @ a[:, :, :3]
        atb = -(a[:, :, :3].transpose(0, 2, 1) @ a[:, :, 3:])
        points = np.linalg.solve(ata, atb)[:, :, 0]
    return points


def similarity(a: np.ndarray, b: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Scale, rotation, shift that bring a nearest to b [Umeyama91]."""
    ma, mb = a.mean(0), b.mean(0)
    u, d, vt = np.linalg.svd((b - mb).T @ (a - ma) / len(a))
    s = np.diag([1, 1, np.sign(np.linalg.det(u @ vt))])
    r = u @ s @ vt
    c = np.trace(np.diag(d) @ s) / ((a - ma) ** 2).sum(1).mean()
    return c, r, mb - c * r @ ma


def camera_error(exact: dict[str, np.ndarray], other: dict[str, np.ndarray], points: np.ndarray) -> tuple[float, float]:
    """In pixels: with the similarity taken off, and without."""
    names = sorted(exact)
    pixels = [project(exact[n], points) for n in names]
    c, r, t = similarity(points, triangulate([other[n] for n in names], pixels))

    def rms(where: np.ndarray) -> float:
        return math.sqrt(np.mean([((project(other[n], where) - u) ** 2).sum(1) for n, u in zip(names, pixels)]))
    return rms(c * points @ r.T + t), rms(points)


def synthesize(photohull: Photohull, name: str, noise: float, size: str, folder: Path) -> Path:
    spec = read_spec(Path(name) if Path(name).exists() else SYNTHETIC / f"{name}.json")
    if noise > 0:
        spec.setdefault("degradations", {})["pose_error"] = noise
    return photohull.synthesize(spec, folder / f"{spec['name']}_{noise:g}", "--size", size)


def surface(photohull: Photohull, scene: Path, refine: str) -> tuple[float, dict]:
    """F-score in percent, and the report."""
    out = scene.parent / f"{scene.name}_{refine}"
    report = photohull.reconstruct(scene, out, "--refine-cameras", refine).report
    return 100 * photohull.seen_f(out / "mesh.ply", scene), report


def judge(options: argparse.Namespace, photohull: Photohull, name: str, noise: float, folder: Path) -> dict:
    scene = synthesize(photohull, name, noise, options.size, folder)
    exact = cameras(scene / "true_cameras" if (scene / "true_cameras").is_dir() else scene)
    points, refined = visible_points(scene / "gt_visible.ply"), scene.parent / f"{scene.name}_refined"
    report = photohull.json("refine-cameras", scene, "--out", refined, *options.options.split())
    row = {"scene": scene.name.rpartition("_")[0], "noise": noise, "changed": report["changed"],
           "tracks": report["tracks"]}
    row["px"], row["world"] = (list(x) for x in zip(camera_error(exact, cameras(scene), points),
                                                    camera_error(exact, cameras(refined), points)))
    if not options.no_surface:
        row["f_off"] = surface(photohull, scene, "off")[0]
        row["f"], report = surface(photohull, scene, "auto")
        row["used"] = report["camera_refinement"]["used"]
        row["cpu_s"] = report["cpu_seconds"]
    return row


def cells(row: dict, exact: dict[str, float | None]) -> list[object]:
    found = [row["scene"], f"{row['noise']:g}", row["tracks"], *(f"{x:.3f}" for x in (*row["px"], *row["world"]))]
    if "f" in row:
        scores = (exact.get(row["scene"]), row["f_off"], row["f"])
        found += ["used" if row["used"] else "not used", *("-" if f is None else f"{f:.2f}" for f in scores)]
    return found


def run(options: argparse.Namespace) -> None:
    photohull, rows = Photohull(options.program), []
    with work_folder(options.keep) as folder:
        for name in options.scenes:
            for noise in options.noise:
                rows.append(judge(options, photohull, name, float(noise), folder))
                print(rows[-1], file=sys.stderr, flush=True)
    exact = {row["scene"]: row.get("f_off") for row in rows if row["noise"] == 0}
    tables.show(COLUMNS + ([] if options.no_surface else SURFACE_COLUMNS), (cells(row, exact) for row in rows))
    keep_json(options.out, rows)
