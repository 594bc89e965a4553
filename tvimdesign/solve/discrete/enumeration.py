"""Every combination of listed sizes accounted for: solved from its neighbour and afresh, or shown to be no better.

The least that each can cost is known first (`least_cost`); the cheapest is solved, and so on until no other can be
better than those found. Without that, all are solved: slow, and what the bounds are held against.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from tvimdesign.solve.discrete.branch_and_bound import GAP
from tvimdesign.solve.discrete.discrete_choices import Box
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.nlp.solver_run import Run

_DATA = 100
"""Combinations between two words of progress."""


@dataclass
class Enumeration:
    """What became of every combination of one tree."""

    found: dict[Box, Run] = field(default_factory=dict)
    """The best design of those that were solved and have one."""
    bounded: int = 0
    """Those that can cost no less than what was found."""
    broken: int = 0
    """Those whose arithmetic limits cannot be kept, seen while they were bounded."""
    below: float = 0.0
    """Largest share by which a design was better than its bound: zero if bounds were bounds."""


def enumerate_all(relaxation: Relaxation) -> dict[Box, Run]:
    """The best design of every combination that has one, each solved."""
    found: dict[Box, Run] = {}
    for number, box in enumerate(relaxation.sizes.each()):
        if number % _DATA == 0:
            relaxation.optimizer.progress(f"proof: combination {number + 1} of {relaxation.sizes.count}")
        run = relaxation.thoroughly(box, _nearest(found, box))
        if run is not None:
            found[box] = run
    return found


class _Valleys:
    """Designs of combinations by the optimum with all sizes free that they descend from, neighbour by neighbour."""

    def __init__(self, relaxation: Relaxation) -> None:
        """Nothing is solved yet."""
        self._tree = relaxation
        self._found: list[dict[Box, Run]] = [{} for _ in relaxation.optima]

    def solved(self, box: Box, cutoff: float) -> list[Run | None]:
        """The design of a combination in every valley whose optimum is below a cutoff: none in it is below that.

        From everywhere else as well where there is no such valley.
        """
        runs = []
        for optimum, found in zip(self._tree.optima, self._found, strict=True):
            if optimum.start.objective < cutoff:
                run, _ = self._tree.exactly(box, _nearest(found, box) or optimum)
                if run is not None:
                    found[box] = run
                runs.append(run)
        return runs or [self._tree.thoroughly(box, None)]


def account_for_all(relaxation: Relaxation, keep: int, known: Mapping[Box, Run]) -> Enumeration:
    """The best `keep` combinations, as far as bounds are bounds; designs of some are `known` from a search."""
    from tvimdesign.solve.discrete.least_cost import LeastCost  # with the compiler, which other runs do without

    every = Enumeration(dict(known))
    relaxation.optimizer.progress(f"proof: bounds of {relaxation.sizes.count} combinations")
    least = LeastCost(relaxation)
    least.find(_cutoff(every.found, keep))
    every.broken = int(np.sum(least.broken))
    valleys = _Valleys(relaxation)
    order = [k for k in np.argsort(least.bounds, kind="stable") if not least.broken[k]]
    for number, k in enumerate(order):
        box, bound, cutoff = least.boxes[k], float(least.bounds[k]), _cutoff(every.found, keep)
        if bound >= cutoff:
            every.bounded = sum(least.boxes[left] not in every.found for left in order[number:])
            break
        if number % _DATA == 0:
            relaxation.optimizer.progress(f"proof: {number} combinations solved, at most {len(order) - number} left")
        found = [*valleys.solved(box, cutoff), every.found.get(box)]
        best = min((run for run in found if run is not None), key=lambda run: run.start.objective, default=None)
        if best is not None:
            every.found[box] = best
            every.below = max(every.below, (bound - best.start.objective) / abs(best.start.objective))
    return every


def _cutoff(found: Mapping[Box, Run], keep: int) -> float:
    """What a combination must cost less than to be among the best."""
    objectives = sorted(run.start.objective for run in found.values())
    return objectives[keep - 1] * (1.0 - GAP) if len(objectives) >= keep else math.inf


def _nearest(found: Mapping[Box, Run], box: Box) -> Run | None:
    nearest = min(found, key=lambda other: _steps(other, box), default=None)
    return found[nearest] if nearest is not None else None


def _steps(one: Box, other: Box) -> int:
    """Sizes that lie between two combinations, over all numbers."""
    return sum(abs(a - b) for (a, _), (b, _) in zip(one, other, strict=True))
