"""How precise the cameras of photographs on a printed sheet are.

    python3 -m bench pose [--size 1600x1200] [--spec datasets/synthetic/on_sheet.json] [--cases plain,hidden,rims,noise,moved,bent]
        [--out bench/results/pose.json] [--keep FOLDER]

Renders the spec's object on the sheet in several ways, lets `photohull pose` find the cameras, and compares them with the
exact ones. Prints the table of docs/guide/sheet.md: photographs with a pose, the reprojection's root mean square, the error
of the focal length, the largest error of a camera's place (of its distance from the sheet's middle) and of its direction,
and what the report says of the sheet's bend."""
import argparse
import copy
import json
import math
from pathlib import Path

from bench import tables
from bench.runner import SYNTHETIC, Photohull, add_keep, add_program, keep_json, listed, read_spec, work_folder

# What is changed in the spec, and what pose is told.
HIDDEN = {"sheet": {"hidden": 0.3}}
CASES = {
    "plain": ("as the spec has it", {}, []),
    "hidden": ("30 % of the tags hidden", HIDDEN, []),
    "rims": ("hidden, out of focus at the rims", HIDDEN | {"degradations": {"edge_blur": 2}}, []),
    "noise": ("hidden, twice the noise, JPEG",
              HIDDEN | {"degradations": {"photon_noise": 0.03, "read_noise": 0.006, "jpeg": 85}}, []),
    "moved": ("hidden, a quarter blurred by motion", HIDDEN | {"degradations": {"motion_blur": 5}}, []),
    "bent": ("hidden, sheet bent by 5 mm, printed at 97 %",
             {"sheet": {"hidden": 0.3, "print": 0.97, "bend": [0, 0, 7.73]}}, ["--bar", 145.5]),
}
COLUMNS = ["photographs", "posed", "rms", "focal length", "place", "direction", "bend"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("--spec", type=Path, default=SYNTHETIC / "on_sheet.json")
    parser.add_argument("--size", default="1600x1200", help="of the photographs")
    parser.add_argument("--cases", type=listed, default=list(CASES), help="default: %(default)s")
    parser.add_argument("--out", type=Path)
    add_keep(parser)


def changed(spec: dict, changes: dict) -> dict:
    spec = copy.deepcopy(spec)
    for part, values in changes.items():
        spec.setdefault(part, {}).update(values)
    return spec


def cameras_of(path: Path) -> dict[str, tuple[list, dict]]:
    frames = json.loads(path.read_text(encoding="utf-8"))["frames"]
    return {Path(f["file_path"]).name: (f["transform_matrix"], f) for f in frames}


def errors_of(scene: Path, posed: Path) -> dict[str, float]:
    sheet = json.loads((scene / "spec.json").read_text(encoding="utf-8"))["result"]["sheet"]
    true, found = cameras_of(scene / "transforms.json"), cameras_of(posed / "transforms.json")
    focal = place = turn = 0.0
    for name, (pose, frame) in found.items():
        exact, exact_frame = true[name]
        center = [(exact[i][3] - sheet["origin"][i]) / sheet["unit"] for i in range(3)]
        place = max(place, math.dist(center, [pose[i][3] for i in range(3)]) / math.hypot(*center))
        trace = sum(exact[i][k] * pose[i][k] for i in range(3) for k in range(3))
        turn = max(turn, math.degrees(math.acos(max(-1.0, min(1.0, (trace - 1) / 2)))))
        focal = max(focal, abs(frame["fl_x"] / exact_frame["fl_x"] - 1))
    return {"posed": len(found), "of": len(true), "focal": focal, "place": place, "turn": turn}


def measure(photohull: Photohull, spec: dict, case: str, size: str, folder: Path) -> dict:
    label, changes, words = CASES[case]
    path = folder / f"{case}.json"
    path.write_text(json.dumps(changed(spec, changes)), encoding="utf-8")
    scene, posed = folder / case, folder / f"{case}_posed"
    photohull.call("synthesize", path, "--out", scene, "--size", size)
    report = photohull.call("pose", scene / "images", "--board", spec["sheet"]["board"], "--out", posed, "--json",
                            "--no-masks", *words).report
    return {"case": label, "rms": report["rms"], "bend": report["bend"],
            "focal_sigma": report["cameras"][0]["focal_sigma"] / report["cameras"][0]["focal_length"][0],
            } | errors_of(scene, posed)


def cells(r: dict) -> list[str]:
    bend = r["bend"]
    return [r["case"], f"{r['posed']} of {r['of']}", f"{r['rms']:.3f} px", f"{100 * r['focal']:.3f} %",
            f"{100 * r['place']:.4f} %", f"{r['turn']:.4f} degrees",
            f"{bend['height']:.2f} +- {bend['height_sigma']:.2f} mm" if bend["found"] else "none"]


def run(options: argparse.Namespace) -> None:
    photohull, rows = Photohull(options.program), []
    spec = read_spec(options.spec)
    spec["sheet"]["board"] = str((options.spec.parent / spec["sheet"]["board"]).resolve())
    with work_folder(options.keep) as folder:
        rows += [measure(photohull, spec, case, options.size, folder) for case in options.cases]
    tables.show(COLUMNS, map(cells, rows))
    keep_json(options.out, rows)
