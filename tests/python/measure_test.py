"""Measurements: of shapes whose figures are known, by Python and by the command line."""
import csv
import io
import json
import subprocess

import numpy as np
import pytest

import photohull


def test_a_sphere(sphere, result):
    measured = result.measure()
    truth = photohull.evaluate(result, sphere, samples=1000)["volume"]
    assert measured["closed"] and measured["volume"]["value"] == pytest.approx(truth["recon"], rel=0.005)
    radius = (3 * measured["volume"]["value"] / (4 * np.pi)) ** (1 / 3)
    assert measured["area"]["value"] == pytest.approx(4 * np.pi * radius**2, rel=0.05)
    assert measured["height"]["value"] == pytest.approx(2 * radius, rel=0.1)
    assert measured["hull_volume"]["value"] >= measured["volume"]["value"]
    assert measured["hull_volume"]["value"] == pytest.approx(measured["volume"]["value"], rel=0.1)
    for name in ("volume", "area", "height", "hull_volume"):
        assert 0 < measured[name]["uncertainty"] < measured[name]["value"], name


def test_sections_add_up_to_the_volume(result):
    measured = result.measure(axis="x", sections=200)
    assert measured["axis"] == [1, 0, 0] and len(measured["sections"]) == 200
    areas = [section["area"]["value"] for section in measured["sections"]]
    slab = measured["height"]["value"] / 200
    assert sum(areas) * slab == pytest.approx(measured["volume"]["value"], rel=1e-3)
    low, high = np.array(measured["box"]["min"]), np.array(measured["box"]["max"])
    vertices = result.mesh.vertices
    assert np.allclose(low, vertices.min(axis=0)) and np.allclose(high, vertices.max(axis=0))
    assert measured["sections"][0]["position"] == pytest.approx(low[0] + slab / 2)


def test_the_oriented_box_holds_the_mesh_and_is_no_larger(result):
    measured = result.measure()
    box = measured["oriented_box"]
    axes, size = np.array(box["axes"]), np.array(box["size"])
    assert np.allclose(axes @ axes.T, np.eye(3)) and np.linalg.det(axes) == pytest.approx(1)
    inside = np.abs((result.mesh.vertices - box["center"]) @ axes.T) - size / 2
    assert inside.max() < 1e-6 * size.max()
    assert size[0] >= size[1] >= size[2]
    assert size.prod() <= measured["box"]["volume"]["value"] * (1 + 1e-9)


def test_the_command_line_says_the_same(result, program, tmp_path):
    result.write(tmp_path / "out")
    known = photohull.measure(tmp_path / "out", sections=4)
    said = subprocess.run([program, "measure", "out", "--sections", "4", "--json"], cwd=tmp_path, check=True,
                          capture_output=True, text=True).stdout
    assert json.loads(said) == known
    assert known["volume"]["value"] == pytest.approx(result.measure()["volume"]["value"], rel=1e-5)
    table = subprocess.run([program, "measure", "out", "out", "--csv"], cwd=tmp_path, check=True, capture_output=True,
                           text=True).stdout
    rows = list(csv.DictReader(io.StringIO(table)))
    assert [row["name"] for row in rows] == ["out", "out"]
    assert float(rows[0]["volume"]) == pytest.approx(known["volume"]["value"], rel=1e-6)
    assert float(rows[1]["height_uncertainty"]) == pytest.approx(known["height"]["uncertainty"], rel=1e-6)


def test_an_open_mesh_has_no_volume(sphere, program, tmp_path):
    result = photohull.hull(sphere, views="0-4", resolution=32, unseen="open", report_page="off")
    measured = result.measure()
    assert not measured["closed"] and measured["volume"] is None and measured["sections"] == []
    assert measured["area"]["value"] > 0
    result.write(tmp_path / "open")
    said = subprocess.run([program, "measure", tmp_path / "open"], check=True, capture_output=True, text=True).stdout
    assert "not known: the mesh is open" in said


@pytest.mark.parametrize("options, sentence", [({"axis": "w"}, "axis=w: expected one of up, x, y, z"),
                                               ({"sections": -1}, "sections=-1: expected 0 to 10000"),
                                               ({"section": 3}, "did you mean sections?")])
def test_what_is_said_of_bad_options(result, options, sentence):
    with pytest.raises(photohull.UsageError, match=sentence):
        result.measure(**options)


def test_what_the_command_line_says_of_bad_arguments(program, tmp_path):
    for words, code, sentence in ((["a", "b", "--json"], 2, "--json is for one folder"), (["a", "--json", "--csv"], 2, "exclude"),
                                  ([str(tmp_path)], 1, "report.json"), ([""], 2, "DIR is empty")):
        done = subprocess.run([program, "measure", *words], capture_output=True, text=True, check=False)
        assert done.returncode == code and sentence in done.stderr, done.stderr
