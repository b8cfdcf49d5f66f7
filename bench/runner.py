"""How the program is called: its path, its options, its output folders, what it printed and what it cost."""
import argparse
import contextlib
import hashlib
import json
import os
import resource
import subprocess
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build/release/photohull"
SHARED = ROOT.parent / "shared"  # image sets that are too large for the project
DATASETS = SHARED / "datasets"
RESULTS = ROOT / "bench/results"
SYNTHETIC = ROOT / "datasets/synthetic"
JUDGED_AS_FAILED = 3  # exit code of a reconstruction that was made, and failed its own checks


class ProgramError(SystemExit):
    """The program ended with an error; `words` is its command line, `status` its exit code."""

    def __init__(self, words: list[str], status: int, message: str):
        super().__init__(f"photohull {' '.join(words)} failed ({status}): {message}")
        self.words, self.status, self.message = words, status, message


@dataclass
class Run:
    """What a run printed and cost."""
    output: str
    status: int
    cpu_seconds: float
    wall_seconds: float

    @cached_property
    def report(self) -> dict:
        return json.loads(self.output)


def children_cpu() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Photohull:
    """A build of the program. `environment` is set for its processes in addition to this process's own."""

    def __init__(self, program: Path | str = PROGRAM, environment: dict[str, str] | None = None):
        self.program = Path(program).resolve()
        self.environment = environment or {}
        if not os.access(self.program, os.X_OK) or self.program.is_dir():
            raise SystemExit(f"{self.program} is no program; build it, or name another one")

    @cached_property
    def identity(self) -> str:
        """Differs between builds: of the program and of those beside it that it starts."""
        digest = hashlib.sha256()
        for part in sorted(self.program.parent.glob(self.program.name + "*")):
            if part.is_file():
                digest.update(part.read_bytes())
        return digest.hexdigest()

    def call(self, *words: object) -> Run:
        """Runs one command. Errors of the program end the study with its message."""
        command = [str(word) for word in words]
        cpu, start = children_cpu(), time.perf_counter()
        done = subprocess.run([self.program, *command], env=os.environ | self.environment, capture_output=True,
                              check=False)
        wall, cpu = time.perf_counter() - start, children_cpu() - cpu
        if done.returncode not in (0, JUDGED_AS_FAILED):
            lines = done.stderr.decode(errors="replace").strip().splitlines()
            raise ProgramError(command, done.returncode, lines[-1] if lines else "no message")
        return Run(done.stdout.decode(errors="replace"), done.returncode, cpu, wall)

    def json(self, *words: object) -> dict:
        return self.call(*words, "--json").report

    def synthesize(self, spec: Path | dict, scene: Path, *options: object) -> Path:
        """Renders a scene by a spec file, or by a spec that is written beside the scene."""
        if isinstance(spec, dict):
            file = scene.parent / f"{scene.name}.json"
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(json.dumps(spec), encoding="utf-8")
            spec = file
        self.once(scene, "synthesize", spec, "--out", scene, *options)
        return scene

    def reconstruct(self, scene: Path, out: Path, *options: object) -> Run:
        """A run with its report."""
        return self.once(out, "reconstruct", scene, "--out", out, "--json", *options)

    def evaluate(self, mesh: Path, *options: object) -> dict:
        return self.json("evaluate", mesh, *options)

    def seen_f(self, mesh: Path, scene: Path, threshold: float = 0.0025) -> float:
        """F-score of the surface that cameras see, at a share of the diagonal."""
        return self.evaluate(mesh, "--truth", scene, "--thresholds", threshold)["seen"]["f"][0]["f"]

    def every_eighth_view(self, scene: Path) -> str:
        """The views that are held out to judge by, as a list for --hold-out and --views."""
        return ",".join(str(i) for i in range(0, len(self.json("info", scene)["views"]), 8))

    def once(self, out: Path, *words: object) -> Run:
        """Runs a command that writes into the folder `out`; what the same build made there by the same words of the
        same inputs is taken as it is."""
        record = record_of(out)
        wanted = {"program": self.identity, "environment": self.environment, "words": [str(word) for word in words],
                  "inputs": [state_of(Path(word)) for word in words if word != out and isinstance(word, Path)]}
        if record.is_file() and out.is_dir():
            kept = json.loads(record.read_text(encoding="utf-8"))
            if {key: kept[key] for key in wanted} == wanted:
                return Run(**kept["run"])
        record.unlink(missing_ok=True)
        out.parent.mkdir(parents=True, exist_ok=True)
        done = self.call(*words)
        fields = {"output": done.output, "status": done.status, "cpu_seconds": done.cpu_seconds,
                  "wall_seconds": done.wall_seconds}
        record.write_text(json.dumps(wanted | {"run": fields}), encoding="utf-8")
        return done


def record_of(folder: Path) -> Path:
    """Where it stands which run made a folder."""
    return folder.parent / f"{folder.name}.run.json"


def state_of(path: Path) -> str:
    """Differs when a file, or what made a folder, has changed; a folder that no run made is taken to stay as it is."""
    file = record_of(path) if path.is_dir() else path
    return hashlib.sha256(file.read_bytes()).hexdigest() if file.is_file() else ""


def read_spec(path: Path) -> dict:
    """A spec for `synthesize`, whose lines that begin with // are comments."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return json.loads("\n".join(line for line in lines if not line.strip().startswith("//")))


def f_scores(judged: dict) -> dict[float, float]:
    """Threshold, as a share of the diagonal, to F-score: of what `evaluate` said of all surface, or of what is seen."""
    return {row["t"]: row["f"] for row in judged["f"]}


def listed(text: str) -> list[str]:
    """Type of an option that takes names with commas between them."""
    return text.split(",")


def add_program(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--program", type=Path, default=PROGRAM, help="default: build/release/photohull")


def add_datasets(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--datasets", type=Path, default=DATASETS, help="folder of the scenes (default: %(default)s)")


def add_keep(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--keep", type=Path, help="folder for what is made, to look at or go on from (default: it goes)")


@contextlib.contextmanager
def work_folder(keep: Path | None) -> Iterator[Path]:
    """The folder to keep things in, or one that goes at the end."""
    if keep:
        keep.mkdir(parents=True, exist_ok=True)
        yield keep
        return
    with tempfile.TemporaryDirectory() as name:
        yield Path(name)


def keep_json(path: Path | str | None, value: object) -> None:
    """Writes figures to a file, where one is wanted."""
    if path:
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        Path(path).write_text(json.dumps(value, indent=1), encoding="utf-8")
