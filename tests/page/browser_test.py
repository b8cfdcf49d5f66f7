#!/usr/bin/env python3
"""Opens pages of reports in a headless Chromium: browser_test.py WRITE_SAMPLE_PAGE PHOTOHULL SCENE

One page is of a result that nobody made, whose names want to be markup; the other of a small reconstruction of the scene. Of
each: nothing in the console, nothing loaded from elsewhere, the model in the picture, and controls that change it. Ends with 77
where there is no Chromium (CHROMIUM names another program than chromium) or no Pillow (Debian: python3-pil)."""
import functools
import io
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from typing import ClassVar

from browser import Page


NOT_RUN = 77
try:
    from PIL import Image, ImageChops
except ImportError:
    print("not run: it needs Pillow (Debian: python3-pil)")
    sys.exit(NOT_RUN)

WINDOW = (480, 640)  # pixels
SOON = 15  # seconds
WRITE_SAMPLE, PHOTOHULL, SCENE = sys.argv[1:4] if len(sys.argv) == 4 else ("", "", "")
CHROMIUM = shutil.which(os.environ.get("CHROMIUM", "chromium"))


def difference(one: Image.Image, other: Image.Image) -> float:
    """Share of the pixels that differ clearly."""
    assert one.size == other.size
    most = functools.reduce(ImageChops.lighter, ImageChops.difference(one, other).split())  # of the three channels
    return sum(most.histogram()[25:]) / (one.width * one.height)


class PageCase(unittest.TestCase):
    page: ClassVar[Page]
    path: ClassVar[Path]
    folder: ClassVar[tempfile.TemporaryDirectory]
    seconds: ClassVar[float]

    @classmethod
    def write(cls, folder: Path) -> Path:
        raise NotImplementedError

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = tempfile.TemporaryDirectory(prefix="photohull_page_")
        cls.path = cls.write(Path(cls.folder.name))
        cls.page = Page(CHROMIUM)
        cls.page.size(*WINDOW)
        cls.page.prefers(still=True)
        cls.seconds = cls.page.load(cls.path)
        print(f"{cls.__name__}: {cls.path.stat().st_size / 1e6:.2f} MB, ready after {cls.seconds:.2f} s")

    @classmethod
    def tearDownClass(cls) -> None:
        cls.page.close()
        cls.folder.cleanup()

    def tearDown(self) -> None:
        self.assertEqual(self.page.errors, [])

    def picture(self) -> Image.Image:
        self.page.settle()
        return Image.open(io.BytesIO(self.page.screenshot("#viewport"))).convert("RGB")

    def click(self, selector: str) -> None:
        self.page.evaluate(f"document.querySelector('{selector}').click()")

    def text(self, selector: str) -> str:
        return self.page.evaluate(f"document.querySelector('{selector}').textContent")

    def check_basics(self, first: str = "colour") -> None:
        """The model is in the picture, and each switch changes it."""
        self.click("#cameras")  # off
        self.page.evaluate("document.getElementById('canvas').style.visibility = 'hidden'")
        empty = self.picture()
        self.page.evaluate("document.getElementById('canvas').style.visibility = ''")
        shown = [self.picture()]
        self.assertGreater(difference(shown[0], empty), 0.05)
        for layer in ("clay", "confidence", "views", "disagreement"):
            self.click(f"#layer-{layer}")
            shown.append(self.picture())
            for before in shown[:-1]:
                self.assertGreater(difference(shown[-1], before), 0.02, layer)
        self.assertIn("differ", self.text("#legend"))
        self.click(f"#layer-{first}")
        self.assertLess(difference(self.picture(), shown[0]), 0.001)
        self.click("#cameras")  # on
        self.assertGreater(difference(self.picture(), shown[0]), 0.002)

    def check_keys(self) -> None:
        """The keyboard alone turns the model, flies to cameras and comes back."""
        self.page.prefers(still=False)
        self.addCleanup(self.page.prefers, still=True)
        self.page.evaluate("document.getElementById('canvas').focus()")
        self.page.press("Home")
        start = self.picture()
        self.page.press("ArrowLeft")
        self.assertGreater(difference(self.picture(), start), 0.01)
        self.page.press("Home")
        self.assertLess(difference(self.picture(), start), 0.001)
        self.page.press("PageDown")
        self.page.settle()
        self.assertEqual(self.page.evaluate("document.getElementById('camera').value"), "0")
        self.assertFalse(self.page.evaluate("document.getElementById('photograph').hidden"))
        self.page.press("Home")
        self.assertLess(difference(self.picture(), start), 0.001)
        self.page.press("PageUp")
        self.page.settle()
        self.assertNotEqual(self.page.evaluate("document.getElementById('camera').value"), "-1")
        self.page.press("Escape")
        self.page.settle()
        self.assertEqual(self.page.evaluate("document.getElementById('camera').value"), "-1")
        self.assertTrue(self.page.evaluate("document.getElementById('photograph').hidden"))

    def check_loads_nothing(self) -> None:
        own = self.path.absolute().as_uri()
        others = [url for url in self.page.requests
                  if url not in (own, "about:blank") and not url.startswith(("data:", "blob:"))]
        self.assertEqual(others, [])


class SamplePage(PageCase):
    @classmethod
    def write(cls, folder: Path) -> Path:
        path = folder / "report.html"
        subprocess.run([WRITE_SAMPLE, str(path)], check=True)
        return path

    def test_model_and_switches(self) -> None:
        self.check_basics()

    def test_keys(self) -> None:
        self.check_keys()

    def test_names_stay_text(self) -> None:
        self.assertEqual(self.page.evaluate("document.querySelectorAll('script').length"), 5)
        self.assertEqual(self.page.evaluate("document.querySelectorAll('img[src=x]').length"), 0)
        self.assertIn("<img src=x onerror=alert(2)>", self.text("#details"))
        self.assertIn("view2a</script><script>alert(1)</script>", self.text("#details"))
        self.check_loads_nothing()

    def test_worst_view_comes_first(self) -> None:
        self.assertEqual(self.text(".rank tbody tr .link"), "view4.jpg")
        self.assertEqual(self.text(".rank td.beyond"), "70 %")

    def test_reason_leads_to_its_view_and_to_its_place(self) -> None:
        self.click(".reasons li .link")
        self.page.settle()
        self.assertEqual(self.page.evaluate("document.getElementById('camera').value"), "2")
        self.click(".reasons li:nth-child(2) .link")
        self.assertTrue(self.page.evaluate("document.getElementById('layer-views').checked"))
        self.click("#layer-colour")
        self.page.evaluate("document.getElementById('camera').value = '-1'")
        self.page.evaluate("document.getElementById('camera').dispatchEvent(new Event('change'))")

    def test_blends_the_photograph_over_the_model(self) -> None:
        """The camera's own picture of the model lies below its photograph, which is of one grey."""
        self.click("#strip button:nth-child(6)")
        for opacity, covered in ((100, True), (0, False)):
            self.page.evaluate(f"document.getElementById('opacity').value = {opacity}")
            self.page.evaluate("document.getElementById('opacity').dispatchEvent(new Event('input'))")
            picture = self.picture()
            middle = picture.getpixel((picture.width // 2, picture.height // 2))
            grey = max(abs(value - 190) for value in middle) < 6
            self.assertEqual(grey, covered, middle)
        self.click("#strip button:nth-child(6)")

    def test_fits_narrow_windows(self) -> None:
        self.page.size(360, 740, 2, touch=True)
        try:
            self.page.settle()
            self.assertLessEqual(self.page.evaluate("document.documentElement.scrollWidth"), 360)
        finally:
            self.page.size(*WINDOW)

    def test_controls_have_names(self) -> None:
        unnamed = self.page.evaluate(
            "[...document.querySelectorAll('button, select, input')].filter(e => !(e.textContent.trim() || e.ariaLabel || "
            "e.labels?.[0]?.textContent.trim())).map(e => e.outerHTML)")
        self.assertEqual(unnamed, [])


class LargePage(PageCase):
    """As many triangles as a page may have, with a texture."""

    @classmethod
    def write(cls, folder: Path) -> Path:
        path = folder / "report.html"
        subprocess.run([WRITE_SAMPLE, str(path), "316"], check=True)
        return path

    def test_shows_the_texture(self) -> None:
        """Its red and green squares, which no vertex has."""
        self.click("#cameras")
        pixels = list(self.picture().getdata())
        self.click("#cameras")
        for red, green in ((220, 40), (30, 200)):
            share = sum(1 for p in pixels if abs(p[0] - red) < 16 and abs(p[1] - green) < 16) / len(pixels)
            self.assertGreater(share, 0.02, (red, green))
        self.assertEqual(self.page.evaluate("document.querySelectorAll('#layers input').length"), 5)

    def test_model_and_switches(self) -> None:
        self.check_basics("texture")

    def test_opens_soon(self) -> None:
        """Two seconds where nothing else runs (docs/guide/report_page.md); machines of tests are busy."""
        self.assertLess(self.seconds, SOON)


class ReconstructionPage(PageCase):
    @classmethod
    def write(cls, folder: Path) -> Path:
        out = folder / "it's <b>"
        subprocess.run([PHOTOHULL, "reconstruct", SCENE, "--out", str(out), "--quality", "draft", "--resolution", "64"],
                       check=True, capture_output=True)
        return out / "report.html"

    def test_model_and_switches(self) -> None:
        self.check_basics()

    def test_keys(self) -> None:
        self.check_keys()

    def test_command_makes_it_again(self) -> None:
        self.assertEqual(shlex.split(self.text("pre code")),
                         ["photohull", "reconstruct", SCENE, "--out", str(self.path.parent), "--quality", "draft", "--resolution", "64"])
        self.check_loads_nothing()


class BatchPage(unittest.TestCase):
    """Of a batch with a name that wants to be markup, and a scene that is not there."""

    def setUp(self) -> None:
        self.folder = tempfile.TemporaryDirectory(prefix="photohull_batch_")
        out = Path(self.folder.name) / "out"
        pieces = Path(self.folder.name) / "list.txt"
        pieces.write_text(f"\"{SCENE}\" --name \"<b>it's 1\"\n\"{SCENE}\" --name second --resolution 40\nnowhere --name lost\n", encoding="utf-8")
        subprocess.run([PHOTOHULL, "batch", "--list", str(pieces), "--out", str(out), "--method", "hull", "--resolution", "48",
                        "--refine-cameras", "off"], check=False, capture_output=True)
        self.page = Page(CHROMIUM)
        self.page.size(1000, 800)
        self.page.load(out / "index.html", "document.querySelectorAll('article').length === 3")

    def tearDown(self) -> None:
        self.page.close()
        self.folder.cleanup()

    def names(self) -> list[str]:
        return self.page.evaluate("[...document.querySelectorAll('article h2')].map(e => e.textContent)")

    def test_shows_all_and_chooses_among_them(self) -> None:
        self.assertEqual(self.names(), ["<b>it's 1", "second", "lost"])
        self.page.wait("[...document.images].every(image => image.complete)")
        self.assertEqual(self.page.evaluate("[...document.images].map(image => image.naturalWidth > 100)"), [True, True])
        self.assertIn("1 no result", self.page.evaluate("document.getElementById('summary').textContent"))
        self.assertEqual(self.page.evaluate("document.querySelectorAll('#timeline a.without').length"), 1)
        self.page.evaluate("document.getElementById('filter-without').click()")
        self.assertEqual(self.names(), ["lost"])
        self.page.evaluate("document.querySelector('#timeline a').click()")  # which is asked for, whatever was chosen
        self.assertEqual(len(self.names()), 3)
        self.page.evaluate("document.getElementById('search').value = 'SEC'")
        self.page.evaluate("document.getElementById('search').dispatchEvent(new Event('input'))")
        self.assertEqual(self.names(), ["second"])
        self.assertEqual(self.page.errors, [])
        link = self.page.evaluate("document.querySelector('article h2 a').href")
        self.assertTrue(link.endswith("/out/second/report.html"), link)
        if picture := os.environ.get("PHOTOHULL_PICTURE"):
            self.page.evaluate("document.getElementById('search').value = ''")
            self.page.evaluate("document.getElementById('search').dispatchEvent(new Event('input'))")
            Path(picture).write_bytes(self.page.screenshot("body"))


if __name__ == "__main__":
    if not CHROMIUM:
        print("There is no chromium here; scripts/test.sh installs it.")
        sys.exit(NOT_RUN)
    unittest.main(argv=sys.argv[:1], verbosity=2)
