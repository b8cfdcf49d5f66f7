"""Whether two builds of the program make the same bytes, and what the second costs against the first.

    python3 -m bench same_bytes BEFORE AFTER OUT [--quick]

BEFORE and AFTER are programs; each lies beside the programs that it starts (photohull-main, photohull-lab). The six
rendered scenes of --datasets, templeSparseRing and four scenes that BEFORE synthesizes are reconstructed by both, with
each of the four methods. The table says whether mesh.ply and volume.vdb have the same bytes, and has the CPU seconds of
AFTER over those of BEFORE. The exit code is 1 where anything differs or a run fails. Results that the same builds left
in OUT are taken as they are.

The two builds run in turn, and of --repeat runs the one that took least counts: a ratio of single runs on a machine
with other jobs says little. The first run of a build compiles its shaders, which the driver keeps."""
import argparse
import filecmp
from pathlib import Path

from bench import tables
from bench.runner import ROOT, SYNTHETIC, Photohull, ProgramError, add_datasets

RENDERED = ("armadillo", "bunny", "fandisk", "trellis", "plaster", "glazed")
TEMPLE = ROOT / "datasets/templeSparseRing"
# Stems, and cameras that outlines refine; lens distortion; noise and unlike exposures; no masks (but for the hull).
SYNTHESIZED = ("seedling_off", "distorted", "degraded", WITHOUT_MASKS := "moving_clutter")
METHODS = ("hull", "voxel-coloring", "space-carving", "refine")
FILES = ("mesh.ply", "volume.vdb")
QUICK = {"resolution": 48, "size": "192x192", "views": "spread:12"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    parser.add_argument("out", type=Path)
    add_datasets(parser)
    parser.add_argument("--quick", action="store_true",
                        help="few voxels along the box, at most 12 views, small synthetic pictures")
    parser.add_argument("--resolution", type=int, default=128, help="voxels along the box (default: %(default)s)")
    parser.add_argument("--repeat", type=int, default=1, help="runs of each; the one that took least CPU time counts")
    parser.add_argument("--scenes", nargs="*", help="these scenes only")
    parser.add_argument("--methods", nargs="*", default=METHODS, choices=METHODS, help="these methods only")


def find_scenes(options: argparse.Namespace, before: Photohull) -> dict[str, Path]:
    """Name and folder of the scenes; those that are not there are said to be left out."""
    wanted = options.scenes or (*RENDERED, TEMPLE.name, *SYNTHESIZED)
    scenes = {}
    for name in wanted:
        if name in SYNTHESIZED:
            size = ["--size", QUICK["size"]] if options.quick else []
            scenes[name] = before.synthesize(SYNTHETIC / f"{name}.json", options.out / "scenes" / name, *size)
            continue
        folder = TEMPLE if name == TEMPLE.name else options.datasets / name
        if folder.is_dir():
            scenes[name] = folder.resolve()
        else:
            print(f"{name} is left out: there is no folder {folder}", flush=True)
    return scenes


def compare(builds: dict[str, Photohull], scene: Path, folder: Path, method: str,
            options: argparse.Namespace) -> tuple[list[str], bool]:
    """The cells of a row after scene and method, and whether all is equal."""
    words = ["--method", method, "--resolution", QUICK["resolution"] if options.quick else options.resolution]
    words += ["--views", QUICK["views"]] if options.quick else []
    words += ["--masks", "none"] if scene.name == WITHOUT_MASKS and method != "hull" else []
    seconds: dict[str, float] = {}
    for repeat in range(options.repeat):
        for name, program in builds.items():
            try:
                done = program.reconstruct(scene, folder / f"{name}-{repeat}", *words)
            except ProgramError as error:
                return [f"{name} failed: {error.message}", "", "", "", ""], False
            seconds[name] = min(done.cpu_seconds, seconds.get(name, done.cpu_seconds))
    first = folder / "before-0"
    equal = [all(filecmp.cmp(first / file, folder / f"{name}-{repeat}" / file, shallow=False)
                 for name in builds for repeat in range(options.repeat)) for file in FILES]
    ratio = seconds["after"] / seconds["before"]
    return [*("equal" if same else "different" for same in equal), f"{seconds['before']:.2f}",
            f"{seconds['after']:.2f}", f"{ratio:.3f}"], all(equal)


def run(options: argparse.Namespace) -> int:
    builds = {"before": Photohull(options.before), "after": Photohull(options.after)}
    scenes = find_scenes(options, builds["before"])
    differ = []
    print(tables.head(["scene", "method", *FILES, "CPU s before", "after", "ratio"]), flush=True)
    for name, scene in scenes.items():
        for method in options.methods:
            cells, equal = compare(builds, scene, options.out / name / method, method, options)
            print(tables.line([name, method, *cells]), flush=True)
            if not equal:
                differ.append(f"{name} by {method}")
    count = len(scenes) * len(options.methods)
    print(f"\n{count - len(differ)} of {count} reconstructions are equal" +
          (f"; not: {', '.join(differ)}" if differ else ""))
    return 1 if differ or not scenes else 0
