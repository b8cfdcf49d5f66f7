"""What bench/results keeps of a measurement: figures that pages need, with the program that gave them and the day."""
import datetime
import json
import re
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from bench.runner import RESULTS, ROOT, Photohull, f_scores

# What is done about a degradation: its name, the axis, and the settings with and without it.
CURES = [
    ("cameras refined", "pose-error", "default", "cameras as given"),
    ("intrinsics that views share refined", "intrinsics-error", "default", "cameras as given"),
    ("the same", "pixel-centre", "default", "cameras as given"),
    ("wrong views left out", "wrong-views", "default", "all views kept"),
    ("wrong masks left out", "mask-wrong", "default", "all views kept"),
    ("outlines moved to the edges", "mask-dilated", "default", "outlines as given"),
    ("the same", "mask-eroded", "default", "outlines as given"),
    ("holes mended", "mask-holes", "default", "holes kept"),
    ("noise known", "noise", "default", "noise unknown"),
    ("best pairs of views", "gloss", "default", "all pairs"),
    ("the same", "haze", "default", "all pairs"),
    ("photometric gains", "exposure", "default", "colours as given"),
    ("the same", "white-balance", "default", "colours as given"),
    ("the same", "vignetting", "default", "colours as given"),
]
SECTIONS = {"marks": "Promises", "breakdown": "Where it breaks", "bytes": "Equal bytes", "verdicts": "Verdicts"}


@dataclass
class Results:
    """Figures; `program` and `date` are empty where those who measured did not write them down."""
    figures: object
    program: dict
    date: str


def read(name: str) -> Results:
    if not (RESULTS / f"{name}.json").is_file():
        raise SystemExit(f"bench/results/{name}.json is not there: nobody has measured it yet")
    data = json.loads((RESULTS / f"{name}.json").read_text(encoding="utf-8"))
    if isinstance(data, dict) and {"program", "date", "results"} <= set(data):
        return Results(data["results"], data["program"], data["date"])
    return Results(data, {}, "")


def write(name: str, figures: object, program: dict) -> None:
    """A run a line, where the figures are a list of runs."""
    text = json.dumps(figures, indent=1)
    if isinstance(figures, list):
        text = "[\n " + ",\n ".join(map(json.dumps, figures)) + "\n]"
    head = f'"program": {json.dumps(program)}, "date": "{datetime.date.today()}"'
    (RESULTS / f"{name}.json").write_text(f"{{{head}, \"results\": {text}}}\n", encoding="utf-8")


def commit_here() -> str:
    """The commit of this checkout, and whether its sources are changed."""
    def git(*words: str) -> str:
        return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
    changed = git("status", "--porcelain", "--", "src", "cli", "shaders", "cmake", "CMakeLists.txt")
    return git("rev-parse", "--short", "HEAD") + (" with changes" if changed else "")


def identity(photohull: Photohull, commit: str | None) -> dict:
    """Version of the program and the commit that it was built from, which a build in this checkout need not be told."""
    if not commit and photohull.program.is_relative_to(ROOT):
        commit = commit_here()
    found = {"version": photohull.json("--version")["version"], "sha256": photohull.identity[:16]}
    return found | ({"commit": commit} if commit else {})


def run_of_chart(run: dict) -> dict:
    """Figures of the surface that cameras see; of a failed run, the status alone."""
    row = {"scene": run["scene"], "tool": run["variant"], "resolution": run["resolution"]}
    if run["status"] != "ok":
        return row | {"status": run["status"]}
    repeat, seen = run["repeats"][run["median_repeat"]], run["evaluation"]["seen"]
    f = {f"f{100 * t:g}".replace(".", ""): round(100 * score, 2) for t, score in f_scores(seen).items()}
    return row | {
        "cpu_s": round(repeat["cpu_seconds"], 2),
        "wall_s": round(repeat["wall_seconds"], 2),
        "peak_mb": round(repeat["peak_memory_bytes"] / 2**20),
        **f,
        "acc90_pct": round(seen["accuracy_pct_diag"], 4),
        "comp05": round(100 * next(row["recall"] for row in seen["f"] if row["t"] == 0.005), 2),
        "triangles": run["report"]["mesh"]["triangles"],
    }


def chart(folder: Path) -> list[dict]:
    return [run_of_chart(run) for run in json.loads((folder / "results.json").read_text(encoding="utf-8"))["runs"]]


def table_below(summary: str, heading: str) -> dict | None:
    """The first table below a heading of summary.md."""
    found = re.search(rf"^## {re.escape(heading)}\n(.*?)(?=^## |\Z)", summary, re.S | re.M)
    lines = [line for line in (found[1] if found else "").splitlines() if line.startswith("|")]
    cells = [[text.strip() for text in line.strip("|").split("|")] for line in lines]
    return {"columns": cells[0], "rows": cells[2:]} if cells else None


def cures(curves: list[dict]) -> dict | None:
    """F at 0.25 % in percent, without and with each cure, at the clean and every other strength."""
    points, rows = {(c["axis"], c["variant"]): c["points"] for c in curves}, []
    for cure, axis, on, off in CURES:
        if (axis, on) not in points or (axis, off) not in points:
            continue
        cells = [(with_["label"], f"{100 * without['f025']:.1f}, **{100 * with_['f025']:.1f}**")
                 for without, with_ in zip(points[axis, off], points[axis, on], strict=True)]
        others = "; ".join(f"{label}: {text}" for label, text in cells[1:])
        rows.append([cure, axis.replace("-", " "), cells[0][1], others])
    return {"columns": ["cure", "degradation", "clean", "strength: without, with"], "rows": rows} if rows else None


def stress(folder: Path) -> dict:
    """The tables of summary.md, and a row a reconstruction."""
    results = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    summary = (folder / "summary.md").read_text(encoding="utf-8")
    named = {name: table_below(summary, heading) for name, heading in SECTIONS.items()}
    named["cures"] = cures(results["curves"])
    rows = []
    for s in results["samples"]:
        run = json.loads((folder / "runs" / f"{s['run']}.json").read_text(encoding="utf-8"))
        f = f_scores(run["evaluation"]) if run.get("evaluation") else {}
        signals = s["report"]["verdict"]["signals"] if s.get("report") else {}
        rows.append({key: s.get(key) for key in ("axis", "label", "scene", "variant", "verdict", "within_a_voxel")}
                    | {"f01": f.get(0.001), "f025": s["f025"], "f05": s["f05"], "cpu_s": s["cpu_seconds"],
                       "missed": signals.get("silhouettes_missed")})
    return {"tables": {name: table for name, table in named.items() if table}, "runs": rows}


def json_file(out: Path) -> object:
    return json.loads(out.with_suffix(".json").read_text(encoding="utf-8"))


KEEPERS: dict[str, Callable[[Path], object]] = {"chart": chart, "stress": stress, "json": json_file}


def copy_pictures(out: Path, pictures: dict[str, str]) -> None:
    """Charts that pages show: the names of files in the folder, or patterns of them, to a path below docs/images."""
    for pattern, target in pictures.items():
        for chart_file in out.glob(pattern):
            shutil.copy(chart_file, ROOT / "docs/images" / target.format(name=chart_file.name))
