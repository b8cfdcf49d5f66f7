"""What becomes of real photographs whose cameras are off.

    python3 -m bench cameras_off [--scenes fountain,templeSparseRing] [--pixels 0,0.5,2,8,32] [--resolution 256]
        [--out FILE] [--keep FOLDER]

Takes scenes with a file of camera matrices (*_par.txt), turns every camera at random by so many pixels in the middle of
its image (standard deviation of each of three angles) and moves it by half of that across, and reconstructs with cameras
as they are (--refine-cameras off) and by default. Columns:
  features, px   what a quick look at features finds (feature_agreement in report.json; without outlines)
  outlines, px   the same of silhouettes' tangents (masks.disagreement)
  agree, px      what features agree to in the default run, held out: before and after refinement
  explained      the share of the photographs' texture that the result explains (without masks), or that is confirmed on
                 the surface (with masks), as the verdict has it: cameras as they are, and by default
  CPU s          of the stage that looks at cameras, in the default run
Needs numpy."""
import argparse
import math
import sys
from pathlib import Path

import numpy as np

from bench import tables
from bench.runner import Photohull, add_datasets, add_keep, add_program, keep_json, listed, work_folder

COLUMNS = ["scene", "off by, px", "features, px", "outlines, px", "agree, px", "explained, as they are", "by default", "CPU s"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    add_datasets(parser)
    parser.add_argument("--scenes", type=listed, default="fountain,templeSparseRing")
    parser.add_argument("--pixels", type=listed, default="0,0.5,2,8,32")
    parser.add_argument("--resolution", type=int, default=256)
    parser.add_argument("--out", type=Path, help="file for the figures")
    add_keep(parser)


def turned(angles: np.ndarray) -> np.ndarray:
    """The rotation about a vector by its length, radians [Rodrigues' formula]."""
    angle = np.linalg.norm(angles)
    if angle == 0:
        return np.eye(3)
    x, y, z = angles / angle
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k


def put_off(scene: Path, pixels: float, folder: Path) -> Path:
    """The scene's photographs, with cameras that are off."""
    rng = np.random.default_rng(7)
    folder.mkdir(parents=True, exist_ok=True)
    given = next(scene.glob("*_par.txt"))
    for file in scene.iterdir():
        if file != given and file.name != "transforms.json" and not (folder / file.name).exists():
            (folder / file.name).symlink_to(file.resolve())
    count, *lines = given.read_text(encoding="utf-8").split("\n")
    written = [count]
    for line in filter(str.strip, lines):
        name, *words = line.split()
        numbers = np.array(words, float)
        k, rotation, move = numbers[:9].reshape(3, 3), numbers[9:18].reshape(3, 3), numbers[18:]
        turn = turned(rng.normal(0, pixels / k[0, 0], 3))
        shift = rng.normal(0, 0.5 * pixels / k[0, 0], 3) * np.linalg.norm(move)
        rotation, move = turn @ rotation, turn @ move + shift
        written.append(" ".join([name, *(f"{x:.12g}" for x in (*k.ravel(), *rotation.ravel(), *move))]))
    (folder / given.name).write_text("\n".join(written) + "\n", encoding="utf-8")
    return folder


def explained(report: dict) -> float:
    """In percent."""
    verdict = report["verdict"]
    return 100 * verdict.get("photographs", {"explained": verdict["signals"]["matched"]})["explained"]


def judge(photohull: Photohull, scene: Path, pixels: float, resolution: int, folder: Path) -> dict:
    off = put_off(scene, pixels, folder / f"{scene.name}_{pixels:g}")
    options = ("--resolution", resolution)
    taken = photohull.reconstruct(off, folder / f"{off.name}_taken", "--refine-cameras", "off", *options).report
    report = photohull.reconstruct(off, folder / f"{off.name}_default", *options).report
    refined = report.get("camera_refinement", {})
    return {"scene": scene.name, "pixels": pixels, "features": report.get("feature_agreement", {}).get("pixels"),
            "outlines": report["masks"].get("disagreement"), "used": refined.get("used", False),
            "agree": [refined.get("residual_before"), refined.get("residual_after")],
            "explained": [explained(taken), explained(report)],
            "cpu_s": next(stage["cpu_seconds"] for stage in report["stages"] if stage["name"] == "cameras")}


def cells(row: dict) -> list[object]:
    def known(value: float | None) -> str:
        return "-" if value is None else f"{value:.2f}"
    agree = f"{known(row['agree'][0])} to {known(row['agree'][1])}" if row["used"] else "left as they are"
    return [row["scene"], f"{row['pixels']:g}", known(row["features"]), known(row["outlines"]), agree,
            *(f"{share:.0f} %" for share in row["explained"]), f"{row['cpu_s']:.1f}"]


def run(options: argparse.Namespace) -> None:
    photohull, rows = Photohull(options.program), []
    with work_folder(options.keep) as folder:
        for name in options.scenes:
            for pixels in options.pixels:
                rows.append(judge(photohull, options.datasets / name, float(pixels), options.resolution, folder))
                print(rows[-1], file=sys.stderr, flush=True)
    tables.show(COLUMNS, map(cells, rows))
    keep_json(options.out, rows)
