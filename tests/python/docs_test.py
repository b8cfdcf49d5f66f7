"""The documentation of Python's package: its examples run, and stubs and guide say what there is."""
import ast
import doctest
import inspect
import os
import re
from pathlib import Path

import numpy as np
import pytest

import photohull
import photohull._result
from photohull import convert, romi
from photohull._stubs import option_stubs

SOURCE = Path(os.environ["PHOTOHULL_SOURCE"])
STUBS = SOURCE / "python/photohull"
INNER = ("photohull._core", "photohull._errors", "photohull._result")  # whose classes photohull shows as its own


@pytest.mark.parametrize("module", [photohull, convert, romi], ids=lambda module: module.__name__)
def test_examples_of_docstrings(module, monkeypatch):
    monkeypatch.chdir(SOURCE)
    flags = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS
    done = doctest.testmod(module, extraglobs={"photohull": photohull, "np": np}, optionflags=flags)
    assert done.attempted > 0 and done.failed == 0


def test_stubs_of_options_are_those_of_the_library():
    assert (STUBS / "_options.pyi").read_text() == option_stubs(), \
        "write them anew: python3 -m photohull._stubs > python/photohull/_options.pyi"


def names_in(stub):
    """Functions and classes of a stub, with the members of these."""
    found = {}
    for node in ast.parse((STUBS / stub).read_text()).body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and not node.name.startswith("_"):
            members = getattr(node, "body", []) if isinstance(node, ast.ClassDef) else []
            found[node.name] = {m.name for m in members if isinstance(m, ast.FunctionDef)}
    return found


def public_members(object_):
    return {name for name in vars(object_) if not name.startswith("_")}


@pytest.mark.parametrize("stub, module", [("__init__.pyi", photohull), ("romi.pyi", romi), ("convert.pyi", convert)])
def test_stubs_name_all_there_is(stub, module):
    stubs = names_in(stub)
    there = {name for name, value in vars(module).items() if (inspect.isclass(value) or inspect.isfunction(value))
             and not name.startswith("_") and value.__module__ in (module.__name__, *({"photohull": INNER}.get(module.__name__, ())))}
    assert set(stubs) == there
    for name, members in stubs.items():
        if members:
            assert {m for m in members if not m.startswith("_")} == {
                m for m in public_members(getattr(module, name)) if callable(getattr(getattr(module, name), m))
                or isinstance(vars(getattr(module, name))[m], property)}, name


def test_arguments_of_stubs_are_those_of_functions():
    for node in ast.parse((STUBS / "__init__.pyi").read_text()).body:
        if isinstance(node, ast.FunctionDef):
            known = inspect.signature(getattr(photohull, node.name)).parameters
            said = [a.arg for a in node.args.args + node.args.kwonlyargs] + ([node.args.kwarg.arg] if node.args.kwarg else [])
            assert said == list(known), node.name


def test_everything_public_is_documented():
    for name in photohull.__all__:
        value = getattr(photohull, name)
        assert inspect.getdoc(value), name
        if inspect.isclass(value) and value.__module__ == "photohull._result":
            assert all(inspect.getdoc(vars(value)[m]) for m in public_members(value)), name


def scripts_of(page):
    return re.findall(r"```python\n(.*?)```", (SOURCE / page).read_text(), re.DOTALL)


@pytest.mark.parametrize("page, folder_of_plant", [("README.md", False), ("docs/guide/python.md", True)])
def test_scripts_of_pages_run(page, folder_of_plant, sphere, table, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path if folder_of_plant else SOURCE)
    if folder_of_plant:
        os.symlink(sphere, "plant")
        os.symlink(table / "table/images", "photos")
        os.symlink(table / "board.json", "board.json")
    posed = photohull.load(table / "table")
    view = ([1000, 1000, 32, 24], np.eye(3), [0, 0, 1000], np.ones((48, 64), np.uint8))
    scripts = scripts_of(page)
    assert scripts
    names = {"views": [view], "pictures": [posed.image(i) for i in range(len(posed))]}
    for script in scripts:
        exec(compile(script, page, "exec"), names)  # pylint: disable=exec-used
    said = capsys.readouterr().out
    assert not folder_of_plant or re.search(r"volume [\d.]+ \+- [\d.]+", said)


def test_arrays_to_a_measured_plant_take_fifteen_lines():
    lines = scripts_of("docs/guide/python.md")[0].strip().splitlines()
    assert len(lines) <= 15


def test_pages_name_functions_that_there_are():
    page = (SOURCE / "docs/guide/python.md").read_text()
    assert set(re.findall(r"photohull\.(\w+)\(", page)) <= set(photohull.__all__)
