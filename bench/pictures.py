"""8-bit pictures of any format, read and written by oiiotool (OpenImageIO)."""
import subprocess
import tempfile
from pathlib import Path

import numpy as np


def read(path: Path) -> np.ndarray:
    """Codes as height x width x channels; one channel of grey pictures, else three."""
    with tempfile.TemporaryDirectory() as name:
        raw = Path(name) / "picture.pnm"
        subprocess.run(["oiiotool", path, "-d", "uint8", "-o", raw], check=True)
        magic, size, _, codes = raw.read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    channels = {b"P5": 1, b"P6": 3}[magic]
    return np.frombuffer(codes, np.uint8, width * height * channels).reshape(height, width, channels)


def write_grey(path: Path, grey: np.ndarray) -> None:
    with tempfile.TemporaryDirectory() as name:
        raw = Path(name) / "picture.pgm"
        raw.write_bytes(b"P5\n%d %d\n255\n" % grey.shape[::-1] + grey.tobytes())
        subprocess.run(["oiiotool", raw, "-d", "uint8", "-o", path], check=True)
