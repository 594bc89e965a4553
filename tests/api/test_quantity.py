"""Quantities are those of pint; `import tvimdesign` names all that is public and loads nothing heavy."""

import ast
import math
import subprocess
import sys

import pint
import pytest
from support import ROOT

import tvimdesign as tvim
from tvimdesign.api.tables import quantity
from tvimdesign.device import Choice, table_for


def test_quantities_are_pints_and_mix_with_a_users_own() -> None:
    assert tvim.Quantity is pint.Quantity
    mine = pint.get_application_registry()
    for value, unit, other, expected in (
        (0.0665, "kg", "g", 66.5), (math.pi, "rad", "deg", 180.0), (373.15, "degC", "degC", 100.0),
        (math.inf, "s", "min", math.inf), (5.0, "N*m/rad", "N*m/deg", math.radians(5.0)), (0.5, "1", "percent", 50.0),
    ):  # fmt: skip
        assert quantity(value, unit).to(other).magnitude == pytest.approx(expected, rel=1e-12)
    torque, stiffness = quantity(12.3456, "N*m"), quantity(5.0, "N*m/rad")
    assert f"{quantity(0.0665, 'g'):.3g~P}" == "66.5 g"
    assert torque > 12_000 * mine.newton * mine.millimeter
    assert (torque / stiffness).to("rad").magnitude == pytest.approx(2.46912)
    with pytest.raises(pint.DimensionalityError):
        torque.to("kg")


def test_units_are_written_in_the_order_of_the_table() -> None:
    assert f"{quantity(8.0, 'N*m'):.4g~P}" == "8 N·m"
    assert f"{quantity(8.0, 'N*m*s/rad'):.4g~P}" == "8 N·m·s/rad"
    formatter = pint.get_application_registry().formatter
    formatter.default_sort_func = lambda items, _: sorted(items, key=lambda item: item[2])
    try:
        assert f"{quantity(8.0, 'N*m'):.4g~P}" == "8 m·N"
    finally:
        formatter.default_sort_func = None


@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_pint_reads_every_unit_of_the_table_alike(mode: str) -> None:
    units = {row.unit for row in table_for(mode).quantities if not isinstance(row, Choice)}
    for unit in units - {"degC"}:  # Hz: SI has cycles a second here, as pint does
        assert quantity(1.0, unit).to_base_units().magnitude == pytest.approx(1.0, rel=1e-12), unit


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


def test_public_names_are_there_and_on_the_page() -> None:
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
    page = (ROOT / "docs/python.md").read_text()
    left_out = {"__version__", "Cell", "Parts", "Reasons", "Result", "Sweep", "Design"}  # what calls return
    assert [name for name in tvim.__all__ if name not in left_out and name not in page] == []
    for kind in (tvim.Study, tvim.Result, tvim.Sweep):
        calls = [name for name in vars(kind) if not name.startswith("_") and name not in {"of", "resolved"}]
        assert [
            name for name in calls if f".{name}" not in page and name not in {"name", "mode", "cells", "axes"}
        ] == []
