"""What the adapter for ROMI has to give, in plain NumPy: the votes of one view, from the formulas."""
import numpy as np


def project_back(values, origin, voxel_size, kind, camera, mask, log=False):
    """Changes `values`: "carving" of int32, or "averaging" of float32."""
    (fx, fy, cx, cy), rotation, translation = camera
    x, y, z = (origin[axis] + np.arange(values.shape[axis]) * voxel_size for axis in range(3))
    x, y, z = np.meshgrid(x, y, z, indexing="ij", sparse=True)
    p = [row[0] * x + row[1] * y + row[2] * z + t for row, t in zip(np.asarray(rotation), translation)]
    before = p[2] > 0
    depth = np.where(before, p[2], 1)
    column, row = np.trunc(p[0] / depth * fx + cx), np.trunc(p[1] / depth * fy + cy)
    height, width = mask.shape
    seen = before & (column >= 0) & (column <= width - 1) & (row >= 0) & (row <= height - 1)
    if kind == "averaging":
        light = mask / 255 if mask.dtype == np.uint8 else mask
        light = (np.log(1e-10 + light) if log else light).astype(np.float32)
        values[seen] += light[row[seen].astype(int), column[seen].astype(int)]
        return
    object_ = np.zeros(values.shape, bool)
    object_[seen] = mask.astype(np.int32)[row[seen].astype(int), column[seen].astype(int)] != 0
    values[seen & ~object_] = -1
    values[seen & object_ & (values == 0)] = 1
