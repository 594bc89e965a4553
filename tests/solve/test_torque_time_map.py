"""The walk over torque and cycle time, by searches whose answers are known."""

import math

import pytest

from tvimdesign.solve.pareto.tradeoff import Failure, Point
from tvimdesign.solve.torque_time_map import CYCLE, EMPTY, HOT, MASS, TORQUE, TRADED, UNANSWERED, _Walk

PART = "seal_torque"
"""The part whose torque is bounded in place of the least."""


class Trade:
    """Searches of modules whose mass falls with the cycle, down to the fastest cycle, up to the largest torque."""

    def __init__(self, *, reach=math.inf, infeasible=True, fastest=lambda torque: 40.0 * math.sqrt(torque)):
        self.reference = dict.fromkeys((*TRADED, PART), 1.0)
        self.reach, self.infeasible, self.fastest = reach, infeasible, fastest
        self.optimum = self.point(2.0, math.inf)
        self.found, self.warm = [self.optimum], []

    def point(self, torque, cycle):
        values = {TORQUE: torque, CYCLE: min(cycle, 200.0), HOT: 0.1 * torque}
        return Point("", {**values, MASS: torque * (1.0 + 100.0 / values[CYCLE])}, {})

    def weights(self, weights):
        return weights

    def prices(self, point):
        return {f"{TORQUE} >= {point.values[TORQUE]:g}": 1.0}

    def beside(self, point, objective, where, *, warm):
        self.warm.append(warm)
        limits = {name: bound.limit for bound in objective.bounds for name in bound.factors}
        torque, cycle = -limits[PART], limits.get(CYCLE, math.inf)
        if objective.weights[CYCLE] == 1.0:
            return self.point(torque, self.fastest(torque))
        far = abs(math.log(torque / point.values[TORQUE])) > self.reach
        if far or torque > 8.0 or cycle < 40.0 * math.sqrt(torque):
            return Failure(where, "", infeasible=self.infeasible and not far)
        self.found.append(self.point(torque, cycle))
        return self.found[-1]


def statuses(trade, torques=(1.0, 2.0, 4.0, 10.0), cycles=(30.0, 60.0, 120.0)):
    walk = _Walk(trade, 0.2, sorted(cycles, reverse=True))
    return {(cell.torque, cell.cycle): cell.status for cell in walk.over(torques)}


def test_cells_beyond_the_fastest_or_strongest_design_are_empty():
    expected = {
        (torque, cycle): "optimal" if torque <= 8.0 and cycle >= 40.0 * math.sqrt(torque) else EMPTY
        for torque in (1.0, 2.0, 4.0, 10.0)
        for cycle in (30.0, 60.0, 120.0)
    }
    trade = Trade()
    assert statuses(trade) == expected
    assert len(trade.warm) < 40
    assert statuses(Trade(reach=0.3)) == expected


def test_a_slow_fastest_design_empties_no_cell_of_the_torque_beside():
    trapped = Trade(fastest=lambda torque: 100.0 if torque == 1.0 else 40.0 * math.sqrt(torque))
    assert statuses(trapped)[1.0, 60.0] == "optimal"


@pytest.mark.parametrize("infeasible", [True, False])
def test_a_torque_is_empty_only_if_a_search_ends_at_limits(infeasible):
    status = EMPTY if infeasible else UNANSWERED
    assert statuses(Trade(infeasible=infeasible))[10.0, 120.0] == status
