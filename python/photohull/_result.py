"""Results: what reconstruct() returns."""
from __future__ import annotations

import numpy as np

from . import _core


class Mesh:
    """Triangles, counter-clockwise seen from outside. Arrays that it gives cannot be written to.

    ``positions``, ``faces``, ``normals``, ``colours`` and ``confidence`` are views of the library's
    own memory, which lives as long as any of them.
    """

    def __init__(self, core):
        self._core = core
        self._vertices = None

    def __repr__(self):
        return repr(self._core)

    @property
    def vertices(self):
        """(n, 3) float64, world units. Computed once: ``origin + positions``."""
        if self._vertices is None:
            self._vertices = self._core.world_vertices()
            self._vertices.flags.writeable = False
        return self._vertices

    @property
    def positions(self):
        """(n, 3) float32, world units, relative to ``origin``; a view."""
        return self._core.positions

    @property
    def origin(self):
        """(3,) float64, world units: what ``positions`` are relative to."""
        return self._core.origin

    @property
    def faces(self):
        """(m, 3) uint32, indices of vertices; a view."""
        return self._core.faces

    @property
    def normals(self):
        """(n, 3) float32, unit length, outward; a view."""
        return self._core.normals

    @property
    def colours(self):
        """(n, 3) float32, linear RGB; a view. :func:`photohull.convert.srgb` gives 8-bit sRGB."""
        return self._core.colours

    @property
    def confidence(self):
        """(n,) float32: the chance that a vertex lies within a voxel of the truth; 0 where no camera sees it; a view."""
        return self._core.confidence


class Volume:
    """A truncated signed distance on a lattice of cubic voxels.

    Distances are in voxels, negative inside, and clamped to 3 voxels either way. They are stored
    for bricks of 8 x 8 x 8 voxels near the surface. The voxel (i, j, k) has its centre at
    ``origin + voxel_size * (i, j, k)``.
    """

    def __init__(self, core):
        self._core = core

    def __repr__(self):
        return repr(self._core)

    @property
    def shape(self):
        """Voxels along x, y and z."""
        return self._core.shape

    @property
    def origin(self):
        """(3,) float64, world units: the centre of the voxel (0, 0, 0)."""
        return self._core.origin

    @property
    def voxel_size(self):
        """World units."""
        return self._core.voxel_size

    @property
    def inside_voxels(self):
        """How many voxels have a negative distance."""
        return self._core.inside_voxels

    @property
    def bricks(self):
        """(b, 3) int32: brick (x, y, z) begins at the voxel 8 * (x, y, z); a view."""
        return self._core.bricks

    @property
    def distances(self):
        """(b, 8, 8, 8) float32, of each brick, indexed [x, y, z]; a view."""
        return self._core.distances

    def dense(self):
        """A new float32 array of all voxels' distances, indexed [x, y, z]; 4 bytes a voxel."""
        return self._core.dense()

    def occupancy(self):
        """A new bool array of all voxels: is its centre inside?"""
        return self.dense() < 0

    def save_vdb(self, path):
        """Writes an OpenVDB file with surface, colours (Cd) and confidence, as ``volume.vdb`` has them."""
        self._core.save_vdb(path)


class Result:
    """What a reconstruction made. ``verdict`` says whether it can be trusted, ``reasons`` why not."""

    def __init__(self, core):
        self._core = core
        self._mesh = None

    def __repr__(self):
        return repr(self._core)

    @property
    def mesh(self):
        """The surface, a :class:`Mesh`."""
        if self._mesh is None:
            self._mesh = Mesh(self._core.mesh)
        return self._mesh

    @property
    def volume(self):
        """The :class:`Volume` that the mesh is the zero level of."""
        return Volume(self._core.volume)

    @property
    def report(self):
        """A dictionary, as in ``report.json`` (docs/reference/report.md)."""
        return self._core.report

    @property
    def verdict(self):
        """"good", "doubtful" or "failed"."""
        return self._core.verdict

    @property
    def reasons(self):
        """Sentences: what is wrong and what to do; empty when the verdict is good."""
        return self._core.reasons

    @property
    def up(self):
        """(3,) float64: the axis of the world that is upward in most photographs."""
        return self._core.up

    @property
    def preview(self):
        """(height, width, 3) uint8, sRGB: the model beside a photograph; a view."""
        return self._core.preview

    def measure(self, **options):
        """Volume, surface area, height, boxes, convex hull and cross-sections, as :func:`photohull.measure` tells."""
        return _core.measure(self._core, options)

    def write(self, folder, *, progress=None):
        """Writes the files of ``photohull reconstruct`` into a folder; returns their names."""
        return self._core._write(folder, progress)
