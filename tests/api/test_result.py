"""Results and quantities in Python."""

import ast
import json
import math
import subprocess
import sys

import matplotlib as mpl
import pandas as pd
import pint
import pytest
from support import ROOT, study_path

import tvimdesign as tvim
from tvimdesign.api.tables import quantity
from tvimdesign.device import Choice, table_for


@pytest.mark.gate
def test_values_are_quantities_and_choices_words(result):
    mass = result["module_mass"]
    assert isinstance(mass, tvim.Quantity)
    assert f"{mass.units:~}" == "g"
    assert mass.to_base_units().magnitude == pytest.approx(result.design.value("module_mass"), rel=1e-12)
    assert result["joint_stiffness@hot"].magnitude == pytest.approx(result.design.value("joint_stiffness@hot"))
    assert result["spring_material"] == "music_wire"
    with pytest.raises(tvim.InputError, match="did you mean 'module_mass'"):
        result["modul_mass"]


@pytest.mark.gate
def test_the_cycle_is_a_frame_of_its_phases_with_units(result):
    cycle = result.cycle
    phases, units = cycle.groupby("phase", sort=False), cycle.attrs["units"]
    assert list(phases.groups)[:2] == ["softening", "stiffening"]
    assert list(units) == list(cycle.columns[1:])
    assert not cycle.loc[cycle.phase != "equilibrium_stiffening"].isna().any().any()
    end = phases.last().loc["softening"]
    for column, name in (("time", "response_time"), ("electrical_energy", "switch_energy")):
        measured = tvim.Quantity(float(end[column]), units[column])
        assert abs(measured - result[name]) <= 0.01 * result[name]
    assert cycle.near_face.min() < 30.0
    assert (units["near_face"], units["joint_stiffness"]) == ("degC", "N*m/rad")


@pytest.mark.gate
def test_the_table_has_value_unit_meaning_and_status(result):
    table = result.table()
    assert list(table.columns)[:4] == ["value", "unit", "meaning", "status"]
    assert set(table.index) == set(result.design.values)
    assert table.loc["module_mass", ["value", "unit"]].tolist() == [result["module_mass"].magnitude, "g"]
    assert table.loc["spring_stiffness", "status"] == "active"
    assert table.loc["wire_diameter", "status"] == "found"
    assert table.loc["stroke", "status"] == "set"
    assert table.loc["spring_density", "status"] == "default"
    assert table.loc["module_mass", "status"] == "computed"
    assert set(table[table.status == "found"].index) == set(result.design.study["vary"])
    torques = result.table("torque")
    assert 1 < len(torques) < len(table)
    assert "holding_torque" in torques.index


def test_requirements_and_reasons_are_those_of_the_study(result):
    table = result.requirements()
    rows = table[table.origin == "require"]
    limits = " ".join(rows.limit)
    for limit in result.design.study["require"]:
        name, at, point = limit["output"].partition("@")
        shear = table_for("shear")
        for part in shear.output(name).least_of or (name,):
            assert (f"{part}{at}{point}" in limits) == shear.output(part).exists(result.design.choices)
    # Ten limits: two are on the least of several, listed one by one, and two on the stiffness, at five angles.
    assert (len(rows), table.met.all()) == (27, True)  # so are the places that the core and the pads' seats yield at
    assert result.table().loc["holding_torque", "status"] == "active"
    assert result.feasible
    assert result.status == "optimal"
    assert result.accepting == ("structure_temperature_margin",)
    assert result.above_rating == ()
    why = result.why()
    assert any("spring_stiffness" in sentence and "costs" in sentence for sentence in why.sentences)
    table = why.table()
    active = table[table.stands == "active"]
    assert len(active) == len(why.sentences)
    assert {"module_mass", "response_time"} <= set(table.columns)
    assert "<p>" in why._repr_html_()


@pytest.mark.slow
def test_intervals_say_what_may_be_and_what_to_measure_first(result):
    table = result.intervals()
    required = {limit["output"] for limit in result.design.study["require"]}
    assert required | {"module_mass", "softening_time", "frozen_time"} <= set(table.index)
    assert (table.low <= table.value + 1e-12 * table.value.abs()).all()
    assert (table.value <= table.high + 1e-12 * table.high.abs()).all()
    soft = table.loc["softening_time"]
    assert soft.low < soft.alone_low < soft["value"] < soft.alone_high < soft.high
    assert soft.measure_first in {entry["name"] for entry in result.uncertainty()["unmeasured"]}
    assert result.uncertainty() is result.data["uncertainty"]
    assert result.uncertainty()["parts_yield"] != result.uncertainty()["ranges_hold"]


def test_figures_are_drawn_and_matplotlib_stays_as_it_was(result):
    before = dict(mpl.rcParams)
    figures = {name: result.plot(name) for name in result.plots}
    assert {"cycle", "impedance", "torque"} <= set(figures)
    assert dict(mpl.rcParams) == before
    for figure in figures.values():
        assert len(figure.axes) > 0
        assert figure._repr_png_()[:4] == b"\x89PNG"  # what a notebook asks for
    with pytest.raises(tvim.InputError, match="there are: cycle"):
        result.plot("cicle")


@pytest.mark.gate
def test_the_command_line_gives_the_same_and_writes_the_same(result, tvimdesign, tmp_path):
    words = (study_path("paper_shear"), "--set", "solver.starts=1", "--no-cad", "--no-plots")
    done = tvimdesign("run", *words, "--out", tmp_path / "run")
    assert done.returncode == 0, done.stderr
    saved = result.save(tmp_path / "saved", plots=False)
    names = {path.relative_to(tmp_path / "run") for path in (tmp_path / "run").rglob("*") if path.is_file()}
    assert {path.relative_to(saved) for path in saved.rglob("*") if path.is_file()} == names
    printed, written = (json.loads((tmp_path / f / "results.json").read_text()) for f in ("run", "saved"))
    assert written["values"].keys() == printed["values"].keys()
    for name, entry in printed["values"].items():
        assert written["values"][name]["value"] == pytest.approx(entry["value"], rel=1e-9), name
    assert tvim.read_design(str(saved / "design.json")) == result.design


def test_results_in_use_and_changed_studies_are_saved_rightly(study, tmp_path):
    changed = study.set(pcl_thickness="1.3 mm").evaluate(progress=False)
    folder = changed.save(tmp_path / "x", plots=False)
    with pytest.raises(tvim.InputError, match="holds results already"):
        changed.save(tmp_path / "x")
    assert changed.save(tmp_path / "x", overwrite=True, plots=False) == folder
    assert tvim.load(folder / "study.yaml").resolved.module["pcl_thickness"] == pytest.approx(1.3e-3)
    assert not list(tmp_path.glob("*.json"))


@pytest.mark.gate
def test_a_study_is_evaluated_as_it_is_drawn_within_two_lines(study):
    drawn = study.evaluate(progress=False)
    assert drawn.status == "evaluated"
    assert drawn["coil_count"].magnitude == pytest.approx(3.25)
    assert "evaluated" in str(drawn.why())
    result = tvim.load(study_path("paper_reconstructed")).evaluate(progress=False)
    assert result["spring_stiffness"].to("N*m/rad").magnitude == pytest.approx(5.6, rel=0.02)  # the paper's Table I


@pytest.mark.gate
def test_no_design_is_an_error_that_has_the_closest_one():
    study = tvim.Study(
        mode="shear",
        vary={"wire_diameter": (1.2, 3.2, "mm"), "coil_diameter": (8, 32, "mm"), "coil_count": [3, 8]},
        require={"spring_stiffness": ">= 20 N.m/rad", "spring_fatigue_safety": ">= 3"},
        minimize="module_mass",
        solver={"starts": 1, "max_iterations": 60},
    )
    with pytest.raises(tvim.NoDesignError, match="no feasible design found") as caught:
        study.run(progress=False)
    assert isinstance(caught.value, tvim.InfeasibleError)
    closest = caught.value.result
    assert not closest.feasible
    assert (closest.table().status == "violated").any()
    assert closest.plots == []


def test_a_notebook_and_show_print_what_a_run_prints(result, capsys):
    shown = result._repr_html_()
    assert "spring_stiffness &gt;= 5.2 N·m/rad" in shown
    assert "optimal" in shown
    assert f"{result['module_mass']:.4g~P}" in shown
    result.show()
    assert "The paper's module, re-optimised" in capsys.readouterr().out


@pytest.mark.gate
def test_a_front_is_sought_without_a_folder(tmp_path):
    study = tvim.load(study_path("paper_shear")).set(
        {"front.points": 3, "front.of": ["response_time", "module_mass"], "solver.starts": 1}
    )
    result = study.run(progress=False)
    assert len(result.data["front"]["points"]) >= 3
    assert "front" in result.plots
    folder = result.save(tmp_path / "front", plots=False)
    assert (folder / "front/01.design.json").exists()
    assert len(pd.read_csv(folder / "front.csv")) == len(result.data["front"]["points"])


@pytest.mark.slow
def test_parts_are_made(result, tmp_path):
    parts = result.parts(tmp_path / "parts", progress=False)
    assert any(file.suffix == ".step" for file in parts.files)
    assert (parts.table()["level"] != "failure").all()


def test_quantities_are_pints_and_mix_with_a_users_own():
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


def test_units_are_written_in_the_order_of_the_table():
    assert f"{quantity(8.0, 'N*m'):.4g~P}" == "8 N·m"
    assert f"{quantity(8.0, 'N*m*s/rad'):.4g~P}" == "8 N·m·s/rad"
    formatter = pint.get_application_registry().formatter
    formatter.default_sort_func = lambda items, _: sorted(items, key=lambda item: item[2])
    try:
        assert f"{quantity(8.0, 'N*m'):.4g~P}" == "8 m·N"
    finally:
        formatter.default_sort_func = None


@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_pint_reads_every_unit_of_the_table_alike(mode):
    units = {row.unit for row in table_for(mode).quantities if not isinstance(row, Choice)}
    for unit in units - {"degC"}:  # Hz: SI has cycles a second here, as pint does
        assert quantity(1.0, unit).to_base_units().magnitude == pytest.approx(1.0, rel=1e-12), unit


HEAVY = ("casadi", "numpy", "pandas", "scipy", "matplotlib", "pint", "cadquery", "pydantic", "rich", "typer")


def loaded_by(code: str) -> list[str]:
    ended = f"{code}\nimport sys; print(*sorted(set({HEAVY!r}) & set(sys.modules)))"
    return subprocess.run(
        [sys.executable, "-c", ended], capture_output=True, text=True, cwd=ROOT, check=True
    ).stdout.split()


def test_the_import_loads_no_library():
    assert loaded_by("import tvimdesign; dir(tvimdesign); tvimdesign.__version__; tvimdesign.InputError") == []


@pytest.mark.gate
def test_a_run_from_python_waits_for_pandas_until_a_table_is_asked_for():
    modules = loaded_by("import tvimdesign as t; r = t.example('paper_reconstructed').evaluate(progress=False)")
    assert not {"pandas", "matplotlib"} & set(modules)  # scipy is loaded by numba, which runs the engine


def test_public_names_are_there_and_on_the_page():
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
