"""What 'photohull bench visibility' measured, as Markdown tables in the papers' structure.

    build/release/photohull bench visibility --json bench/results/visibility.json
    python3 -m bench visibility_tables bench/results/visibility.json

Several files, one a scene say, are joined; --merge writes them as one."""
import argparse
import json
from collections.abc import Callable, Iterable, Sequence
from operator import itemgetter
from pathlib import Path

from bench import tables
from bench.runner import listed

PIXELS = 800 * 600  # of the pictures in [BarrosoCeles07], to which receivers are scaled
SHOWN = 1024
TABLES = ("errors", "means", "biases", "angles", "detection", "volumes", "li17", "cad07", "filters")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("results", nargs="+", type=Path, help="visibility.json")
    parser.add_argument("--merge", type=Path, help="file to write the joined results to")
    parser.add_argument("--tables", type=listed, default=",".join(TABLES), help="some of the tables: %(default)s")


def join(files: Iterable[Path]) -> dict:
    joined: dict = {}
    for path in files:
        for key, value in json.loads(path.read_text(encoding="utf-8")).items():
            if isinstance(value, list) and key not in ("angles", "volumes"):
                joined.setdefault(key, []).extend(value)
            else:
                joined.setdefault(key, value)
    return joined


def table(head: Sequence[str], rows: Iterable[Iterable[object]]) -> None:
    print(tables.markdown(head, rows) + "\n")


class Results:
    def __init__(self, data: dict):
        self.data = data
        self.scenes = {s["name"]: s for s in data["scenes"]}
        self.cells = {(c["scene"], c["technique"], c["resolution"]): c for c in data["cells"]}
        self.techniques = list(dict.fromkeys(c["technique"] for c in data["cells"]))
        self.resolutions = sorted({c["resolution"] for c in data["cells"]})

    def total(self, cell: dict) -> float:
        return cell["false_occlusion_percent"] + cell["false_visibility_percent"]

    def errors(self) -> None:
        print(f"### Errors at {SHOWN} texels: falsely hidden + falsely visible, % (silhouette, texels)\n")
        rows = []
        for technique in self.techniques:
            row = [f"`{technique}`"]
            for scene in self.scenes:
                cell = self.cells.get((scene, technique, SHOWN))
                row.append(f"{cell['false_occlusion_percent']:.2f} + {cell['false_visibility_percent']:.2f} "
                           f"({cell['silhouette_texels']:.2f})" if cell else "-")
            rows.append(row)
        table(["technique"] + list(self.scenes), rows)

    def means(self) -> None:
        print("### Mean over the scenes: total error in %, map ms + test ms, MiB\n")
        rows = []
        for technique in self.techniques:
            row = [f"`{technique}`"]
            for resolution in self.resolutions:
                found = [self.cells[s, technique, resolution] for s in self.scenes
                         if (s, technique, resolution) in self.cells]
                if not found:
                    row.append("-")
                    continue

                def mean(value: Callable[[dict], float]) -> float:
                    return sum(map(value, found)) / len(found)
                row.append(f"{mean(self.total):.3f}; {mean(itemgetter('map_ms')):.0f} + "
                           f"{mean(itemgetter('test_ms')):.1f}; {mean(itemgetter('bytes')) / 2**20:.0f}")
            rows.append(row)
        table(["technique"] + [f"{r}" for r in self.resolutions], rows)

    def biases(self) -> None:
        print("### Constant bias: falsely hidden + falsely visible, %, at 1024 texels\n")
        widths = sorted({b["bias_texels"] for b in self.data["biases"]})
        rows = []
        for scene in self.scenes:
            found = {b["bias_texels"]: b for b in self.data["biases"] if b["scene"] == scene}
            rows.append([scene] + [f"{found[w]['false_occlusion_percent']:.2f} + "
                                   f"{found[w]['false_visibility_percent']:.2f}" for w in widths])
        table(["texels of bias"] + [f"{w:g}" for w in widths], rows)

    def angles(self) -> None:
        print("### Total error in % (silhouette, texels) by the angle between the two cameras, 1024 texels\n")
        degrees = sorted({a["degrees"] for a in self.data["angles"]})
        techniques = list(dict.fromkeys(a["technique"] for a in self.data["angles"]))
        found = {(a["technique"], a["degrees"]): a for a in self.data["angles"]}
        table(["map"] + [f"{d:g}" for d in degrees],
              [[f"`{t}`"] + [f"{self.total(found[t, d]):.2f} ({found[t, d]['silhouette_texels']:.2f})"
                             for d in degrees] for t in techniques])

    def detection(self) -> None:
        print("### Triangles seen in a texel, and share of them that maps know, %\n")
        rows = []
        for scene in self.scenes:
            for r in self.resolutions:
                found = {d["technique"]: d for d in self.data["detection"]
                         if d["scene"] == scene and d["resolution"] == r}
                if found:
                    rows.append([scene, r, f"{found['lists']['triangles_per_texel']:.2f}"] +
                                [f"{found[t]['found_percent']:.1f}" for t in ("sub-pixel", "coverage", "lists")])
        table(["scene", "texels", "triangles", "sub-pixel", "coverage", "lists"], rows)

    def volumes(self) -> None:
        print("### A volume of 256^3 voxels: map ms, falsely hidden + falsely visible, %\n")
        table(["way"] + [str(r) for r in self.resolutions],
              [[way] + [f"{v['map_ms']:.0f}; {v['false_occlusion_percent']:.2f} + {v['false_visibility_percent']:.2f}"
                        for v in self.data["volumes"] if v["way"] == way] for way in ("faces", "march")])

    def ms(self, scene: str, technique: str, resolution: int) -> float:
        cell = self.cells[scene, technique, resolution]
        return cell["map_ms"] + cell["test_ms"]

    def li17(self) -> None:
        print("### [Li17] Table 1: ms by resolution, dense mesh (paper: Dragon)\n")
        paper = {512: (16.9, 25.7), 1024: (32.8, 42.8), 2048: (34.4, 44.1), 4096: (67.3, 78.4)}
        rows = []
        for r in self.resolutions:
            if ("dense", "coverage", r) not in self.cells:
                continue
            plain, ours, lists = (self.ms("dense", t, r) for t in ("plain", "coverage", "lists"))
            p = paper[r]
            rows.append([f"{r}", f"{plain:.0f}", f"{ours:.0f}", f"{100 * (ours / plain - 1):.0f} %",
                         f"{100 * (lists / plain - 1):.0f} %",
                         f"{p[0]}, {p[1]}: {100 * (p[1] / p[0] - 1):.0f} %"])
        table(["map", "plain", "coverage", "increase", "increase of `lists`", "paper"], rows)
        print("### [Li17] Table 2: ms by model\n")
        paper = {"dense": "Dragon: 32.8 34.4, 42.5 43.6, 42.8 44.1", "wires": "Butterfly: 15.7 17.1, 24.6 26.3, 25.4 27.3",
                 "leaves": "Tree: 11.1 16.9, 16.9 18.5, 17.2 18.9", "ball": "Ball: 7.6 9.4, 10.7 12.6, 10.9 13.3"}
        rows = []
        for scene, theirs in paper.items():
            if scene in self.scenes:
                s = self.scenes[scene]
                rows.append([scene, s["vertices"], s["triangles"]] +
                            [f"{self.ms(scene, t, r):.0f}" for t in ("plain", "sub-pixel", "coverage", "lists")
                             for r in (1024, 2048)] + [theirs])
        table(["model", "vertices", "polygons"] + [f"{t} {r}" for t in ("plain", "SPSM", "coverage", "lists")
                                                    for r in (1024, 2048)] + ["paper: SM, SPSM, theirs"], rows)

    def frames(self, scene: str, technique: str, lights: int, dynamic: bool, close: bool) -> float:
        """Per second: a pass of the picture, one more a light with its test, and dynamic lights' maps."""
        view = next(v["ms"] for v in self.data["views"] if v["scene"] == scene and v["close"] == close)
        if not lights:
            return 1000 / view
        cell = self.cells[scene, technique, 2048]
        test = cell["test_ms"] * PIXELS / self.scenes[scene]["receivers"]
        return 1000 / (view + lights * (view + test + (cell["map_ms"] if dynamic else 0)))

    def cad07(self, scene: str = "assembly_250k") -> None:
        if scene not in self.scenes:
            return
        f = lambda *a: f"{self.frames(scene, *a):.1f}"
        print(f"### [BarrosoCeles07] Table 2: frames a second, {scene}, maps of 2048\n")
        rows = [("no shadows", 0, False, 60, 300), ("1 static light", 1, False, 37, 230),
                ("2 static lights", 2, False, 25, 160), ("1 dynamic light", 1, True, 22, 45),
                ("2 dynamic lights", 2, True, 13, 25)]
        table(["plain map", "whole scene", "near view", "paper"],
              [[n, f("plain", l, d, False), f("plain", l, d, True), f"{a}, {b}"] for n, l, d, a, b in rows])
        print("### Table 3: against acne\n")
        table(["dynamic lights", "constant: whole", "near", "second-depth: whole", "near", "dual-depth: whole", "near",
               "paper: constant, midpoint"],
              [[l] + [f(t, l, True, c) for t in ("plain", "second-depth", "dual-depth") for c in (False, True)] + [p]
               for l, p in ((1, "22 45, 16 27"), (2, "13 25, 9 14"))])
        print("### Table 5: warp and partitions\n")
        table(["dynamic lights", "ZP_1: whole", "near", "ZP_2: whole", "near", "paper"],
              [[l] + [f(t, l, True, c) for t in ("general-lispsm", "zp2") for c in (False, True)] + [p]
               for l, p in ((1, "21-22, 44-88; 16-20, 31-66"), (2, "13, 30-49; 9-12, 22-38"))])
        print("### Tables 6 and 7: all that is recommended, near view\n")
        table(["dynamic lights", "plain", "recommended", "paper: 8800 GTS", "paper: 6800 GT"],
              [[l, f("plain", l, True, True), f("recommended", l, True, True), a, b]
               for l, a, b in ((1, "45, 29-59", "33, 9-12"), (2, "25, 18-30", "18, 5-7"))])

    def filters(self, scene: str = "assembly_250k") -> None:
        """Table 4, in frames a second and in milliseconds of the test alone."""
        columns = {"PCF 3x3": "pcf3", "adaptive": "pcf3-adaptive", "PCF 5x5": "pcf5", "5x5 adaptive": "pcf5-adaptive",
                   "VSM 3x3": "variance3", "VSM 5x5": "variance"}
        if any((scene, t, 2048) not in self.cells for t in columns.values()):
            return
        print("### Table 4: filters, near view\n")
        rows = [[n] + [f"{self.frames(scene, t, l, d, True):.1f}" for t in columns.values()] + [p]
                for n, l, d, p in (("1 static", 1, False, "84, 84; 194, 194"), ("2 static", 2, False, "56, 56; 116, 116"),
                                   ("1 dynamic", 1, True, "43, 43; 46, 46"), ("2 dynamic", 2, True, "22, 21; 25, 25"))]
        rows.append(["test, ms"] + [f"{self.cells[scene, t, 2048]['test_ms']:.1f}" for t in columns.values()] + [""])
        table(["lights"] + list(columns) + ["paper: adaptive 3x3, 5x5; VSM 3x3, 5x5"], rows)


def run(options: argparse.Namespace) -> None:
    data = join(options.results)
    if options.merge:
        options.merge.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
    results = Results(data)
    for part in options.tables:
        getattr(results, part)()
