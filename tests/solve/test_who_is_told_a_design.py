"""A design is passed on as soon as it exists: its parts start before its account is complete."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from answers import shipped_answer

from tvimdesign.solve import result
from tvimdesign.solve.result import answer
from tvimdesign.study import Study


@pytest.mark.gate
def test_a_design_is_handed_on_before_the_rest_is_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    study = Study.model_validate(shipped_answer("paper_as_published").design.study)
    order: list[Any] = []
    histories = result._histories
    monkeypatch.setattr(result, "_histories", lambda *of: order.append("histories") or histories(*of))
    found = answer(study, designed=lambda design, _: order.append(design))
    assert order[0] is found.design
    assert order[1:] == ["histories"]


@pytest.mark.gate
def test_where_a_search_ends_without_a_design_nothing_is_handed_on() -> None:
    known = shipped_answer("paper_shear")
    assert known.solution
    study = Study.model_validate(known.design.study)
    for status, is_design in (("optimal", True), ("infeasible: this design breaks its limits least", False)):
        told: list[Any] = []
        solution = replace(known.solution, status=status)
        found = answer(
            study, search=lambda *_, of=solution: of, designed=lambda design, _, told=told: told.append(design)
        )
        assert (bool(told), found.found) == (is_design, is_design)
