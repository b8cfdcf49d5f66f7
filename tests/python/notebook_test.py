"""The notebook of examples/ runs, by nbconvert where that and a kernel are installed (Debian: python3-nbconvert, python3-ipykernel)."""
import json
import os
from pathlib import Path

import pytest

NOTEBOOK = Path(os.environ["PHOTOHULL_SOURCE"]) / "examples/measure_a_shape.ipynb"


def test_notebook_has_no_outputs():
    """They would be another machine's, and of another day."""
    cells = json.loads(NOTEBOOK.read_text())["cells"]
    assert all(not cell["outputs"] for cell in cells if cell["cell_type"] == "code")


def test_cells_run_in_order(capsys):
    names = {}
    for cell in json.loads(NOTEBOOK.read_text())["cells"]:
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), NOTEBOOK.name, "exec"), names)  # pylint: disable=exec-used
    said = capsys.readouterr().out
    assert "24 photographs" in said and "volume" in said and "#" in said


def test_notebook_runs_by_nbconvert(tmp_path):
    nbformat = pytest.importorskip("nbformat", reason="python3-nbconvert is not installed")
    execute = pytest.importorskip("nbconvert.preprocessors", reason="python3-nbconvert is not installed")
    pytest.importorskip("ipykernel", reason="python3-ipykernel is not installed")
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    execute.ExecutePreprocessor(timeout=600).preprocess(notebook, {"metadata": {"path": str(tmp_path)}})
    said = "".join(output.get("text", "") for cell in notebook.cells for output in cell.get("outputs", []))
    assert "24 photographs" in said
