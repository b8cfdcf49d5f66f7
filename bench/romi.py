"""photohull.romi beside a plain NumPy version of the same votes and Open3D's carving: CPU and wall seconds, memory, and how
far they differ.

    /usr/bin/python3 -m bench romi

A made-up plant of thin stems stands in the volume; its masks are drawn for cameras on two rings around it. Each is run in
a process of its own, with that Python for which photohull's package was built. NumPy's time for all views is that of the
first --numpy-views of them, times the number of views, for each costs the same. Open3D (Debian: python3-open3d) keeps a
voxel where any of its eight corners lies in the masks, the others where its centre does; it is left out where it is missing."""
import argparse
import importlib.util
import multiprocessing
import resource
import sys
import time
from pathlib import Path
from typing import NamedTuple

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


class Volume(NamedTuple):
    shape: tuple[int, int, int]
    origin: tuple[float, float, float]  # the first voxel's centre
    voxel: float


class Cost(NamedTuple):
    cpu: float  # seconds of all views, user and system, all threads
    wall: float
    making: float  # CPU seconds before the first view: what makes the volume
    peak: float  # MiB, of the whole process


def cpu_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def cost_of(make, view, views, count=0):
    """What `make` made, after `view` took each view, and what that cost; of the first `count` views, for all of them."""
    begin = cpu_seconds()
    volume = make()
    cpu, wall = cpu_seconds(), time.perf_counter()
    making = cpu - begin
    some = views[:count or len(views)]
    for of_view, mask in some:
        view(volume, of_view, mask)
    times = len(views) / len(some)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return volume, Cost((cpu_seconds() - cpu) * times, (time.perf_counter() - wall) * times, making, peak)


def by_photohull(volume, kind, views, count):
    """The values after `count` views, those after all, and what all cost."""
    from photohull.romi import Backprojection

    def make():
        return Backprojection(volume.shape, volume.origin, volume.voxel, type=kind)

    def view(into, of_view, mask):
        into.process_view(*of_view, mask)

    whole, cost = cost_of(make, view, views)
    few = make()
    for of_view, mask in views[:count]:
        view(few, of_view, mask)
    return few.values(), whole.values(), cost


def by_numpy(volume, kind, views, count):
    """The values after `count` views, and what all would cost."""
    def view(into, of_view, mask):
        project_back(into, volume.origin, volume.voxel, kind, of_view, mask)

    return cost_of(lambda: np.zeros(volume.shape, np.int32 if kind == "carving" else np.float32), view, views, count)


def by_open3d(volume, views):
    """The voxels that are left, as indices, and what it cost."""
    import open3d

    def make():
        corner = np.array(volume.origin) - 0.5 * volume.voxel
        sides = [n * volume.voxel for n in volume.shape]
        return open3d.geometry.VoxelGrid.create_dense(corner, np.zeros(3), volume.voxel, *sides)

    def view(into, of_view, mask):
        (fx, fy, cx, cy), rotation, translation = of_view
        camera = open3d.camera.PinholeCameraParameters()
        camera.intrinsic = open3d.camera.PinholeCameraIntrinsic(mask.shape[1], mask.shape[0], fx, fy, cx, cy)
        camera.extrinsic = np.vstack([np.column_stack([rotation, translation]), [0, 0, 0, 1]])
        into.carve_silhouette(open3d.geometry.Image(mask.astype(np.float32)), camera, True)

    grid, cost = cost_of(make, view, views)
    return np.array([voxel.grid_index for voxel in grid.get_voxels()]), cost


def alone(function, *arguments):
    """In a process of its own."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        return pool.apply(function, arguments)


def row(kind: str, name: str, cost: Cost, ours: Cost, differs: str) -> None:
    print(f"| {kind} | {name} | {cost.cpu:.1f} | {cost.wall:.1f} | {cost.cpu / ours.cpu:.1f} | {cost.making:.1f} | {cost.peak:.0f} | {differs} |",
          flush=True)


def run(options: argparse.Namespace) -> int:
    sys.path.insert(0, str(options.package))
    width, height = map(int, options.size.split("x"))
    shape = tuple(map(int, options.shape.split("x")))
    voxel = 450 / shape[2]
    volume = Volume(shape, tuple(-0.5 * voxel * (n - 1) for n in shape), voxel)
    points = stems(np.random.default_rng(1))
    cameras = [camera(i, options.views, width, height) for i in range(options.views)]
    views = [(c, drawn(points, c, width, height)) for c in cameras]
    print(f"{options.views} views of {width} x {height} into {shape[0]} x {shape[1]} x {shape[2]} voxels")
    print("| type | by | CPU s | wall s | ratio | volume, CPU s | peak MiB | beside photohull |\n|---|---|---|---|---|---|---|---|")
    for kind in ("carving", "averaging"):
        few, whole, ours = alone(by_photohull, volume, kind, views, options.numpy_views)
        row(kind, "photohull", ours, ours, f"{np.count_nonzero(whole == 1)} voxels left" if kind == "carving" else "")
        theirs, cost = alone(by_numpy, volume, kind, views, options.numpy_views)
        row(kind, "NumPy", cost, ours, f"largest difference {np.abs(few.astype(np.float64) - theirs).max():.2g}")
        if kind == "carving" and importlib.util.find_spec("open3d"):
            left, cost = alone(by_open3d, volume, views)
            kept = np.count_nonzero(whole[tuple(left.T)] == 1)
            row(kind, "Open3D", cost, ours, f"{len(left)} voxels left, {kept} of them the same")
    return 0
