from collections.abc import Callable, Sequence
from typing import Any

from numpy.typing import ArrayLike, NDArray

EPS: float

class Backprojection:
    def __init__(
        self,
        shape: Sequence[int],
        origin: ArrayLike,
        voxel_size: float,
        type: str = "carving",
        default_value: float = 0,
        labels: Sequence[str] | None = None,
        log: bool = False,
    ) -> None: ...
    def clear(self) -> None: ...
    def process_view(self, intrinsics: ArrayLike, rot: ArrayLike, tvec: ArrayLike, mask: ArrayLike) -> None: ...
    def values(self) -> NDArray[Any]: ...
    def process_fileset(
        self, fs: Any, use_colmap_poses: bool = False, invert: bool = False, read_image: Callable[[Any], NDArray[Any]] | None = None
    ) -> NDArray[Any]: ...
    def process_label(
        self,
        fs: Any,
        label: str | None = None,
        use_colmap_poses: bool = False,
        invert: bool = False,
        read_image: Callable[[Any], NDArray[Any]] | None = None,
    ) -> NDArray[Any]: ...
