"""Every combination of listed sizes solved: slow, and what branch and bound is held against.

A combination is solved warm from the one before, which is its neighbour. Each optimum with all sizes free begins a
chain of its own, so that a worse optimum of one chain does not hide a better one of another.
"""

from __future__ import annotations

import time

from tvimdesign.solve.discrete.discrete_choices import Box
from tvimdesign.solve.discrete.relaxation import Relaxation, order
from tvimdesign.solve.nlp.solver_run import Run

_BETWEEN_WORDS = 50
"""Combinations between two words of progress."""


def enumerate_all(relaxation: Relaxation) -> dict[Box, Run]:
    """The best design of every combination that has one."""
    found: dict[Box, Run] = {}
    chains: list[Run | None] = [*relaxation.optima] or [None]
    count, began = relaxation.sizes.count, time.perf_counter()
    for number, box in enumerate(relaxation.sizes.each()):
        if relaxation.optimizer.deadline.passed:
            break
        if number % _BETWEEN_WORDS == 0:
            seconds = (time.perf_counter() - began) / max(number, 1) * (count - number)
            left = f", about {seconds:.0f} s left" if number else ""
            relaxation.optimizer.progress(f"enumeration: {number} of {count} combinations solved{left}")
        for place, near in enumerate(chains):
            run, certain = relaxation.exactly(box, near)
            if run is None:
                if certain:  # by arithmetic, or from everywhere: the other chains would find no more
                    break
                continue
            chains[place] = run
            if box not in found or order(run) < order(found[box]):
                found[box] = run
    return found
