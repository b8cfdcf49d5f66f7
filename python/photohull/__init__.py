"""Space carving on the GPU: calibrated photographs to volumes and meshes.

    import photohull
    result = photohull.reconstruct("datasets/templeSparseRing", resolution=256)
    result.write("out/temple")

Frames and units, of everything here:

* World: right-handed, in the scene's own unit.
* Camera: x right, y down, z forward (as in OpenCV); ``x_camera = R @ x_world + t``.
* Pixels: the centre of the top-left pixel is (0, 0); ``K`` is in pixels.
* Volumes: the voxel (i, j, k) has its centre at ``origin + voxel_size * (i, j, k)``.

Options are keyword arguments; :func:`options` lists them with their meaning and legal values.
Failures are raised as :class:`Error`, whose message is a sentence for people. Long calls take
``progress``, a function of (stage, fraction, message): the name of what is being done, the share of
the job that is done, from 0 to 1, and a warning or None. It is called in the thread that called,
and may raise an exception to stop the job. Ctrl-C stops a job, too. Meanwhile other threads run.
"""
from __future__ import annotations

import json
import os
from typing import NamedTuple

from . import _core
from ._core import Scene
from ._errors import Cancelled, DeviceError, Error, OutOfMemory, UsageError
from ._result import Mesh, Result, Volume

__version__ = _core.version
__all__ = [
    "Cancelled", "DeviceError", "Error", "Mesh", "OutOfMemory", "Result", "Scene", "UsageError", "ViewMask", "Volume",
    "convert", "devices", "evaluate", "hull", "load", "masks", "measure", "options", "pose", "reconstruct", "refine", "romi", "scene",
    "space_carving", "synthesize", "voxel_coloring",
]

_LISTS = {
    "load": _core.load_options,
    "reconstruct": _core.reconstruct_options,
    "masks": _core.mask_options,
    "evaluate": _core.evaluate_options,
    "measure": _core.measure_options,
    "pose": _core.pose_options,
}


def options(function="reconstruct"):
    """The options of ``"load"``, ``"reconstruct"``, ``"masks"``, ``"evaluate"``, ``"measure"`` or ``"pose"``.

    Returns a list of dictionaries with ``name``, ``help``, ``values`` (which are legal), ``unit``,
    ``default`` and ``type``, all of them text.

    >>> [option["values"] for option in photohull.options() if option["name"] == "quality"]
    ['draft, normal or high']
    """
    if function not in _LISTS:
        raise UsageError(f"{function!r} has no options: expected one of {', '.join(_LISTS)}")
    return _LISTS[function]()


def load(path, **options):
    """A scene from a folder or file in any format that photohull reads.

    ``options`` are those of ``photohull.options("load")``: which views, their box, and how masks
    and files are read. Photographs are decoded when they are needed.

    >>> scene = photohull.load("datasets/templeSparseRing", views="0-4")
    >>> len(scene), scene.names[0]
    (5, 'templeSR0001.png')
    >>> photohull.load("datasets/templeSparseRing", veiws="0-4")
    Traceback (most recent call last):
    photohull._errors.UsageError: veiws: photohull.load has no such option; did you mean views?
    """
    return _core.load(path, options)


def scene(images, K, R, t, *, masks=None, names=None, distortion=None, box=None, box_scale=None, box_exact=None):
    """A scene of arrays. They are copied; nothing refers to them afterwards.

    images      list of arrays (height, width), or (height, width, channels) of 1, 3 (RGB) or 4
                (RGBA) channels: uint8 or uint16 (sRGB), or float32 or float64 (linear light)
    K           (3, 3) for all views, or (views, 3, 3): camera matrices, in pixels
    R           (3, 3) or (views, 3, 3): rotations from world to camera
    t           (3,), (views, 3) or (views, 3, 1): translations, ``x_camera = R @ x_world + t``
    masks       list of (height, width) arrays, or of None where a view has none: bool, uint8 (0
                background, 255 object), or floating-point numbers from 0 to 1. Without masks they
                are made from the background, where that is plain
    names       of the views, each another; by default "0000", "0001" and so on
    distortion  (n,) or (views, n) with n of 4, 5 or 8: OpenCV's k1, k2, p1, p2, k3, k4, k5, k6
    box         (2, 3), least corner first: the region of interest in world units. Without one it is
                found in the photographs
    """
    given = {"box_scale": box_scale, "box_exact": box_exact}
    return _core.scene(images, K, R, t, masks, names, distortion, box, given)


def _scene_and_options(given, options):
    """The scene, and the options that are not about how it is read."""
    reading = {option["name"] for option in _core.load_options()}
    if not isinstance(given, Scene):
        of_scene = {name: value for name, value in options.items() if name in reading}
        return load(given, **of_scene), {n: v for n, v in options.items() if n not in reading}
    for name in options:
        if name in reading:
            raise UsageError(f"{name}: it says how a scene is read; give it to photohull.load or photohull.scene")
    return given, options


def reconstruct(scene, *, progress=None, **options):
    """Reconstructs a scene: a :class:`Scene`, or a path, which is loaded first.

    ``options`` are those of ``photohull.options()``, with a path also those of
    ``photohull.options("load")``. Returns a :class:`Result`. A result that fails its own checks is
    returned, too, with the verdict "failed".

    >>> result = photohull.reconstruct("datasets/templeSparseRing", method="hull", resolution=48)
    >>> result.mesh.faces.shape[1], result.mesh.faces.dtype
    (3, dtype('uint32'))
    >>> photohull.reconstruct("datasets/templeSparseRing", resolution=1)
    Traceback (most recent call last):
    photohull._errors.UsageError: resolution=1: at least 2
    """
    read, rest = _scene_and_options(scene, options)
    return Result(_core.reconstruct(read, rest, progress))


def hull(scene, *, progress=None, **options):
    """The visual hull alone: what the silhouettes leave. As :func:`reconstruct` with ``method="hull"``."""
    return reconstruct(scene, progress=progress, method="hull", **options)


def voxel_coloring(scene, *, progress=None, **options):
    """Space carving in a single plane sweep. As :func:`reconstruct` with ``method="voxel-coloring"``."""
    return reconstruct(scene, progress=progress, method="voxel-coloring", **options)


def space_carving(scene, *, progress=None, **options):
    """Space carving by plane sweeps. As :func:`reconstruct` with ``method="space-carving"``."""
    return reconstruct(scene, progress=progress, method="space-carving", **options)


def refine(scene, *, progress=None, **options):
    """The hull, and the surface moved to where the photographs agree. As :func:`reconstruct` with ``method="refine"``."""
    return reconstruct(scene, progress=progress, method="refine", **options)


def pose(photographs, *, out, board=None, make_masks=True, masks=None, ordered=False, progress=None, **options):
    """Finds the cameras of photographs, and writes a scene into the folder ``out``, which :func:`load` reads.

    photographs  a path or a list of paths: files, or folders of them; or a list of arrays
                 (height, width) or (height, width, channels) of 1, 3 (RGB) or 4 (RGBA) channels,
                 uint8 (sRGB), which are written to arrays/0000.png and so on in ``out``. Arrays say
                 nothing of their lenses: those of one size count as one lens, and ``focal`` says
                 where its search begins
    out          folder for the scene: transforms.json, pose.json, coverage.png and masks/
    board        the JSON file that ``photohull board`` wrote beside the sheet it printed, on which
                 the object stands: the world is the sheet's then, z = 0 is the paper, z points up,
                 lengths are millimetres unless ``unit`` says otherwise. Without it the program
                 COLMAP finds the cameras; scale and directions of the world are any
    make_masks   with a board: make masks of what differs from the sheet's picture
    masks        without a board: a folder of masks, NAME.png or NAME.EXT.png; for arrays a list
                 of (height, width) arrays as :func:`scene` takes them, or of None
    ordered      without a board: each photograph was taken near the one before

    ``options`` are those of ``photohull.options("pose")``: ``focal``, in pixels or, as in "28mm", for
    35 mm film, and what is known of the sheet. Returns a dictionary, the content of pose.json:
    cameras, photographs in their order (with ``posed``, ``R`` and ``t``, or the ``reason`` why one
    has no pose), with a board ``rms`` in pixels, and warnings, which go to ``progress``, too.

    >>> photohull.pose([], out="never")
    Traceback (most recent call last):
    photohull._errors.UsageError: photographs: give at least one, or a folder of them
    """
    return json.loads(_core.pose(photographs, out, board, make_masks, masks, ordered, options, progress))


class ViewMask(NamedTuple):
    """A view's mask: (height, width) uint8, 0 background, 255 object, or None; where it came from; how sure it is, 0 to 1."""

    name: str
    mask: object
    source: str
    confidence: float


def masks(scene, *, progress=None, **options):
    """The masks that a reconstruction would use, of the undistorted photographs, as a list of :class:`ViewMask`.

    ``options`` are those of ``photohull.options("masks")``, with a path also those of ``"load"``.
    """
    read, rest = _scene_and_options(scene, options)
    return [ViewMask(*of_view) for of_view in _core.masks(read, rest, progress)]


def _mesh_or_path(mesh):
    if isinstance(mesh, Result):
        mesh = mesh.mesh
    return (mesh.vertices, mesh.faces) if isinstance(mesh, Mesh) else mesh


def evaluate(mesh, truth, *, progress=None, **options):
    """Measures a mesh by the exact surface.

    mesh   a :class:`Result`, a :class:`Mesh`, a pair of arrays (vertices, faces) of shape (n, 3)
           and (m, 3), or a path
    truth  such a pair, or a path: of a mesh, or of a folder that :func:`synthesize` wrote

    ``options`` are those of ``photohull.options("evaluate")``. Returns a dictionary with the keys
    of ``photohull evaluate --json``; distances are in world units.
    """
    return _core.evaluate(_mesh_or_path(mesh), truth, options, progress)


def synthesize(spec, folder, *, device="auto", threads=0, progress=None):
    """Renders calibrated photographs of a surface that is known exactly, as ``photohull synthesize`` does.

    spec    a dictionary as in docs/guide/synthetic.md, or the path of a JSON file
    folder  for the scene: new, empty, or an older synthesized scene

    Returns a dictionary: views, triangles, diagonal (world units), seen and largest_fill (shares).
    """
    if isinstance(spec, dict):
        text, base = json.dumps(spec), "."
    else:
        base = os.path.dirname(os.path.abspath(spec))
        with open(spec, encoding="utf-8") as file:
            text = file.read()
    return _core.synthesize(text, base, folder, device, threads, progress)


def measure(result, **options):
    """Measures a :class:`Result`, or a folder that one was written to.

    ``options`` are those of ``photohull.options("measure")``: the axis and the number of
    cross-sections. Returns a dictionary as ``photohull measure --json`` prints it: volume, area,
    height, box, oriented_box, hull_volume and sections; each quantity has a value and an
    uncertainty, in scene units, their squares and cubes. The volume of an open mesh is None.
    """
    if isinstance(result, Result):
        return result.measure(**options)
    return _core.measure_folder(result, options)


def devices():
    """The EGL devices, as dictionaries: index, renderer, vendor, version, software, and problem (empty: usable)."""
    return _core.devices()


from . import convert, romi  # noqa: E402  (they need what stands above)
