"""Every combination of listed sizes solved, each warm from the nearest before it: slow, and a proof of the rest."""

from __future__ import annotations

from tvimdesign.solve.listed import Box
from tvimdesign.solve.optimizer import Run
from tvimdesign.solve.tree import Tree, order

_TOLD = 100
"""Combinations between two words of progress."""


def enumerate_all(tree: Tree) -> dict[Box, Run]:
    """The best design of every combination that has one; a chain of runs from each of the tree's different optima."""
    found: dict[Box, Run] = {}
    optima: list[Run | None] = [*tree.optima] or [None]
    chains: list[list[tuple[Box, Run]]] = [[] for _ in optima]
    for number, box in enumerate(tree.sizes.each()):
        if number % _TOLD == 0:
            tree.optimizer.progress(f"proof: combination {number + 1} of {tree.sizes.count}")
        for chain, optimum in zip(chains, optima, strict=True):
            near = min(chain, key=lambda one: _steps(one[0], box))[1] if chain else optimum
            run, _ = tree.exactly(box, near)
            if run is None:
                break  # begun from every optimum already
            chain.append((box, run))
            if box not in found or order(run) < order(found[box]):
                found[box] = run
    return found


def _steps(one: Box, other: Box) -> int:
    """Sizes that lie between two combinations, over all numbers."""
    return sum(abs(a - b) for (a, _), (b, _) in zip(one, other, strict=True))
