"""Passes of an object that was laid on another side in between: how well `photohull pose --pass` joins them.

    python3 -m bench passes [--objects bunny,pawn,arch,plaster] [--size 1200x900] [--turn 90,0,0] [--seeds 1] [--scan]
        [--plain] [--keep FOLDER] [--out FILE]

Renders each object on the sheet, and then again turned onto another side (`--turn`, degrees about x, y and z), with other
noise; joins the two passes, and compares the motion with the exact one: the turn that is left, and how far it puts the
object's surface from where it is across the lines of sight (root mean square over the surface), each beside the standard
deviation that the report states (of the turn: about one axis); and the seam. `--seeds` renders so many pairs with other
noise; the last line then has root mean squares. `--scan` makes models by `scan --pass`, by the exact cameras and masks of
both passes, and by `scan` of the first pass alone, and prints F-scores at 0.25 % of the diagonal, of the surface that each
pass sees and of all, and how many edges of the mesh are open. `--plain` gives the object no texture. Needs numpy."""
import argparse
import copy
import json
import math
from pathlib import Path
from statistics import fmean

import numpy as np

from bench import ply, tables
from bench.runner import DATASETS, ROOT, Photohull, ProgramError, add_keep, add_program, keep_json, listed, work_folder

BOARD = ROOT / "datasets/boards/board_a4.json"
ELEVATIONS = (15, 38, 58)
OBJECTS = {
    "bunny": {"geometry": {"mesh": str(DATASETS / "bunny/gt.ply")}, "material": {"base": [0.5, 0.36, 0.24], "contrast": 0.7}},
    "pawn": {"geometry": {"shape": "pawn"}, "material": {"base": [0.6, 0.33, 0.16], "contrast": 0.6}},
    "arch": {"geometry": {"shape": "arch"}, "material": {"base": [0.6, 0.33, 0.16], "contrast": 0.6}},
    "plaster": {"geometry": {"mesh": str(DATASETS / "plaster/gt.ply")},
                "material": {"base": [0.75, 0.74, 0.72], "contrast": 0.03, "chroma": 0}},
}
PLAIN = {"contrast": 0}
COLUMNS = ["object", "turn off, degrees", "stated", "surface off, px", "stated", "seam, px", "points", "features", "outside"]
ERRORS = [("degrees_off", "rotation_sigma_degrees"), ("px_off", "seam_sigma")]
MODEL_COLUMNS = ["object", "model", "F, seen by pass 1", "F, seen by pass 2", "F, all", "of the surface found", "open edges",
                 "verdict"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("--objects", type=listed, default=["bunny", "pawn", "arch"], help="default: %(default)s")
    parser.add_argument("--size", default="1200x900", help="of the photographs")
    parser.add_argument("--turn", type=lambda text: [float(word) for word in text.split(",")], default=[90.0, 0.0, 0.0])
    parser.add_argument("--seeds", type=int, default=1, help="pairs of passes of each object")
    parser.add_argument("--plain", action="store_true", help="objects without texture")
    parser.add_argument("--scan", action="store_true", help="make models, too")
    parser.add_argument("--out", type=Path)
    add_keep(parser)


def spec_of(name: str, plain: bool, seed: int) -> dict:
    rings = [{"count": 8, "elevation": e, "phase": i / 3} for i, e in enumerate(ELEVATIONS)]
    spec = {"name": name, "background": {"colour": [0.1, 0.12, 0.14]}, "sheet": {"board": str(BOARD), "fill": 0.5},
            "image": {"samples": 3, "maps": False}, "truth_samples": 200000,
            "cameras": {"rings": rings, "distance": 3.2, "fill": 0.5, "roll": 5},
            "degradations": {"photon_noise": 0.015, "read_noise": 0.003, "blur": 0.5,
                             "seed": seed}} | copy.deepcopy(OBJECTS[name])
    if plain:
        spec["material"] |= PLAIN
    return spec


def turned(spec: dict, turn: list[float]) -> dict:
    spec = copy.deepcopy(spec)
    spec["sheet"]["turn"] = turn
    spec["degradations"]["seed"] += 1
    return spec


def rotation(turn: list[float]) -> np.ndarray:
    """By degrees about x, y and z, in that order."""
    result = np.eye(3)
    for axis, degrees in enumerate(turn):
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        i, j = (axis + 1) % 3, (axis + 2) % 3
        one = np.eye(3)
        one[i, i] = one[j, j] = c
        one[i, j], one[j, i] = -s, s
        result = one @ result
    return result


def described(scene: Path) -> dict:
    return json.loads((scene / "spec.json").read_text(encoding="utf-8"))


def exact_motion(first: Path, other: Path) -> np.ndarray:
    """From the second pass's sheet to the first one's, millimetres, 4 x 4."""
    a, b = described(first)["result"]["sheet"], described(other)["result"]["sheet"]
    motion = np.eye(4)
    motion[:3, :3] = rotation(described(other)["sheet"]["turn"]).T
    middle = np.array(b["turned_about"])
    motion[:3, 3] = (middle + motion[:3, :3] @ (np.array(b["origin"]) - middle) - np.array(a["origin"])) / a["unit"]
    return motion


def found_motion(report: dict) -> np.ndarray:
    told = report["passes"][1]["motion"]
    axis, angle = np.array(told["axis"]), math.radians(told["angle"])
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    motion = np.eye(4)
    motion[:3, :3] += math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
    motion[:3, 3] = told["translation"]
    return motion


def surface_of(scene: Path) -> np.ndarray:
    """Points of the exact surface in the sheet's frame, millimetres."""
    sheet = described(scene)["result"]["sheet"]
    return (ply.positions(ply.vertices(scene / "gt_visible.ply")) - np.array(sheet["origin"])) / sheet["unit"]


def pixel_of(scene: Path) -> float:
    """Millimetres at the object, in the mean over the views."""
    told = described(scene)["result"]
    middle = np.mean(np.array(told["tight_box"]), axis=0)
    frames = json.loads((scene / "transforms.json").read_text(encoding="utf-8"))["frames"]
    sizes = [math.dist([row[3] for row in frame["transform_matrix"][:3]], middle) / frame["fl_x"] for frame in frames]
    return fmean(sizes) / told["sheet"]["unit"]


def judged(first: Path, other: Path, report: dict) -> dict:
    true, found = exact_motion(first, other), found_motion(report)
    between = true[:3, :3].T @ found[:3, :3]
    points = surface_of(other)
    off = points @ (found - true)[:3, :3].T + (found - true)[:3, 3]
    # Across a line of sight two of the three axes count.
    rms = math.sqrt(2 / 3 * float(np.mean(np.sum(off**2, axis=1))))
    # Sines tell small angles; cosines do not.
    turn = math.degrees(math.asin(min(1.0, float(np.linalg.norm(between - between.T)) / math.sqrt(8))))
    if np.trace(between) < 1:
        turn = 180 - turn
    told = report["passes"][1]["motion"]
    return told | {"points": [p["points"] for p in report["passes"]], "degrees_off": turn, "px_off": rms / pixel_of(other)}


def photographs_of(scene: Path) -> Path:
    """A folder of the photographs alone: beside a scene's own lie exact masks, which are taken where one is missing."""
    photos = scene.with_name(f"{scene.name}_photos")
    photos.mkdir(exist_ok=True)
    for image in (scene / "images").iterdir():
        if not (photos / image.name).exists():
            (photos / image.name).hardlink_to(image)
    return photos


def exact_scene(first: Path, other: Path, folder: Path) -> Path:
    """The views of both passes with their exact cameras and masks, in the first one's world."""
    folder.mkdir(parents=True, exist_ok=True)
    scene = json.loads((first / "transforms.json").read_text(encoding="utf-8"))
    middle, turn = np.array(described(other)["result"]["sheet"]["turned_about"]), rotation(described(other)["sheet"]["turn"]).T
    motion = np.eye(4)
    motion[:3, :3], motion[:3, 3] = turn, middle - turn @ middle
    frames = []
    for source in (first, other):
        for frame in json.loads((source / "transforms.json").read_text(encoding="utf-8"))["frames"]:
            for key in ("file_path", "mask_path"):
                frame[key] = str((source / frame[key]).resolve())
            if source == other:
                frame["transform_matrix"] = (motion @ np.array(frame["transform_matrix"])).tolist()
            frames.append(frame)
    (folder / "transforms.json").write_text(json.dumps(scene | {"frames": frames}), encoding="utf-8")
    return folder


def models(photohull: Photohull, first: Path, other: Path, folder: Path) -> dict[str, dict]:
    name = first.name
    scanned, exact, one = folder / f"{name}_scan", folder / f"{name}_exact", folder / f"{name}_one"
    photohull.once(exact, "reconstruct", exact_scene(first, other, folder / f"{name}_both"), "--out", exact)
    photohull.once(one, "scan", photographs_of(first), "--board", BOARD, "--out", one, "--fresh")
    result = {}
    for label, model in (("scan of two passes", scanned), ("exact cameras and masks", exact), ("scan of the first pass", one)):
        by_passes = [photohull.evaluate(model / "mesh.ply", "--truth", truth, "--align", "--thresholds", 0.0025)
                     for truth in (first, other)]
        report = json.loads((model / "report.json").read_text(encoding="utf-8"))
        result[label] = {"seen": [e["seen"]["f"][0] for e in by_passes], "all": by_passes[0]["f"][0],
                         "open_edges": ply.open_edges(model / "mesh.ply"), "verdict": report["verdict"]["level"]}
    return result


def model_rows(name: str, made: dict[str, dict]) -> list[list[object]]:
    return [[name, label, *(f"{100 * of['f']:.2f}" for of in m["seen"]), f"{100 * m['all']['f']:.2f}",
             f"{100 * m['all']['recall']:.2f} %", m["open_edges"], m["verdict"]] for label, m in made.items()]


def row(name: str, r: dict) -> str:
    return tables.line([
        name, f"{r['degrees_off']:.4f}", f"{r['rotation_sigma_degrees']:.4f}", f"{r['px_off']:.3f}", f"{r['seam_sigma']:.3f}",
        f"{r['seam']:.3f}", f"{r['points'][0]}, {r['points'][1]}", r["tracks"], f"{100 * r['outside']:.2f} %"])


def rms_row(all_of_it: list[dict]) -> str:
    mean = {key: math.sqrt(fmean(r[key]**2 for r in all_of_it)) for pair in ERRORS for key in pair}
    return tables.line(["root mean square", *(f"{mean[key]:.4f}" for pair in ERRORS for key in pair), "", "", "", ""])


def run(options: argparse.Namespace) -> None:
    photohull, kept, made = Photohull(options.program), {}, {}
    with work_folder(options.keep) as folder:
        print(tables.head(COLUMNS), flush=True)
        for name in [f"{name}_{seed}" for name in options.objects for seed in range(options.seeds)]:
            spec = spec_of(name.rsplit("_", 1)[0], options.plain, 2 * int(name.rsplit("_", 1)[1]))
            first = photohull.synthesize(spec, folder / name, "--size", options.size)
            other = photohull.synthesize(turned(spec, options.turn), folder / f"{name}_turned", "--size", options.size)
            passes = ["--pass", photographs_of(first), photographs_of(other), "--board", BOARD]
            scanned = folder / f"{name}_scan"
            posed = scanned / "scene" if options.scan else folder / f"{name}_posed"
            try:
                if options.scan:
                    photohull.once(scanned, "scan", *passes, "--out", scanned, "--fresh")
                else:
                    photohull.once(posed, "pose", *passes, "--out", posed)
            except ProgramError as refused:
                print(tables.line([name, refused.message]), flush=True)
                continue
            kept[name] = judged(first, other, json.loads((posed / "pose.json").read_text(encoding="utf-8")))
            print(row(name, kept[name]), flush=True)
            if options.scan:
                kept[name]["models"] = made[name] = models(photohull, first, other, folder)
        if len(kept) > 1:
            print(rms_row(list(kept.values())))
        if made:
            print()
            tables.show(MODEL_COLUMNS, [r for name, of in made.items() for r in model_rows(name, of)])
    keep_json(options.out, kept)
