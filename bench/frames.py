"""Frames of something that moves, each by itself and in chains.

    python3 -m bench frames [--spec datasets/synthetic/figure.json] [--frames 60] [--chains 1,10,60] [--size 640x480]
        [--first 12] [--words "OPTIONS OF RECONSTRUCT"] [--out FILE] [--keep FOLDER]

Renders the spec's motion, with cameras that differ in exposure, with noise and without shadows, lets `photohull batch --frames` reconstruct it with chains of several lengths, in turn, and
compares time, F-scores and colours. Time is that of the reconstructions, from batch.csv, each frame's in the quickest of
several rounds, and a ratio to chains of 1. F is
the mean over the frames at 0.1 and 0.25 % of the diagonal, and the lowest difference of a frame from chains of 1. Flicker is
the root mean square, in 8-bit codes of sRGB, of how much colours change from frame to frame on parts that do not move;
noise is the same of the photographs' pixels there."""
import argparse
import csv
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


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("--spec", type=Path, default=SYNTHETIC / "figure.json")
    parser.add_argument("--frames", type=int, default=60, help="of one period (default: %(default)s)")
    parser.add_argument("--first", type=int, help="only so many of them (default: all)")
    parser.add_argument("--chains", type=listed, default=["1", "10", "60"], help="default: 1,10,60")
    parser.add_argument("--size", help="of the photographs (default: the spec's)")
    parser.add_argument("--repeat", type=int, default=3, help="rounds, of which each frame's quickest counts (default: %(default)s)")
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


def make(photohull: Photohull, scene: Path, frames: list[str], chain: int, words: list[str], out: Path) -> dict:
    """The sums of CPU and wall seconds of every frame."""
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
    return {"frames": [[100 * s[t] for t in THRESHOLDS] for s in scores],
            "flicker": flicker(out, frames, still_points(scene, frames)), "noise": noise(scene, frames)}


def compared(r: dict, base: dict) -> dict:
    """With what is said of it beside chains of 1."""
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
    count = options.first or options.frames
    frames = [f"{i:0{len(str(count - 1))}d}" for i in range(count)]
    with work_folder(options.keep) as folder:
        size = ["--size", options.size] if options.size else []
        scene = photohull.synthesize(start_of(read_spec(options.spec) | CHANGES, count / options.frames), folder / "scene",
                                     "--frames", f"{frames[0]}-{frames[-1]}", *size)
        outs = {int(chain): folder / f"chain{chain}" for chain in options.chains}
        rounds = [{chain: make(photohull, scene, frames, chain, options.words.split(), out) for chain, out in outs.items()}
                  for _ in range(options.repeat)]
        rows = [{"chain": chain} | {f"{name}_s": quickest([r[chain] for r in rounds], name) for name in ("cpu", "wall")}
                | judged(photohull, scene, frames, out) for chain, out in outs.items()]
    rows = [compared(r, rows[0]) for r in rows]
    print(page.table_of(page.data("benchmarks")["frames"], rows))
    keep_json(options.out, rows)
