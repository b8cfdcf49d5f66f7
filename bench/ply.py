"""Vertices of binary little-endian PLY files."""
from pathlib import Path

import numpy as np

KINDS = {"float": "<f4", "float32": "<f4", "double": "<f8", "float64": "<f8", "uchar": "u1", "uint8": "u1",
         "short": "<i2", "int16": "<i2", "ushort": "<u2", "uint16": "<u2", "int": "<i4", "int32": "<i4",
         "uint": "<u4", "uint32": "<u4"}


def vertices(path: Path) -> np.ndarray:
    """The vertices, which come first in the file, as a structured array of all their properties."""
    with open(path, "rb") as file:
        fields, count, element = [], 0, ""
        while True:
            words = file.readline().decode().split()
            if not words:
                raise SystemExit(f"{path}: the header ends early")
            if words[0] == "element":
                element = words[1]
                count = int(words[2]) if element == "vertex" else count
            elif words[0] == "property" and element == "vertex":
                fields.append((words[2], KINDS[words[1]]))
            elif words[0] == "end_header":
                return np.fromfile(file, dtype=fields, count=count)


def positions(vertex: np.ndarray) -> np.ndarray:
    """n x 3 coordinates in double precision."""
    return np.stack([vertex[axis] for axis in "xyz"], 1).astype(float)
