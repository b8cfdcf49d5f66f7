"""Share of the object's pixels in highlights, for the axis `gloss` of bench/plans/stress.json.

    python3 -m bench highlight_share

Every scene is synthesized with and without gloss, in pictures of 96 x 96 pixels; a pixel is in a highlight where gloss
adds at least half of the light that is there without. Prints the share over all views for each strength of the axis.
Needs numpy, and oiiotool (OpenImageIO)."""
import argparse
import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from bench import pictures, tables
from bench.runner import ROOT, Photohull, add_program, work_folder

PLAN = ROOT / "bench/plans/stress.json"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)


def linear(codes: np.ndarray) -> np.ndarray:
    v = codes / 255.0
    return np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4).mean(axis=2)


def light(photohull: Photohull, spec: dict, material: dict, folder: Path) -> np.ndarray:
    """Linear light of all pixels that the object covers."""
    small = {"image": {"width": 96, "height": 96, "samples": 2, "maps": False}, "truth_samples": 100}
    scene = photohull.synthesize(spec | small | {"material": material}, folder / "scene")
    return np.concatenate([linear(pictures.read(path))[pictures.read(scene / "masks" / path.name)[..., 0] > 127]
                           for path in sorted((scene / "images").glob("*.png"))])


def rows(photohull: Photohull, folder: Path) -> Iterator[list[object]]:
    plan = json.loads(PLAN.read_text(encoding="utf-8"))
    axis = next(a for a in plan["axes"] if a["name"] == "gloss")
    for scene in plan["scenes"]:
        if scene.get("on_demand"):
            continue
        spec = plan["spec"] | scene["spec"]
        matt = light(photohull, spec, {}, folder)
        for point in axis["points"]:
            glossy = light(photohull, spec, point["spec"]["material"], folder)
            yield [scene["name"], point["strength"], f"{(glossy - matt > 0.5 * matt).mean():.3f}"]


def run(options: argparse.Namespace) -> None:
    with work_folder(None) as folder:
        tables.show(["scene", "strength", "share"], rows(Photohull(options.program), folder))
