"""`import tvimdesign` names everything public, loads nothing heavy, and the page on Python speaks of all of it."""

from __future__ import annotations

import ast
import subprocess
import sys

import pytest
from support import ROOT

import tvimdesign as tvim

HEAVY = ("casadi", "numpy", "pandas", "scipy", "matplotlib", "pint", "cadquery", "pydantic", "rich", "typer")


def loaded_by(code: str) -> list[str]:
    ended = f"{code}\nimport sys; print(*sorted(set({HEAVY!r}) & set(sys.modules)))"
    return subprocess.run(
        [sys.executable, "-c", ended], capture_output=True, text=True, cwd=ROOT, check=True
    ).stdout.split()


def test_the_import_loads_no_library() -> None:
    assert loaded_by("import tvimdesign; dir(tvimdesign); tvimdesign.__version__; tvimdesign.InputError") == []


@pytest.mark.gate
def test_a_run_from_python_waits_for_pandas_until_a_table_is_asked_for() -> None:
    found = loaded_by("import tvimdesign as t; r = t.example('paper_as_published').evaluate(progress=False)")
    assert not {"pandas", "matplotlib"} & set(found)  # scipy is loaded by numba, which runs the engine


def test_every_public_name_is_there() -> None:
    for name in tvim.__all__:
        assert getattr(tvim, name) is not None
    assert set(tvim.__all__) == set(dir(tvim))
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        getattr(tvim, "noth" + "ing")


def test_type_checkers_see_the_same_names() -> None:
    stub = ast.parse((ROOT / "tvimdesign/__init__.pyi").read_text())
    imported = {
        (line.module, alias.asname) for line in stub.body if isinstance(line, ast.ImportFrom) for alias in line.names
    }
    assert imported == {(module, name) for module, names in tvim._PUBLIC.items() for name in names}


def test_every_error_is_a_tvim_error() -> None:
    errors = [getattr(tvim, name) for name in tvim.__all__ if name.endswith("Error")]
    assert len(errors) == 9
    assert all(issubclass(error, tvim.TvimError) for error in errors)


def test_the_page_speaks_of_every_public_name() -> None:
    page = (ROOT / "docs/python.md").read_text()
    left_out = {"__version__", "Cell", "Parts", "Reasons", "Result", "Sweep", "Design"}  # what calls return
    assert [name for name in tvim.__all__ if name not in left_out and name not in page] == []
    for kind in (tvim.Study, tvim.Result, tvim.Sweep):
        calls = [name for name in vars(kind) if not name.startswith("_") and name not in {"of", "resolved"}]
        assert [
            name for name in calls if f".{name}" not in page and name not in {"name", "mode", "cells", "axes"}
        ] == []
