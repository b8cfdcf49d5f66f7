"""Textured models beside photographs that they were not made from, and what fewer triangles and smaller files cost.

    python3 -m bench textures [--scenes bunny,templeRing] [--studies held-out,truth] [--out FILE] [--keep FOLDER]

Three views are held out, and cameras are taken as given, for those of the held-out views could not be refined. The test
program compare_with_photographs draws the meshes from their cameras: with the texture of mesh.glb, with the vertices'
colours of mesh.ply, and with those of a run with twice the resolution, where a quarter of the voxels' area has a vertex
each (`held-out`). Then models within 0.5 voxels beside one within 0.02, which has nearly all triangles (`simplified`); files
with JPEG and compressed geometry beside the plain file (`files`); and, of scenes with a gt.ply, how many texels differ from
the surface's true colour (`truth`). Prints the tables of docs/measurements/textures.md."""
import argparse
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from bench import page
from bench.runner import Photohull, ProgramError, add_datasets, add_keep, add_program, keep_json, listed, work_folder

HELD_OUT = {"fountain": "3,6,8"}  # of 11 views, which all look from one side; others: the next line
HELD_OUT_OF_RINGS = "0,8,16"
OPTIONS = {"fountain": ("--masks", "none")}
RESOLUTION = {"fountain": 416}  # half its default
STUDIES = ("held-out", "simplified", "files", "truth")
ERROR, NEARLY_NONE = 0.5, 0.02  # voxels
FILES = {"png": (), "jpeg": ("--texture-format", "jpeg"), "png, compressed": ("--compress",),
         "jpeg, compressed": ("--texture-format", "jpeg", "--compress")}
LAST_LINE = re.compile(r"PSNR ([-\d.]+) dB, ZNCC ([-\d.]+), contrast ([-\d.]+)")
TRUTH_LINE = re.compile(r": (\d+) texels, of (\d+) more .*; ([\d.]+) % differ by more than [\d.]+, PSNR ([-\d.]+) dB")


def listed_studies(text: str) -> list[str]:
    studies = listed(text)
    if unknown := [name for name in studies if name not in STUDIES]:
        raise argparse.ArgumentTypeError(f"{unknown[0]} is none of {', '.join(STUDIES)}")
    return studies


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    add_datasets(parser)
    parser.add_argument("--scenes", type=listed, default="bunny,templeRing")
    parser.add_argument("--studies", type=listed_studies, default=",".join(STUDIES[:3]), help=", ".join(STUDIES))
    parser.add_argument("--out", type=Path, help="file for the figures")
    add_keep(parser)


class Study:
    def __init__(self, photohull: Photohull, scene: Path, folder: Path):
        self.photohull, self.scene, self.folder = photohull, scene, folder
        self.views = HELD_OUT.get(scene.name, HELD_OUT_OF_RINGS)

    def reconstruct(self, name: str, *options: object, resolution: int | None = None, held_out: bool = True) -> tuple[Path, dict]:
        """The folder of a run, and its report."""
        if held_out:
            options = (*options, "--hold-out", self.views)
        if resolution or self.scene.name in RESOLUTION:
            options = (*options, "--resolution", resolution or RESOLUTION[self.scene.name])
        print(self.scene.name, name, file=sys.stderr, flush=True)
        out = self.folder / f"{self.scene.name}-{name.replace(', ', '-')}"
        report = self.photohull.reconstruct(self.scene, out, "--refine-cameras", "off", *OPTIONS.get(self.scene.name, ()),
                                            *options).report
        return out, report

    def likeness(self, mesh: Path, reference: Path | None = None) -> dict:
        """How much pictures of a mesh look like photographs, or like pictures of the reference."""
        like = ("--like", reference) if reference else ()
        said = self.judged("compare_with_photographs", self.scene, self.views, *like, mesh)
        psnr, zncc, contrast = map(float, LAST_LINE.findall(said)[-1])
        return {"psnr": psnr, "zncc": zncc, "contrast": contrast}

    def judged(self, judge: str, *arguments: object) -> str:
        """What a test program prints."""
        words = [str(word) for word in (self.photohull.program.parent / "tests/texture" / judge, *arguments)]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode:
            raise ProgramError(words, done.returncode, done.stderr.strip())
        return done.stdout

    def truth(self) -> Iterator[dict]:
        for name, held_out in ("all photographs", False), ("textured", True):
            out, report = self.reconstruct(name, "--export", "glb", held_out=held_out)
            known, unknown, apart, psnr = TRUTH_LINE.findall(self.judged("compare_with_truth", self.scene, out / "mesh.glb"))[-1]
            yield {"kind": "truth", "scene": self.scene.name, "left_out": self.views if held_out else "none", "known": int(known),
                   "unknown": int(unknown), "apart": float(apart) / 100, "psnr": float(psnr), "filled": report["texture"]["filled_share"]}

    def held_out(self) -> Iterator[dict]:
        out, report = self.reconstruct("textured", "--export", "glb")
        resolution = max(report["grid"]["voxels"])
        fine, _ = self.reconstruct("twice", resolution=2 * resolution)
        stages = {stage["name"]: stage["cpu_seconds"] for stage in report["stages"]}
        yield {"kind": "held-out", "scene": self.scene.name, "held_out": self.views, "resolution": resolution,
               "texture": self.likeness(out / "mesh.glb"), "vertices": self.likeness(out / "mesh.ply"),
               "twice": self.likeness(fine / "mesh.ply"), "triangles": report["mesh"]["triangles"],
               "textured": report["texture"], "texture_s": stages["texture"], "cpu_s": report["cpu_seconds"]}

    def simplified(self) -> Iterator[dict]:
        full, nearly = self.reconstruct("nearly-all-triangles", "--export", "glb", "--mesh-error", NEARLY_NONE)
        lean, report = self.reconstruct("simplified", "--export", "glb", "--mesh-error", ERROR)
        plain, usual = self.reconstruct("textured", "--export", "glb")
        uniform = usual["mesh"]["triangles"]
        yield {"kind": "simplified", "scene": self.scene.name, "uniform": uniform,
               "nearly": nearly["mesh"]["triangles"], "triangles": report["mesh"]["triangles"],
               "share": report["mesh"]["triangles"] / uniform,
               "like": self.likeness(lean / "mesh.glb", full / "mesh.glb"),
               "photographs": self.likeness(lean / "mesh.glb"), "plain": self.likeness(plain / "mesh.glb")}

    def files(self) -> Iterator[dict]:
        plain = self.reconstruct("textured", "--export", "glb")[0] / "mesh.glb"
        for name, options in FILES.items():
            made = plain
            if options:
                made = self.reconstruct(f"file {name}", "--export", "glb", *options)[0] / "mesh.glb"
            yield {"kind": "files", "scene": self.scene.name, "file": name, "megabytes": made.stat().st_size / 1e6,
                   "share": made.stat().st_size / plain.stat().st_size,
                   **({"like": self.likeness(made, plain)} if options else {})}


def run(options: argparse.Namespace) -> None:
    photohull, rows = Photohull(options.program), []
    with work_folder(options.keep) as folder:
        for scene in options.scenes:
            study = Study(photohull, options.datasets / scene, folder)
            for name in options.studies:
                rows += getattr(study, name.replace("-", "_"))()
    for table in page.data("textures").values():
        if any(row["kind"] in table["where"]["kind"] for row in rows):
            print(page.table_of(table, rows), end="\n\n")
    keep_json(options.out, rows)
