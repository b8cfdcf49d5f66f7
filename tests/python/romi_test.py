"""The adapter against a plain NumPy version of the same votes."""
import numpy as np
import pytest

import photohull
from photohull.romi import Backprojection
from reference import project_back

SHAPE, ORIGIN, VOXEL = (37, 29, 41), (-1.13, -0.91, -1.31), 0.0613


def views(count, seed=3):
    """Cameras around the volume, some with part of it beside their image or behind them, and masks of blobs."""
    random = np.random.default_rng(seed)
    for i in range(count):
        axis = random.normal(size=3)
        axis /= np.linalg.norm(axis)
        angle = random.uniform(0, 2 * np.pi)
        cross = np.cross(np.eye(3), axis)
        rotation = np.cos(angle) * np.eye(3) + np.sin(angle) * cross.T + (1 - np.cos(angle)) * np.outer(axis, axis)
        distance = 0.5 if i % 4 == 3 else random.uniform(2.5, 4)
        y, x = np.mgrid[0:97, 0:131]
        mask = np.hypot(x - random.uniform(40, 90), y - random.uniform(30, 70)) < random.uniform(20, 60)
        mask[random.random(mask.shape) < 0.002] ^= True
        yield [120.3, 118.7, 65.2, 47.9], rotation, [0.11, -0.07, distance], mask


def both(kind, masks, **options):
    ours = Backprojection(SHAPE, ORIGIN, VOXEL, type=kind, **options)
    theirs = np.full(SHAPE, options.get("default_value", 0), ours.dtype)
    for (intrinsics, rotation, translation, _), mask in zip(views(len(masks)), masks):
        ours.process_view(intrinsics, rotation, translation, mask)
        project_back(theirs, ORIGIN, VOXEL, kind, (intrinsics, rotation, translation), mask, options.get("log", False))
    return ours.values(), theirs


def test_carving_is_the_same():
    masks = [mask for *_, mask in views(12)]
    for count in (1, 2, 12):
        ours, theirs = both("carving", masks[:count])
        assert ours.dtype == np.int32 and np.array_equal(ours, theirs)
    assert set(np.unique(ours)) <= {-1, 0, 1} and len(np.unique(both("carving", masks[:2])[0])) == 3


@pytest.mark.parametrize("log", [False, True])
def test_averaging_is_the_same(log):
    random = np.random.default_rng(5)
    whole = [np.where(mask, 255, 0).astype(np.uint8) for *_, mask in views(8)]
    shares = [(mask * random.random(mask.shape)).astype(np.float32) for *_, mask in views(8)]
    for masks in (whole, shares):
        ours, theirs = both("averaging", masks, log=log)
        assert ours.dtype == np.float32 and np.ptp(theirs) > 1
        assert np.abs(ours - theirs).max() <= 1e-4


def test_default_values_stay_where_no_view_looks():
    masks = [mask for *_, mask in views(3)]
    ours, theirs = both("carving", masks, default_value=5)
    assert np.array_equal(ours, theirs) and 5 in ours


def test_masks_of_all_types_and_orders():
    masks = [mask for *_, mask in views(4)]
    expected, _ = both("carving", masks)
    for changed in (lambda m: m.astype(np.uint8), lambda m: m.astype(np.int64), lambda m: m.astype(np.float64),
                    np.asfortranarray, lambda m: np.repeat(m, 2, axis=1)[:, ::2]):
        assert np.array_equal(both("carving", [changed(m) for m in masks])[0], expected)


def test_clear_begins_anew():
    projected = Backprojection(SHAPE, ORIGIN, VOXEL)
    list_of_views = list(views(5))
    for view in list_of_views:
        projected.process_view(*view)
    first = projected.values().copy()
    projected.clear()
    assert not projected.values().any()
    for view in list_of_views:
        projected.process_view(*view)
    assert np.array_equal(projected.values(), first)


class File:
    def __init__(self, view, channel):
        intrinsics, rotation, translation, self.mask = view
        camera = {"camera_model": {"params": intrinsics, "width": 131, "height": 97}, "rotmat": rotation.tolist(),
                  "tvec": translation}
        self.metadata = {"camera": camera, "channel": channel}

    def get_metadata(self, name):
        return self.metadata.get(name)


class Fileset:
    def __init__(self, files):
        self.files = files

    def get_files(self):
        return self.files


def test_filesets_by_label():
    files = [File(view, "stem" if i % 2 else "leaf") for i, view in enumerate(views(6))]
    files.append(File(next(views(1)), "leaf"))
    files[-1].metadata["camera"] = None  # its pose is not known: passed over
    votes = Backprojection(SHAPE, ORIGIN, VOXEL, labels=["leaf", "stem"]).process_fileset(
        Fileset(files), read_image=lambda file: np.where(file.mask, 255, 0).astype(np.uint8))
    assert votes.shape == (2, *SHAPE)
    alone = Backprojection(SHAPE, ORIGIN, VOXEL)
    for file in files[1::2]:
        model = file.metadata["camera"]
        alone.process_view(model["camera_model"]["params"], model["rotmat"], model["tvec"], file.mask)
    assert np.array_equal(votes[1], alone.values())


BAD = {
    "type": (lambda: Backprojection(SHAPE, ORIGIN, VOXEL, type="carve"), "type='carve': expected one of carving, averaging"),
    "shape": (lambda: Backprojection((3, 4), ORIGIN, VOXEL), r"shape has the shape \(2,\)"),
    "no voxels": (lambda: Backprojection((3, 0, 3), ORIGIN, VOXEL), "shape holds 0"),
    "voxel size": (lambda: Backprojection(SHAPE, ORIGIN, 0), "voxel_size=0: must be finite and positive"),
    "mask": (lambda: Backprojection(SHAPE, ORIGIN, VOXEL).process_view([1, 1, 1, 1], np.eye(3), [0, 0, 1], np.zeros(4)),
             r"mask has the shape \(4,\)"),
    "rotation": (lambda: Backprojection(SHAPE, ORIGIN, VOXEL).process_view([1, 1, 1, 1], np.eye(2), [0, 0, 1], np.eye(4)),
                 r"rot has the shape \(2, 2\)"),
    "skew": (lambda: Backprojection(SHAPE, ORIGIN, VOXEL).process_view(np.ones((3, 3)), np.eye(3), [0, 0, 1], np.eye(4)),
             "intrinsics: K must be"),
}


@pytest.mark.parametrize("name", BAD)
def test_what_is_said_of_bad_input(name):
    call, sentence = BAD[name]
    with pytest.raises(photohull.UsageError, match=sentence):
        call()
