"""Meshes for other packages, which are needed only by the function that is called."""
from __future__ import annotations

import numpy as np


def srgb(linear):
    """8-bit sRGB of linear light, of any shape (IEC 61966-2-1).

    >>> photohull.convert.srgb(np.array([0.0, 0.2140, 1.0]))
    array([  0, 127, 255], dtype=uint8)
    """
    light = np.clip(np.asarray(linear, dtype=np.float64), 0, 1)
    coded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return np.round(255 * coded).astype(np.uint8)


def to_trimesh(mesh):
    """A ``trimesh.Trimesh`` with the same vertices, normals and, as sRGB, colours. Needs trimesh."""
    import trimesh

    colours = None if mesh.colours is None else srgb(mesh.colours)
    return trimesh.Trimesh(vertices=mesh.vertices, faces=mesh.faces, vertex_normals=mesh.normals,
                           vertex_colors=colours, process=False)


def to_open3d(mesh):
    """An ``open3d.geometry.TriangleMesh`` with the same vertices, normals and, as sRGB, colours. Needs Open3D."""
    import open3d

    # Open3D takes only writable arrays; it copies them.
    out = open3d.geometry.TriangleMesh(open3d.utility.Vector3dVector(mesh.vertices.astype(np.float64)),
                                       open3d.utility.Vector3iVector(mesh.faces.astype(np.int32)))
    if mesh.normals is not None:
        out.vertex_normals = open3d.utility.Vector3dVector(mesh.normals.astype(np.float64))
    if mesh.colours is not None:
        out.vertex_colors = open3d.utility.Vector3dVector(srgb(mesh.colours) / 255)
    return out
