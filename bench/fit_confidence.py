#!/usr/bin/env python3
"""Fits the constants of src/render/confidence.cpp and measures how well confidence is calibrated.

    bench/fit_confidence.py [--also SCENE ...] [--resolution 192]

makes the scenes of datasets/synthetic, reconstructs each by refinement and as a hull with
--evidence, and measures every vertex against the exact surface. A vertex is right when it lies
within a voxel of it. Every other scene by name, from the second on, is fitted to (of the two halves
the one with more wrong vertices to learn from): the logistic function by refinement, then what
hulls lack in odds. Each scene weighs the same. Prints the constants, and for each scene
what the program's own confidence gives: calibration error, Brier score, AUC (docs/guide/evaluate.md);
--also adds scenes that are measured only. What is there in the work folder is not made again.
Needs numpy.
"""
import argparse
import json
import pathlib
import subprocess
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
BINS = 10
PER_SCENE = 20000  # vertices, so that large meshes do not decide
# As in src/render/confidence.cpp.
LEAST_DEVIATION, LEAST_SCATTER = 0.01, 0.05
RIDGE = 1e-2  # of the standardised weights; keeps the fit from running away, moves little


def read_ply(path):
    """The vertices of a binary PLY that photohull wrote, as a structured array."""
    kinds = {"float": "<f4", "double": "<f8", "uchar": "u1"}
    with open(path, "rb") as file:
        fields, count, element = [], 0, None
        while True:
            words = file.readline().decode().split()
            if not words:
                sys.exit(f"{path}: the header ends early")
            if words[0] == "element":
                element = words[1]
                count = int(words[2]) if element == "vertex" else count
            elif words[0] == "property" and element == "vertex":
                fields.append((words[2], kinds[words[1]]))
            elif words[0] == "end_header":
                return np.fromfile(file, dtype=fields, count=count)


class Bench:
    def __init__(self, arguments):
        self.program = arguments.program
        self.work = arguments.work
        self.resolution = str(arguments.resolution)

    def call(self, *words):
        done = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True)
        if done.returncode not in (0, 3):  # 3: done, but the result failed its own checks
            sys.exit(f"photohull {' '.join(map(str, words))}: {done.stderr.strip()}")

    def scene_of(self, spec):
        folder = self.work / "scenes" / spec.stem
        if not (folder / "gt.ply").exists():
            folder.parent.mkdir(parents=True, exist_ok=True)
            self.call("synthesize", spec, "--out", folder)
        return folder

    def measure(self, scene, method):
        """Evidence, confidence and error (voxels) of the seen vertices of a reconstruction."""
        out = self.work / "runs" / f"{method}-{self.resolution}" / f"{scene.parent.name}-{scene.name}"
        errors = out / "errors.ply"
        if not errors.exists():
            out.mkdir(parents=True, exist_ok=True)
            self.call("reconstruct", scene, "--out", out, "--method", method, "--resolution",
                      self.resolution, "--evidence")
            self.call("evaluate", out / "evidence.ply", "--truth", scene, "--error-mesh", errors)
        voxel = json.loads((out / "report.json").read_text())["grid"]["voxel_size"]
        mesh, judged = read_ply(out / "evidence.ply"), read_ply(errors)
        seen = mesh["confidence"] > 0
        columns = [np.ones(seen.sum()),
                   np.log(mesh["disagreement"][seen] + LEAST_DEVIATION),
                   np.log(mesh["scatter"][seen] + LEAST_SCATTER),
                   np.log(mesh["fine_share"][seen])]
        chosen = np.random.default_rng(1).permutation(seen.sum())[:PER_SCENE]
        return Measured(scene.name, np.stack(columns, 1).astype(float)[chosen],
                        mesh["confidence"][seen].astype(float)[chosen],
                        np.abs(judged["distance"][seen]).astype(float)[chosen] / voxel)


class Measured:
    def __init__(self, name, evidence, confidence, error):
        self.name, self.evidence, self.confidence, self.error = name, evidence, confidence, error
        self.right = error <= 1


def chance(evidence, weights):
    return 1 / (1 + np.exp(-evidence @ weights))


def stack(scenes):
    evidence = np.concatenate([s.evidence for s in scenes])
    right = np.concatenate([s.right for s in scenes]).astype(float)
    weight = np.concatenate([np.full(len(s.right), 1 / len(s.right)) for s in scenes])
    return evidence, right, weight


def fit(scenes):
    """Logistic regression by Newton's method."""
    evidence, right, weight = stack(scenes)
    mean, spread = evidence.mean(0), evidence.std(0)
    mean[0], spread[0] = 0, 1
    x = (evidence - mean) / spread
    w = np.zeros(x.shape[1])
    for _ in range(50):
        p = chance(x, w)
        step = np.linalg.solve((x * (weight * p * (1 - p))[:, None]).T @ x + RIDGE * np.eye(len(w)),
                               x.T @ (weight * (right - p)) - RIDGE * w)
        w += step
        if np.abs(step).max() < 1e-8:
            break
    w /= spread
    w[0] -= w[1:] @ mean[1:]
    return w


def fit_offset(scenes, weights):
    """What to add to the constant for these scenes."""
    evidence, right, weight = stack(scenes)
    offset = np.zeros_like(weights)
    for _ in range(50):
        p = chance(evidence, weights + offset)
        offset[0] += (weight * (right - p)).sum() / (weight * p * (1 - p)).sum()
    return offset


def calibration_error(confidence, right):
    bins = np.clip(np.ceil(confidence * BINS).astype(int) - 1, 0, BINS - 1)
    gaps = np.bincount(bins, confidence - right, BINS)
    return np.abs(gaps).sum() / len(right)


def auc(confidence, right):
    values, inverse, counts = np.unique(confidence, return_inverse=True, return_counts=True)
    ranks = (np.cumsum(counts) - (counts - 1) / 2)[inverse]
    good, bad = right.sum(), (~right).sum()
    if good == 0 or bad == 0:
        return float("nan")
    return (ranks[right].sum() - good * (good + 1) / 2) / (good * bad)


def table(title, scenes, weights=None):
    """One row a scene, by the program's confidence or by that of `weights`."""
    print(f"\n{title}\n{'scene':22} {'right':>7} {'conf.':>7} {'ECE':>7} {'Brier':>7} {'AUC':>7}")
    rows = []
    for s in scenes:
        c = s.confidence if weights is None else chance(s.evidence, weights)
        rows.append([s.right.mean(), c.mean(), calibration_error(c, s.right),
                     ((c - s.right) ** 2).mean(), auc(c, s.right)])
        print(f"{s.name:22} " + " ".join(f"{v:7.3f}" for v in rows[-1]))
    print(f"{'mean':22} " + " ".join(f"{v:7.3f}" for v in np.nanmean(rows, 0)))


def draw(bench, name, scenes):
    """The reliability diagram of all scenes together: errors become heights over a plane."""
    per_scene = min(len(s.right) for s in scenes)
    confidence = np.concatenate([s.confidence[:per_scene] for s in scenes])
    error = np.concatenate([s.error[:per_scene] for s in scenes])
    points = np.zeros((len(error), 4), "<f4")
    points[:, 2], points[:, 3] = np.minimum(error, 100), confidence
    header = ("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
              "property float y\nproperty float z\nproperty float confidence\nend_header\n")
    cloud, plane = bench.work / f"{name}.ply", bench.work / "plane.obj"
    cloud.write_bytes(header.format(len(points)).encode() + points.tobytes())
    plane.write_text("v -999 -999 0\nv 999 -999 0\nv 999 999 0\nv -999 999 0\nf 1 2 3\nf 1 3 4\n")
    bench.call("evaluate", cloud, "--truth", plane, "--reliability", 1, "--reliability-plot",
               bench.work / f"{name}.svg")
    print(f"{bench.work / name}.svg: {len(points)} vertices, calibration error "
          f"{calibration_error(confidence, error <= 1):.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/release/photohull", type=pathlib.Path)
    parser.add_argument("--work", default=ROOT / "out/confidence", type=pathlib.Path)
    parser.add_argument("--also", nargs="*", default=[], type=pathlib.Path)
    parser.add_argument("--resolution", default=192, type=int)
    arguments = parser.parse_args()
    bench = Bench(arguments)
    scenes = [bench.scene_of(s) for s in sorted((ROOT / "datasets/synthetic").glob("*.json"))]
    measured = {}
    for method in ("refine", "hull"):
        for scene in [*scenes, *(s.resolve() for s in arguments.also)]:
            print(f"{method} {scene.name}", file=sys.stderr)
            measured.setdefault(method, []).append(bench.measure(scene, method))
    count = len(scenes)
    refined, hulls = measured["refine"][:count], measured["hull"][:count]
    halves = {"fitted": slice(1, None, 2), "held out": slice(0, None, 2)}

    weights = fit(refined[halves["fitted"]])
    offset = fit_offset(hulls[halves["fitted"]], weights)
    print("kConstant = %.2f, kByDisagreement = %.2f, kByScatter = %.2f, kByShare = %.2f" %
          tuple(weights))
    print("kSilhouettesOnly = %.2f" % offset[0])
    for half, which in halves.items():
        table(f"refine, {half}: the program's confidence", refined[which])
    if arguments.also:
        table("refine, other scenes: the program's confidence", measured["refine"][count:])
    for half, which in halves.items():
        table(f"hull, {half}: the program's confidence", hulls[which])
    if arguments.also:
        table("hull, other scenes: the program's confidence", measured["hull"][count:])
    swapped = fit(refined[halves["held out"]])
    print("\nhalves swapped: " + " ".join(f"{w:.2f}" for w in swapped))
    table("refine, the fitted half by these constants of the other", refined[halves["fitted"]], swapped)
    print()
    draw(bench, "held-out", refined[halves["held out"]])
    if arguments.also:
        draw(bench, "other-scenes", measured["refine"][count:])


if __name__ == "__main__":
    main()
