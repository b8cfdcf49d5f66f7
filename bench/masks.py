"""Masks made from the background of rendered scenes, against the exact ones.

    python3 -m bench masks [--specs bench/specs/masks_black.json,...] [--out bench/results/masks.json] [--keep FOLDER]

Masks are made by the background's colours and by photographs without the object, each without and with GrabCut. Prints
the table of docs/guide/masks.md: intersection over union (the mean and the worst view), the share of the object that is
missed, confidence (mean and least), and whether confidence tells the good masks (IoU of 0.95 at least) from the bad
ones: the chance that of two such masks the better one has more of it."""
import argparse
from pathlib import Path
from statistics import fmean

from bench import tables
from bench.runner import ROOT, Photohull, add_keep, add_program, keep_json, listed, work_folder

GOOD = 0.95
COLUMNS = ["scene", "from", "GrabCut", "masks", "IoU, mean (worst)", "missed", "confidence, mean (least)", "CPU s"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    specs = sorted(str(path) for path in (ROOT / "bench/specs").glob("masks_*.json"))
    parser.add_argument("--specs", type=listed, default=specs, help="default: bench/specs/masks_*.json")
    parser.add_argument("--out", type=Path)
    add_keep(parser)


def measure(photohull: Photohull, spec: Path, folder: Path) -> list[dict]:
    scene, rows = photohull.synthesize(spec, folder / spec.stem), []
    ways = {"colours": ["--masks", "background"], "plates": ["--masks", "auto", "--background", scene / "plates"]}
    for label, way in ways.items():
        for cut in (False, True):
            out = folder / f"{spec.stem}_{label}{'_cut' if cut else ''}"
            done = photohull.call("masks", scene, *way, "--compare", scene / "masks", "--json", "--out", out,
                                  *(["--grabcut"] if cut else []))
            views = done.report["views"]
            rows.append({"scene": spec.stem, "from": label, "grabcut": cut, "cpu": done.cpu_seconds,
                         "masks": len(made(views)), "views": views})
    return rows


def made(views: list[dict]) -> list[dict]:
    return [view for view in views if view["source"] != "none"]


def cells(row: dict) -> list[object]:
    v = made(row["views"])
    iou, confidence = [x["iou"] for x in v], [x["confidence"] for x in v]
    figures = [f"{fmean(iou):.4f} ({min(iou):.4f})", f"{100 * fmean(x['missed'] for x in v):.2f} %",
               f"{fmean(confidence):.2f} ({min(confidence):.2f})"] if v else ["-", "-", "-"]
    return [row["scene"], row["from"], "yes" if row["grabcut"] else "no", f"{len(v)} of {len(row['views'])}", *figures,
            f"{row['cpu']:.1f}"]


def told_apart(rows: list[dict]) -> None:
    """Prints how well confidence tells good masks, made without GrabCut, from bad ones."""
    judged = [(x["confidence"], x["iou"]) for row in rows if not row["grabcut"] for x in made(row["views"])]
    good, bad = [c for c, i in judged if i >= GOOD], [c for c, i in judged if i < GOOD]
    if not good or not bad:
        return
    share = fmean((g > b) + 0.5 * (g == b) for g in good for b in bad)
    print(f"{len(good)} good and {len(bad)} bad masks; the good one has more confidence in {share:.3f} of the pairs")
    for limit in (0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9):
        print(f"below {limit:.1f}: {sum(c < limit for c in bad)} of {len(bad)} bad, "
              f"{sum(c < limit for c in good)} of {len(good)} good")


def run(options: argparse.Namespace) -> None:
    photohull = Photohull(options.program)
    with work_folder(options.keep) as folder:
        rows = [row for spec in options.specs for row in measure(photohull, Path(spec), folder)]
    tables.show(COLUMNS, map(cells, rows))
    told_apart(rows)
    keep_json(options.out, rows)
