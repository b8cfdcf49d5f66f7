"""photohull.romi against a plain NumPy version of the same votes: CPU and wall seconds, and how far they differ.

    python3 -m bench romi

A made-up plant of thin stems stands in the volume; its masks are drawn for cameras on two rings around it. NumPy's time
for all views is that of the first --numpy-views of them, times the number of views, for each costs the same."""
import argparse
import sys
import time
from pathlib import Path

from bench.runner import PROGRAM, ROOT

import numpy as np

sys.path.insert(0, str(ROOT / "tests/python"))
from reference import project_back  # noqa: E402


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--package", type=Path, default=PROGRAM.parent / "python", help="default: build/release/python")
    parser.add_argument("--views", type=int, default=72)
    parser.add_argument("--size", default="1440x1080", help="of the masks, pixels (default: %(default)s)")
    parser.add_argument("--shape", default="300x300x450", help="of the volume, voxels (default: %(default)s)")
    parser.add_argument("--numpy-views", type=int, default=3, help="that NumPy's time is measured on (default: %(default)s)")


def stems(random) -> np.ndarray:
    """Points along branches of a plant in a box of 300 x 300 x 450 units around the origin."""
    points = []
    for _ in range(24):
        base = np.array([0, 0, random.uniform(-200, 120)])
        tip = base + np.array([*random.uniform(-120, 120, 2), random.uniform(20, 100)])
        points.append(base + np.linspace(0, 1, 200)[:, None] * (tip - base))
    points.append(np.linspace([0, 0, -220], [0, 0, 200], 600))
    return np.concatenate(points)


def camera(index: int, views: int, width: int, height: int):
    angle, elevation = 4 * np.pi * index / views, np.radians(10 if 2 * index < views else 40)
    back = np.array([np.cos(angle) * np.cos(elevation), np.sin(angle) * np.cos(elevation), np.sin(elevation)])
    right = np.array([-np.sin(angle), np.cos(angle), 0])
    rotation = np.stack([right, -np.cross(back, right), -back])
    return [1.25 * width, 1.25 * width, width / 2, height / 2], rotation, -rotation @ (1000 * back)


def drawn(points, of_view, width: int, height: int) -> np.ndarray:
    (fx, fy, cx, cy), rotation, translation = of_view
    p = points @ rotation.T + translation
    mask = np.zeros((height, width), np.uint8)
    radius = 5
    for x, y in zip((p[:, 0] / p[:, 2] * fx + cx).astype(int), (p[:, 1] / p[:, 2] * fy + cy).astype(int)):
        mask[max(y - radius, 0):max(y + radius + 1, 0), max(x - radius, 0):max(x + radius + 1, 0)] = 255
    return mask


def run(options: argparse.Namespace) -> int:
    sys.path.insert(0, str(options.package))
    from photohull.romi import Backprojection
    width, height = map(int, options.size.split("x"))
    shape = tuple(map(int, options.shape.split("x")))
    voxel = 450 / shape[2]
    origin = tuple(-0.5 * voxel * (n - 1) for n in shape)
    points = stems(np.random.default_rng(1))
    cameras = [camera(i, options.views, width, height) for i in range(options.views)]
    masks = [drawn(points, c, width, height) for c in cameras]
    print(f"{options.views} views of {width} x {height} into {shape[0]} x {shape[1]} x {shape[2]} voxels")
    print("| type | photohull, CPU s | wall s | NumPy, CPU s | ratio | largest difference |\n|---|---|---|---|---|---|")
    for kind in ("carving", "averaging"):
        ours = Backprojection(shape, origin, voxel, type=kind)
        cpu, wall = time.process_time(), time.perf_counter()
        for of_view, mask in zip(cameras, masks):
            ours.process_view(*of_view, mask)
        cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
        few = Backprojection(shape, origin, voxel, type=kind)
        theirs = np.zeros(shape, few.dtype)
        slow = time.process_time()
        for of_view, mask in zip(cameras[:options.numpy_views], masks):
            project_back(theirs, origin, voxel, kind, of_view, mask)
        slow = (time.process_time() - slow) * options.views / options.numpy_views
        for of_view, mask in zip(cameras[:options.numpy_views], masks):
            few.process_view(*of_view, mask)
        worst = np.abs(few.values().astype(np.float64) - theirs).max()
        print(f"| {kind} | {cpu:.1f} | {wall:.1f} | {slow:.0f} | {slow / cpu:.0f} | {worst:.2g} |", flush=True)
    return 0
