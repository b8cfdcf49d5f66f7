"""Meshes for other packages, where these are installed."""
import numpy as np
import pytest

from photohull import convert


def test_srgb_is_the_standards():
    assert convert.srgb([0, 0.0031308, 0.5, 1, 2, -1]).tolist() == [0, 10, 188, 255, 255, 0]
    assert convert.srgb(np.zeros((4, 3))).shape == (4, 3)


def test_trimesh(result):
    pytest.importorskip("trimesh")
    mesh = convert.to_trimesh(result.mesh)
    assert np.array_equal(mesh.faces, result.mesh.faces) and np.allclose(mesh.vertices, result.mesh.vertices)
    assert mesh.volume == pytest.approx(result.measure()["volume"]["value"], rel=1e-4)
    assert np.array_equal(mesh.visual.vertex_colors[:, :3], convert.srgb(result.mesh.colours))


def test_open3d(result):
    pytest.importorskip("open3d")
    mesh = convert.to_open3d(result.mesh)
    assert np.array_equal(np.asarray(mesh.triangles), result.mesh.faces)
    assert np.allclose(np.asarray(mesh.vertices), result.mesh.vertices)
    assert np.allclose(np.asarray(mesh.vertex_colors) * 255, convert.srgb(result.mesh.colours))
