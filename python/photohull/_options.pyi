# The options as keyword arguments. Written by python3 -m photohull._stubs.
import os
from collections.abc import Mapping, Sequence
from typing import Literal, TypedDict

import numpy as np

class LoadOptions(TypedDict, total=False):
    # views to use, e.g. "0-10,15,img_*.png"; spread:N (N that show the object from all sides) or all
    # (default: all; to reconstruct, spread:120 where there are more).
    views: str | float | os.PathLike[str] | None
    # views to leave out of these, a list of the same kind; 'photohull evaluate with photos' judges by
    # them.
    hold_out: str | float | os.PathLike[str] | None
    # region of interest "x0 y0 z0 x1 y1 z1" in world units, or auto: found in the photographs
    # (default: the scene's own, else auto).
    box: str | Sequence[float] | Sequence[Sequence[float]] | np.ndarray | None
    # scales the box, whatever it is, about its middle. Default: 1.
    box_scale: float | None
    # take the box as it is: not made smaller where the object is, and no surface beyond it. Default:
    # False.
    box_exact: bool | None
    # how the scene is read (default: detected).
    format: Literal["middlebury", "colmap-binary", "colmap-text", "transforms", "alicevision", "openmvg", "metashape", "realitycapture", "nvm", "pmvs", "bundler", "mve", "mvsnet", "strecha", "projection", "matlab", "opencv"] | None
    # auto (files, alpha, else a background model), background (always that), none, or a folder of
    # masks. Default: auto.
    masks: str | float | os.PathLike[str] | None
    # masks from photographs without the object: a file for a camera that stands still, or a folder
    # with one for every view.
    background: str | float | os.PathLike[str] | None
    # folder of the photographs, where they are not where the scene has them.
    images: str | float | os.PathLike[str] | None
    # coordinate of the top-left pixel's centre in the scene file (default: the format's) (pixels).
    pixel_center: float | None
    # refuse scenes whose photographs are not all there, readable and of their cameras' shape, and
    # folders of masks that lack some (default: such photographs are left out while two of three
    # remain, such masks done without). Default: False.
    strict: bool | None

class ReconstructOptions(TypedDict, total=False):
    # voxel size from the images' pixels, and how much work is done. Default: normal.
    quality: Literal["draft", "normal", "high"] | None
    # how space is carved (default: hull for draft, else refine).
    method: Literal["hull", "voxel-coloring", "space-carving", "refine"] | None
    # voxels along the box's longest side (voxels).
    resolution: int | None
    # voxel size in world units; excludes the resolution (world units).
    voxel_size: float | None
    # views to use, e.g. "0-10,15,img_*.png"; spread:N (N that show the object from all sides) or all
    # (default: all; to reconstruct, spread:120 where there are more).
    views: str | float | os.PathLike[str] | None
    # views to leave out of these, a list of the same kind; 'photohull evaluate with photos' judges by
    # them.
    hold_out: str | float | os.PathLike[str] | None
    # region of interest "x0 y0 z0 x1 y1 z1" in world units, or auto: found in the photographs
    # (default: the scene's own, else auto).
    box: str | Sequence[float] | Sequence[Sequence[float]] | np.ndarray | None
    # scales the box, whatever it is, about its middle. Default: 1.
    box_scale: float | None
    # take the box as it is: not made smaller where the object is, and no surface beyond it. Default:
    # False.
    box_exact: bool | None
    # fit (voxels centred on the box) or fixed: they begin in the box's lower corner, and box and
    # voxel size alone say where they are, for results that are to be compared or follow each other.
    # Default: fit.
    lattice: Literal["fit", "fixed"] | None
    # cameras made to agree with the photographs first, auto where it pays (default: off for draft,
    # else auto where masks' outlines show that cameras are wrong).
    refine_cameras: Literal["off", "auto", "poses", "poses+intrinsics"] | None
    # gains, white balance and vignetting of the photographs made alike, for colours and confidence;
    # auto where gains differ by more than the noise of their estimate, and correcting them pays.
    # Default: auto.
    photometric: Literal["off", "auto", "on"] | None
    # fewer triangles: how far mesh.ply may be from the uniform mesh (0: uniform). Default: 0.
    mesh_error: str | float | os.PathLike[str] | None
    # surface that no camera sees: closed, open (left out; without masks what is doubtful, too), or
    # auto: closed where there are masks. Default: auto.
    unseen: Literal["auto", "open", "closed"] | None
    # what surrounds the box, on coarser grids: on (with the method refine only), off, or auto: where
    # the box was found, and fewer than half of the photographs have masks. Default: off.
    surroundings: Literal["auto", "on", "off"] | None
    # how the scene is read (default: detected).
    format: Literal["middlebury", "colmap-binary", "colmap-text", "transforms", "alicevision", "openmvg", "metashape", "realitycapture", "nvm", "pmvs", "bundler", "mve", "mvsnet", "strecha", "projection", "matlab", "opencv"] | None
    # auto (files, alpha, else a background model), background (always that), none, or a folder of
    # masks. Default: auto.
    masks: str | float | os.PathLike[str] | None
    # masks from photographs without the object: a file for a camera that stands still, or a folder
    # with one for every view.
    background: str | float | os.PathLike[str] | None
    # folder of the photographs, where they are not where the scene has them.
    images: str | float | os.PathLike[str] | None
    # coordinate of the top-left pixel's centre in the scene file (default: the format's) (pixels).
    pixel_center: float | None
    # refuse scenes whose photographs are not all there, readable and of their cameras' shape, and
    # folders of masks that lack some (default: such photographs are left out while two of three
    # remain, such masks done without). Default: False.
    strict: bool | None
    # pixels by which the object's outline lies outside the masks' (negative: inside); auto: measured
    # on the photographs (pixels). Default: auto.
    mask_offset: float | str | None
    # silhouettes that may leave a point out and it stands all the same; auto: up to a third of the
    # views, and only where masks show what would be missing otherwise (views). Default: auto.
    views_may_miss: int | str | None
    # mend holes and bites of given masks where the photograph shows the object's colours, or keep
    # them. Default: mend.
    mask_holes: str | float | os.PathLike[str] | None
    # standard deviation of the photographs' noise in 8-bit codes (default: measured) (8-bit codes).
    noise: float | None
    # use views whose silhouettes disagree with all others' and views that are strongly blurred, too.
    # Default: False.
    keep_views: bool | None
    # sweeps: how photographs are resampled on their planes (default: anisotropic).
    sampler: Literal["mipmap", "centroid", "nearest", "bilinear", "trilinear", "trilinear-derivative", "ripmap", "summed-area", "anisotropic", "hardware", "ewa"] | None
    # sweeps: N x N samples a voxel (default: 1).
    supersample: int | None
    # sweeps: what decides whether views agree on a voxel (default: zncc).
    consistency: Literal["zncc", "gain-variance", "adaptive-variance", "robust-variance", "histogram", "census"] | None
    # sweeps: how it is known who sees a voxel (default: plain).
    visibility: Literal["plain", "receiver-plane", "virtual-normal", "pcf3", "pcf3-virtual", "rays"] | None
    # sweeps: pixels around its projection within which each view may show a voxel: bears cameras that
    # are wrong by as much (default: 0) (pixels).
    r_consistency: float | None
    # results of the moment before, of the same rig: the surface starts from theirs (refine), and
    # their cameras and gains hold.
    follow: str | float | os.PathLike[str] | None
    # results of the same rig: their cameras and gains hold, and nothing of them is measured again.
    rig: str | float | os.PathLike[str] | None
    # of the whole whose results are followed, on voxels that are halved, one part of so many, for
    # models larger than memory ('photohull plan' with parts makes them all). Default: all.
    part: str | float | os.PathLike[str] | None
    # how often the whole's voxels are halved for its parts. Default: 1.
    finer: int | None
    # at which photographs are read; auto: what the voxels need, and the memory bears. Default: auto.
    image_scale: float | str | None
    # memory that the job may take; auto: three quarters of what is available (bytes). Default: auto.
    max_memory: int | str | None
    # NAME=VALUE: a parameter of the method changed, for experiments (repeatable).
    tune: str | Sequence[str] | Mapping[str, float] | None
    # auto, software, or an index from 'photohull devices'. Default: auto.
    device: str | float | os.PathLike[str] | None
    # threads that compute. Default: 0.
    threads: int | None
    # start anew: else an interrupted refinement of the same job goes on after the last level that it
    # finished, and masks and cameras that the run before in this folder made by the same photographs
    # are taken from there. Default: False.
    fresh: bool | None
    # write evidence.ply too, the uniform mesh with what confidence is computed from, and missing.png:
    # where the model leaves the masks empty, or without masks explained.png: what of a photograph it
    # explains. Default: False.
    evidence: bool | None
    # write report.html, too: the model to turn, its cameras, the verdict and the figures, as one page
    # for a browser. Default: on.
    report_page: Literal["on", "off"] | None
    # a format that the mesh is written in, too (repeatable): ply (colours, normals and confidence),
    # stl (triangles alone, for printers), glb (glTF with a texture, for the web and viewers), obj
    # (with a texture, for modelling programs), usdz (with a texture, for phones and tablets).
    export: str | Sequence[str] | Mapping[str, float] | None
    # texture of exported files that hold one: as fine as the photographs (auto), one image with edges
    # of this many texels at most, or off: colours at vertices. Default: auto.
    texture: str | float | os.PathLike[str] | None
    # contrast of what is as fine as two texels, beside which 1 is the best photograph's: more
    # sharpens the texture, and its noise. Default: 1.
    texture_detail: float | None
    # write glb with quantised vertices and compressed by meshoptimizer; viewers need
    # EXT_meshopt_compression. Default: False.
    compress: bool | None
    # of the images in or beside exported files: png (exact), or jpeg (smaller). Default: png.
    texture_format: Literal["png", "jpeg"] | None
    # length of a scene unit: stl is written in millimetres, glb in metres, and usdz says it (default:
    # stl keeps the scene's numbers, and in glb and usdz they count as metres).
    unit: Literal["mm", "cm", "m", "inch"] | None

class MaskOptions(TypedDict, total=False):
    # let GrabCut place the contours. Default: False.
    grabcut: bool | None
    # times that an undistorted picture may be as large as the photograph. Default: 2.
    max_frame_growth: float | None

class EvaluateOptions(TypedDict, total=False):
    # distances to count within, fractions of the truth's diagonal. Default: 0.001,0.0025,0.005,0.01.
    thresholds: str | Sequence[float] | None
    # further distances to count within, in world units.
    absolute: str | Sequence[float] | None
    # points to measure the result at. Default: 200000.
    samples: int | None
    # seed of the random numbers that choose these points. Default: 1.
    seed: int | None
    # cameras that must see a part of the truth for it to count. Default: 1.
    min_views: int | None
    # columns of rays along a side of the box, by which volumes are compared. Default: 256.
    columns: int | None

class MeasureOptions(TypedDict, total=False):
    # of the height and of cross-sections: up (the world's axis that is upward in most photographs),
    # or one of the world's. Default: up.
    axis: Literal["up", "x", "y", "z"] | None
    # cross-sections, in the middle of as many slabs of the same height. Default: 10.
    sections: int | None

class PoseOptions(TypedDict, total=False):
    # which distortion is found. Default: brown.
    lens: Literal["pinhole", "brown", "rational", "fisheye"] | None
    # length of the printed bar as a ruler measures it (mm). Default: 0.
    bar: float | None
    # height of the box above the sheet (mm). Default: 0.
    height: float | None
    # height of the box's lower side above the sheet (mm). Default: 1.
    margin: float | None
    # unit of the scene's world (mm). Default: 1.
    unit: float | None
    # take the sheet for flat, and do not find out whether it is bent. Default: False.
    flat: bool | None
    # focal length to start from where photographs state none in their EXIF data.
    focal: str | float | os.PathLike[str] | None
