"""Frames of something that moves, each by itself and in chains.

    python3 -m bench frames [--spec datasets/synthetic/figure.json] [--frames 60] [--chains 1,10,60] [--size 640x480]
        [--first 12] [--words "OPTIONS OF RECONSTRUCT"] [--out FILE] [--keep FOLDER]

Renders the spec's motion, lets `photohull batch --frames` reconstruct it with chains of several lengths, in turn, and
compares time, F-scores and colours. Time is that of the reconstructions, from batch.csv, and a ratio to chains of 1. F is
the mean over the frames at 0.1 and 0.25 % of the diagonal, and the lowest difference of a frame from chains of 1. Flicker is
the root mean square, in 8-bit codes of sRGB, of how much colours change from frame to frame on parts that do not move;
noise is the same of the photographs' pixels there."""
import argparse
import csv
from pathlib import Path
from statistics import fmean

import numpy as np
from PIL import Image

from bench import ply, tables
from bench.runner import SYNTHETIC, Photohull, add_keep, add_program, f_scores, keep_json, listed, read_spec, work_folder

STILL_POINTS = 400
STILL = 1e-4  # share of the diagonal by which still parts may differ between frames' exact surfaces
THRESHOLDS = (0.001, 0.0025)
COLUMNS = ["chain", "CPU s a frame", "ratio", "wall ratio", "F 0.1 %", "F 0.25 %", "lowest difference", "flicker", "noise"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("--spec", type=Path, default=SYNTHETIC / "figure.json")
    parser.add_argument("--frames", type=int, default=60, help="of one period (default: %(default)s)")
    parser.add_argument("--first", type=int, help="only so many of them")
    parser.add_argument("--chains", type=listed, default=["1", "10", "60"], help="default: 1,10,60")
    parser.add_argument("--size", help="of the photographs (default: the spec's)")
    parser.add_argument("--words", default="", help="options for reconstruct, in one text")
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


def measure(photohull: Photohull, scene: Path, frames: list[str], chain: int, words: list[str], folder: Path) -> dict:
    out = folder / f"chain{chain}"
    photohull.call("batch", str(scene) + "/{frame}", "--frames", f"{frames[0]}-{frames[-1]}", "--chain", chain, "--fresh",
                   "--out", out, *words)
    with open(out / "batch.csv", encoding="utf-8", newline="") as table:
        rows = list(csv.DictReader(table))
    scores = [f_scores(photohull.evaluate(out / frame / "mesh.ply", "--truth", scene / frame, "--thresholds",
                                          ",".join(map(str, THRESHOLDS)))) for frame in frames]
    return {"chain": chain, "cpu": fmean(float(r["cpu_seconds"]) for r in rows),
            "wall": fmean(float(r["wall_seconds"]) for r in rows),
            "f": [[100 * s[t] for t in THRESHOLDS] for s in scores],
            "flicker": flicker(out, frames, still_points(scene, frames)), "noise": noise(scene, frames)}


def cells(r: dict, base: dict) -> list[str]:
    lowest = min(b - a for one, other in zip(base["f"], r["f"], strict=True) for a, b in zip(one, other, strict=True))
    means = [fmean(f[i] for f in r["f"]) for i in range(len(THRESHOLDS))]
    return [str(r["chain"]), f"{r['cpu']:.2f}", f"{r['cpu'] / base['cpu']:.2f}", f"{r['wall'] / base['wall']:.2f}",
            *(f"{m:.2f}" for m in means), f"{lowest:+.2f}", f"{r['flicker']:.2f}", f"{r['noise']:.2f}"]


def run(options: argparse.Namespace) -> None:
    photohull = Photohull(options.program)
    count = options.first or options.frames
    digits = len(str(options.frames - 1))
    all_frames = [f"{i:0{digits}d}" for i in range(options.frames)]
    with work_folder(options.keep) as folder:
        size = ["--size", options.size] if options.size else []
        scene = photohull.synthesize(read_spec(options.spec), folder / "scene", "--frames",
                                     f"{all_frames[0]}-{all_frames[-1]}", *size)
        rows = [measure(photohull, scene, all_frames[:count], int(chain), options.words.split(), folder)
                for chain in options.chains]
    tables.show(COLUMNS, [cells(r, rows[0]) for r in rows])
    keep_json(options.out, rows)
