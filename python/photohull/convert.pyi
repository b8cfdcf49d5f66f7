from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import Mesh

def srgb(linear: ArrayLike) -> NDArray[np.uint8]: ...
def to_trimesh(mesh: Mesh) -> Any: ...
def to_open3d(mesh: Mesh) -> Any: ...
