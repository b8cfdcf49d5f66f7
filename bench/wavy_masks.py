"""Moves the outlines of all masks of a synthetic scene, in every view by a smooth random field of its own.

    build/release/photohull synthesize SPEC.json --out out/scene
    python3 -m bench wavy_masks out/scene out/wavy            # by 1 pixel, the deviation in x and in y
    build/release/photohull reconstruct out/wavy --out out/result --resolution 192

Needs numpy, and oiiotool (OpenImageIO). What such masks do to results is in
docs/design/decisions/0005-where-evidence-begins.md."""
import argparse
import shutil
from pathlib import Path

import numpy as np

from bench import pictures

SMOOTH = 12  # pixels, deviation of the Gaussian that the field is smoothed with


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--pixels", type=float, default=1)


def smooth_field(rng: np.random.Generator, shape: tuple[int, int], pixels: float) -> np.ndarray:
    """Random numbers of this deviation, correlated over some 20 pixels."""
    rows, columns = np.fft.fftfreq(shape[0])[:, None], np.fft.rfftfreq(shape[1])[None]
    kernel = np.exp(-2 * (np.pi * SMOOTH) ** 2 * (rows**2 + columns**2))
    field = np.fft.irfft2(np.fft.rfft2(rng.standard_normal(shape)) * kernel, shape)
    return pixels * field / field.std()


def displaced(grey: np.ndarray, dy: np.ndarray, dx: np.ndarray) -> np.ndarray:
    height, width = grey.shape
    y, x = np.mgrid[0:height, 0:width]
    y, x = np.clip(y + dy, 0, height - 1.001), np.clip(x + dx, 0, width - 1.001)
    i, j = y.astype(int), x.astype(int)
    v, u, g = y - i, x - j, grey.astype(float)
    value = (1 - v) * ((1 - u) * g[i, j] + u * g[i, j + 1]) + v * ((1 - u) * g[i + 1, j] + u * g[i + 1, j + 1])
    return np.round(value).astype(np.uint8)


def run(options: argparse.Namespace) -> None:
    shutil.copytree(options.scene, options.out)
    rng = np.random.default_rng(1)
    for path in sorted((options.out / "masks").glob("*.png")):
        grey = pictures.read(path)[..., 0]
        dy, dx = (smooth_field(rng, grey.shape, options.pixels) for _ in range(2))
        path.unlink()
        pictures.write_grey(path, displaced(grey, dy, dx))
