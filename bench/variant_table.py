#!/usr/bin/env python3
"""A chart's variants against its scenes as a Markdown table: F-score in percent, and CPU seconds.

    build/release/photohull chart bench/plans/sampling.json --out out/sampling-chart
    bench/variant_table.py out/sampling-chart/results.json --threshold 0.5
"""
import argparse
import json


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", help="results.json of 'photohull chart'")
    parser.add_argument("--threshold", type=float, default=0.5, help="of the F-score, percent of the diagonal")
    options = parser.parse_args()
    with open(options.results, encoding="utf-8") as file:
        runs = json.load(file)["runs"]
    scenes = list(dict.fromkeys(run["scene"] for run in runs))
    several = len({run["resolution"] for run in runs}) > 1
    rows = {}
    for run in runs:
        name = f"{run['variant']}, {run['resolution']}" if several else run["variant"]
        row = rows.setdefault(name, {"seconds": 0.0})
        if run["status"] != "ok":
            continue
        scores = {round(100 * f["t"], 6): 100 * f["f"] for f in run["evaluation"]["seen"]["f"]}
        row[run["scene"]] = scores[options.threshold]
        row["seconds"] += run["repeats"][run["median_repeat"]]["cpu_seconds"]
    print("| variant | " + " | ".join(scenes) + " | mean | CPU s, all |")
    print("|" + "---|" * (len(scenes) + 3))
    for variant, row in rows.items():
        found = [row.get(scene) for scene in scenes]
        mean = sum(f or 0 for f in found) / len(found)
        cells = [f"{f:.1f}" if f is not None else "failed" for f in found]
        print(f"| {variant} | " + " | ".join(cells) + f" | {mean:.2f} | {row['seconds']:.1f} |")


if __name__ == "__main__":
    main()
