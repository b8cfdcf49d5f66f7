#!/usr/bin/python3
"""Share of the object's pixels in highlights, for the axis `gloss` of bench/plans/stress.json.

    bench/highlight_share.py build/release/photohull

Every scene is synthesized with and without gloss, in pictures of 96 x 96 pixels; a pixel is in a highlight where gloss adds at
least half of the light that is there without. Prints the share over all views for each strength of the axis.
"""
import json
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

import numpy as np

PLAN = Path(__file__).resolve().parent / "plans" / "stress.json"


def read_png(path):
    """An 8-bit PNG without palette or interlacing, as height x width x channels."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        chunk = data[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            width, height, _, colour = struct.unpack(">IIBB", chunk[:10])
        if kind == b"IDAT":
            packed += chunk
        at += 12 + size
    n = {0: 1, 2: 3}[colour]
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, width * n + 1)
    out = np.zeros((height + 1, width * n), int)  # row 0 is that above the picture
    for y in range(height):
        kind, row, above, now = rows[y, 0], rows[y, 1:].astype(int), out[y], out[y + 1]
        for x in range(width * n):
            a, b, c = (now[x - n], above[x], above[x - n]) if x >= n else (0, above[x], 0)
            nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            now[x] = (row[x] + (0, a, b, (a + b) // 2, nearest)[kind]) & 255
    return out[1:].reshape(height, width, n)


def linear(codes):
    v = codes / 255.0
    return np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4).mean(axis=2)


def light(program, plan, scene, material):
    """Linear light of all pixels that the object covers."""
    spec = json.loads(json.dumps(plan["spec"]))
    spec.update(scene["spec"])
    spec["image"] = {"width": 96, "height": 96, "samples": 2, "maps": False}
    spec["truth_samples"] = 100
    spec["material"] = material
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "spec.json").write_text(json.dumps(spec))
        subprocess.run([program, "synthesize", folder / "spec.json", "--out", folder / "out"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        pictures = sorted((folder / "out" / "images").glob("*.png"))
        return np.concatenate([linear(read_png(p))[read_png(folder / "out" / "masks" / p.name)[..., 0] > 127]
                               for p in pictures])


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    plan = json.loads(PLAN.read_text())
    axis = next(a for a in plan["axes"] if a["name"] == "gloss")
    for scene in plan["scenes"]:
        if scene.get("on_demand"):
            continue
        plain = light(sys.argv[1], plan, scene, {})
        for point in axis["points"]:
            glossy = light(sys.argv[1], plan, scene, point["spec"]["material"])
            print(f"{scene['name']} {point['strength']}: {(glossy - plain > 0.5 * plain).mean():.3f}")


if __name__ == "__main__":
    main()
