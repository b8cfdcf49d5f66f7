#!/usr/bin/env python3
"""How the verdict calls every synthetic scene, against how good the result is.

    bench/verdict_scenes.py build/release/photohull out/verdict_scenes [--resolution 96] [--only NAME ...]

Each spec of datasets/synthetic is photographed small, with two seeds, and reconstructed in several ways
(VARIANTS). results.json of the folder holds for each run F at 0.5 % of the diagonal, of the parts that are
seen, and the verdict with its reasons and the signals that it rests on. Runs that are there are not repeated.
The tables at the end count the calls, and in how many of them the first reason is the right one, apart for
seed 1, on which limits were fitted, and for the others; docs/measurements/stability.md has them.
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess

SPECS = pathlib.Path(__file__).resolve().parent.parent / "datasets" / "synthetic"
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


def first_is_right(key, result):
    spec, _, variant = key.split("|")
    causes = VARIANT_CAUSES[variant] + ([] if variant == "small box" else SPEC_CAUSES.get(spec, []))
    return any(re.search(WORDS[cause], result["reasons"][0]) for cause in causes)


def spec_json(path):
    lines = [line for line in path.read_text().splitlines() if not line.strip().startswith("//")]
    return json.loads("\n".join(lines))


def arguments_of(variant, views, resolution):
    if variant == "every third view":
        return ["--views", f"spread:{max(5, views // 3)}", "--resolution", str(resolution)]
    given = VARIANTS[variant]
    return given if "--quality" in given or "--resolution" in given else given + ["--resolution", str(resolution)]


def call(command):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True)


def measure(program, scene, out, arguments):
    done = call([program, "reconstruct", scene, "--out", out, "--json", *arguments])
    if done.returncode not in (0, 3):
        return {"exit": done.returncode, "error": done.stderr.strip().splitlines()[-1:]}
    report = json.loads(done.stdout)
    judged = json.loads(call([program, "evaluate", out / "mesh.ply", "--truth", scene, "--json"]).stdout)
    at = {f["t"]: f["f"] for f in judged["f"]}
    seen = {f["t"]: f["f"] for f in judged["seen"]["f"]}
    verdict = report["verdict"]
    return {"exit": done.returncode, "f": at[0.005], "f_seen": seen[0.005], "level": verdict["level"],
            "reasons": verdict["reasons"], "verdict": verdict, "cpu_seconds": report["cpu_seconds"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--resolution", type=int, default=96)
    parser.add_argument("--size", default="320x240")
    parser.add_argument("--seeds", default="1,2")
    parser.add_argument("--only", nargs="*", default=[])
    parser.add_argument("--variants", default=",".join(VARIANTS))
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    file = options.folder / "results.json"
    results = json.loads(file.read_text()) if file.exists() else {}
    for path in sorted(SPECS.glob("*.json")):
        if options.only and path.stem not in options.only:
            continue
        for seed in options.seeds.split(","):
            missing = [v for v in options.variants.split(",") if f"{path.stem}|{seed}|{v}" not in results]
            if not missing:
                continue
            scene = options.folder / "scene"
            shutil.rmtree(scene, ignore_errors=True)
            call([options.program, "synthesize", path, "--size", options.size, "--seed", seed, "--out", scene])
            views = len(json.loads((scene / "transforms.json").read_text())["frames"])
            for variant in missing:
                arguments = arguments_of(variant, views, options.resolution)
                result = measure(options.program, scene, options.folder / "out", arguments)
                results[f"{path.stem}|{seed}|{variant}"] = result
                file.write_text(json.dumps(results, indent=1))
                print(path.stem, seed, variant, result.get("level"), round(100 * result.get("f_seen", 0), 1),
                      result.get("reasons", result.get("error"))[:1], flush=True)
    summary(results)


def summary(results):
    fitted = {key for key in results if key.split("|")[1] == "1"}
    for title, chosen in [("fitted on", fitted), ("judged on", set(results) - fitted)]:
        print(f"\n{title}:\n\n| F of what is seen, 0.5 % | good | doubtful | failed | refused |\n|---|---|---|---|---|")
        for low, high in [(0, 0.8), (0.8, 0.95), (0.95, 2)]:
            runs = [results[key] for key in chosen if "f" in results[key] and low <= results[key]["f_seen"] < high]
            counts = [sum(r["level"] == level for r in runs) for level in ("good", "doubtful", "failed")]
            print(f"| {100 * low:.0f} to {min(100, 100 * high):.0f} % |", " | ".join(map(str, counts)), "| 0 |")
        print("| no result | 0 | 0 | 0 |", sum("f" not in results[key] for key in chosen), "|")
        called = [key for key in chosen if results[key].get("reasons")]
        wrong = sorted(key for key in called if not first_is_right(key, results[key]))
        if called:
            print(f"\nThe right cause comes first in {len(called) - len(wrong)} of {len(called)} called "
                  f"({100 * (1 - len(wrong) / len(called)):.0f} %); not in: {', '.join(wrong) or 'none'}")


if __name__ == "__main__":
    main()
