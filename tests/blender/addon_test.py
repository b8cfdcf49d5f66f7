#!/usr/bin/env python3
"""The add-on in Blender: addon_test.py PROGRAM BLENDER ADDON [FOLDER]

Renders stairs, which no turn or mirror maps to themselves, by cameras that are rolled, of two focal lengths and with
principal points off the middle; reconstructs them; and has Blender import the result (in_blender.py, which checks what it
finds). FOLDER keeps what is made."""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

SPEC = {
    "name": "stairs",
    "geometry": {"shape": "steps"},
    "image": {"width": 320, "height": 240, "samples": 1, "maps": False},
    "cameras": {"count": 16, "distances": [1, 1.6], "focals": [1, 0.7], "roll": 20, "fill": 0.9, "principal_offset": [11, -7]},
    "truth_samples": 1000,
}


# Debian's Blender takes its Python library from the first python3 of PATH, which need not be the one that has NumPy.
SYSTEM = os.environ | {"PATH": "/usr/bin:/bin"}


def run(*words, env=None) -> None:
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=500, check=False, env=env)
    if done.returncode not in (0, 3):
        sys.exit(f"{words[0]} {words[1]} failed ({done.returncode}):\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
    print(done.stdout.strip()[-1500:])


def in_blender(blender: str, *words) -> None:
    inside = Path(__file__).with_name("in_blender.py")
    run(blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python", inside, "--", *words, env=SYSTEM)


def check(program: str, blender: str, addon: str, folder: Path) -> None:
    (folder / "stairs.json").write_text(json.dumps(SPEC), encoding="utf-8")
    run(program, "synthesize", folder / "stairs.json", "--out", folder / "stairs")
    # With a texture and a unit, and without either.
    run(program, "reconstruct", folder / "stairs", "--out", folder / "textured", "--resolution", "64",
        "--export", "glb", "--unit", "cm", "--texture", "512")
    run(program, "reconstruct", folder / "stairs", "--out", folder / "plain", "--resolution", "32", "--method", "hull")
    for result in ("textured", "plain"):
        in_blender(blender, addon, folder / result, folder / f"{result}.png")


def main() -> None:
    program, blender, addon = sys.argv[1:4]
    if len(sys.argv) > 4:
        check(program, blender, addon, Path(sys.argv[4]).resolve())
        return
    with tempfile.TemporaryDirectory() as folder:
        check(program, blender, addon, Path(folder))


if __name__ == "__main__":
    main()
