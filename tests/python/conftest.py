"""What the tests of Python's package share: a small scene of a sphere whose answer is known, and photographs on a printed sheet."""
import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

import photohull

RADIUS = 1.0
SPEC = {
    "name": "sphere",
    "geometry": {"shape": "sphere"},
    "image": {"width": 96, "height": 72, "samples": 2, "maps": False},
    "cameras": {"rings": [{"count": 8, "elevation": 10}, {"count": 8, "elevation": 45, "phase": 0.5}]},
}

# On a printed sheet, as small as its tags allow.
TABLE = {
    "geometry": {"shape": "pawn"}, "material": {"base": [0.6, 0.33, 0.16]}, "background": {"colour": [0.1, 0.12, 0.14]},
    "sheet": {"board": "board.json", "fill": 0.6, "hidden": 0.2},
    "image": {"width": 800, "height": 600, "samples": 1, "maps": False}, "truth_samples": 2000,
    "cameras": {"rings": [{"count": 4, "elevation": 32}, {"count": 4, "elevation": 55, "phase": 0.5}], "distance": 3.2, "fill": 0.5},
}


@pytest.fixture(scope="session")
def sphere(tmp_path_factory) -> Path:
    """A folder with photographs of a sphere, their masks and cameras."""
    folder = tmp_path_factory.mktemp("sphere")
    photohull.synthesize(SPEC, folder)
    return folder


class Arrays:
    """The same as arrays."""

    def __init__(self, folder):
        scene = photohull.load(folder)
        self.images = [scene.image(view) for view in range(len(scene))]
        self.masks = [scene.mask(view) for view in range(len(scene))]
        self.K, self.R, self.t = np.array(scene.K), np.array(scene.R), np.array(scene.t)
        self.names, self.box = scene.names, scene.box

    def scene(self, **changes):
        given = {"images": self.images, "K": self.K, "R": self.R, "t": self.t, "masks": self.masks,
                 "names": self.names, "box": self.box} | changes
        return photohull.scene(given.pop("images"), given.pop("K"), given.pop("R"), given.pop("t"), **given)


@pytest.fixture(scope="session")
def arrays(sphere):
    return Arrays(sphere)


@pytest.fixture(scope="session")
def result(sphere):
    return photohull.hull(sphere, resolution=32)


@pytest.fixture(scope="session")
def program() -> str:
    return os.environ["PHOTOHULL_PROGRAM"]


@pytest.fixture(scope="session")
def table(tmp_path_factory, program):
    """A folder with board.json, and in table/images photographs of a chess piece on that sheet."""
    folder = tmp_path_factory.mktemp("table")
    subprocess.run([program, "board", "--out", folder / "board.pdf"], check=True, capture_output=True)
    (folder / "spec.json").write_text(json.dumps(TABLE))
    photohull.synthesize(folder / "spec.json", folder / "table")
    return folder
