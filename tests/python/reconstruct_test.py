"""Reconstructions: what they give, that they are those of the command line, and how they are stopped."""
import os
import signal
import subprocess
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import photohull

QUICK = {"method": "hull", "resolution": 24, "report_page": "off"}


@pytest.mark.parametrize("options", [{"resolution": 32, "method": "hull"},
                                     {"resolution": 24, "mesh_error": 0.25, "export": ["glb", "stl"], "unit": "cm"}])
def test_files_have_the_bytes_of_the_command_line(sphere, program, tmp_path, options):
    words = []
    for name, value in options.items():
        for each in value if isinstance(value, list) else [value]:
            words += [f"--{name.replace('_', '-')}", str(each)]
    subprocess.run([program, "reconstruct", sphere, "--out", tmp_path / "cli", *words], check=True, capture_output=True)
    files = photohull.reconstruct(sphere, **options).write(tmp_path / "python")
    assert set(files) == set(os.listdir(tmp_path / "cli"))
    for name in set(files) - {"report.json", "report.html"}:  # which tell times
        assert (tmp_path / "cli" / name).read_bytes() == (tmp_path / "python" / name).read_bytes(), name


def test_arrays_of_the_mesh_are_views(result):
    mesh = result.mesh
    count = len(mesh.vertices)
    assert mesh.positions.shape == mesh.normals.shape == mesh.colours.shape == (count, 3)
    assert mesh.confidence.shape == (count,) and mesh.faces.max() == count - 1
    for name in ("positions", "faces", "normals", "colours", "confidence"):
        one, two = getattr(mesh, name), getattr(mesh, name)
        assert one.ctypes.data == two.ctypes.data and not one.flags.writeable and not one.flags.owndata, name
    assert mesh.vertices is mesh.vertices
    assert np.allclose(mesh.vertices, mesh.origin + mesh.positions)
    assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-3)


def test_views_outlive_their_result(sphere):
    faces = photohull.reconstruct(sphere, **QUICK).mesh.faces
    kept = faces.copy()
    for _ in range(3):
        photohull.reconstruct(sphere, **QUICK)
    assert np.array_equal(faces, kept)


def test_the_dense_volume_is_that_of_the_bricks(result):
    volume = result.volume
    dense = volume.dense()
    assert dense.shape == volume.shape and dense.dtype == np.float32
    assert (dense < 0).sum() == volume.inside_voxels == volume.occupancy().sum()
    for brick, distances in zip(volume.bricks, volume.distances):
        x, y, z = 8 * brick
        assert np.array_equal(dense[x:x + 8, y:y + 8, z:z + 8], distances)
    centres = volume.origin + volume.voxel_size * np.argwhere(dense < 0)
    assert np.allclose(centres.mean(axis=0), result.mesh.vertices.mean(axis=0), atol=volume.voxel_size)


def test_a_sphere_is_one(result):
    centre = result.mesh.vertices.mean(axis=0)
    radii = np.linalg.norm(result.mesh.vertices - centre, axis=1)
    assert radii.std() < 0.05 * radii.mean()
    assert result.verdict in ("good", "doubtful") and isinstance(result.reasons, list)
    assert result.report["grid"]["voxel_size"] == result.volume.voxel_size
    assert result.preview.dtype == np.uint8 and result.preview.shape[2] == 3


def test_the_vdb_is_that_of_the_folder(result, tmp_path):
    result.write(tmp_path)
    result.volume.save_vdb(tmp_path / "other.vdb")
    assert (tmp_path / "other.vdb").read_bytes() == (tmp_path / "volume.vdb").read_bytes()


OPTIONS = {
    "an unknown option": ({"resolutoin": 32}, "resolutoin: photohull.reconstruct has no such option; did you mean resolution?"),
    "one like no other": ({"zzzzzzzz": 1}, r"photohull.options\(\) lists them"),
    "a number out of range": ({"resolution": 1}, "resolution=1: at least 2"),
    "text for a number": ({"resolution": "many"}, "resolution=many: expected a whole number"),
    "a fraction": ({"resolution": 2.5}, "resolution=2.5: expected a whole number"),
    "a truth value for a number": ({"resolution": True}, "resolution=True: expected at least 2"),
    "a number for a truth value": ({"fresh": 1}, "fresh=1: expected True or False"),
    "an unknown choice": ({"quality": "best"}, "quality=best: expected one of draft, normal, high"),
    "no text": ({"quality": object()}, "quality=<object object"),
    "two that exclude each other": ({"resolution": 9, "voxel_size": 0.1}, "resolution and voxel_size exclude each other"),
    "an unknown parameter": ({"tune": {"no.such": 1}}, "no.such"),
    "a dictionary for a number": ({"resolution": {}}, "resolution={}: expected at least 2"),
}


@pytest.mark.parametrize("name", OPTIONS)
def test_what_is_said_of_bad_options(sphere, name):
    options, sentence = OPTIONS[name]
    with pytest.raises(photohull.UsageError, match=sentence) as raised:
        photohull.reconstruct(sphere, **options)
    assert isinstance(raised.value, photohull.Error) and isinstance(raised.value, ValueError)


def test_options_of_reading_belong_to_load(sphere):
    scene = photohull.load(sphere, views="0-11", box=[[-2, -2, -2], [2, 2, 2]])
    assert len(scene) == 12 and np.array_equal(scene.box, [[-2, -2, -2], [2, 2, 2]])
    with pytest.raises(photohull.UsageError, match="views: it says how a scene is read; give it to photohull.load"):
        photohull.reconstruct(scene, views="0-3")
    assert len(photohull.reconstruct(sphere, views="0-11", **QUICK).report["cameras"]) == 12


def test_values_may_be_of_numpy_or_none(sphere):
    plain = photohull.reconstruct(sphere, **QUICK)
    other = photohull.reconstruct(sphere, **QUICK | {"resolution": np.int64(24), "noise": None, "threads": np.float32(0).astype(int)})
    assert np.array_equal(plain.mesh.vertices, other.mesh.vertices)


def test_a_missing_scene_is_an_error():
    with pytest.raises(photohull.Error, match="no/such/folder") as raised:
        photohull.load("no/such/folder")
    assert not isinstance(raised.value, photohull.UsageError)


def test_progress_is_told_in_the_callers_thread(sphere):
    calls = []
    photohull.reconstruct(sphere, progress=lambda *call: calls.append((threading.get_ident(), *call)), **QUICK)
    assert {thread for thread, *_ in calls} == {threading.get_ident()}
    stages = [stage for _, stage, _, _ in calls]
    assert {"scene", "views", "hull", "mesh", "preview"} <= set(stages)
    shares = [share for *_, share, message in calls if message is None]
    assert shares == sorted(shares) and 0 <= shares[0] and shares[-1] == 1


def test_a_callback_that_raises_stops_the_job(sphere):
    def callback(stage, share, message):
        if stage == "hull":
            raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        photohull.reconstruct(sphere, progress=callback, **QUICK)
    assert photohull.reconstruct(sphere, **QUICK).mesh.faces.size > 0


def test_an_interrupt_stops_the_job(sphere):
    stages = []

    def callback(stage, share, message):
        if "hull" not in stages and stage == "hull":
            os.kill(os.getpid(), signal.SIGINT)
        stages.append(stage)

    started = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        photohull.reconstruct(sphere, progress=callback, method="refine", resolution=200)
    assert time.monotonic() - started < 120
    assert "preview" not in stages
    assert photohull.reconstruct(sphere, **QUICK).mesh.faces.size > 0


def test_an_interrupt_stops_a_job_without_a_callback(sphere):
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    with pytest.raises(KeyboardInterrupt):
        timer.start()
        photohull.reconstruct(sphere, method="refine", resolution=200)
    assert photohull.reconstruct(sphere, **QUICK).mesh.faces.size > 0


def test_other_threads_run_meanwhile(sphere):
    counted, done = [0], threading.Event()

    def count():
        while not done.wait(0.005):
            counted[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    started = time.monotonic()
    photohull.reconstruct(sphere, **QUICK)
    seconds = time.monotonic() - started
    done.set()
    thread.join()
    assert counted[0] > 20 * seconds  # of 200 a second, had it nothing else to do


def test_two_threads_reconstruct_at_once(sphere):
    meshes = []
    threads = [threading.Thread(target=lambda: meshes.append(photohull.reconstruct(sphere, **QUICK).mesh)) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(meshes) == 2 and np.array_equal(meshes[0].vertices, meshes[1].vertices)


def test_each_method_has_its_function(sphere):
    for function, method in ((photohull.hull, "hull"), (photohull.space_carving, "space-carving"),
                             (photohull.voxel_coloring, "voxel-coloring"), (photohull.refine, "refine")):
        result = function(sphere, resolution=16, report_page="off")
        assert result.report["options"]["method"] == method and result.mesh.faces.size > 0


def test_masks_are_those_of_the_scene(sphere, arrays):
    masks = photohull.masks(photohull.load(sphere))
    assert [mask.name for mask in masks] == arrays.names
    assert all(np.array_equal(mask.mask, given) for mask, given in zip(masks, arrays.masks))
    assert {(mask.source, mask.confidence) for mask in masks} == {("mask files", 1.0)}
    assert all(mask.mask is None for mask in photohull.masks(sphere, masks="none"))


def test_evaluation_against_the_truth(sphere, result):
    judged = photohull.evaluate(result, sphere, samples=20000)
    same = photohull.evaluate((result.mesh.vertices, result.mesh.faces), sphere / "gt.ply", samples=20000)
    assert judged["volume"]["iou"] > 0.85 and same["volume"]["iou"] == judged["volume"]["iou"]
    with pytest.raises(photohull.UsageError, match="face 0 names the vertex 9 of 3"):
        photohull.evaluate((np.eye(3), [[0, 1, 9]]), sphere)


def test_specs_are_checked(tmp_path):
    with pytest.raises(photohull.Error, match="geometri"):
        photohull.synthesize({"geometri": {}}, tmp_path / "scene")
    assert not Path(tmp_path / "scene").exists()


def test_devices_are_listed():
    assert any(device["problem"] == "" and "OpenGL" not in device["renderer"] for device in photohull.devices())
