"""The documents: every block of Python runs, and every name is described."""

import doctest
import importlib
import inspect
import re
from pathlib import Path

import pytest

import gdel

DOCUMENTS = Path(__file__).parent.parent
BLOCK = re.compile(r"(?:<!-- needs: (.*?) -->\n)?```python\n(.*?)```", re.DOTALL)


@pytest.mark.parametrize("page", ["README.md", "docs/tutorials.md", "docs/api.md"])
def test_blocks_run(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names = {}
    for needed, block in BLOCK.findall((DOCUMENTS / page).read_text()):
        try:
            for module in filter(None, needed.split(", ")):
                if module == "CUDA":
                    if not importlib.import_module("torch").cuda.is_available():
                        raise ImportError
                else:
                    importlib.import_module(module)
        except ImportError:
            continue
        exec(compile(block, page, "exec"), names)


PARTS = ["balls", "constrained", "delaunay", "voronoi", "interpolate", "derived", "transport"]
MODULES = ["", *(f"._{part}" for part in PARTS), ".dask", ".scipy"]


@pytest.mark.parametrize("module", MODULES)
def test_examples_of_docstrings(module):
    found = doctest.testmod(importlib.import_module("gdel" + module))
    assert found.failed == 0


def test_the_api_page_is_complete():
    page = (DOCUMENTS / "docs/api.md").read_text()
    for name in gdel.__all__:
        assert f"`{name}" in page, name
        item = getattr(gdel, name)
        if inspect.isclass(item):
            members = [member for member in vars(item) if not member.startswith("_")]
            missing = [member for member in members if f"`{member}" not in page and f".{member}" not in page]
            assert not missing, (name, missing)
