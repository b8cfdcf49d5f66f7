"""How far results of other devices are from the default device's.

    python3 -m bench devices [NAME=VALUE[,NAME=VALUE...] ...] [--out FILE]

A synthetic scene is reconstructed by hull, space carving and refinement on the default device and with each set of
environment variables, for example LP_NATIVE_VECTOR_WIDTH=128 (llvmpipe with vectors half as wide) or
LIBGL_ALWAYS_SOFTWARE=1,MESA_LOADER_DRIVER_OVERRIDE=zink (OpenGL on Vulkan). Prints whether mesh.ply has the same bytes,
its F-score at 0.25 % of the diagonal against the truth, and the distances of its surface from the default device's, in
voxels."""
import argparse
from collections.abc import Iterator
from pathlib import Path

from bench import tables
from bench.runner import Photohull, ProgramError, add_program, f_scores, keep_json, work_folder

SPEC = {
    "geometry": {"shape": "folds", "parameters": {"count": 5, "depth": 0.25, "lean": 0.3}},
    "image": {"width": 256, "height": 256, "samples": 2, "maps": False},
    "truth_samples": 40000,
    "cameras": {"fill": 0.92, "rings": [{"count": 8, "elevation": -15}, {"count": 8, "elevation": 20, "phase": 0.5},
                                        {"count": 8, "elevation": 55}]},
}
METHODS = ("hull", "space-carving", "refine")
COLUMNS = ["method", "environment", "device", "same bytes", "F 0.25 %", "mean, voxels", "95 %", "greatest"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("environments", nargs="*", help="variables with commas between them")
    parser.add_argument("--out", type=Path, help="file for the table")


def compare(photohull: Photohull, scene: Path, method: str, out: Path, first: Path) -> list[str]:
    """A row's figures: the device's name, same bytes, F-score, distances from the mesh `first` in voxels."""
    report = photohull.reconstruct(scene, out, "--resolution", 80, "--method", method).report
    mesh = out / "mesh.ply"
    f = f_scores(photohull.evaluate(mesh, "--truth", scene))[0.0025]
    apart = photohull.evaluate(mesh, "--truth", first)["recon_to_gt"]
    same = mesh.read_bytes() == first.read_bytes()
    far = [0 if same else apart[name] / report["grid"]["voxel_size"] for name in ("mean", "q95", "max")]
    return [report["device"], "yes" if same else "no", f"{100 * f:.2f}", *(f"{d:.2g}" for d in far)]


def rows(options: argparse.Namespace, folder: Path) -> Iterator[list[str]]:
    scene = Photohull(options.program).synthesize(SPEC, folder / "scene")
    for method in METHODS:
        for i, environment in enumerate(["", *options.environments]):
            variables = dict(pair.split("=", 1) for pair in environment.split(",") if pair)
            photohull = Photohull(options.program, variables)
            try:
                figures = compare(photohull, scene, method, folder / f"{method}-{i}", folder / f"{method}-0/mesh.ply")
            except ProgramError as error:
                figures = [f"error: {error.message}", *[""] * 5]
            yield [method, environment or "as it is", *figures]


def run(options: argparse.Namespace) -> None:
    with work_folder(None) as folder:
        found = list(rows(options, folder))
    print(tables.markdown(COLUMNS, found))
    keep_json(options.out, {"tables": {"devices": {"columns": COLUMNS, "rows": found}}})
