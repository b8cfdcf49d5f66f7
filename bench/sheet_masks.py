"""Masks of objects on a printed sheet, against the exact ones, and models by them.

    python3 -m bench sheet_masks [--objects bunny,armadillo,pawn,plant,plaster] [--case plain] [--size 1200x900] [--views]
        [--scan] [--keep FOLDER] [--out FILE]

Renders objects on the sheet, seen from 12, 32 and 55 degrees above it, lets `photohull pose` find cameras and masks, and
compares these with the exact masks: intersection over union, and what is missed and what is too much, as shares of the exact
mask; in the mean of each height, and the worst view. `--case hard`: a lens with distortion that is out of focus at the
rims, and 30 % of the tags hidden; `sun`: one hard light; `clutter`: before a background of many
colours; `turntable`: a camera and such a background that stand still, 24 degrees above a sheet that turns. `--views` prints every view. `--scan` lets `scan` and `reconstruct` (which is given the exact cameras and masks) make
models, and prints the F-scores of both at 0.25 % of the diagonal."""
import argparse
import json
from pathlib import Path
from statistics import fmean

import numpy as np
from PIL import Image

from bench import ply, tables
from bench.refine_cameras import similarity
from bench.runner import DATASETS, ROOT, Photohull, add_keep, add_program, keep_json, listed, work_folder

BOARD = ROOT / "datasets/boards/board_a4.json"
ELEVATIONS = (12, 32, 55)
OBJECTS = {
    "bunny": {"geometry": {"mesh": str(DATASETS / "bunny/gt.ply")}, "material": {"base": [0.5, 0.36, 0.24], "contrast": 0.7}},
    "armadillo": {"geometry": {"mesh": str(DATASETS / "armadillo/gt.ply")},
                  "material": {"base": [0.45, 0.45, 0.5], "contrast": 0.6, "size": 0.06}},
    "pawn": {"geometry": {"shape": "pawn"}, "material": {"base": [0.6, 0.33, 0.16], "contrast": 0.6}},
    "plant": {"geometry": {"shape": "plant"}, "material": {"base": [0.2, 0.45, 0.12], "contrast": 0.7, "size": 0.05}},
    "plaster": {"geometry": {"mesh": str(DATASETS / "plaster/gt.ply")},
                "material": {"base": [0.75, 0.74, 0.72], "contrast": 0.03, "chroma": 0}},
}
CASES = {
    "plain": {},
    "sun": {"light": {"ambient": 0.3, "directional": [{"direction": [0.5, -0.4, 0.8], "colour": [0.7, 0.68, 0.62]}]}},
    # Lens distortion, out of focus at the rims, 30 % of the tags hidden.
    "hard": {"sheet": {"board": str(BOARD), "fill": 0.55, "hidden": 0.3},
             "degradations": {"k1": -0.05, "photon_noise": 0.015, "read_noise": 0.003, "blur": 0.5, "edge_blur": 2}},
    "clutter": {"background": {"type": "clutter", "size": 0.5}},
    # As datasets/synthetic/on_turntable.json.
    "turntable": {"background": {"type": "clutter", "size": 0.5}, "sheet": {"board": str(BOARD), "fill": 0.6},
                  "cameras": {"turntable": True, "rings": [{"count": 18, "elevation": 24}], "distance": 3.4, "fill": 0.45},
                  "degradations": {"photon_noise": 0.01, "read_noise": 0.003, "blur": 0.4}},
}
COLUMNS = ["scene", "degrees", "IoU, mean", "missed, mean", "too much, mean", "IoU, worst", "missed, worst", "too much, worst"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("--objects", type=listed, default=list(OBJECTS), help="default: %(default)s")
    parser.add_argument("--case", choices=list(CASES), default="plain")
    parser.add_argument("--size", default="1200x900", help="of the photographs")
    parser.add_argument("--views", action="store_true", help="print every view")
    parser.add_argument("--scan", action="store_true", help="make models, too")
    parser.add_argument("--out", type=Path)
    add_keep(parser)


def spec_of(name: str, case: str) -> dict:
    rings = [{"count": 8, "elevation": e, "phase": i / 3} for i, e in enumerate(ELEVATIONS)]
    return {"name": f"{name}_{case}", "background": {"colour": [0.1, 0.12, 0.14]}, "sheet": {"board": str(BOARD), "fill": 0.55},
            "image": {"samples": 3, "maps": False}, "truth_samples": 200000,
            "cameras": {"rings": rings, "distance": 3.2, "fill": 0.5, "roll": 5},
            "degradations": {"photon_noise": 0.015, "read_noise": 0.003, "blur": 0.5}} | OBJECTS[name] | CASES[case]


def judged(scene: Path, posed: Path) -> list[dict]:
    frames = json.loads((scene / "spec.json").read_text(encoding="utf-8"))["cameras"]["rings"]
    heights = [ring["elevation"] for ring in frames for _ in range(ring["count"])]
    views = []
    for height, path in zip(heights, sorted((scene / "masks").iterdir()), strict=True):
        exact = np.asarray(Image.open(path).convert("L")) >= 128
        found = np.asarray(Image.open(posed / "masks" / path.name).convert("L")) >= 128
        shares = [int((found & exact).sum()), int((exact & ~found).sum()), int((found & ~exact).sum())]
        views.append({"view": path.name, "height": height, "iou": shares[0] / sum(shares), "missed": shares[1] / exact.sum(),
                      "too_much": shares[2] / exact.sum()})
    return views


def rows_of(name: str, views: list[dict], each: bool) -> list[list[object]]:
    rows = []
    for height in sorted({v["height"] for v in views}):
        of = [v for v in views if v["height"] == height]
        mean = {key: fmean(v[key] for v in of) for key in ("iou", "missed", "too_much")}
        rows.append([name, height, f"{mean['iou']:.4f}", f"{100 * mean['missed']:.2f} %", f"{100 * mean['too_much']:.2f} %",
                     f"{min(v['iou'] for v in of):.4f}", f"{100 * max(v['missed'] for v in of):.2f} %",
                     f"{100 * max(v['too_much'] for v in of):.2f} %"])
        if each:
            rows += [[v["view"], "", f"{v['iou']:.4f}", f"{100 * v['missed']:.2f} %", f"{100 * v['too_much']:.2f} %", "", "", ""]
                     for v in of]
    return rows


def camera_places(scene: Path) -> dict[str, np.ndarray]:
    frames = json.loads((scene / "transforms.json").read_text(encoding="utf-8"))["frames"]
    return {Path(frame["file_path"]).name: np.array(frame["transform_matrix"])[:3, 3] for frame in frames}


def moved_onto(posed: Path, scene: Path, mesh: Path) -> Path:
    """The mesh in the exact scene's frame, by where both have the cameras: surfaces tell less of a body that is round."""
    found, exact = camera_places(posed), camera_places(scene)
    names = sorted(found.keys() & exact.keys())
    scale, rotation, shift = similarity(np.array([found[n] for n in names]), np.array([exact[n] for n in names]))
    out = mesh.with_name("moved.ply")
    ply.write_mesh(out, scale * ply.positions(ply.vertices(mesh)) @ rotation.T + shift, ply.triangles(mesh))
    return out


def models(photohull: Photohull, scene: Path, posed: Path, folder: Path) -> dict:
    """F-scores at 0.25 % of the diagonal, of the surface that cameras see, in percent."""
    scanned, exact = folder / f"{scene.name}_scan", folder / f"{scene.name}_exact"
    photohull.once(scanned, "scan", scene / "images", "--board", BOARD, "--out", scanned, "--fresh")
    photohull.reconstruct(scene, exact)
    meshes = {"scan": moved_onto(scanned / "scene", scene, scanned / "mesh.ply"), "exact": exact / "mesh.ply"}
    # The scan's cameras, and exact masks.
    photohull.reconstruct(posed, folder / f"{scene.name}_cameras", "--masks", scene / "masks")
    meshes["exact masks"] = moved_onto(posed, scene, folder / f"{scene.name}_cameras" / "mesh.ply")
    f = {name: 100 * photohull.seen_f(mesh, scene) for name, mesh in meshes.items()}
    print(f"{scene.name}: F at 0.25 %: scan {f['scan']:.2f}, its cameras with exact masks {f['exact masks']:.2f}, exact cameras "
          f"and masks {f['exact']:.2f}, difference {f['scan'] - f['exact']:.2f}", flush=True)
    return f


def run(options: argparse.Namespace) -> None:
    photohull, kept = Photohull(options.program), {}
    with work_folder(options.keep) as folder:
        print(tables.head(COLUMNS), flush=True)
        for name in options.objects:
            scene = photohull.synthesize(spec_of(name, options.case), folder / f"{name}_{options.case}", "--size", options.size)
            posed = folder / f"{scene.name}_posed"
            photohull.once(posed, "pose", scene / "images", "--board", BOARD, "--out", posed)
            kept[scene.name] = judged(scene, posed)
            for row in rows_of(scene.name, kept[scene.name], options.views):
                print(tables.line(row), flush=True)
            if options.scan:
                kept[f"{scene.name} models"] = models(photohull, scene, posed, folder)
    keep_json(options.out, kept)
