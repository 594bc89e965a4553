"""A sweep's cells are the designs that its studies have on their own; progress shows where it is seen."""

import sys
import threading
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support import cases_of

import tvimdesign as tvim
from tvimdesign.api.notebook import in_notebook, shown_progress
from tvimdesign.solve.nlp.solution import SAME_OPTIMUM

EVALUATED = {"coil_count": [3.0, 3.5], "wire_diameter": ["2 mm", "2.4 mm"]}


@pytest.fixture(scope="module")
def optimised(study: tvim.Study) -> tvim.Sweep[tvim.Study]:
    # Where on its circle the coil ends decides how much leg and tang bend, so that each turn of the coil count has
    # optima of its own; a cell that begins at its neighbour's stays with that kind. Here all have the range of one end.
    return study.vary(coil_count=[3, 3.1]).sweep(pcl_thickness=(np.linspace(0.6, 0.8, 3), "mm"), progress=False)


@pytest.fixture(scope="module")
def grid() -> tvim.Sweep[tvim.Study]:
    return tvim.example("paper_reconstructed").sweep(EVALUATED, progress=False)


@pytest.mark.slow
def test_cell_at_the_optimum_is_the_optimum(optimised, result):
    assert result["pcl_thickness"].magnitude == pytest.approx(0.6, rel=1e-6)  # the end of its range, which is active
    # Mass and volume trade along a flat valley there, so what is minimised says whether it is the same optimum.
    reference, weights = result.design.solution["reference"], result.design.study["minimize"]
    first = dict(zip(optimised.plan.columns, optimised.stored_cells[0].values, strict=True))
    cell, alone = (
        sum(w * values[n] / reference[n] for n, w in weights.items()) for values in (first, result.design.values)
    )
    assert cell == pytest.approx(alone, rel=SAME_OPTIMUM)


@pytest.mark.slow
def test_a_warm_cell_is_what_its_study_has_from_every_start(optimised):
    assert optimised.warm_solves == 3
    cell = optimised[2]
    assert cell.result is not None
    minimized = dict(cell.study.resolved.minimize)
    cold = cell.study.run(progress=False)
    # The cold run divides by its own start, so its goal is another one: of either goal each design is the best.
    for warm, other in ((cold, cell.result), (cell.result, cold)):
        reference = warm.design.solution["reference"]
        own, others = (sum(w * r.design.values[n] / reference[n] for n, w in minimized.items()) for r in (warm, other))
        assert own <= others * (1 + 1e-5)


def test_cells_are_single_evaluations_with_units_beside_the_table(grid):
    table = grid.table("spring_stiffness", "module_mass")
    assert table[["coil_count", "wire_diameter"]].to_numpy().tolist() == [
        [pytest.approx(n), pytest.approx(d)] for n in (3.0, 3.5) for d in (2.0, 2.4)
    ]
    alone = tvim.example("paper_reconstructed").set(coil_count=3.5, wire_diameter="2.4 mm").evaluate(progress=False)
    assert table.spring_stiffness[3] == pytest.approx(alone["spring_stiffness"].magnitude, rel=1e-12)
    assert grid.warm_solves == 0
    table = grid.table("spring_stiffness")
    shape = table.wire_diameter**4 / table.coil_count
    assert np.ptp(table.spring_stiffness / shape) < 1e-9 * float((table.spring_stiffness / shape).iloc[0])
    units = grid.table("module_mass").attrs["units"]
    assert units == {"coil_count": "1", "wire_diameter": "mm", "module_mass": "g"}
    assert "wire_diameter [mm]" in grid._repr_html_()


@pytest.mark.slow
def test_a_table_has_the_verdicts_of_its_cells():
    study = tvim.example("paper_reconstructed").set({"tolerances": {"pcl_thickness": "0.1 mm"}})
    table = study.sweep(coil_count=[3.0], progress=False).table("module_mass", verdicts=True)
    assert list(table.columns[:3]) == ["coil_count", "status", "verdict"]
    assert table.verdict[0] == study.set(coil_count=3.0).evaluate(progress=False).verdict


@pytest.mark.gate
def test_requirements_may_be_swept(study):
    lean = study.set({"solver.starts": 1})
    sweep = lean.sweep({"require.holding_torque": [">= 10 N.m", ">= 14 N.m"]}, progress=False)
    table = sweep.table("holding_torque", "module_mass")
    assert list(table["require.holding_torque"]) == [10.0, 14.0]
    assert table.holding_torque.tolist() == [pytest.approx(10.0, rel=1e-4), pytest.approx(14.0, rel=1e-4)]
    assert sweep.warm_solves == 0


@cases_of("api_sweep", "refused")
def test_what_cannot_be_swept_is_refused_before_anything_is_solved(study, axes, message):
    with pytest.raises(tvim.InputError, match=message):
        study.sweep(axes, progress=False)


def test_a_figure_has_a_line_for_each_value_of_the_second_axis(grid):
    (axes,) = grid.plot("spring_stiffness").axes
    assert len(axes.lines) == 2
    assert axes.get_xlabel() == "coil count"
    assert axes.get_ylabel() == "spring stiffness (N·m/rad)"


def test_the_study_s_section_is_swept_and_samples_lie_between_its_ends():
    study = tvim.example("paper_reconstructed")
    own = study.set({"sweep.over": {"wire_diameter": {"from": "2 mm", "to": "2.4 mm"}}})
    sweep = own.sweep(method="latin_hypercube", count=4, seed=3, progress=False)
    wires = sorted(sweep.table("module_mass").wire_diameter)
    assert [int((wire - 2.0) / 0.1) for wire in wires] == [0, 1, 2, 3]  # one in each quarter
    assert own.sweep(method="latin_hypercube", count=4, seed=4, progress=False)[0].at != sweep[0].at


@pytest.mark.gate
def test_workers_and_a_folder_give_the_table_of_this_process(grid, tmp_path):
    study = tvim.example("paper_reconstructed")
    outputs = ["spring_stiffness"]
    stored = study.sweep(EVALUATED, outputs=outputs, out=tmp_path / "sweep", workers=2, progress=False)
    names = ("module_mass", "spring_stiffness")
    assert stored.table(*names).equals(grid.table(*names))
    assert (tmp_path / "sweep/cells.csv").exists()
    with pytest.raises(tvim.InputError, match="not kept by this sweep"):
        stored.table("spring_mass")
    with pytest.raises(tvim.InputError, match="name it with out="):
        study.sweep(EVALUATED, workers=2)


@pytest.fixture
def notebook(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Stand in for a notebook's kernel, as far as progress needs it; return what it shows."""
    messages: list[str] = []

    def note(data: dict[str, str], **how: bool) -> Any:
        assert how["raw"]
        messages.append(data["text/plain"])
        return SimpleNamespace(update=note)

    kernel, display = ModuleType("IPython"), ModuleType("IPython.display")
    monkeypatch.setattr(kernel, "get_ipython", lambda: SimpleNamespace(kernel=object()), raising=False)
    monkeypatch.setattr(display, "display", note, raising=False)
    monkeypatch.setitem(sys.modules, "IPython", kernel)
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    return messages


def test_a_notebook_s_line_is_empty_in_the_end_and_after_an_error(study, notebook):
    assert in_notebook()
    study.evaluate()
    assert "... simulating one working cycle" in notebook
    assert notebook[-1] == ""
    notebook.clear()
    study.evaluate(progress=False)
    assert notebook == []

    def work() -> None:
        with shown_progress(True) as say:
            say("working")
            raise KeyError

    with pytest.raises(KeyError):
        work()
    assert notebook == ["...", "... working", ""]


def test_a_pipe_sees_lines_and_a_thread_nothing(study, capfd):
    with shown_progress(True) as say:
        say("working")
    assert capfd.readouterr() == ("", "... working\n")
    failed: list[BaseException] = []

    def work() -> None:
        try:
            study.evaluate()
        except BaseException as error:
            failed.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert failed == []
