#!/usr/bin/python3
"""How far results of other devices are from the default device's.

    bench/devices.py build/release/photohull [NAME=VALUE[,NAME=VALUE...] ...]

A synthetic scene is reconstructed by hull, space carving and refinement on the default device and with each set of environment
variables, for example LP_NATIVE_VECTOR_WIDTH=128 (llvmpipe with vectors half as wide) or
LIBGL_ALWAYS_SOFTWARE=1,MESA_LOADER_DRIVER_OVERRIDE=zink (OpenGL on Vulkan). Prints whether mesh.ply has the same bytes, its F-score
at 0.25 % of the diagonal against the truth, and the distances of its surface from the default device's, in voxels.
"""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

SPEC = {
    "geometry": {"shape": "folds", "parameters": {"count": 5, "depth": 0.25, "lean": 0.3}},
    "image": {"width": 256, "height": 256, "samples": 2, "maps": False},
    "truth_samples": 40000,
    "cameras": {"fill": 0.92, "rings": [{"count": 8, "elevation": -15}, {"count": 8, "elevation": 20, "phase": 0.5},
                                        {"count": 8, "elevation": 55}]},
}
METHODS = ("hull", "space-carving", "refine")


def run(program, *arguments, environment=""):
    pairs = dict(pair.split("=", 1) for pair in environment.split(",") if pair)
    done = subprocess.run([program, *map(str, arguments)], env=os.environ | pairs, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, check=False)
    if done.returncode not in (0, 3):  # 3: reconstructed, and judged as failed
        raise RuntimeError(done.stderr.decode().strip().splitlines()[-1])
    return done.stdout


def compare(program, scene, method, folder, device):
    """A row's figures: the device's name, same bytes, F-score, distances in voxels."""
    out, first = folder / device.replace("/", "_") / method, folder / method / "mesh.ply"
    out = out if device else folder / method
    report = json.loads(run(program, "reconstruct", scene, "--out", out, "--resolution", 80, "--method", method, "--json",
                            environment=device))
    mesh = out / "mesh.ply"
    score = json.loads(run(program, "evaluate", mesh, "--truth", scene, "--json"))
    apart = json.loads(run(program, "evaluate", mesh, "--truth", first, "--json"))["recon_to_gt"]
    same = mesh.read_bytes() == first.read_bytes()
    f025 = next(f["f"] for f in score["f"] if f["t"] == 0.0025)
    far = [0 if same else apart[name] / report["grid"]["voxel_size"] for name in ("mean", "q95", "max")]
    return [report["device"], "yes" if same else "no", f"{100 * f025:.2f}", *(f"{d:.2g}" for d in far)]


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    program, devices = sys.argv[1], ["", *sys.argv[2:]]
    print("| method | environment | device | same bytes | F 0.25 % | mean, voxels | 95 % | greatest |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        spec, scene = folder / "spec.json", folder / "scene"
        spec.write_text(json.dumps(SPEC))
        run(program, "synthesize", spec, "--out", scene)
        for method in METHODS:
            for device in devices:
                try:
                    figures = compare(program, scene, method, folder, device)
                except RuntimeError as error:
                    figures = [f"error: {error}"]
                print("| " + " | ".join([method, device or "as it is", *figures]) + " |", flush=True)


if __name__ == "__main__":
    main()
