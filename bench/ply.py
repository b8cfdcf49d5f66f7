"""Vertices and triangles of binary little-endian PLY files."""
from pathlib import Path

import numpy as np

KINDS = {"float": "<f4", "float32": "<f4", "double": "<f8", "float64": "<f8", "uchar": "u1", "uint8": "u1",
         "short": "<i2", "int16": "<i2", "ushort": "<u2", "uint16": "<u2", "int": "<i4", "int32": "<i4",
         "uint": "<u4", "uint32": "<u4"}


def header(file, path: Path) -> tuple[list[tuple[str, str]], dict[str, int]]:
    """The vertices' properties and the elements' counts; the file stands at the first vertex then."""
    fields, counts, element = [], {}, ""
    while True:
        words = file.readline().decode().split()
        if not words:
            raise SystemExit(f"{path}: the header ends early")
        if words[0] == "element":
            element = words[1]
            counts[element] = int(words[2])
        elif words[0] == "property" and element == "vertex":
            fields.append((words[2], KINDS[words[1]]))
        elif words[0] == "end_header":
            return fields, counts


def vertices(path: Path) -> np.ndarray:
    """The vertices, which come first in the file, as a structured array of all their properties."""
    with open(path, "rb") as file:
        fields, counts = header(file, path)
        return np.fromfile(file, dtype=fields, count=counts["vertex"])


def triangles(path: Path) -> np.ndarray:
    """n x 3 indices of the vertices, of a file whose faces come next, are triangles and have nothing but
    their vertices, as photohull writes them."""
    with open(path, "rb") as file:
        fields, counts = header(file, path)
        np.fromfile(file, dtype=fields, count=counts["vertex"])
        faces = np.fromfile(file, dtype=[("count", "u1"), ("corners", "<i4", 3)], count=counts["face"])
    if np.any(faces["count"] != 3):
        raise SystemExit(f"{path}: not all faces are triangles")
    return faces["corners"]


def open_edges(path: Path) -> int:
    """Edges that do not have one triangle on either side, running against each other: 0 of a closed surface."""
    corners = triangles(path).astype(np.int64)
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    size = int(edges.max()) + 1
    forth, times = np.unique(edges[:, 0] * size + edges[:, 1], return_counts=True)
    back = np.unique(edges[:, 1] * size + edges[:, 0])
    return int(np.sum(times > 1) + len(np.setxor1d(forth, back, assume_unique=True)))


def positions(vertex: np.ndarray) -> np.ndarray:
    """n x 3 coordinates in double precision."""
    return np.stack([vertex[axis] for axis in "xyz"], 1).astype(float)


def write_mesh(path: Path, places: np.ndarray, corners: np.ndarray) -> None:
    """Binary little-endian, nothing but vertices and triangles."""
    faces = np.empty(len(corners), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, corners
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(places)}\nproperty float x\nproperty float y\n"
                   f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n".encode())
        file.write(places.astype("<f4").tobytes())
        file.write(faces.tobytes())
