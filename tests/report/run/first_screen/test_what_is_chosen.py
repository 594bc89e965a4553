"""The line of what was chosen names the design's own choice, and says that the ranking is one without margins."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from tvimdesign.device import table_for
from tvimdesign.report.run.first_screen.verdict import chosen_lines
from tvimdesign.solve.nlp.solution import Choosing, SolverEffort, Standard
from tvimdesign.solve.result import StudyResult

RANKED = ((1.0e-3, 0.6339), (1.1e-3, 0.6426), (1.2e-3, 0.6541))
"""Wires and objectives of the printed elbow's search."""


def line(own: float, robust: dict[str, Any] | None, spring: str = "none") -> str:
    """The line of a design with this wire [m], whose study asks for margins or not."""
    best = tuple(Standard({"wire_diameter": wire, "stock_spring": "none"}, objective, {}) for wire, objective in RANKED)
    none = SolverEffort()
    choosing = Choosing(
        20, 20, 0, 0, best=best, between=None, proven=False, improved=0.0, work=none, proof=none, inside=0.0
    )
    design = SimpleNamespace(values={"wire_diameter": own}, choices={"stock_spring": spring}, study={"robust": robust})
    answer = SimpleNamespace(solution=SimpleNamespace(choosing=choosing), design=design)
    return " ".join(" ".join(chosen_lines(cast(StudyResult, answer), table_for("shear"), 400)).split())


def test_without_margins_the_best_of_the_ranking_is_the_design() -> None:
    said = line(1.0e-3, None)
    assert said.startswith(
        "Chosen wire_diameter 1 mm · stock_spring none · best of 20 combinations · the next is 1.4 %"
    )
    assert "1.4 % worse: wire_diameter 1.1 mm" in said
    assert "margins" not in said


@pytest.mark.parametrize("robust", [{"share": 0.95, "sigma": None}, {"share": None, "sigma": 2.0}])
def test_with_margins_the_design_s_own_choice_is_named_and_the_ranking_is_said_to_be_without(
    robust: dict[str, Any],
) -> None:
    said = line(1.1e-3 * (1 + 1e-12), robust)
    assert said.startswith("Chosen wire_diameter 1.1 mm · stock_spring none · with margins, of 20 combinations")
    assert "ranked without margins, the best is wire_diameter 1 mm" in said
    assert "the next is 1.4 % worse: the one chosen" in said
    assert "the third is 3.2 % worse: wire_diameter 1.2 mm" in said
    same = line(1.0e-3, robust)
    assert "best of 20 combinations, ranked without margins" in same
    assert "the best is" not in same


def test_a_record_that_the_margins_changed_is_the_design_s_own_too() -> None:
    said = line(1.0e-3, {"share": 0.95, "sigma": None}, "central_t10160")
    assert said.startswith("Chosen wire_diameter 1 mm · stock_spring central_t10160")
    assert "the best is stock_spring none" in said
