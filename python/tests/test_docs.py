"""Runs the examples of the documents."""

import inspect
import re

import pytest

import hardpoint

from conftest import ROOT

PAGES = [ROOT / "docs/python.md", ROOT / "docs/scaling.md"]


def blocks(page):
    return re.findall(r"^```python\n(.*?)^```", page.read_text(), re.M | re.S)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_block_of_the_page_runs(page, monkeypatch, tmp_path):
    for package in ("scipy", "openmdao", "jax", "pandas", "distributed", "matplotlib"):
        pytest.importorskip(package)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    monkeypatch.chdir(ROOT)
    found, names = blocks(page), {"__name__": page.stem, "folder": str(tmp_path)}
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    assert len(found) > 2
    for k, block in enumerate(found):
        exec(compile(block, f"{page.name}, block {k + 1}", "exec"), names)


def test_the_reference_has_everything_and_everything_is_documented():
    listed = re.findall(r"^::: hardpoint\.(\w+)$", (ROOT / "docs/python-api.md").read_text(), re.M)
    assert sorted(listed) == sorted(name for name in hardpoint.__all__ if not name.startswith("__"))
    for name in listed:
        thing = getattr(hardpoint, name)
        assert inspect.getdoc(thing), name
        for member, value in vars(thing).items() if inspect.isclass(thing) else ():
            if not member.startswith("_") and (callable(value) or isinstance(value, (property, classmethod))):
                assert inspect.getdoc(getattr(thing, member)), f"{name}.{member}"


@pytest.mark.parametrize("notebook", sorted((ROOT / "python/examples").glob("*.ipynb")), ids=lambda path: path.name)
def test_every_notebook_runs(notebook):
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    read = nbformat.read(notebook, as_version=4)
    assert not any(cell.get("outputs") for cell in read.cells), "notebooks are kept without their outputs"
    nbclient.NotebookClient(read, timeout=None, resources={"metadata": {"path": str(notebook.parent)}}).execute()
    shown = [out["data"] for cell in read.cells for out in cell.get("outputs", []) if "data" in out]
    assert any("<iframe" in data.get("text/html", "") for data in shown)
