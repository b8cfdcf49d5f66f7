"""What photographs of different exposure, white balance and vignetting cost, and what --photometric brings back.

    python3 -m bench photometric [--specs bench/specs/jitter_folds.json,...] [--methods refine,hull]
        [--out bench/results/photometric.json] [--keep FOLDER]

Each spec is rendered as it is and without these degradations ("alike"); both are reconstructed with every eighth view
held out. Prints the table of docs/guide/cameras.md: F at 0.25 % of the diagonal, the error of the gains against the
synthesizer's true ones (up to a factor a channel), by how much the photographs disagree on the colour of a surface
point, the error of predicted photographs (PSNR; with the gains of all views measured on the mesh where --photometric is
on), and the stage's CPU seconds."""
import argparse
import json
import math
from pathlib import Path

from bench import tables
from bench.runner import ROOT, Photohull, add_keep, add_program, keep_json, listed, read_spec, work_folder

SPECS = [str(ROOT / f"bench/specs/jitter_{name}.json") for name in ("folds", "pawn", "block")]
COLUMNS = ["scene", "method", "--photometric", "F 0.25 %", "gain error rms (max)", "colours differ", "corrected",
           "vignetting", "PSNR, dB", "CPU s"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("--specs", type=listed, default=SPECS, help="default: bench/specs/jitter_*.json")
    parser.add_argument("--methods", type=listed, default="refine")
    parser.add_argument("--resolution", type=int, default=160)
    parser.add_argument("--out", type=Path)
    add_keep(parser)


def render(photohull: Photohull, path: Path, alike: bool, folder: Path) -> Path:
    spec = read_spec(path)
    if alike:
        for key in ("exposure", "white_balance", "vignetting"):
            spec["degradations"].pop(key, None)
    return photohull.synthesize(spec, folder / (spec["name"] + ("_alike" if alike else "")))


def gain_errors(scene: Path, photometric: dict) -> dict[str, float]:
    result = json.loads((scene / "spec.json").read_text(encoding="utf-8"))["result"]
    true = dict(zip(result["views"], result["gains"]))
    errors = []
    for channel in range(3):
        logs = [math.log(v["gain"][channel] / true[v["name"] if v["name"] in true else Path(v["name"]).stem][channel])
                for v in photometric["views"] if v["solved"]]
        middle = sum(logs) / len(logs)
        errors += [e - middle for e in logs]
    return {"rms": math.sqrt(sum(e * e for e in errors) / len(errors)), "max": max(map(abs, errors))}


def measure(photohull: Photohull, scene: Path, method: str, photometric: str, resolution: int) -> dict:
    held_out = photohull.every_eighth_view(scene)
    out = scene.parent / f"out_{scene.name}_{method}_{photometric}"
    report = photohull.reconstruct(scene, out, "--method", method, "--resolution", resolution, "--hold-out", held_out,
                                   "--photometric", photometric).report
    mesh = out / "mesh.ply"
    photos = photohull.evaluate(mesh, "--photos", scene, "--views", held_out, "--photometric",
                                photometric)["photos"]["all"]
    row = {"method": method, "photometric": photometric, "f": photohull.seen_f(mesh, scene), "psnr": photos["psnr"],
           "zncc": photos["zncc"]}
    p = report.get("photometric")
    if p:
        row.update(used=p["used"], cpu=sum(s["cpu_seconds"] for s in report["stages"] if s["name"] == "photometric"))
        if "disagreement_before" in p:  # unless a quick look found the photographs alike
            row.update(before=p["disagreement_before"], after=p["disagreement_after"], lenses=p["lenses"])
            if p["solved"]:
                row["gain_error"] = gain_errors(scene, p)
    return row


def cells(r: dict) -> list[str]:
    e = r.get("gain_error")
    corrects = "" if "used" not in r else " (corrects)" if r["used"] else " (leaves)"
    return [r["scene"], r["method"], r["photometric"] + corrects, f"{100 * r['f']:.2f}",
            f"{100 * e['rms']:.2f} % ({100 * e['max']:.2f} %)" if e else "",
            f"{100 * r['before']:.2f} %" if "before" in r else "", f"{100 * r['after']:.2f} %" if "after" in r else "",
            ", ".join(f"{lens['vignetting']:.3f} +- {lens['sigma']:.3f}" for lens in r.get("lenses", [])),
            f"{r['psnr']:.2f}", f"{r['cpu']:.1f}" if "cpu" in r else ""]


def run(options: argparse.Namespace) -> None:
    photohull, rows = Photohull(options.program), []
    with work_folder(options.keep) as folder:
        for spec in map(Path, options.specs):
            alike, unlike = (render(photohull, spec, same, folder) for same in (True, False))
            for method in options.methods:
                for scene, label in ((alike, f"{unlike.name}, alike"), (unlike, unlike.name)):
                    rows += [{"scene": label} | measure(photohull, scene, method, photometric, options.resolution)
                             for photometric in ("off", "auto")]
    tables.show(COLUMNS, map(cells, rows))
    keep_json(options.out, rows)
