"""The runs of `photohull chart` as Markdown tables, and short as JSON.

    build/release/photohull chart bench/plans/synthetic.json --out out/synthetic
    python3 -m bench chart_table out/synthetic/results.json --json bench/results/synthetic_chart.json --table 192
    python3 -m bench chart_table out/synthetic/results.json --variants 0.5

--table N prints the runs of one resolution, a row each; --variants T the variants against the scenes: F-scores in
percent at T percent of the diagonal, and CPU seconds."""
import argparse
import json
from collections.abc import Iterator
from pathlib import Path

from bench import tables
from bench.runner import f_scores

COLUMNS = ["scene", "method", "CPU s", "peak MB", "F 0.1 %", "F 0.25 %", "F 0.5 %", "completeness 0.5 %",
           "acc90 %", "triangles"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("results", type=Path, help="results.json of 'photohull chart'")
    parser.add_argument("--json", type=Path, help="file for the short form, a line a run")
    parser.add_argument("--table", type=int, metavar="N", help="print the runs of this resolution")
    parser.add_argument("--variants", type=float, metavar="T", help="print variants against scenes at this threshold")


def short(run: dict) -> dict:
    """One run's figures, of the surface that cameras see; a failed run's status alone."""
    row = {"scene": run["scene"], "tool": run["variant"], "resolution": run["resolution"]}
    if run["status"] != "ok":
        return row | {"status": run["status"]}
    repeat = run["repeats"][run["median_repeat"]]
    seen = run["evaluation"]["seen"]
    f = f_scores(seen)
    return row | {
        "cpu_s": round(repeat["cpu_seconds"], 2),
        "wall_s": round(repeat["wall_seconds"], 2),
        "peak_mb": round(repeat["peak_memory_bytes"] / 2**20),
        "f01": round(100 * f[0.001], 2),
        "f025": round(100 * f[0.0025], 2),
        "f05": round(100 * f[0.005], 2),
        "acc90_pct": round(seen["accuracy_pct_diag"], 4),
        "comp05": round(100 * next(row["recall"] for row in seen["f"] if row["t"] == 0.005), 2),
        "triangles": run["report"]["mesh"]["triangles"],
    }


def of_resolution(rows: list[dict], resolution: int) -> Iterator[list[object]]:
    for r in rows:
        if r["resolution"] != resolution:
            continue
        if "status" in r:
            yield [r["scene"], r["tool"], r["status"], *[""] * (len(COLUMNS) - 3)]
            continue
        yield [r["scene"], r["tool"], f"{r['cpu_s']:.1f}", r["peak_mb"], f"{r['f01']:.2f}", f"{r['f025']:.2f}",
               f"{r['f05']:.2f}", f"{r['comp05']:.2f}", f"{r['acc90_pct']:.3f}", r["triangles"]]


def variants(runs: list[dict], threshold: float) -> str:
    scenes = list(dict.fromkeys(run["scene"] for run in runs))
    several = len({run["resolution"] for run in runs}) > 1
    rows: dict[str, dict] = {}
    for run in runs:
        name = f"{run['variant']}, {run['resolution']}" if several else run["variant"]
        row = rows.setdefault(name, {"seconds": 0.0})
        if run["status"] != "ok":
            continue
        scores = {round(100 * t, 6): 100 * f for t, f in f_scores(run["evaluation"]["seen"]).items()}
        row[run["scene"]] = scores[threshold]
        row["seconds"] += run["repeats"][run["median_repeat"]]["cpu_seconds"]
    lines = []
    for variant, row in rows.items():
        found = [row.get(scene) for scene in scenes]
        lines.append([variant, *(f"{f:.1f}" if f is not None else "failed" for f in found),
                      f"{sum(f or 0 for f in found) / len(found):.2f}", f"{row['seconds']:.1f}"])
    return tables.markdown(["variant", *scenes, "mean", "CPU s, all"], lines)


def run(options: argparse.Namespace) -> None:
    runs = json.loads(options.results.read_text(encoding="utf-8"))["runs"]
    if options.json or options.table:
        rows = [short(run) for run in runs]
    if options.json:
        options.json.write_text("[\n " + ",\n ".join(json.dumps(row) for row in rows) + "\n]\n", encoding="utf-8")
    if options.table:
        tables.show(COLUMNS, of_resolution(rows, options.table))
    if options.variants is not None:
        print(variants(runs, options.variants))
