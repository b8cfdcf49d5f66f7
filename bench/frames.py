"""Frames of something that moves, each by itself and in chains.

    python3 -m bench frames [--spec datasets/synthetic/figure.json] [--frames 60] [--first 8] [--ways alone,of_4,...]
        [--size 640x480] [--repeat 3] [--out FILE] [--keep FOLDER]

Renders the spec's motion, with cameras that differ in exposure, with noise and without shadows, lets `photohull batch
--frames` reconstruct it in several ways, in turn, and compares time, F-scores and colours. Time is that of the
reconstructions, from batch.csv, each frame's in the quickest of several rounds, and a ratio to the first way. F is the
mean over the frames at 0.1 and 0.25 % of the diagonal, and the lowest difference of a frame from the first way.
Flicker is the root mean square, in 8-bit codes of sRGB, of how much colours change from frame to frame on parts that do
not move; noise is the same of the photographs' pixels there."""
import argparse
import csv
import json
from pathlib import Path
from statistics import fmean

import numpy as np
from PIL import Image

from bench import page, ply
from bench.runner import SYNTHETIC, Photohull, add_keep, add_program, f_scores, keep_json, listed, read_spec, work_folder

# Shadows would move over what stands still. Cameras have gains of their own, and noise.
CHANGES = {"light": {"shadows": False}, "degradations": {"photon_noise": 0.01, "read_noise": 0.003, "blur": 0.4,
                                                          "exposure": 0.15, "white_balance": 0.05}}
STILL_POINTS = 400
STILL = 1e-4  # share of the diagonal by which still parts may differ between frames' exact surfaces
THRESHOLDS = (0.001, 0.0025)
# Length of the chains, and options.
WAYS = {
    "alone": ("each by itself", 1, []),
    "of_4": ("chains of 4", 4, []),
    "of_8": ("chains of 8", 8, []),
    "two": ("of 8, always the last two levels", 8, ["follow.again_levels=2"]),
    "last": ("of 8, always the last level alone", 8, ["follow.levels=1", "follow.again_least_near=0"]),
    "always": ("of 8, whatever has moved", 8, ["follow.least_inside=0"]),
    "hardly": ("of 8, where hardly anything has moved", 8, ["follow.least_inside=0.9"]),
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("--spec", type=Path, default=SYNTHETIC / "figure.json")
    parser.add_argument("--frames", type=int, default=60, help="of one period (default: %(default)s)")
    parser.add_argument("--first", type=int, default=8, help="only so many of them (default: %(default)s)")
    parser.add_argument("--ways", type=listed, default=list(WAYS), help="default: %(default)s")
    parser.add_argument("--size", help="of the photographs (default: the spec's)")
    parser.add_argument("--repeat", type=int, default=3, help="rounds, of which each frame's quickest counts (default: %(default)s)")
    parser.add_argument("--out", type=Path)
    add_keep(parser)


def nearest(points: np.ndarray, to: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For each point the index of the nearest of `to`, and its distance."""
    index, distance = [], []
    for p in points:
        squared = ((to - p) ** 2).sum(axis=1)
        i = int(squared.argmin())
        index.append(i)
        distance.append(float(np.sqrt(squared[i])))
    return np.array(index), np.array(distance)


def places(path: Path) -> np.ndarray:
    v = ply.vertices(path)
    return np.stack([v["x"], v["y"], v["z"]], axis=1).astype(float)


def still_points(scene: Path, frames: list[str]) -> np.ndarray:
    """Points that a camera sees and that lie on the exact surface of every third frame."""
    first = places(scene / frames[0] / "gt_visible.ply")
    diagonal = float(np.linalg.norm(np.ptp(first, axis=0)))
    points = first[np.random.default_rng(1).permutation(len(first))[: 20 * STILL_POINTS]]
    for frame in frames[1::3]:
        points = points[nearest(points, places(scene / frame / "gt_visible.ply"))[1] < STILL * diagonal]
    return points[:STILL_POINTS]


def flicker(out: Path, frames: list[str], points: np.ndarray) -> float:
    if not len(points):
        return float("nan")
    colours = []
    for frame in frames:
        v = ply.vertices(out / frame / "mesh.ply")
        at = nearest(points, np.stack([v["x"], v["y"], v["z"]], axis=1).astype(float))[0]
        colours.append(np.stack([v["red"], v["green"], v["blue"]], axis=1)[at].astype(float))
    changes = np.diff(np.array(colours), axis=0)
    return float(np.sqrt((changes**2).mean()))


def noise(scene: Path, frames: list[str]) -> float:
    """Of pixels of the object that change least: still parts'."""
    image = sorted((scene / frames[0] / "images").iterdir())[0].name
    stack = np.array([np.asarray(Image.open(scene / f / "images" / image).convert("RGB"), float) for f in frames])
    mask = np.all([np.asarray(Image.open(scene / f / "masks" / image).convert("L")) > 250 for f in frames], axis=0)
    change = np.sqrt((np.diff(stack, axis=0) ** 2).mean(axis=(0, 3)))[mask]
    return float(np.median(change[change <= np.quantile(change, 0.3)]))


def make(photohull: Photohull, scene: Path, frames: list[str], way: str, out: Path) -> dict:
    """CPU and wall seconds of every frame."""
    _, chain, changes = WAYS[way]
    words = [word for change in changes for word in ("--tune", change)]
    photohull.call("batch", str(scene) + "/{frame}", "--frames", f"{frames[0]}-{frames[-1]}", "--chain", chain, "--fresh",
                   "--out", out, *words)
    with open(out / "batch.csv", encoding="utf-8", newline="") as table:
        rows = list(csv.DictReader(table))
    return {name: [float(r[f"{name}_seconds"]) for r in rows] for name in ("cpu", "wall")}


def quickest(rounds: list[dict], name: str) -> float:
    """The mean of the frames, each by its quickest round: what else the machine does is no part of it."""
    return fmean(min(times) for times in zip(*(r[name] for r in rounds), strict=True))


def judged(photohull: Photohull, scene: Path, frames: list[str], out: Path) -> dict:
    scores = [f_scores(photohull.evaluate(out / frame / "mesh.ply", "--truth", scene / frame, "--thresholds",
                                          ",".join(map(str, THRESHOLDS)))) for frame in frames]
    reports = [json.loads((out / frame / "report.json").read_text(encoding="utf-8")) for frame in frames]
    return {"followed": sum(r["followed"] for r in reports), "frames": [[100 * s[t] for t in THRESHOLDS] for s in scores],
            "flicker": flicker(out, frames, still_points(scene, frames)), "noise": noise(scene, frames)}


def compared(r: dict, base: dict) -> dict:
    """With what is said of it beside the first way."""
    lowest = min(b - a for one, other in zip(base["frames"], r["frames"], strict=True)
                 for a, b in zip(one, other, strict=True))
    f = [fmean(frame[i] for frame in r["frames"]) for i in range(len(THRESHOLDS))]
    return r | {"ratio": r["cpu_s"] / base["cpu_s"], "wall_ratio": r["wall_s"] / base["wall_s"], "f01": f[0], "f025": f[1],
                "lowest": lowest}


def start_of(spec: dict, share: float) -> dict:
    """The spec of the first share of its motion."""
    def cut(first, last):
        if isinstance(first, list):
            return [cut(a, b) for a, b in zip(first, last, strict=True)]
        return first + share * (last - first)

    return spec | {"motion": {name: [first, cut(first, last)] for name, (first, last) in spec["motion"].items()}}


def run(options: argparse.Namespace) -> None:
    photohull = Photohull(options.program)
    frames = [f"{i:0{len(str(options.first - 1))}d}" for i in range(options.first)]
    with work_folder(options.keep) as folder:
        size = ["--size", options.size] if options.size else []
        scene = photohull.synthesize(start_of(read_spec(options.spec) | CHANGES, options.first / options.frames),
                                     folder / "scene", "--frames", f"{frames[0]}-{frames[-1]}", *size)
        rounds = [{way: make(photohull, scene, frames, way, folder / way) for way in options.ways}
                  for _ in range(options.repeat)]
        rows = [{"way": WAYS[way][0]} | {f"{name}_s": quickest([r[way] for r in rounds], name) for name in ("cpu", "wall")}
                | judged(photohull, scene, frames, folder / way) for way in options.ways]
    rows = [compared(r, rows[0]) for r in rows]
    print(page.table_of(page.data("benchmarks")["frames"], rows))
    keep_json(options.out, rows)
