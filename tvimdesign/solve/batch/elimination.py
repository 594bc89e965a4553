"""Newton's method on sparse equations written out as scalar operations: nothing is left to decide at run time."""

from __future__ import annotations

import math
from typing import Any

from tvimdesign.simulation.working_cycle.casadi_setup import ca


def newton_step(unknowns: Any, equations: Any) -> Any:
    """Unknowns after one exact Newton step on `equations` = 0; both SX columns.

    The Jacobian's entries are eliminated one by one, without pivoting, which equations of heat flow allow: whoever
    couples to fewest goes first (Markowitz), so that chains stay chains and a body beside them goes last.
    """
    jacobian = ca.jacobian(equations, unknowns)
    count = unknowns.numel()
    rows: list[dict[int, Any]] = [{} for _ in range(count)]
    for i, j in zip(*jacobian.sparsity().get_triplet(), strict=True):
        rows[i][j] = jacobian[i, j]
    right = [equations[i] for i in range(count)]
    order = []
    open_rows = set(range(count))
    while open_rows:
        pivot = min(open_rows, key=lambda i: (_cost(rows, i, open_rows), i))
        open_rows.remove(pivot)
        order.append(pivot)
        inverse = 1.0 / rows[pivot][pivot]
        later = {j: entry for j, entry in rows[pivot].items() if j in open_rows}
        for i in sorted(open_rows):
            if pivot in rows[i]:
                factor = rows[i].pop(pivot) * inverse
                right[i] = right[i] - factor * right[pivot]
                for j, entry in later.items():
                    rows[i][j] = rows[i].get(j, 0.0) - factor * entry
        rows[pivot] = {pivot: inverse, **later}
    steps: dict[int, Any] = {}
    for pivot in reversed(order):
        known = sum((entry * steps[j] for j, entry in rows[pivot].items() if j != pivot), right[pivot] * 0.0)
        steps[pivot] = (right[pivot] - known) * rows[pivot][pivot]
    return ca.vertcat(*(unknowns[i] - steps[i] for i in range(count)))


def _cost(rows: list[dict[int, Any]], pivot: int, open_rows: set[int]) -> float:
    """Entries that eliminating a row may fill; a row without a diagonal waits until others have filled it."""
    if pivot not in rows[pivot]:
        return math.inf
    across = sum(j in open_rows for j in rows[pivot]) - 1
    down = sum(pivot in rows[i] for i in open_rows) - 1
    return across * down
