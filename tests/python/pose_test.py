"""Cameras found from Python: as the command line finds them, refused in sentences, and stopped."""
import json
import os
import shutil
import signal
import subprocess

import numpy as np
import pytest

import photohull

# As small as its tags allow.
SPEC = {
    "geometry": {"shape": "pawn"}, "material": {"base": [0.6, 0.33, 0.16]}, "background": {"colour": [0.1, 0.12, 0.14]},
    "sheet": {"board": "board.json", "fill": 0.6, "hidden": 0.2},
    "image": {"width": 800, "height": 600, "samples": 1, "maps": False}, "truth_samples": 2000,
    "cameras": {"rings": [{"count": 4, "elevation": 32}, {"count": 4, "elevation": 55, "phase": 0.5}], "distance": 3.2, "fill": 0.5},
}


@pytest.fixture(scope="module")
def table(tmp_path_factory, program):
    folder = tmp_path_factory.mktemp("table")
    subprocess.run([program, "board", "--out", folder / "board.pdf"], check=True, capture_output=True)
    (folder / "spec.json").write_text(json.dumps(SPEC))
    photohull.synthesize(folder / "spec.json", folder / "table")
    return folder


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
    assert all(photo["posed"] for photo in report["photographs"]) and report["rms"] < 0.2
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
    with pytest.raises(photohull.UsageError, match=sentence.replace("?", r"\?")):
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
