"""Every combination of listed sizes solved, from its neighbour and afresh: slow, and a proof of the rest."""

from __future__ import annotations

from tvimdesign.solve.listed import Box
from tvimdesign.solve.run import Run
from tvimdesign.solve.tree import Tree

_TOLD = 100
"""Combinations between two words of progress."""


def enumerate_all(tree: Tree) -> dict[Box, Run]:
    """The best design of every combination that has one."""
    found: dict[Box, Run] = {}
    for number, box in enumerate(tree.sizes.each()):
        if number % _TOLD == 0:
            tree.optimizer.progress(f"proof: combination {number + 1} of {tree.sizes.count}")
        nearest = min(found, key=lambda other: _steps(other, box), default=None)
        run = tree.thoroughly(box, found[nearest] if nearest else None)
        if run is not None:
            found[box] = run
    return found


def _steps(one: Box, other: Box) -> int:
    """Sizes that lie between two combinations, over all numbers."""
    return sum(abs(a - b) for (a, _), (b, _) in zip(one, other, strict=True))
