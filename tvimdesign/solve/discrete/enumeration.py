"""Every combination of listed sizes solved: slow, for a comparison with branch and bound.

Combinations go in blocks. In a block each is solved warm from the one before, which is its neighbour. Each optimum with
all sizes free begins a chain of its own, so that a worse optimum of one chain does not hide a better one of another.
No block depends on another, nor on who solves it.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from tvimdesign.solve.discrete.discrete_choices import Box
from tvimdesign.solve.discrete.relaxation import Relaxation, order
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.study import Study

BLOCK = 16
"""Combinations of a block: tenths of a second where arithmetic rules them out, up to a minute where not."""


class Block(NamedTuple):
    """Some combinations of a tree, each a neighbour of the one before."""

    place: int
    """Of the tree."""
    first: int
    """Combination, from 0."""


class SolvedBlock(NamedTuple):
    """The best design of every combination of a block that has one, and what that took."""

    runs: dict[Box, Run]
    work: SolverEffort


class Begin(NamedTuple):
    """The search whose combinations are to be solved."""

    study: Study
    reference: dict[str, float] | None
    objectives: Sequence[str]
    trees: Sequence[Relaxation]


def blocks_of(trees: Sequence[Relaxation]) -> list[Block]:
    """Return all combinations of a search."""
    return [Block(tree.place, first) for tree in trees for first in range(0, tree.sizes.count, BLOCK)]


def solved(tree: Relaxation, block: Block) -> SolvedBlock:
    """Solve the combinations of a block; those at its end are left where the time is over."""
    runs: dict[Box, Run] = {}
    chains: list[Run | None] = [*tree.optima] or [None]
    own, tree.work = tree.work, SolverEffort()
    for number in range(block.first, min(block.first + BLOCK, tree.sizes.count)):
        box = tree.sizes.combination(number)
        if tree.optimizer.deadline.passed:
            break
        for place, near in enumerate(chains):
            run, certain = tree.exactly(box, near)
            if run is None:
                if certain:  # by arithmetic, or from everywhere: the other chains would find no more
                    break
                continue
            chains[place] = run
            if box not in runs or order(run) < order(runs[box]):
                runs[box] = run
    work, tree.work = tree.work, own
    return SolvedBlock(runs, work)


def enumerated_here(begin: Begin) -> Iterator[tuple[Block, SolvedBlock]]:
    """Solve every combination in this process, until the time is over."""
    count, began, number = sum(tree.sizes.count for tree in begin.trees), time.perf_counter(), 0
    for block in blocks_of(begin.trees):
        tree = begin.trees[block.place]
        if tree.optimizer.deadline.passed:
            return
        seconds = (time.perf_counter() - began) / max(number, 1) * (count - number)
        left = f", about {seconds:.0f} s left" if number else ""
        tree.optimizer.progress(f"choosing from lists: {number} of {count} combinations solved{left}")
        yield block, solved(tree, block)
        number += min(BLOCK, tree.sizes.count - block.first)
