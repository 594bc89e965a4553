"""Boxes that the search leaves as infeasible, compared with every combination solved alone from several starts.

All combinations are requested, so that no box is left for its bound.
"""

import itertools
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from choosing import with_each_record
from support import ROOT

from tvimdesign.solve.discrete.discrete_choices import Box, discrete_sizes, is_one
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.infeasibility.feasibility_screen import NOWHERE
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.solve.nlp.solver_run import NO_DESIGN, NO_MODULE, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.search import optimize
from tvimdesign.study import Study, read_study_text, read_tree
from tvimdesign.study.tree import tree_of_text, with_settings

SOLVER = ("solver.starts=2", "solver.cells=6", "solver.fineness=0.67", "solver.alternatives=32")
SHELVES = {
    # Four of its heaters; two are too large for three arcs.
    "shelf": (
        "vary.peltier_module={choose: [ma10_063_05_1, ma10_063_03, pc_128_10_05, pc_072]}",
        "vary.wire_diameter={choose: [1.6 mm, 1.7018 mm, 1.8034 mm]}", "vary.spring_pairs={choose: [2, 3]}",
        "vary.process={choose: [print_pc]}", "vary.spring_material={choose: [music_wire]}",
        "vary.tiles_per_arc={choose: [2]}",
    ),
    # Wire too thin, and heaters that the cycle alone rules out.
    "shelf_compression": (
        "vary.peltier_module={choose: [silicone_9ar_02_24v, silicone_9ar_08_24v, polyimide_foil_24v, "
        "silicone_9ar_04_12v]}",
        "vary.wire_diameter={choose: [2.1 mm, 2.4 mm]}", "vary.process={choose: [print_abs, print_pc]}",
        "vary.spring_material={choose: [chrome_silicon]}", "vary.coil_count=[3, 5]", "require.peak_voltage=<= 9 V",
    ),
}  # fmt: skip
"""Studies of `benchmarks/` with shorter lists."""


def shelf(name: str) -> Study:
    text = (ROOT / f"benchmarks/{name}.yaml").read_text(encoding="utf-8")
    return read_tree(with_settings(tree_of_text(text, f"{name}.yaml", name, Path()), [*SHELVES[name], *SOLVER]))


SEVERAL = 3
"""Starts of each combination alone."""


@pytest.mark.slow
@pytest.mark.parametrize("name", SHELVES)
def test_no_combination_in_them_has_one(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    left: list[tuple[Relaxation, Box]] = []
    searched = Relaxation.best_within

    def watched(self: Relaxation, box: Box, near: Run | None) -> tuple[Run | None, bool]:
        run, certain = searched(self, box, near)
        if run is None and certain:
            left.append((self, box))
        return run, certain

    monkeypatch.setattr(Relaxation, "best_within", watched)
    study = shelf(name)
    solution = optimize(study)
    choosing = solution.choosing
    alone = with_each_record(study, solution.reference, SEVERAL)
    assert 0 < len(alone) < choosing.combinations
    assert any(not is_one(box) for _, box in left)
    assert not {tuple(tree.choices(one).values()) for tree, box in left for one in _each(box)} & alone.keys()
    told = {tuple(one.choices.values()): one.objective for one in choosing.best}
    assert all(told[one] <= objective * (1.0 + 1e-6) for one, objective in alone.items())
    assert choosing.without_design + len(told) == choosing.combinations


def _each(box: Box) -> list[Box]:
    """Return every combination in a box."""
    places = [range(first, last + 1) for first, last in box]
    return [tuple((place, place) for place in one) for one in itertools.product(*places)]


STUDY = """
mode: shear
vary: {coil_count: {from: 3, to: 5, step: 1}, current: [0.5 A, 2.5 A]}
minimize: module_mass
solver: {cells: 6, starts: 1}
"""
OVER = "Maximum_Iterations_Exceeded"


@pytest.fixture(scope="module")
def tree() -> tuple[Relaxation, Run]:
    study = read_study_text(STUDY, "test")
    relaxation = Relaxation(0, Optimizer(study), {}, discrete_sizes(study, study.table), SolverEffort())
    return relaxation, relaxation.optimizer.solve()


@pytest.mark.parametrize(
    ("cold", "box", "certain", "searches"),
    [(NO_DESIGN, ((1, 1),), True, 2), (OVER, ((1, 1),), False, 2), (NO_DESIGN, ((0, 1),), False, 1)],
)  # fmt: skip
def test_a_warm_run_cut_short_leaves_several_combinations_open(
    tree: tuple[Relaxation, Run], monkeypatch: pytest.MonkeyPatch,
    cold: str, box: Box, certain: bool, searches: int,
) -> None:  # fmt: skip
    """Several are searched from one place alone: their halves are asked the same."""
    relaxation, near = tree
    asked: list[str] = []

    def ending(status: str) -> Callable[..., Any]:
        def ended(*_: Any, **_begin: Any) -> Run:
            asked.append(status)
            return replace(near, start=replace(near.start, status=status, converged=False))

        return ended

    monkeypatch.setattr(relaxation, "_screened", lambda *_: False)
    monkeypatch.setattr(relaxation, "_beside", ending(OVER))
    monkeypatch.setattr(relaxation, "_solved", ending(cold))
    assert relaxation.best_within(box, near) == (None, certain)
    assert asked == [OVER] + [cold] * searches


def beginning_nowhere(relaxation: Relaxation, monkeypatch: pytest.MonkeyPatch, near: Run) -> list[str]:
    """Let the first run within a box begin at no module; the endings of all runs."""
    solved, endings = relaxation._solved, list[str]()

    def first_fails(*known: Any, **words: Any) -> Run:
        run = solved(*known, **words)
        if not endings:
            run = replace(near, start=replace(near.start, status=NO_MODULE, converged=False))
        endings.append(run.start.status)
        return run

    monkeypatch.setattr(relaxation, "_screened", lambda *_: False)
    monkeypatch.setattr(relaxation, "_solved", first_fails)
    return endings


def test_if_no_run_can_start_differential_evolution_finds_a_module(
    tree: tuple[Relaxation, Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Legs that do not reach their pins, say: the run nearby with another size in it is no module."""
    relaxation, near = tree
    endings = beginning_nowhere(relaxation, monkeypatch, near)
    found, certain = relaxation.best_within(((1, 1),), None)
    assert certain
    assert found.start.converged
    assert found.start.end["coil_count"] == pytest.approx(4.0)
    assert len(endings) == 2


def test_no_module_by_differential_evolution_is_certainly_no_design(
    tree: tuple[Relaxation, Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    relaxation, near = tree
    endings = beginning_nowhere(relaxation, monkeypatch, near)
    monkeypatch.setattr(relaxation._screen, "worst", lambda unknowns: np.full(unknowns.shape[1], NOWHERE))
    assert relaxation.best_within(((1, 1),), None) == (None, True)
    assert endings == [NO_MODULE]
