#!/usr/bin/env python3
"""Moves the outlines of all masks of a synthetic scene, in every view by a smooth random field of its own.

    build/release/photohull synthesize SPEC.json --out out/scene
    bench/wavy_masks.py out/scene out/wavy                    # by 1 pixel, the deviation in x and in y
    build/release/photohull reconstruct out/wavy --out out/result --resolution 192

Needs numpy and oiiotool (OpenImageIO). The figures are in docs/measurements/benchmarks.md, "Evidence of all views".
"""
import argparse
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

SMOOTH = 12  # pixels, deviation of the Gaussian that the field is smoothed with


def read(path, folder):
    """8-bit grey values of a picture."""
    raw = folder / "mask.pgm"
    subprocess.run(["oiiotool", path, "-d", "uint8", "-o", raw], check=True)
    magic, size, _, pixels = raw.read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    assert magic == b"P5"
    return np.frombuffer(pixels, np.uint8, width * height).reshape(height, width)


def write(path, grey, folder):
    raw = folder / "mask.pgm"
    raw.write_bytes(b"P5\n%d %d\n255\n" % grey.shape[::-1] + grey.tobytes())
    subprocess.run(["oiiotool", raw, "-d", "uint8", "-o", path], check=True)


def smooth_field(rng, shape, pixels):
    """Random numbers of this deviation, correlated over some 20 pixels."""
    rows, columns = np.fft.fftfreq(shape[0])[:, None], np.fft.rfftfreq(shape[1])[None]
    kernel = np.exp(-2 * (np.pi * SMOOTH) ** 2 * (rows**2 + columns**2))
    field = np.fft.irfft2(np.fft.rfft2(rng.standard_normal(shape)) * kernel, shape)
    return pixels * field / field.std()


def displaced(grey, dy, dx):
    height, width = grey.shape
    y, x = np.mgrid[0:height, 0:width]
    y, x = np.clip(y + dy, 0, height - 1.001), np.clip(x + dx, 0, width - 1.001)
    i, j = y.astype(int), x.astype(int)
    v, u, g = y - i, x - j, grey.astype(float)
    value = (1 - v) * ((1 - u) * g[i, j] + u * g[i, j + 1]) + v * ((1 - u) * g[i + 1, j] + u * g[i + 1, j + 1])
    return np.round(value).astype(np.uint8)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--pixels", type=float, default=1)
    arguments = parser.parse_args()
    shutil.copytree(arguments.scene, arguments.out)
    rng = np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as name:
        for path in sorted((arguments.out / "masks").glob("*.png")):
            grey = read(path, Path(name))
            dy, dx = (smooth_field(rng, grey.shape, arguments.pixels) for _ in range(2))
            path.unlink()
            write(path, displaced(grey, dy, dx), Path(name))


if __name__ == "__main__":
    main()
