"""Records whose own start reaches no design start at the best design with other records."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from support import ROOT

from tvimdesign.base.deadline import Deadline
from tvimdesign.solve.discrete.discrete_choices import discrete_sizes
from tvimdesign.solve.discrete.record_families import families_of
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.discrete.trees import Trees
from tvimdesign.solve.nlp.solver_run import Array, Run
from tvimdesign.study import read_study


@pytest.fixture(scope="module")
def trees() -> list[Relaxation]:
    study = read_study(ROOT / "studies" / "rigid_modules.yaml")
    sizes = discrete_sizes(study, study.table)
    return Trees(study, None, lambda _: None, (), Deadline(600.0), sizes).of(families_of(study))


@pytest.mark.slow
def test_modules_that_no_limit_excludes_reach_an_optimum_from_own_starts(trees: list[Relaxation]) -> None:
    # A mixed start whose joint is soft before it is heated was no place to begin from.
    for tree in trees:
        tree.starts()
        assert tree.optima


@pytest.mark.slow
def test_records_without_an_optimum_are_begun_at_the_others_optimum(
    trees: list[Relaxation], monkeypatch: pytest.MonkeyPatch
) -> None:
    first = trees[0]
    if not first.optima:
        first.starts()
    last, begun = replace(first), list[Array]()  # `last` is as `first` was before anything was solved
    solve = last.optimizer.solve

    def noted(*given: Any, begin: Array, **more: Any) -> Run:
        begun.append(begin)
        return solve(*given, begin=begin, **more)

    monkeypatch.setattr(last.optimizer, "solve", noted)
    (run,) = last.from_other_records([first])
    index, best = last.optimizer.model.index, first.optima[0].start.end
    sizes = [name for name in last.optimizer.study.vary if name in best]
    assert sizes
    assert [begun[0][index[name]] for name in sizes] == pytest.approx([best[name] for name in sizes])
    assert run.start.converged
    assert last.optima == [run]
    assert last.from_other_records([first]) == []
