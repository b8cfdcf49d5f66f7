#!/usr/bin/env python3
"""The runs of a chart, short: a JSON line a run, and a Markdown table of one resolution.

    build/release/photohull chart bench/plans/synthetic.json --out out/synthetic
    bench/chart_table.py out/synthetic/results.json --json bench/results/synthetic_chart.json --table 192
"""
import argparse
import json

COLUMNS = ["scene", "method", "CPU s", "peak MB", "F 0.1 %", "F 0.25 %", "F 0.5 %", "completeness 0.5 %",
           "acc90 %", "triangles"]


def short(run):
    """One run's figures, of the surface that cameras see; a failed run's status alone."""
    row = {"scene": run["scene"], "tool": run["variant"], "resolution": run["resolution"]}
    if run["status"] != "ok":
        return row | {"status": run["status"]}
    repeat = run["repeats"][run["median_repeat"]]
    seen = run["evaluation"]["seen"]
    at = {f["t"]: f for f in seen["f"]}
    return row | {
        "cpu_s": round(repeat["cpu_seconds"], 2),
        "wall_s": round(repeat["wall_seconds"], 2),
        "peak_mb": round(repeat["peak_memory_bytes"] / 2**20),
        "f01": round(100 * at[0.001]["f"], 2),
        "f025": round(100 * at[0.0025]["f"], 2),
        "f05": round(100 * at[0.005]["f"], 2),
        "acc90_pct": round(seen["accuracy_pct_diag"], 4),
        "comp05": round(100 * at[0.005]["recall"], 2),
        "triangles": run["report"]["mesh"]["triangles"],
    }


def table(rows, resolution):
    yield "| " + " | ".join(COLUMNS) + " |"
    yield "|" + "---|" * len(COLUMNS)
    for r in rows:
        if r["resolution"] != resolution:
            continue
        if "status" in r:
            yield f"| {r['scene']} | {r['tool']} | {r['status']} |" + " |" * (len(COLUMNS) - 3)
            continue
        yield (f"| {r['scene']} | {r['tool']} | {r['cpu_s']:.1f} | {r['peak_mb']} | {r['f01']:.2f} | {r['f025']:.2f} "
               f"| {r['f05']:.2f} | {r['comp05']:.2f} | {r['acc90_pct']:.3f} | {r['triangles']} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", help="results.json of 'photohull chart'")
    parser.add_argument("--json", help="file for the short form")
    parser.add_argument("--table", type=int, metavar="N", help="print the runs of this resolution")
    options = parser.parse_args()
    with open(options.results, encoding="utf-8") as file:
        rows = [short(run) for run in json.load(file)["runs"]]
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            file.write("[\n " + ",\n ".join(json.dumps(row) for row in rows) + "\n]\n")
    if options.table:
        print("\n".join(table(rows, options.table)))


if __name__ == "__main__":
    main()
