"""What 'photohull bench visibility' measured, as Markdown tables in the papers' structure: a method a table, whose names
bench/pages/visibility.json uses."""
from collections.abc import Callable, Iterable
from operator import itemgetter

from bench.tables import markdown

PIXELS = 800 * 600  # of the pictures in [BarrosoCeles07], to which receivers are scaled
SHOWN = 1024
ASSEMBLY = "assembly_250k"


def mean(found: list[dict], value: Callable[[dict], float]) -> float:
    return sum(map(value, found)) / len(found)


def total(cell: dict) -> float:
    return cell["false_occlusion_percent"] + cell["false_visibility_percent"]


def both(cell: dict) -> str:
    return f"{cell['false_occlusion_percent']:.2f} + {cell['false_visibility_percent']:.2f}"


class Results:
    def __init__(self, data: dict):
        self.data = data
        self.scenes = {s["name"]: s for s in data["scenes"]}
        self.cells = {(c["scene"], c["technique"], c["resolution"]): c for c in data["cells"]}
        self.techniques = list(dict.fromkeys(c["technique"] for c in data["cells"]))
        self.resolutions = sorted({c["resolution"] for c in data["cells"]})

    def errors(self) -> str:
        """Falsely hidden + falsely visible, % (silhouette, texels)."""
        def cell(scene: str, technique: str) -> str:
            found = self.cells.get((scene, technique, SHOWN))
            return f"{both(found)} ({found['silhouette_texels']:.2f})" if found else "-"
        return markdown(["technique", *self.scenes],
                        ([f"`{t}`", *(cell(scene, t) for scene in self.scenes)] for t in self.techniques))

    def means(self) -> str:
        """Total error in %, map ms + test ms, MiB."""
        def cell(technique: str, resolution: int) -> str:
            found = [c for (_, t, r), c in self.cells.items() if (t, r) == (technique, resolution)]
            if not found:
                return "-"
            return (f"{mean(found, total):.3f}; {mean(found, itemgetter('map_ms')):.0f} + "
                    f"{mean(found, itemgetter('test_ms')):.1f}; {mean(found, itemgetter('bytes')) / 2**20:.0f}")
        return markdown(["technique", *self.resolutions],
                        ([f"`{t}`", *(cell(t, r) for r in self.resolutions)] for t in self.techniques))

    def biases(self) -> str:
        widths = sorted({b["bias_texels"] for b in self.data["biases"]})
        found = {(b["scene"], b["bias_texels"]): b for b in self.data["biases"]}
        return markdown(["texels of bias", *(f"{w:g}" for w in widths)],
                        ([scene, *(both(found[scene, w]) for w in widths)] for scene in self.scenes))

    def angles(self) -> str:
        degrees = sorted({a["degrees"] for a in self.data["angles"]})
        found = {(a["technique"], a["degrees"]): a for a in self.data["angles"]}
        return markdown(["map", *(f"{d:g}" for d in degrees)],
                        ([f"`{t}`", *(f"{total(found[t, d]):.2f} ({found[t, d]['silhouette_texels']:.2f})"
                                      for d in degrees)]
                         for t in dict.fromkeys(a["technique"] for a in self.data["angles"])))

    def detection(self) -> str:
        """Triangles seen in a texel, and the share of them that maps know."""
        found = {(d["scene"], d["resolution"], d["technique"]): d for d in self.data["detection"]}
        places = [(s, r) for s in self.scenes for r in self.resolutions if (s, r, "lists") in found]
        return markdown(["scene", "texels", "triangles", "sub-pixel", "coverage", "lists"],
                        ([s, r, f"{found[s, r, 'lists']['triangles_per_texel']:.2f}",
                          *(f"{found[s, r, t]['found_percent']:.1f}" for t in ("sub-pixel", "coverage", "lists"))]
                         for s, r in places))

    def volumes(self) -> str:
        return markdown(["way", *self.resolutions],
                        ([way, *(f"{v['map_ms']:.0f}; {both(v)}" for v in self.data["volumes"] if v["way"] == way)]
                         for way in ("faces", "march")))

    def ms(self, scene: str, technique: str, resolution: int) -> float:
        cell = self.cells[scene, technique, resolution]
        return cell["map_ms"] + cell["test_ms"]

    def li17_resolutions(self) -> str:
        paper = {512: (16.9, 25.7), 1024: (32.8, 42.8), 2048: (34.4, 44.1), 4096: (67.3, 78.4)}
        rows = []
        for r, (plain_ms, theirs) in paper.items():
            plain, ours, lists = (self.ms("dense", t, r) for t in ("plain", "coverage", "lists"))
            rows.append([r, f"{plain:.0f}", f"{ours:.0f}", *(f"{100 * (ms / plain - 1):.0f} %" for ms in (ours, lists)),
                         f"{plain_ms}, {theirs}: {100 * (theirs / plain_ms - 1):.0f} %"])
        return markdown(["map", "plain", "coverage", "increase", "increase of `lists`", "paper"], rows)

    def li17_models(self) -> str:
        paper = {"dense": "Dragon: 32.8 34.4, 42.5 43.6, 42.8 44.1",
                 "wires": "Butterfly: 15.7 17.1, 24.6 26.3, 25.4 27.3",
                 "leaves": "Tree: 11.1 16.9, 16.9 18.5, 17.2 18.9", "ball": "Ball: 7.6 9.4, 10.7 12.6, 10.9 13.3"}
        columns = {"plain": "plain", "SPSM": "sub-pixel", "coverage": "coverage", "lists": "lists"}
        return markdown(["model", "vertices", "polygons", *(f"{t} {r}" for t in columns for r in (1024, 2048)),
                         "paper: SM, SPSM, theirs"],
                        ([scene, self.scenes[scene]["vertices"], self.scenes[scene]["triangles"],
                          *(f"{self.ms(scene, t, r):.0f}" for t in columns.values() for r in (1024, 2048)), theirs]
                         for scene, theirs in paper.items()))

    def frames(self, technique: str, lights: int, dynamic: bool, close: bool) -> str:
        """Per second: a pass of the picture, one more a light with its test, and dynamic lights' maps."""
        view = next(v["ms"] for v in self.data["views"] if v["scene"] == ASSEMBLY and v["close"] == close)
        ms = view
        if lights:
            cell = self.cells[ASSEMBLY, technique, 2048]
            test = cell["test_ms"] * PIXELS / self.scenes[ASSEMBLY]["receivers"]
            ms += lights * (view + test + (cell["map_ms"] if dynamic else 0))
        return f"{1000 / ms:.1f}"

    def frames_of(self, techniques: Iterable[str], lights: int) -> list[str]:
        """With dynamic lights, of the whole scene and of the near view."""
        return [self.frames(t, lights, True, close) for t in techniques for close in (False, True)]

    def celes_plain(self) -> str:
        rows = [("no shadows", 0, False, "60, 300"), ("1 static light", 1, False, "37, 230"),
                ("2 static lights", 2, False, "25, 160"), ("1 dynamic light", 1, True, "22, 45"),
                ("2 dynamic lights", 2, True, "13, 25")]
        return markdown(["plain map", "whole scene", "near view", "paper"],
                        ([n, *(self.frames("plain", l, d, close) for close in (False, True)), p]
                         for n, l, d, p in rows))

    def celes_acne(self) -> str:
        return markdown(["dynamic lights", "constant: whole", "near", "second-depth: whole", "near", "dual-depth: whole",
                         "near", "paper: constant, midpoint"],
                        ([l, *self.frames_of(("plain", "second-depth", "dual-depth"), l), p]
                         for l, p in ((1, "22 45, 16 27"), (2, "13 25, 9 14"))))

    def celes_warps(self) -> str:
        return markdown(["dynamic lights", "ZP_1: whole", "near", "ZP_2: whole", "near", "paper"],
                        ([l, *self.frames_of(("general-lispsm", "zp2"), l), p]
                         for l, p in ((1, "21-22, 44-88; 16-20, 31-66"), (2, "13, 30-49; 9-12, 22-38"))))

    def celes_all(self) -> str:
        return markdown(["dynamic lights", "plain", "recommended", "paper: 8800 GTS", "paper: 6800 GT"],
                        ([l, self.frames("plain", l, True, True), self.frames("recommended", l, True, True), a, b]
                         for l, a, b in ((1, "45, 29-59", "33, 9-12"), (2, "25, 18-30", "18, 5-7"))))

    def celes_filters(self) -> str:
        """In frames a second, and in milliseconds of the test alone."""
        columns = {"PCF 3x3": "pcf3", "adaptive": "pcf3-adaptive", "PCF 5x5": "pcf5", "5x5 adaptive": "pcf5-adaptive",
                   "VSM 3x3": "variance3", "VSM 5x5": "variance"}
        rows = [[n, *(self.frames(t, l, d, True) for t in columns.values()), p]
                for n, l, d, p in (("1 static", 1, False, "84, 84; 194, 194"),
                                   ("2 static", 2, False, "56, 56; 116, 116"),
                                   ("1 dynamic", 1, True, "43, 43; 46, 46"), ("2 dynamic", 2, True, "22, 21; 25, 25"))]
        rows.append(["test, ms", *(f"{self.cells[ASSEMBLY, t, 2048]['test_ms']:.1f}" for t in columns.values()), ""])
        return markdown(["lights", *columns, "paper: adaptive 3x3, 5x5; VSM 3x3, 5x5"], rows)
