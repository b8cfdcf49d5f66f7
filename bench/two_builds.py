"""Whether one build of the program is faster than another, and as accurate.

    python3 -m bench two_builds BEFORE AFTER [--repeat 3] [--jobs armadillo draft ...]

BEFORE and AFTER are programs; each lies beside the programs that it starts. Every job of the table is done by both in turn, and
what stands in it is the median of --repeat runs, and of the ratios of each round: other programs that run beside them slow both of a
round alike. F is that of the surface which cameras see, at 0.1 and 0.25 % of the box's diagonal, where a scene has its true surface.
One more round goes first, in which each build compiles its shaders."""
import argparse
import statistics
from pathlib import Path

from bench import tables
from bench.runner import Photohull, Run, add_datasets, add_keep, f_scores, work_folder

RENDERED = ("armadillo", "bunny", "fandisk", "trellis", "plaster", "glazed")
HULL = ("--method", "hull", "--resolution", 256)
# Name of the job, the scene, and options.
JOBS = {name: (name, ()) for name in (*RENDERED, "templeSparseRing", "templeRing", "dinoRing")} | {
    "hull": ("templeRing", HULL),
    "hull-as-given": ("templeRing", (*HULL, "--refine-cameras", "off")),
    "draft": ("armadillo", ("--quality", "draft")),
}
THRESHOLDS = (0.001, 0.0025)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    add_datasets(parser)
    add_keep(parser)
    parser.add_argument("--repeat", type=int, default=3, help="rounds that count (default: %(default)s)")
    parser.add_argument("--jobs", nargs="*", default=list(JOBS), choices=JOBS, metavar="JOB", help=f"of {', '.join(JOBS)}")


def accuracy(program: Photohull, mesh: Path, scene: Path) -> dict[float, float]:
    return f_scores(program.evaluate(mesh, "--truth", scene, "--thresholds", ",".join(map(str, THRESHOLDS)))["seen"])


def cells(runs: dict[str, list[Run]]) -> list[str]:
    """What each build cost, and what the second costs against the first."""
    cpu = {name: statistics.median(run.cpu_seconds for run in done) for name, done in runs.items()}
    peak = {name: statistics.median(run.report["peak_memory_bytes"] for run in done) / 2**20 for name, done in runs.items()}

    def ratio(figure: str) -> float:
        return statistics.median(getattr(b, figure) / getattr(a, figure) for a, b in zip(runs["before"], runs["after"]))

    shares = statistics.median(run.wall_seconds / run.cpu_seconds for run in runs["after"])
    return [f"{cpu['before']:.2f}", f"{cpu['after']:.2f}", f"{ratio('cpu_seconds'):.3f}", f"{ratio('wall_seconds'):.3f}",
            f"{shares:.2f}", f"{peak['before']:.0f}", f"{peak['after']:.0f}"]


def run(options: argparse.Namespace) -> int:
    builds = {"before": Photohull(options.before), "after": Photohull(options.after)}
    print(tables.head(["job", "CPU s before", "after", "ratio", "ratio of wall", "wall / CPU after", "peak MiB before", "after",
                       *(f"F {100 * t:g} % before, after" for t in THRESHOLDS)]), flush=True)
    with work_folder(options.keep) as folder:
        for job in options.jobs:
            name, words = JOBS[job]
            scene = (options.datasets / name).resolve()
            runs: dict[str, list[Run]] = {build: [] for build in builds}
            for repeat in range(options.repeat + 1):
                for build, program in builds.items():
                    done = program.reconstruct(scene, folder / f"{job}-{build}-{repeat}", *words)
                    if repeat > 0:
                        runs[build].append(done)
            f = [""] * len(THRESHOLDS)
            if name in RENDERED:
                judged = [accuracy(builds["after"], folder / f"{job}-{build}-1/mesh.ply", scene) for build in builds]
                f = [", ".join(f"{100 * of[t]:.2f}" for of in judged) for t in THRESHOLDS]
            print(tables.line([job, *cells(runs), *f]), flush=True)
    return 0
