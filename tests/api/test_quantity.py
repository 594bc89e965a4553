"""Quantities know their unit; `import tvimdesign` names all that is public and loads nothing heavy."""

import ast
import math
import subprocess
import sys

import pytest
from support import ROOT

import tvimdesign as tvim


@pytest.mark.parametrize(
    ("quantity", "unit", "value"),
    [
        (tvim.Quantity(66.5, "g"), "kg", 0.0665),
        (tvim.Quantity(1.0, "in"), "mm", 25.4),
        (tvim.Quantity(100.0, "degC"), "degC", 100.0),
        (tvim.Quantity(180.0, "deg"), "rad", math.pi),
        (tvim.Quantity(math.inf, "s"), "min", math.inf),
    ],
    ids=str,
)
def test_other_units(quantity: tvim.Quantity, unit: str, value: float) -> None:
    assert quantity.to(unit).value == pytest.approx(value, rel=1e-12)
    assert quantity.to(unit).unit == unit


def test_a_quantity_is_written_with_its_unit_and_has_si() -> None:
    torque = tvim.Quantity(12.3456, "N*m")
    assert (str(torque), f"{torque:.1f}", float(torque)) == ("12.35 N·m", "12.3 N·m", 12.3456)
    assert str(tvim.Quantity(0.5)) == "0.5"
    assert tvim.Quantity(0.0, "degC").si == pytest.approx(273.15)
    assert tvim.Quantity.parse("2 mm").si == pytest.approx(2e-3)
    assert tvim.Quantity.parse("3.25") == tvim.Quantity(3.25, "1")
    with pytest.raises(tvim.UnitError, match="expected a length"):
        tvim.Quantity(1.0, "g").to("mm")


def test_linspace_has_both_ends_and_the_first_unit() -> None:
    found = tvim.linspace("0.6 mm", "0.2 cm", 8)
    assert [q.unit for q in found] == ["mm"] * 8
    assert [q.value for q in found] == pytest.approx([0.6 + 0.2 * i for i in range(8)])
    assert [q.value for q in tvim.linspace(1, 3, 3)] == [1.0, 2.0, 3.0]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [(("1 mm", "2 s", 3), "expected"), (("1 mm", "2 mm", 1), "two or more"), (("1 furlong", "2 mm", 3), "no unit"),
     (("thick", "2 mm", 3), "does not start with a number")],
)  # fmt: skip
def test_what_linspace_refuses(arguments: tuple[str, str, int], said: str) -> None:
    with pytest.raises(tvim.InputError, match=said):
        tvim.linspace(*arguments)


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
    found = loaded_by("import tvimdesign as t; r = t.example('paper_reconstructed').evaluate(progress=False)")
    assert not {"pandas", "matplotlib"} & set(found)  # scipy is loaded by numba, which runs the engine


def test_public_names_are_there_also_for_type_checkers() -> None:
    for name in tvim.__all__:
        assert getattr(tvim, name) is not None
    assert set(tvim.__all__) == set(dir(tvim))
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        getattr(tvim, "noth" + "ing")
    stub = ast.parse((ROOT / "tvimdesign/__init__.pyi").read_text())
    imported = {
        (line.module, alias.asname) for line in stub.body if isinstance(line, ast.ImportFrom) for alias in line.names
    }
    assert imported == {(module, name) for module, names in tvim._PUBLIC.items() for name in names}
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
