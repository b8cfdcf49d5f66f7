"""Masks projected back onto a dense volume, with the interface of plant-3d-vision's ``cl.Backprojection``.

    from photohull.romi import Backprojection    # in place of: from plant3dvision.cl import Backprojection

It needs neither OpenCL nor a graphics card. The meaning is theirs: the voxel (i, j, k) has its
centre at ``origin + voxel_size * (i, j, k)``; its pixel is ``K (R x + t)`` with fractions cut off
(towards zero); voxels behind the camera or off the image are not touched by a view. Projections are
in double precision, where theirs are in single: a voxel whose projection falls between two pixels to
a millionth may get the other one.
"""
from __future__ import annotations

import numpy as np

from . import _core
from ._errors import UsageError

EPS = 1e-10  # added to a mask's values before their logarithm, as plant-3d-vision does


class Backprojection:
    """Votes of masks for the voxels of a volume.

    shape          voxels along x, y and z
    origin         world position of the centre of the voxel (0, 0, 0)
    voxel_size     world units
    type           "carving": values are int32, -1 where a view shows background, 1 where views show
                   only the object, ``default_value`` where no view looks. "averaging": values are
                   float32, the sum of the masks' values, from 0 to 1 each
    default_value  of all voxels at first
    labels         of :meth:`process_fileset`: channels to process, one after the other; or None
    log            "averaging": sum the logarithms of the masks' values

    >>> volume = Backprojection((4, 4, 4), (-1.5, -1.5, -1.5), 1.0)
    >>> mask = np.zeros((9, 9), dtype=np.uint8); mask[3:6, 3:6] = 255
    >>> volume.process_view([9, 9, 4.5, 4.5], np.eye(3), [0, 0, 9], mask)
    >>> int((volume.values() == 1).sum()), int((volume.values() == -1).sum())
    (40, 24)
    """

    def __init__(self, shape, origin, voxel_size, type="carving", default_value=0, labels=None, log=False):
        if type not in ("carving", "averaging"):
            raise UsageError(f"type={type!r}: expected one of carving, averaging")
        self.shape = tuple(shape)
        self.origin = origin
        self.voxel_size = voxel_size
        self.type = type
        self.default_value = default_value
        self.labels = labels
        self.log = log
        self.dtype = np.int32 if type == "carving" else np.float32
        self._projector = _core.BackProjector(shape, origin, voxel_size)
        self.clear()

    def clear(self):
        """All voxels have the default value again."""
        self._values = np.full(self.shape, self.default_value, dtype=self.dtype)
        self._projector.clear()

    def process_view(self, intrinsics, rot, tvec, mask):
        """Takes another view.

        intrinsics  [fx, fy, cx, cy] or (3, 3), pixels
        rot         (3, 3) or 9 numbers row by row: from world to camera
        tvec        (3,) or (3, 1): x_camera = rot @ x_world + tvec
        mask        (height, width). "carving": 0 is background, after conversion to whole numbers;
                    "averaging": uint8 from 0 to 255, or numbers from 0 to 1
        """
        mask = np.asarray(mask)
        if mask.ndim != 2 or mask.size == 0:
            raise UsageError(f"mask has the shape {mask.shape}: expected (height, width)")
        if mask.dtype.kind not in "buif":
            raise UsageError(f"mask is of the type {mask.dtype}: expected numbers or bool")
        if not np.isfinite(mask).all():
            raise UsageError("mask holds a value that is not a finite number")
        if self.type == "carving":
            object_ = mask.astype(np.int32) != 0
            self._projector.carve(intrinsics, rot, tvec, np.ascontiguousarray(object_, dtype=np.uint8), self._values)
            return
        if mask.dtype == np.uint8:
            mask = mask / 255
        if self.log:
            mask = np.log(EPS + mask)
        self._projector.add(intrinsics, rot, tvec, np.ascontiguousarray(mask, dtype=np.float32), self._values)

    def values(self):
        """The values of all voxels, in an array of ``shape``; :meth:`process_view` goes on in the same array."""
        return self._values

    def process_fileset(self, fs, use_colmap_poses=False, invert=False, read_image=None):
        """Takes all views of a plantdb fileset; with ``labels``, values have an axis more in front, one entry a label.

        read_image  gives the mask of a file; by default ``plantdb.io.read_image``
        """
        if self.labels is None:
            return self.process_label(fs, None, use_colmap_poses, invert, read_image)
        return np.stack([self.process_label(fs, label, use_colmap_poses, invert, read_image) for label in self.labels])

    def process_label(self, fs, label=None, use_colmap_poses=False, invert=False, read_image=None):
        """The same for one label: files whose metadata ``channel`` is another one are passed over."""
        if read_image is None:
            from plantdb.io import read_image
        self.clear()
        for file in fs.get_files():
            if label is not None and file.get_metadata("channel") != label:
                continue
            camera = file.get_metadata("colmap_camera" if use_colmap_poses else "camera")
            if camera is None:
                continue
            mask = read_image(file)
            if invert:
                mask = 255 - mask if mask.dtype == np.uint8 else 1.0 - mask
            self.process_view(camera["camera_model"]["params"][:4], camera["rotmat"], camera["tvec"], mask)
        return self.values()
