"""Small inputs in the place of those that the pages name: one synthesized scene stands for all photographs."""
import json
import re
import shutil
import subprocess
from pathlib import Path

BOX = "-0.6 -0.6 0 0.6 0.6 1.8"  # holds the object of the stand-in
SPEC = {
    "name": "stand-in",
    "geometry": {"shape": "pawn"},
    "image": {"width": 96, "height": 72, "samples": 1, "maps": False},
    "background": {"plates": True},
    "truth_samples": 2000,
    "cameras": {"rings": [{"count": 8, "elevation": 0}, {"count": 8, "elevation": 35, "phase": 0.5}]},
}

# Words of the pages, and what is written for them. Scenes are copies of the stand-in under the page's own names.
WORDS = {
    "SCENE": "scene",
    "../shared/datasets/SCENE": "scene",
    "FRAME": "scene",
    "MESH": "mesh.ply",
    "DIR": "out/dir",
    "PLAN": "bench/plans/smoke.json",
    "SPEC": "datasets/synthetic/sphere.json",
    "FORMAT": "transforms",
    "LIST": "0,8",
    "DISTANCE": "0.01",
    "V": "0.08",
    "S": "0.5",
    "$s": "ball",
    "../shared/datasets/fountain/fountain_par.txt": "../shared/datasets/fountain",
}
# More in the place of the same words.
WORDS_OF = {"stress": {"PLAN": "bench/plans/stress_smoke.json"}}
# What scenes of that name have besides, and what it is a copy of.
PARTS = {"scan": {"cutouts": "masks"}, "plant": {"sparse/0": "colmap_text", "alpha": "masks"}}
SCENES = re.compile(r"(?:\.\./shared/datasets|datasets)/(?!synthetic\b|boards\b)\w+|\b(?:scan|plant|templeRing|room|enlarged)\b")
CUBE_CORNER = """solid corner
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
endsolid corner
"""


def make_scene(program: str, folder: Path) -> Path:
    """The stand-in: 16 views of a chess piece, with masks, plates, exact mesh and cameras in several formats; beside it
    lies a model of it."""
    spec, scene = folder / "stand_in.json", folder / "stand-in"
    spec.write_text(json.dumps(SPEC), encoding="utf-8")
    for words in (["synthesize", spec, "--out", scene],
                  ["reconstruct", scene, "--out", folder / "model", "--resolution", "24"]):
        subprocess.run([program, *words], check=True, capture_output=True)
    return scene


def make_page_folder(folder: Path, source: Path, scene: Path, text: str) -> Path:
    """A folder to run a page's commands in, with all that its text names; what is there may be written to."""
    project = folder / "project"
    for name in ("bench/plans", "bench/specs", "datasets/synthetic", "datasets/boards"):
        shutil.copytree(source / name, project / name)
    for name in {"scene", *SCENES.findall(text)}:
        shutil.copytree(scene, (project / name).resolve())
        for part, original in PARTS.get(name, {}).items():
            shutil.copytree(scene / original, project / name / part)
    plans = "".join(path.read_text(encoding="utf-8") for path in (project / "bench/plans").glob("*.json"))
    shared = (project / "../shared/datasets").resolve()
    shared.mkdir(parents=True, exist_ok=True)
    for name in set(re.findall(r"shared/datasets/(\w+)", plans)):
        if not (shared / name).exists():
            (shared / name).symlink_to(scene)
    (project / "bench/results").mkdir()
    shutil.copytree(scene / "plates", project / "plates")
    shutil.copy(scene / "plates/0000.png", project / "empty.png")
    shutil.copy(scene.parent / "model/mesh.ply", project)
    (project / "cad.stl").write_text(CUBE_CORNER, encoding="utf-8")
    shutil.copy(scene.parent / "stand_in.json", project / "folds.json")
    return project
