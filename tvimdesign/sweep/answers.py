"""Answers cells one after another in this process: a cell's answer depends on its study alone, not on the others."""

import math
from collections import OrderedDict
from typing import Any

from tvimdesign.base.errors import InfeasibleError, InputError, TimeOverError, TvimError
from tvimdesign.device import Choice
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions, given_profiles
from tvimdesign.solve.anchored_search import AnchoredSearch
from tvimdesign.solve.nlp.constraints import constraints_of, in_words, refuse_impossible
from tvimdesign.solve.nlp.solver_run import ABOVE_RATING, BELOW_YIELD, OPTIMAL
from tvimdesign.solve.optimizer.verify_optimum import exceeded, is_met, sorted_by_acceptance
from tvimdesign.study import Study, drawn, given, read_tree
from tvimdesign.sweep.plan import Cell, CellAnswer, SweepPlan, Texts, set_in

MOST_KEPT = 8  # Problems that stay: cells of one kind mostly follow one another
_LONGEST_REASON = 300  # Letters of a reason at most


class CellAnswers:
    """Answers the cells of a sweep."""

    def __init__(self, plan: SweepPlan) -> None:
        self._plan = plan
        self._searches: OrderedDict[Texts, AnchoredSearch] = OrderedDict()

    def answer(self, cell: Cell) -> CellAnswer:
        """Evaluate or optimise a cell; one that has no design, or is none, says so."""
        try:
            study = read_tree(self._plan.cell_tree(cell.texts))
            refuse_impossible(study)
            return self._evaluated(study) if self._plan.task == "evaluate" else self._optimised(study, cell.texts)
        except InfeasibleError as error:
            return self._nothing("infeasible", error)
        except InputError as error:
            return self._nothing("refused", error)
        except TimeOverError as error:
            return self._nothing("not_converged", error)

    def search_of(self, texts: Texts) -> AnchoredSearch:
        """Return the search for the optimum of a cell: it starts at the optimum for the cell's words."""
        words, axes = self._plan.words(texts), self._plan.block.axes
        if words not in self._searches:
            named = {axis.name: text for axis, text in zip(axes, words, strict=True) if text}
            followed = [axis.name for axis in axes if axis.number]
            tree = set_in(self._plan.tree, list(named), list(named.values()))
            self._searches[words] = AnchoredSearch(read_tree(tree), followed, read_tree(self._plan.tree))
            if len(self._searches) > MOST_KEPT:
                self._searches.popitem(last=False)
        self._searches.move_to_end(words)
        return self._searches[words]

    def _evaluated(self, study: Study) -> CellAnswer:
        study = drawn(study)
        numbers = given(study)
        model = DeviceFunctions(study.table, numbers, tuple(study.operating_points), study.solver.cells)
        values = model.values(model.start, Simulator(model).run(model.start, given_profiles(study)).values)
        stated = {name: float(model.start[i]) for name, i in model.index.items()}
        return self._answer_of("evaluated", study, {**stated, **values}, {**numbers, **model.words})

    def _optimised(self, study: Study, texts: Texts) -> CellAnswer:
        search = self.search_of(texts)
        solution, warm = search.find(study)
        model = solution.model
        stated = {name: float(solution.inputs[i]) for name, i in model.index.items()}
        values = {**stated, **solution.values}
        above, _ = sorted_by_acceptance([limit.output for limit in exceeded(values, study.table)], study.accept)
        status = ABOVE_RATING if above and solution.status in {OPTIMAL, BELOW_YIELD} else solution.status
        word = status.partition(":")[0].partition(",")[0].replace(" ", "_")
        answer = self._answer_of(word, study, values, {**given(study), **stated, **model.words})
        reasons = [f"beyond a rating: {', '.join(above)}"] if above else []
        reasons += [] if word == status else [status]
        if status == BELOW_YIELD and solution.yield_reached:
            reached = solution.yield_reached
            lost = f", most lost to {reached.lost_to[0].text}" if reached.lost_to else ""
            reasons.append(f"yield {reached.together:.1%} of {reached.target:.0%} asked{lost}")
        reasons += [f"the search ended at its time limit of {solution.out_of_time:g} s"] if solution.out_of_time else []
        return answer._replace(reason=_short("; ".join([*reasons, *filter(None, [answer.reason])])), warm=warm)

    def _answer_of(self, status: str, study: Study, values: dict[str, float], chosen: dict[str, Any]) -> CellAnswer:
        limits = constraints_of(study, study.table, chosen)
        violated = [limit for limit in limits if not is_met(limit, values[limit.output], study.table)]
        margins = [-float(limit.residual(values[limit.output])) for limit in limits]
        return CellAnswer(
            status=status,
            reason=_short("; ".join(f"violates {in_words(limit, study.table)}" for limit in violated)),
            violated=len(violated), margin=_number(min(margins, default=math.nan)),
            values=tuple(_value(name, study, values, chosen) for name in self._plan.columns),
        )  # fmt: skip

    def _nothing(self, status: str, error: TvimError) -> CellAnswer:
        return CellAnswer(status, _short(str(error)), None, None, (None,) * len(self._plan.columns))


def _value(name: str, study: Study, values: dict[str, float], chosen: dict[str, Any]) -> float | str | None:
    if isinstance(study.table.by_name.get(name.partition("@")[0]), Choice):
        return str(getattr(chosen[name], "name", chosen[name]))
    return _number(values.get(name, math.nan))


def _number(value: float) -> float | None:
    """Return what is no number is nothing; what never happens stays infinite."""
    return None if math.isnan(value) else float(value)


def _short(text: str) -> str:
    text = " ".join(text.split())
    return text if len(text) <= _LONGEST_REASON else text[: _LONGEST_REASON - 3] + "..."
