"""How the verdict calls every synthetic scene, against how good the result is.

    python3 -m bench verdict_scenes out/verdict_scenes [--resolution 96] [--only NAME ...]

Each spec of datasets/synthetic is photographed small, with two seeds, and reconstructed in several ways
(VARIANTS). results.json of the folder holds for each run F at 0.5 % of the diagonal, of the parts that are
seen, and the verdict with its reasons and the signals that it rests on. Runs that are there are not repeated.
The tables at the end count the calls, and in how many of them the first reason is the right one, apart for
seed 1, on which limits were fitted, and for the others; docs/measurements/verdict.md has the latter."""
import argparse
import json
import re
from pathlib import Path

from bench import tables
from bench.runner import SYNTHETIC, Photohull, ProgramError, add_program, f_scores, keep_json, listed

VARIANTS = {
    "default": [],
    "draft": ["--quality", "draft"],
    "coarse": ["--resolution", "40"],
    "hull": ["--method", "hull"],
    "no masks": ["--masks", "none"],
    "every third view": None,
    "small box": ["--box-scale", "0.7", "--box-exact"],
}

# What a run's first reason is to say, by patterns, where it is called: what was done to it (VARIANTS) or what
# is hard about its scene (SPEC_CAUSES). Of a box that is too small nothing else is the cause.
WORDS = {
    "box": r"box cuts the object off|stands just outside the box|lies beyond the box",
    "views": r"add views",
    "voxels": r"use --resolution",
    "hull": r"do not confirm the hull",
    "masks": r"give masks",
    "texture": r"too little texture|is plain",
    "cameras": r"the cameras disagree|cameras had to be moved|outlines disagree",
    "blur": r"noise and blur",
    "hollows": r"folds and hollows|add views that look in",
    "stems": r"thin parts were put back|are stems|thinner than",
}
VARIANT_CAUSES = {
    "default": [],
    "draft": ["hull", "voxels"],
    "coarse": ["voxels"],
    "hull": ["hull"],
    "no masks": ["masks"],
    "every third view": ["views"],
    "small box": ["box"],
}
SPEC_CAUSES = {
    "cage": ["stems", "voxels"],
    "checker_near_nyquist": ["texture"],
    "degraded": ["blur"],
    "folds": ["hollows"],
    "gyroid": ["hollows"],
    "leaves": ["hollows", "voxels"],
    "miscalibrated": ["cameras"],
    "plaster": ["texture"],
    "rods_before_texture": ["views", "voxels"],
    "room": ["views"],
    "seedling": ["stems", "voxels"],
    "seedling_off": ["stems", "voxels", "cameras"],
    "wheel": ["stems", "voxels"],
}

COLUMNS = ["F of what is seen, 0.5 %", "good", "doubtful", "failed", "refused"]
CAUSES = ["called", "the first reason is the right cause"]

def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--resolution", type=int, default=96)
    parser.add_argument("--size", default="320x240")
    parser.add_argument("--seeds", type=listed, default="1,2")
    parser.add_argument("--only", nargs="*", default=[])
    parser.add_argument("--variants", type=listed, default=",".join(VARIANTS))
    parser.add_argument("--json", type=Path, help="file for the calls on other seeds than the first")

def first_is_right(key: str, result: dict) -> bool:
    spec, _, variant = key.split("|")
    causes = VARIANT_CAUSES[variant] + ([] if variant == "small box" else SPEC_CAUSES.get(spec, []))
    return any(re.search(WORDS[cause], result["reasons"][0]) for cause in causes)

def arguments_of(variant: str, views: int, resolution: int) -> list[str]:
    if variant == "every third view":
        return ["--views", f"spread:{max(5, views // 3)}", "--resolution", str(resolution)]
    given = VARIANTS[variant]
    return given if "--quality" in given or "--resolution" in given else given + ["--resolution", str(resolution)]

def measure(photohull: Photohull, scene: Path, out: Path, arguments: list[str]) -> dict:
    try:
        done = photohull.call("reconstruct", scene, "--out", out, "--json", *arguments)
    except ProgramError as error:
        return {"exit": error.status, "error": [error.message]}
    judged = photohull.evaluate(out / "mesh.ply", "--truth", scene)
    verdict = done.report["verdict"]
    return {"exit": done.status, "f": f_scores(judged)[0.005], "f_seen": f_scores(judged["seen"])[0.005],
            "level": verdict["level"], "reasons": verdict["reasons"], "verdict": verdict,
            "cpu_seconds": done.report["cpu_seconds"]}

def run(options: argparse.Namespace) -> None:
    photohull, file = Photohull(options.program), options.folder / "results.json"
    results = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
    for path in sorted(SYNTHETIC.glob("*.json")):
        if options.only and path.stem not in options.only:
            continue
        for seed in options.seeds:
            missing = [v for v in options.variants if f"{path.stem}|{seed}|{v}" not in results]
            if not missing:
                continue
            scene = photohull.synthesize(path, options.folder / "scene", "--size", options.size, "--seed", seed)
            views = len(json.loads((scene / "transforms.json").read_text(encoding="utf-8"))["frames"])
            for variant in missing:
                arguments = arguments_of(variant, views, options.resolution)
                result = measure(photohull, scene, options.folder / "out", arguments)
                results[f"{path.stem}|{seed}|{variant}"] = result
                keep_json(file, results)
                print(path.stem, seed, variant, result.get("level"), round(100 * result.get("f_seen", 0), 1),
                      result.get("reasons", result.get("error"))[:1], flush=True)
    fitted = {key for key in results if key.split("|")[1] == "1"}
    summary("fitted on", results, fitted)
    keep_json(options.json, {"tables": summary("judged on", results, set(results) - fitted)})

def summary(title: str, results: dict[str, dict], chosen: set[str]) -> dict:
    """Prints the calls and in how many the right cause comes first, and gives both as tables."""
    rows = []
    for low, high in [(0, 0.8), (0.8, 0.95), (0.95, 2)]:
        runs = [results[key] for key in chosen if "f" in results[key] and low <= results[key]["f_seen"] < high]
        counts = [sum(r["level"] == level for r in runs) for level in ("good", "doubtful", "failed")]
        rows.append([f"{100 * low:.0f} to {min(100, 100 * high):.0f} %", *counts, 0])
    rows.append(["no result", 0, 0, 0, sum("f" not in results[key] for key in chosen)])
    print(f"\n{title}:\n")
    print(tables.markdown(COLUMNS, rows))
    called = [key for key in chosen if results[key].get("reasons")]
    wrong = sorted(key for key in called if not first_is_right(key, results[key]))
    if called:
        print(f"\nThe right cause comes first in {len(called) - len(wrong)} of {len(called)} called "
              f"({100 * (1 - len(wrong) / len(called)):.0f} %); not in: {', '.join(wrong) or 'none'}")
    return {"calls": {"columns": COLUMNS, "rows": rows},
            "causes": {"columns": CAUSES, "rows": [[len(called), len(called) - len(wrong)]]}}
