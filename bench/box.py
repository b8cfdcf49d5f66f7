"""The box that `photohull info --box auto` finds in each scene's photographs, against the truth.

    python3 -m bench box [SCENE ...]

Prints how much of the truth the box holds, and its volume over that of the truth's own box: the table of
docs/guide/box.md, by the masks that the scene has, and without masks. The truth is the vertices of gt.ply where the
scene has it, and their tight box; else the scene's known box itself, of which the box must then hold the volume (KNOWN
for `fountain`). Needs numpy."""
import argparse
from pathlib import Path

import numpy as np

from bench import ply, tables
from bench.runner import Photohull, add_datasets, add_program, keep_json

SCENES = "templeRing dinoRing templeSparseRing armadillo bunny fandisk trellis plaster glazed tabletop fountain".split()
KNOWN = {"fountain": [[-21, -13.2, -4.6], [-12.4, -8.5, 2.0]]}
LEAST_HELD, MOST_VOLUME = 0.995, 3


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    add_datasets(parser)
    parser.add_argument("--out", type=Path, help="file for the figures as JSON, such as bench/results/box.json")
    parser.add_argument("scenes", nargs="*", default=SCENES)


def corners(report: dict) -> np.ndarray:
    return np.array([report["box"]["min"], report["box"]["max"]])


def held_of(points: np.ndarray | None, known: np.ndarray, found: np.ndarray) -> float:
    """Share of the truth that the found box holds."""
    if points is not None:
        return float(((points >= found[0]) & (points <= found[1])).all(1).mean())
    common = np.clip(np.minimum(known[1], found[1]) - np.maximum(known[0], found[0]), 0, None)
    return float(np.prod(common) / np.prod(known[1] - known[0]))


def truth_of(photohull: Photohull, folder: Path) -> tuple[np.ndarray | None, np.ndarray]:
    """Vertices of the object, if they are known, and its box."""
    if (folder / "gt.ply").exists():
        points = ply.positions(ply.vertices(folder / "gt.ply"))
        return points, np.array([points.min(0), points.max(0)])
    if folder.name in KNOWN:
        return None, np.array(KNOWN[folder.name])
    return None, corners(photohull.json("info", folder))


def measure(photohull: Photohull, folder: Path) -> list[dict]:
    points, box = truth_of(photohull, folder)
    rows = []
    for masks in ("auto", "none"):
        done = photohull.call("info", folder, "--box", "auto", "--masks", masks, "--json")
        got = corners(done.report)
        rows.append({"scene": folder.name, "masks": masks, "held": held_of(points, box, got),
                     "volume": float(np.prod(got[1] - got[0]) / np.prod(box[1] - box[0])), "cpu": done.cpu_seconds,
                     "wall": done.wall_seconds, "box": got.tolist(), "source": done.report["box"]["source"]})
    return rows


def cells(row: dict) -> list[str]:
    missed = "" if row["held"] >= LEAST_HELD and row["volume"] <= MOST_VOLUME else " (missed)"
    return [row["scene"], row["masks"], f"{100 * row['held']:.2f} %", f"{row['volume']:.2f}{missed}",
            f"{row['cpu']:.1f}", row["source"]]


def run(options: argparse.Namespace) -> None:
    photohull = Photohull(options.program)
    rows = [row for name in options.scenes for row in measure(photohull, options.datasets / name)]
    tables.show(["scene", "masks", "truth held", "volume", "CPU s", "what it rests on"], map(cells, rows))
    keep_json(options.out, rows)
