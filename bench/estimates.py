"""What `photohull info` says that a run will cost, against what `photohull reconstruct` then takes.

    python3 -m bench estimates [--results bench/results/estimates.json] [--fresh | --again | --fit]

Peak memory and CPU time, over scenes, methods, resolutions and masks (`jobs`). Prints the table of docs/guide/limits.md
and the ratios taken / said that are worst. Runs that --results does not hold yet are made, one after the other, and kept
there as they end (all: about 25 minutes on two idle cores; --fresh makes all of them anew). --again only asks `info`
anew, and --fit, which needs numpy and scipy, prints the constants of src/pipeline/estimate.cpp that suit the kept runs
best: those of memory have the least mean square of relative errors, those of time the least largest factor."""
import argparse
import json
import math
from collections.abc import Callable
from pathlib import Path
from statistics import median

from bench import tables
from bench.runner import RESULTS, Photohull, add_datasets, add_program, keep_json, work_folder

# Constants that these runs hardly tell, at least: decoding, by the large photographs of docs/guide/limits.md;
# a hull's bricks; sweeps of all of a box at 256 voxels, by runs of an earlier version.
KNOWN = {"kPixelSeconds": 1e-8, "kHullFaceSeconds": 2e-6, "kUnmaskedSweepFaceBytes": 1200}
PROBE_VOXELS = 128  # as src/pipeline/check_room.cpp has it
FAIR = 1.5  # the factor that estimates are to be within
COLUMNS = ["scene, views", "masks", "method", "resolution", "MiB: said / taken", "ratio", "CPU s: said / taken", "ratio"]

Job = tuple[str, str, str, int | None]  # scene, masks, method, resolution; None: as the pixels ask


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    add_datasets(parser)
    parser.add_argument("--results", type=Path, default=RESULTS / "estimates.json")
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--fit", action="store_true")


def jobs() -> list[Job]:
    """What tells most of the model comes first."""
    out = [("fountain", "none", "refine", 256), ("fountain", "none", "refine", 128), ("fountain", "none", "refine", 500),
           ("bunny", "auto", "hull", 256), ("templeSparseRing", "auto", "refine", None)]
    for scene in ("glazed", "plaster", "tabletop", "bunny", "armadillo", "fandisk", "trellis", "templeSparseRing",
                  "templeRing"):
        out += [(scene, masks, "refine", 256) for masks in ("none", "auto")]
    out += [("bunny", "auto", "space-carving", 256), ("fandisk", "none", "space-carving", 128),
            ("templeSparseRing", "none", "space-carving", 128), ("templeSparseRing", "auto", "hull", 256),
            ("trellis", "auto", "hull", 400), ("armadillo", "auto", "refine", 400), ("trellis", "auto", "refine", 400),
            ("armadillo", "auto", "refine", 1024), ("fountain", "none", "refine", None)]
    return out


def words(job: Job, datasets: Path) -> list[object]:
    """The scene, and the options of a job."""
    name, masks, method, resolution = job
    scene = datasets / name / f"{name}_par.txt" if name == "fountain" else datasets / name
    return [scene, "--masks", masks, "--method", method, *(["--resolution", resolution] if resolution else [])]


def ask(photohull: Photohull, job: Job, datasets: Path) -> dict:
    """What is said before the run, and what it is said from."""
    info = photohull.json("info", *words(job, datasets))
    pixels = sum(v["width"] * v["height"] for v in info["views"])
    size = [m - n for m, n in zip(info["box"]["max"], info["box"]["min"])]
    n = [8 * math.ceil((s / info["voxel_size"] + 6) / 8) for s in size]
    given = any(v["mask"] for v in info["views"])
    return {"said_bytes": info["memory_bytes"], "said_cpu": info["cpu_seconds"], "views": len(info["views"]),
            "file_pixels": pixels, "read_pixels": pixels * info["image_scale"] ** 2, "voxels": n,
            "masks": "none" if job[1] == "none" else "given" if given else "made", "voxel_size": info["voxel_size"]}


def measure(photohull: Photohull, job: Job, datasets: Path) -> dict:
    scene, *options = words(job, datasets)
    with work_folder(None) as folder:
        report = photohull.reconstruct(scene, folder / "out", "--device", "software", *options).report
    stages = {s["name"]: {"cpu": round(s["cpu_seconds"], 3), "peak": s["peak_memory_bytes"]} for s in report["stages"]}
    return {"bytes": report["peak_memory_bytes"], "cpu": report["cpu_seconds"], "bricks": report["grid"]["bricks_stored"],
            "vertices": report["mesh"]["vertices"], "surfels": [level["surfels"] for level in report.get("refine", [])],
            "grid": report["grid"]["voxels"], "stages": stages}


def hull_area(photohull: Photohull, job: Job, datasets: Path, voxel: float) -> float:
    """Of the hull that tells how much surface there is, in squares of the job's voxels."""
    name, masks, _, _ = job
    scene, *_ = words(job, datasets)
    with work_folder(None) as folder:
        photohull.reconstruct(scene, folder / "hull", "--device", "software", "--masks", masks, "--method", "hull", "--resolution",
                              PROBE_VOXELS)
        return photohull.json("measure", folder / "hull")["area"]["value"] / voxel**2


def surface(r: dict) -> float:
    """Faces of the box, in voxels."""
    x, y, z = r["voxels"]
    return 2 * (x * y + y * z + z * x)


def memory_terms(r: dict) -> dict[str, float]:
    """Constant of estimate.cpp: what it is multiplied by."""
    masked = r["masks"] != "none"
    terms = {"kBaseBytes": 1, "kMaskedPixelBytes" if masked else "kPixelBytes": r["read_pixels"]}
    if masked:
        terms["kHullAreaBytes"] = r["hull_area"]
    elif r["method"] == "refine":
        terms["kUnmaskedFaceBytes"] = surface(r)
    else:
        terms["kUnmaskedSweepFaceBytes"] = surface(r)
    return terms


def time_terms(r: dict) -> dict[str, float]:
    terms = {"kBaseSeconds": 1, "kPixelSeconds": r["file_pixels"]}
    if r["masks"] == "made":
        terms["kMadePixelSeconds"] = r["read_pixels"]
    if r["method"] == "hull":
        terms["kHullFaceSeconds"] = surface(r)
    elif r["method"] == "refine":
        terms["kUnmaskedRefineFaceSeconds" if r["masks"] == "none" else "kRefineFaceSeconds"] = surface(r)
        if r["masks"] == "none":
            terms["kUnmaskedPixelSeconds"] = r["read_pixels"]
    else:
        terms["kUnmaskedSweepFaceSeconds" if r["masks"] == "none" else "kSweepFaceSeconds"] = surface(r)
    return terms


def usual_fit(rows: list[dict], terms_of: Callable[[dict], dict[str, float]], used: str) -> tuple[dict[str, float], float]:
    """Constants whose relative errors have the least mean square, those of KNOWN as they are, and the largest factor then."""
    import numpy as np
    names = sorted({name for r in rows for name in terms_of(r)} - KNOWN.keys())
    known = np.array([sum(KNOWN[name] * value for name, value in terms_of(r).items() if name in KNOWN) / r[used] for r in rows])
    a = np.array([[terms_of(r).get(name, 0) / r[used] for name in names] for r in rows])
    best = np.linalg.lstsq(a, 1 - known, rcond=None)[0]
    said = a @ best + known
    return dict(zip(names, best)), max(said.max(), 1 / said.min())


def fit(rows: list[dict], terms_of: Callable[[dict], dict[str, float]], used: str) -> tuple[dict[str, float], float]:
    """Constants, none below its bound in KNOWN, whose largest factor between said and used is least, and this factor."""
    import numpy as np
    from scipy.optimize import linprog
    names = sorted({name for r in rows for name in terms_of(r)})
    a = np.array([[terms_of(r).get(name, 0) / r[used] for name in names] for r in rows])
    scale = a.max(0)
    a = a / scale
    bounds = [(KNOWN.get(name, 0) * s, None) for name, s in zip(names, scale)]
    best, least, most = None, 1.0, 4.0
    while most - least > 1e-3:
        factor = math.sqrt(least * most)
        # Of what suits the factor the one that is nearest in the sum.
        limits = np.hstack([np.full(len(a), factor), np.full(len(a), -1 / factor)])
        found = linprog(a.sum(0), A_ub=np.vstack([a, -a]), b_ub=limits, bounds=bounds)
        if found.success:
            best, most = found.x / scale, factor
        else:
            least = factor
    return dict(zip(names, best)), most


def ratio(taken: float, said: float) -> str:
    x = taken / said
    return f"{x:.2f}" + ("" if 1 / FAIR <= x <= FAIR else " (!)")


def cells(r: dict) -> list[object]:
    return [f"{r['scene']}, {r['views']}", r["masks"], r["method"], r["resolution"] or "default",
            f"{r['said_bytes'] / 2**20:.0f} / {r['bytes'] / 2**20:.0f}", ratio(r["bytes"], r["said_bytes"]),
            f"{r['said_cpu']:.0f} / {r['cpu']:.0f}", ratio(r["cpu"], r["said_cpu"])]


def spread(rows: list[dict]) -> None:
    for what, said, used in (("memory", "said_bytes", "bytes"), ("CPU time", "said_cpu", "cpu")):
        ratios = [r[used] / r[said] for r in rows]
        beyond = sum(not 1 / FAIR <= x <= FAIR for x in ratios)
        print(f"{what}: taken / said from {min(ratios):.2f} to {max(ratios):.2f}; {beyond} of {len(ratios)} beyond a "
              f"factor of {FAIR:.1f}")


def complete(options: argparse.Namespace, kept: dict[Job, dict]) -> None:
    """Makes what is missing, and writes the results after each run."""
    photohull = Photohull(options.program)
    for job in jobs():
        row = kept.get(job)
        if row is None and options.again:
            continue
        if row is None or options.again:
            row = (row or {}) | dict(zip(("scene", "asked", "method", "resolution"), job))
            row |= ask(photohull, job, options.datasets)
        if "bytes" not in row:
            row |= measure(photohull, job, options.datasets)
        if row["masks"] != "none" and "hull_area" not in row:
            row["hull_area"] = hull_area(photohull, job, options.datasets, row["voxel_size"])
        kept[job] = row
        keep_json(options.results, list(kept.values()))


def run(options: argparse.Namespace) -> None:
    kept: dict[Job, dict] = {}
    if options.results.exists() and not options.fresh:
        found = json.loads(options.results.read_text(encoding="utf-8"))
        kept = {(r["scene"], r["asked"], r["method"], r["resolution"]): r for r in found}
    if not options.fit:
        complete(options, kept)
    rows = [kept[job] for job in jobs() if job in kept]
    if options.fit:
        for suited, terms, used in ((usual_fit, memory_terms, "bytes"), (fit, time_terms, "cpu")):
            constants, factor = suited(rows, terms, used)
            for name, value in constants.items():
                print(f"{name:28} {value:.3g}")
            print(f"within a factor of {factor:.2f}")
        shares = [r["hull_area"] / surface(r) for r in rows if "hull_area" in r]
        print(f"{'kUsualHull':28} {median(shares):.3g}, from {min(shares):.2f} to {max(shares):.2f}")
    tables.show(COLUMNS, map(cells, rows))
    spread(rows)
