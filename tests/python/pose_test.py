"""Cameras found from Python: as the command line finds them, refused in sentences, and stopped."""
import json
import os
import re
import shutil
import signal
import subprocess

import numpy as np
import pytest

import photohull


def turn_errors(report, known):
    """Of the turns from each photograph with a pose to the next one, beside those of the scene that is known; degrees."""
    posed = [i for i, photo in enumerate(report["photographs"]) if photo["posed"]]
    for i, j in zip(posed, posed[1:]):
        first, second = (np.array(report["photographs"][k]["R"]) for k in (i, j))
        off = second @ first.T @ known.R[i] @ known.R[j].T
        yield np.degrees(np.arccos(np.clip((np.trace(off) - 1) / 2, -1, 1)))


def test_a_scene_is_that_of_the_command_line(table, program, tmp_path):
    words = [program, "pose", table / "table/images", "--board", table / "board.json", "--out", tmp_path / "scene"]
    subprocess.run(words, check=True, capture_output=True)
    files = sorted(path.relative_to(tmp_path / "scene") for path in (tmp_path / "scene").rglob("*") if path.is_file())
    by_cli = {file: (tmp_path / "scene" / file).read_bytes() for file in files}
    shutil.rmtree(tmp_path / "scene")
    calls = []
    report = photohull.pose(table / "table/images", board=table / "board.json", out=tmp_path / "scene",
                            progress=lambda *call: calls.append(call))
    assert {file: (tmp_path / "scene" / file).read_bytes() for file in files} == by_cli
    assert report == json.loads(by_cli[files[[file.name for file in files].index("pose.json")]])
    assert all(photo["posed"] for photo in report["photographs"])
    deviation = max(photo["rotation_sigma_degrees"] for photo in report["photographs"])
    assert deviation < 0.5 and max(turn_errors(report, photohull.load(table / "table"))) < 4 * np.sqrt(2) * deviation
    assert {"tags", "masks"} <= {stage for stage, _, _ in calls} and calls[-1][1] == 1
    scene = photohull.load(tmp_path / "scene")
    assert len(scene) == 8 and scene.mask(0) is not None
    result = photohull.hull(scene, resolution=32, report_page="off")
    assert result.mesh.faces.size > 0 and np.isfinite(result.measure()["height"]["value"])


def test_options_are_those_of_pose(table, tmp_path):
    names = {option["name"] for option in photohull.options("pose")}
    assert {"bar", "height", "unit", "focal"} <= names
    photos = sorted((table / "table/images").iterdir())
    report = photohull.pose(photos[:3], board=table / "board.json", out=tmp_path / "scene", make_masks=False, focal=900)
    assert report["cameras"][0]["stated_focal_length"] == 900 and not (tmp_path / "scene/masks").exists()


@pytest.mark.parametrize("words, sentence", [
    ({"heigth": 5}, "heigth: photohull.pose has no such option; did you mean height?"),
    ({"bar": "long"}, "bar=long"),
    ({"ordered": True}, "ordered: it is for photographs without a board"),
    ({"masks": "here"}, "masks: they are for photographs without a board"),
    ({"board": None, "height": 80}, "height: it says something of a printed sheet"),
    ({"out": ""}, "out: it is empty"),
])
def test_what_is_said_of_wrong_arguments(table, tmp_path, words, sentence):
    with pytest.raises(photohull.UsageError, match=re.escape(sentence)):
        photohull.pose(table / "table/images", **({"board": table / "board.json", "out": tmp_path / "scene"} | words))
    assert not (tmp_path / "scene").exists()


def test_missing_files_are_errors(table, tmp_path):
    with pytest.raises(photohull.Error, match="no/such"):
        photohull.pose("no/such", board=table / "board.json", out=tmp_path / "scene")
    with pytest.raises(photohull.Error, match="no_board.json"):
        photohull.pose(table / "table/images", board=tmp_path / "no_board.json", out=tmp_path / "scene")


def test_a_callback_that_raises_stops_it(table, tmp_path):
    def callback(stage, share, message):
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        photohull.pose(table / "table/images", board=table / "board.json", out=tmp_path / "scene", progress=callback)
    assert not (tmp_path / "scene/transforms.json").exists()


def test_an_interrupt_stops_it(table, tmp_path):
    def callback(stage, share, message):
        if stage == "masks":
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        photohull.pose(table / "table/images", board=table / "board.json", out=tmp_path / "scene", progress=callback)
    assert not (tmp_path / "scene/transforms.json").exists()


@pytest.fixture(scope="module")
def pictures(table):
    scene = photohull.load(table / "table")
    return [scene.image(view) for view in range(len(scene))]


def test_arrays_are_as_good_as_files(table, pictures, tmp_path):
    calls = []
    given = {"board": table / "board.json", "focal": "40mm", "make_masks": False}
    by_file = photohull.pose(table / "table/images", out=tmp_path / "files", **given)
    report = photohull.pose(pictures, out=tmp_path / "scene", progress=lambda *call: calls.append(call), **given)
    assert [photo["name"] for photo in report["photographs"]] == [f"{i:04}.png" for i in range(8)]
    for one, other in zip(report["photographs"], by_file["photographs"]):
        assert {**one, "name": ""} == {**other, "name": ""} and one["posed"]
    assert report["cameras"] == by_file["cameras"] and report["cameras"][0]["stated_focal_length"] > 0
    assert calls[0][0] == "arrays" and calls[-1][1] == 1
    shares = [share for _, share, _ in calls]
    assert shares == sorted(shares)
    scene = photohull.load(tmp_path / "scene")
    assert all(np.array_equal(scene.image(i), picture) for i, picture in enumerate(pictures))


def test_arrays_in_any_order_of_memory_and_of_grey(table, pictures, tmp_path):
    given = {"board": table / "board.json", "make_masks": False}
    grey = [picture[..., 1] for picture in pictures]
    first = photohull.pose(grey, out=tmp_path / "grey", **given)
    strided = [np.asfortranarray(picture) for picture in grey]
    assert photohull.pose(tuple(strided), out=tmp_path / "strided", **given) == first
    stack = np.stack(grey)[..., None]
    stack.setflags(write=False)
    assert photohull.pose(stack, out=tmp_path / "stack", **given) == first
    assert all(photo["posed"] for photo in first["photographs"])


BLACK = np.zeros((6, 8, 3), np.uint8)


@pytest.mark.parametrize("photographs, words, sentence", [
    ([], {}, "photographs: give at least one"),
    ([BLACK, "a.png"], {}, "photographs[1] is a path, and others are arrays"),
    (["a.png", BLACK], {}, "photographs[0] is a path, and others are arrays"),
    ([BLACK, BLACK[0, 0]], {}, "photographs[1] has the shape (3,): expected (height, width)"),
    ([BLACK.astype(np.float32)], {}, "photographs[0] is not of the type uint8"),
    ([BLACK.astype(np.int64)], {}, "photographs[0] is of the type int64"),
    ([7], {}, "photographs[0] has the shape ()"),
    (BLACK, {}, "photographs is one array: give a list of photographs"),
    ([BLACK], {"masks": "folder"}, "masks: expected a list of arrays"),
    (["a.png"], {"masks": [BLACK[..., 0]]}, "masks: expected a folder"),
    ([BLACK] * 2, {"masks": [None]}, "masks has 1 entries for 2 photographs"),
    ([BLACK], {"masks": [BLACK]}, "masks[0] has the shape (6, 8, 3): expected (height, width)"),
    ([BLACK], {"masks": [BLACK[:3, :, 0]]}, "masks[0] is 8 x 3 pixels, but its photograph is 8 x 6"),
    ([BLACK], {"focal": "wide"}, "focal=wide: expected pixels above 0"),
])
def test_what_is_said_of_wrong_arrays(photographs, words, sentence, tmp_path):
    with pytest.raises(photohull.UsageError, match=re.escape(sentence)):
        photohull.pose(photographs, out=tmp_path / "scene", **words)
    assert not (tmp_path / "scene").exists()


def test_a_callback_that_raises_stops_the_writing_of_arrays(table, pictures, tmp_path):
    def callback(stage, share, message):
        raise KeyError(stage)

    with pytest.raises(KeyError, match="arrays"):
        photohull.pose(pictures, board=table / "board.json", out=tmp_path / "scene", progress=callback)
    assert not (tmp_path / "scene/transforms.json").exists()


def test_colmap_that_is_not_there_is_an_error(pictures, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(photohull.Error, match="COLMAP|colmap"):
        photohull.pose(pictures, out=tmp_path / "scene")
    assert not (tmp_path / "scene/transforms.json").exists()


def test_colmap_finds_the_cameras_of_arrays_with_masks(tmp_path):
    assert shutil.which("colmap"), "scripts/test.sh installs it"
    known = photohull.load(os.path.join(os.environ["PHOTOHULL_SOURCE"], "datasets/templeSparseRing"))
    images = [known.image(view) for view in range(len(known))]
    given = [(image.max(axis=2) > 20) for image in images]
    given[3] = None
    report = photohull.pose(images, masks=given, out=tmp_path / "scene", focal=1520)
    posed = [i for i, photo in enumerate(report["photographs"]) if photo["posed"]]
    assert report["with"] == "colmap" and len(posed) >= 8
    assert all(photo["reason"] for photo in report["photographs"] if not photo["posed"])
    assert max(turn_errors(report, known)) < 1
    scene = photohull.load(tmp_path / "scene")
    for view, name in enumerate(scene.names):
        mask = given[int(name[:4])]
        assert (scene.mask(view) is None) == (mask is None)
        assert mask is None or np.array_equal(scene.mask(view) > 0, mask)
