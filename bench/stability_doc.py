"""Puts the tables and curves of `photohull stress` into docs/measurements/stability.md.

    build/release/photohull stress bench/plans/stress.json --out out/stress
    build/release/photohull stress bench/plans/stress_marks.json --out out/stress_marks
    python3 -m bench stability_doc out/stress out/stress_marks
    python3 -m bench stability_doc --verdicts out/seed2       # the table of verdicts alone
    python3 -m bench stability_doc --thin out/stress_thin     # the axes of group thin alone

Replaces what stands between the lines `<!-- stress:NAME -->` and `<!-- /stress:NAME -->` by the sections of the folders'
summary.md, and copies the charts to docs/images. Without the second folder the promises in larger pictures stay as they
are."""
import argparse
import json
import re
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

from bench import tables
from bench.runner import ROOT, f_scores

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

THIN = {"stem-width", "mask-style", "views-off-1", "views-off-2", "view-shift"}  # axes, each scene's figures in full

DOCS = ROOT / "docs"
COLUMNS = ["axis", "point", "scene", "settings", "F 0.1 %", "F 0.25 %", "F 0.5 %", "silhouettes missed", "verdict"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folders", nargs="*", type=Path, help="of all axes, and of the promises in larger pictures")
    parser.add_argument("--verdicts", type=Path, metavar="FOLDER")
    parser.add_argument("--thin", type=Path, metavar="FOLDER")


def section(folder: Path, heading: str) -> str:
    """The tables below a heading of summary.md; nothing where the heading is missing."""
    text = (folder / "summary.md").read_text()
    found = re.search(rf"^## {re.escape(heading)}\n(.*?)(?=^## |\Z)", text, re.S | re.M)
    return found.group(1).strip() if found else ""


def cures(folder: Path) -> str:
    """F at 0.25 % in percent, without and with each cure, at the clean and every other strength."""
    curves = {(c["axis"], c["variant"]): c["points"] for c in json.loads((folder / "results.json").read_text())["curves"]}
    rows = []
    for cure, axis, on, off in CURES:
        pairs = list(zip(curves[axis, off], curves[axis, on], strict=True))
        cells = [(with_["label"], f"{100 * without['f025']:.1f}, **{100 * with_['f025']:.1f}**") for without, with_ in pairs]
        others = "; ".join(f"{label}: {text}" for label, text in cells[1:])
        rows.append([cure, axis.replace("-", " "), cells[0][1], others])
    return ("F at 0.25 % of the diagonal, mean over scenes, without and with the cure.\n\n" +
            tables.markdown(["cure", "degradation", "clean", "strength: without, with"], rows))


def thin(folder: Path) -> str:
    """Every scene's own figures, and the curves."""
    results = json.loads((folder / "results.json").read_text())
    rows = []
    for s in results["samples"]:
        if s["axis"] not in THIN:
            continue
        run = json.loads((folder / "runs" / f"{s['run']}.json").read_text())
        scores = f_scores(run["evaluation"]) if "evaluation" in run else {}
        missed = s["report"]["verdict"]["signals"]["silhouettes_missed"] if s.get("report") else None
        cells = [s["axis"].replace("-", " "), s["label"], s["scene"], s["variant"]]
        cells.append(f"{100 * scores[0.001]:.1f}" if 0.001 in scores else "")
        cells += [f"{100 * s['f025']:.1f}", f"{100 * s['f05']:.1f}"]
        cells += ["" if missed is None else f"{100 * missed:.2f} %", s.get("verdict") or ""]
        rows.append(cells)
    return tables.markdown(COLUMNS, rows) + "\n\n" + pictures(folder, lambda group: group == "thin")


def pictures(folder: Path, wanted: Callable[[str], bool]) -> str:
    """Links to the charts of these groups, which are copied."""
    lines = []
    for chart in sorted(folder.glob("stress--*.png")):
        if not wanted(chart.stem.removeprefix("stress--")):
            continue
        shutil.copy(chart, DOCS / "images" / chart.name)
        lines.append(f"![Breakdown curves: {chart.stem[8:]}](../images/{chart.name})")
    return "\n\n".join(lines)


def replace(parts: dict[str, str]) -> None:
    page = DOCS / "measurements" / "stability.md"
    text = page.read_text()
    for name, content in parts.items():
        pattern = rf"(<!-- stress:{name} -->\n).*?(<!-- /stress:{name} -->)"
        text, count = re.subn(pattern, lambda m: f"{m[1]}{content}\n{m[2]}", text, flags=re.S)
        if count != 1:
            sys.exit(f"{page}: no place <!-- stress:{name} --> for the tables")
    page.write_text(text)


def all_parts(curves: Path) -> dict[str, str]:
    parts = {
        "marks-small": section(curves, "Promises"),
        "breakdown": section(curves, "Where it breaks"),
        "cures": cures(curves),
        "bytes": section(curves, "Equal bytes"),
        "curves": pictures(curves, lambda group: group not in ("marks", "thin")),
    }
    if any(s["axis"] in THIN for s in json.loads((curves / "results.json").read_text())["samples"]):
        parts["thin"] = thin(curves)
    return parts


def run(options: argparse.Namespace) -> None:
    parts = all_parts(options.folders[0]) if options.folders else {}
    if len(options.folders) > 1:
        parts["marks"] = section(options.folders[1], "Promises")
    if options.verdicts:
        parts["verdicts"] = section(options.verdicts, "Verdicts")
    if options.thin:
        parts["thin"] = thin(options.thin)
    if not parts:
        sys.exit("stability_doc needs a folder that 'photohull stress' made")
    replace(parts)
