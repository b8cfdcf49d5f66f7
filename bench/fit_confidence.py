"""Fits the constants of src/render/confidence.cpp and measures how well confidence is calibrated.

    python3 -m bench fit_confidence [--also SCENE ...] [--resolution 192]

makes the scenes of datasets/synthetic, reconstructs each by refinement and as a hull with
--evidence, and measures every vertex against the exact surface. A vertex is right when it lies
within a voxel of it. Every other scene by name, from the second on, is fitted to (of the two halves
the one with more wrong vertices to learn from): the logistic function by refinement, then what
hulls lack in odds. Each scene weighs the same. Prints the constants, and for each scene
what the program's own confidence gives: calibration error, Brier score, AUC (docs/guide/evaluate.md);
--also adds scenes that are measured only. What the same build left in the work folder is not made again.
Needs numpy."""
import argparse
import sys
from pathlib import Path

import numpy as np

from bench import ply, tables
from bench.runner import ROOT, SYNTHETIC, Photohull, add_program

BINS = 10
PER_SCENE = 20000  # vertices, so that large meshes do not decide
# As in src/render/confidence.cpp.
LEAST_DEVIATION, LEAST_SCATTER = 0.01, 0.05
RIDGE = 1e-2  # of the standardised weights; keeps the fit from running away, moves little


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("--work", default=ROOT / "out/confidence", type=Path)
    parser.add_argument("--also", nargs="*", default=[], type=Path)
    parser.add_argument("--resolution", default=192, type=int)


def measure(photohull: Photohull, scene: Path, out: Path, method: str, resolution: int) -> "Measured":
    """Evidence, confidence and error (voxels) of the seen vertices of a reconstruction."""
    report = photohull.reconstruct(scene, out, "--method", method, "--resolution", resolution, "--evidence").report
    errors = out / "errors.ply"
    if not errors.exists() or errors.stat().st_mtime < (out / "evidence.ply").stat().st_mtime:
        photohull.call("evaluate", out / "evidence.ply", "--truth", scene, "--error-mesh", errors)
    mesh, judged = ply.vertices(out / "evidence.ply"), ply.vertices(errors)
    seen = mesh["confidence"] > 0
    columns = [np.ones(seen.sum()),
               np.log(mesh["disagreement"][seen] + LEAST_DEVIATION),
               np.log(mesh["scatter"][seen] + LEAST_SCATTER),
               np.log(mesh["fine_share"][seen])]
    chosen = np.random.default_rng(1).permutation(seen.sum())[:PER_SCENE]
    return Measured(scene.name, np.stack(columns, 1).astype(float)[chosen],
                    mesh["confidence"][seen].astype(float)[chosen],
                    np.abs(judged["distance"][seen]).astype(float)[chosen] / report["grid"]["voxel_size"])


class Measured:
    def __init__(self, name: str, evidence: np.ndarray, confidence: np.ndarray, error: np.ndarray):
        self.name, self.evidence, self.confidence, self.error = name, evidence, confidence, error
        self.right = error <= 1


def chance(evidence: np.ndarray, weights: np.ndarray) -> np.ndarray:
    return 1 / (1 + np.exp(-evidence @ weights))


def stack(scenes: list[Measured]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Evidence, whether it is right, and weights by which each scene counts the same."""
    evidence = np.concatenate([s.evidence for s in scenes])
    right = np.concatenate([s.right for s in scenes]).astype(float)
    weight = np.concatenate([np.full(len(s.right), 1 / len(s.right)) for s in scenes])
    return evidence, right, weight


def fit(scenes: list[Measured]) -> np.ndarray:
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


def fit_offset(scenes: list[Measured], weights: np.ndarray) -> np.ndarray:
    """What to add to the constant for these scenes."""
    evidence, right, weight = stack(scenes)
    offset = np.zeros_like(weights)
    for _ in range(50):
        p = chance(evidence, weights + offset)
        offset[0] += (weight * (right - p)).sum() / (weight * p * (1 - p)).sum()
    return offset


def calibration_error(confidence: np.ndarray, right: np.ndarray) -> float:
    bins = np.clip(np.ceil(confidence * BINS).astype(int) - 1, 0, BINS - 1)
    gaps = np.bincount(bins, confidence - right, BINS)
    return np.abs(gaps).sum() / len(right)


def auc(confidence: np.ndarray, right: np.ndarray) -> float:
    values, inverse, counts = np.unique(confidence, return_inverse=True, return_counts=True)
    ranks = (np.cumsum(counts) - (counts - 1) / 2)[inverse]
    good, bad = right.sum(), (~right).sum()
    if good == 0 or bad == 0:
        return float("nan")
    return (ranks[right].sum() - good * (good + 1) / 2) / (good * bad)


def table(title: str, scenes: list[Measured], weights: np.ndarray | None = None) -> None:
    """One row a scene, by the program's confidence or by that of `weights`."""
    rows = []
    for s in scenes:
        c = s.confidence if weights is None else chance(s.evidence, weights)
        rows.append([s.right.mean(), c.mean(), calibration_error(c, s.right), ((c - s.right) ** 2).mean(),
                     auc(c, s.right)])
    names = [s.name for s in scenes] + ["mean"]
    print(f"\n{title}\n")
    tables.show(["scene", "right", "confidence", "ECE", "Brier", "AUC"],
                ([name, *(f"{v:.3f}" for v in row)] for name, row in zip(names, [*rows, np.nanmean(rows, 0)])))


def draw(photohull: Photohull, work: Path, name: str, scenes: list[Measured]) -> None:
    """The reliability diagram of all scenes together: errors become heights over a plane."""
    per_scene = min(len(s.right) for s in scenes)
    confidence = np.concatenate([s.confidence[:per_scene] for s in scenes])
    error = np.concatenate([s.error[:per_scene] for s in scenes])
    points = np.zeros((len(error), 4), "<f4")
    points[:, 2], points[:, 3] = np.minimum(error, 100), confidence
    header = ("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
              "property float y\nproperty float z\nproperty float confidence\nend_header\n")
    cloud, plane = work / f"{name}.ply", work / "plane.obj"
    cloud.write_bytes(header.format(len(points)).encode() + points.tobytes())
    plane.write_text("v -999 -999 0\nv 999 -999 0\nv 999 999 0\nv -999 999 0\nf 1 2 3\nf 1 3 4\n")
    photohull.call("evaluate", cloud, "--truth", plane, "--reliability", 1, "--reliability-plot", work / f"{name}.svg")
    print(f"{work / name}.svg: {len(points)} vertices, calibration error "
          f"{calibration_error(confidence, error <= 1):.3f}")


def tell(measured: dict[str, list[Measured]], count: int) -> None:
    """Prints the constants, and what they and the program's own give. The first `count` scenes are to fit to."""
    refined, hulls = measured["refine"][:count], measured["hull"][:count]
    halves = {"fitted": slice(1, None, 2), "held out": slice(0, None, 2)}
    weights = fit(refined[halves["fitted"]])
    offset = fit_offset(hulls[halves["fitted"]], weights)
    print("kConstant = %.2f, kByDisagreement = %.2f, kByScatter = %.2f, kByShare = %.2f" % tuple(weights))
    print("kSilhouettesOnly = %.2f" % offset[0])
    for method, scenes in measured.items():
        for half, which in halves.items():
            table(f"{method}, {half}: the program's confidence", scenes[:count][which])
        if scenes[count:]:
            table(f"{method}, other scenes: the program's confidence", scenes[count:])
    swapped = fit(refined[halves["held out"]])
    print("\nhalves swapped: " + " ".join(f"{w:.2f}" for w in swapped))
    table("refine, the fitted half by these constants of the other", refined[halves["fitted"]], swapped)
    print()


def run(options: argparse.Namespace) -> None:
    photohull, work = Photohull(options.program), options.work
    scenes = [photohull.synthesize(spec, work / "scenes" / spec.stem) for spec in sorted(SYNTHETIC.glob("*.json"))]
    measured: dict[str, list[Measured]] = {"refine": [], "hull": []}
    for method, found in measured.items():
        for scene in [*scenes, *(s.resolve() for s in options.also)]:
            print(f"{method} {scene.name}", file=sys.stderr)
            out = work / "runs" / f"{method}-{options.resolution}" / f"{scene.parent.name}-{scene.name}"
            found.append(measure(photohull, scene, out, method, options.resolution))
    count = len(scenes)
    tell(measured, count)
    draw(photohull, work, "held-out", measured["refine"][:count:2])
    if options.also:
        draw(photohull, work, "other-scenes", measured["refine"][count:])
