"""What arrays a scene takes, and what is said of those that it does not."""
import gc
import sys

import numpy as np
import pytest

import photohull

QUICK = {"method": "hull", "resolution": 24, "report_page": "off"}


def mesh_of(scene):
    mesh = photohull.reconstruct(scene, **QUICK).mesh
    return mesh.vertices.tobytes() + mesh.faces.tobytes() + mesh.colours.tobytes()


@pytest.fixture(scope="module")
def expected(arrays):
    return mesh_of(arrays.scene())


def test_arrays_are_as_good_as_files(sphere, expected):
    assert mesh_of(photohull.load(sphere)) == expected


def read_only(array):
    copy = array.copy()
    copy.flags.writeable = False
    return copy


def with_gaps(array):
    """Every second element of a larger array."""
    larger = np.zeros([2 * length for length in array.shape], array.dtype)
    view = larger[tuple(slice(None, None, 2) for _ in array.shape)]
    view[...] = array
    return view


def reversed_twice(array):
    return np.ascontiguousarray(array[::-1])[::-1]


@pytest.mark.parametrize("changed", [np.asfortranarray, read_only, with_gaps, reversed_twice])
def test_order_of_memory_does_not_matter(arrays, expected, changed):
    scene = arrays.scene(images=[changed(i) for i in arrays.images], masks=[changed(m) for m in arrays.masks],
                         K=changed(arrays.K), R=changed(arrays.R), t=changed(arrays.t), box=changed(arrays.box))
    assert mesh_of(scene) == expected


def test_arrays_are_copied(arrays, expected):
    images = [image.copy() for image in arrays.images]
    scene = arrays.scene(images=images)
    for image in images:
        image[:] = 0
    del images
    gc.collect()
    assert mesh_of(scene) == expected


def test_nothing_refers_to_the_arrays_afterwards(arrays):
    image = arrays.images[0].copy()
    before = sys.getrefcount(image)
    arrays.scene(images=[image, *arrays.images[1:]])
    assert sys.getrefcount(image) == before


def test_masks_of_other_types_are_the_same(arrays):
    binary = [mask >= 128 for mask in arrays.masks]
    meshes = {mesh_of(arrays.scene(masks=masks)) for masks in (
        binary, [np.where(b, 255, 0).astype(np.uint8) for b in binary], [b.astype(np.float32) for b in binary],
        [b.astype(np.float64) for b in binary])}
    assert len(meshes) == 1


def test_grey_and_opaque_images(arrays):
    grey = [image[:, :, 1] for image in arrays.images]
    alike = [np.repeat(g[:, :, None], 3, axis=2) for g in grey]
    opaque = [np.dstack([a, np.full(a.shape[:2], 255, np.uint8)]) for a in alike]
    meshes = {mesh_of(arrays.scene(images=images)) for images in (grey, [g[:, :, None] for g in grey], alike, opaque)}
    assert len(meshes) == 1


def linear_from_srgb(coded):
    return np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4)


def test_images_of_more_bits_have_the_same_colours(arrays):
    sixteen = [i.astype(np.uint16) * 257 for i in arrays.images]
    linear = [linear_from_srgb(i / 255.0) for i in arrays.images]
    eight = photohull.reconstruct(arrays.scene(), **QUICK).mesh
    for images in (sixteen, linear, [i.astype(np.float32) for i in linear]):
        mesh = photohull.reconstruct(arrays.scene(images=images), **QUICK).mesh
        assert np.array_equal(mesh.faces, eight.faces)
        assert np.abs(mesh.colours - eight.colours).max() < 0.03  # devices decode 8 bits a little otherwise


def test_cameras_come_back(arrays):
    scene = arrays.scene(t=arrays.t[:, :, None])
    assert np.allclose(scene.K, arrays.K) and np.allclose(scene.R, arrays.R) and np.allclose(scene.t, arrays.t)
    assert np.array_equal(scene.image(3), arrays.images[3]) and np.array_equal(scene.mask(3), arrays.masks[3])
    assert np.array_equal(scene.box, arrays.box)


def test_one_camera_matrix_for_all(arrays):
    same = arrays.scene(K=arrays.K[0])
    assert all(np.array_equal(k, same.K[0]) for k in same.K)


def first(values, replaced):
    return [replaced, *values[1:]]


BAD = {
    "an image of five channels": (lambda a: {"images": first(a.images, np.zeros((72, 96, 5), np.uint8))},
                                  r"images\[0\] has the shape \(72, 96, 5\): expected \(height, width\)"),
    "an image of one axis": (lambda a: {"images": first(a.images, np.zeros(9, np.uint8))}, r"images\[0\] has the shape \(9,\)"),
    "an empty image": (lambda a: {"images": first(a.images, np.zeros((0, 96, 3), np.uint8))}, r"images\[0\] has the shape"),
    "an image of int32": (lambda a: {"images": first(a.images, a.images[0].astype(np.int32))},
                          r"images\[0\] is of the type int32: expected uint8 or uint16"),
    "an image of text": (lambda a: {"images": first(a.images, np.full((72, 96), "a"))}, r"images\[0\] is of the type <U1"),
    "an image that is not finite": (lambda a: {"images": first(a.images, np.full((72, 96), np.nan))},
                                    r"images\[0\] holds a value that is not a finite number"),
    "no image": (lambda a: {"images": []}, "images is empty"),
    "a mask of another size": (lambda a: {"masks": first(a.masks, np.zeros((9, 9), bool))}, "the mask has 9x9 pixels"),
    "a mask of three axes": (lambda a: {"masks": first(a.masks, a.images[0])}, r"masks\[0\] has the shape \(72, 96, 3\)"),
    "a mask of int64": (lambda a: {"masks": first(a.masks, a.masks[0].astype(np.int64))}, r"masks\[0\] is of the type int64"),
    "a mask of 0 and 1": (lambda a: {"masks": first(a.masks, (a.masks[0] > 0).astype(np.uint8))},
                          r"masks\[0\] has values of 0 and 1 only, of the type uint8: give bool, or 0 to 255"),
    "a mask of numbers to 255": (lambda a: {"masks": first(a.masks, a.masks[0].astype(float))}, r"masks\[0\] holds \d+"),
    "too few masks": (lambda a: {"masks": a.masks[1:]}, "masks has 15 entries for 16 images"),
    "too few names": (lambda a: {"names": a.names[1:]}, "names has 15 entries for 16 images"),
    "names that are the same": (lambda a: {"names": ["a"] * 16}, "another one has the same name"),
    "K of one view too few": (lambda a: {"K": a.K[1:]}, r"K has the shape \(15, 3, 3\): expected \(16, 3, 3\) or \(3, 3\)"),
    "K of four rows": (lambda a: {"K": np.eye(4)}, r"K has the shape \(4, 4\)"),
    "K that is not triangular": (lambda a: {"K": a.K[0].T}, "K is not upper triangular"),
    "K of complex numbers": (lambda a: {"K": a.K.astype(complex)}, "K is of the type complex128"),
    "R with a scale": (lambda a: {"R": 2 * a.R}, r"the camera of images\[0\]: R holds a uniform scale of 2"),
    "R that mirrors": (lambda a: {"R": -a.R}, "R has determinant -1"),
    "R that is not finite": (lambda a: {"R": np.full_like(a.R, np.inf)}, "R holds a value that is not a finite number"),
    "t of two numbers": (lambda a: {"t": a.t[:, :2]}, r"t has the shape \(16, 2\)"),
    "t of text": (lambda a: {"t": [["a", "b", "c"]] * 16}, "t is of the type"),
    "a box upside down": (lambda a: {"box": a.box[::-1]}, "box: the first corner must be below the second"),
    "a box of five numbers": (lambda a: {"box": [1, 2, 3, 4, 5]}, r"box has the shape \(5,\)"),
    "three coefficients": (lambda a: {"distortion": [0.1, 0, 0]}, "distortion has 3 coefficients: expected 4, 5 or 8"),
}


@pytest.mark.parametrize("name", BAD)
def test_what_is_said_of_bad_input(arrays, name):
    changes, sentence = BAD[name]
    with pytest.raises(photohull.Error, match=sentence):
        arrays.scene(**changes(arrays))


def test_distortion_is_removed(arrays):
    plain = photohull.reconstruct(arrays.scene(), **QUICK).mesh.vertices
    bent = photohull.reconstruct(arrays.scene(distortion=[0.2, 0, 0, 0]), **QUICK).mesh.vertices
    assert np.ptp(bent, axis=0).max() < np.ptp(plain, axis=0).max()
