"""The walk over torque and cycle time, by searches whose answers are known."""

import math

import pytest

from tvimdesign.solve.pareto.tradeoff import Failure, Point
from tvimdesign.solve.torque_time_map import CYCLE, EMPTY, HOT, MASS, TORQUE, TRADED, UNANSWERED, _Walk

PART = "seal_torque"
"""The part whose torque is bounded in place of the least."""
TORQUES, CYCLES = (1.0, 2.0, 4.0, 10.0), (30.0, 60.0, 120.0)
MODULES = {(t, c): t <= 8.0 and c >= 40.0 * math.sqrt(t) for t in TORQUES for c in CYCLES}


class Trade:
    """Searches of modules whose mass falls with the cycle, down to the fastest cycle, up to the largest torque."""

    def __init__(self, *, reach=math.inf, infeasible=True, closed=None, softest=0.0):
        """Searches lead to torques within a `reach`; those of a `closed` torque's own designs to no shorter cycle.

        No module is softer than the `softest` [N*m/rad].
        """
        self.reference = dict.fromkeys((*TRADED, PART), 1.0)
        self.reach, self.infeasible, self.closed, self.softest = reach, infeasible, closed, softest
        self.optimum = self.point(2.0, math.inf)
        self.points, self.warm, self.cold = [self.optimum], 0, 0

    def point(self, torque, cycle):
        values = {TORQUE: torque, CYCLE: min(cycle, 200.0), HOT: max(0.1 * torque, self.softest)}
        return Point("", {**values, MASS: torque * (1.0 + 100.0 / values[CYCLE])}, {})

    def progress(self, text):
        assert "N*m in" in text

    def weights(self, weights):
        return weights

    def prices(self, point):
        return {f"{TORQUE} >= {point.values[TORQUE]:g}": 1.0}

    def beside(self, point, objective, where, *, cold):
        self.cold += cold
        self.warm += not cold
        limits = {name: bound.limit for bound in objective.bounds for name in bound.factors}
        torque, cycle = -limits[PART], limits.get(CYCLE, math.inf)
        fastest = max(
            40.0 * math.sqrt(torque), point.values[CYCLE] if torque == point.values[TORQUE] == self.closed else 0.0
        )
        cycle = fastest if objective.weights[CYCLE] == 1.0 else cycle
        far = abs(math.log(torque / point.values[TORQUE])) > self.reach
        stiff = self.point(torque, cycle).values[HOT] > limits.get(HOT, math.inf)
        if far or stiff or torque > 8.0 or cycle < fastest * (1.0 - 1e-9):
            return Failure(where, "", infeasible=self.infeasible and not far)
        self.points.append(self.point(torque, cycle))
        return self.points[-1]


def statuses(trade):
    cells = _Walk(trade, 0.2, sorted(CYCLES, reverse=True)).over(TORQUES)
    return {(cell.torque, cell.cycle): cell.status for cell in cells}


TRADES = {"at once": Trade(), "in steps": Trade(reach=0.3), "from the torque beside": Trade(reach=0.4, closed=1.0)}


@pytest.mark.parametrize("trade", TRADES.values(), ids=TRADES)
def test_cells_beyond_the_fastest_or_strongest_design_are_empty(trade):
    assert statuses(trade) == {place: "optimal" if there else EMPTY for place, there in MODULES.items()}
    assert trade.warm < 100
    assert trade.cold <= 3 * len(TORQUES)


@pytest.mark.parametrize(("infeasible", "status"), [(True, EMPTY), (False, UNANSWERED)])
def test_a_torque_is_empty_only_if_a_search_ends_at_limits(infeasible, status):
    assert statuses(Trade(infeasible=infeasible))[10.0, 120.0] == status


def test_torques_below_the_softest_module_s_are_empty():
    cells = statuses(Trade(infeasible=False, softest=0.25))
    assert {status for (torque, _), status in cells.items() if torque == 1.0} == {EMPTY}
    assert cells[2.0, 120.0] == "optimal"
