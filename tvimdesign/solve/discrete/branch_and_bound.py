"""Branch and bound over listed sizes and records: boxes of sizes, each bounded by its relaxed optimum.

Within a box every listed number is free between the smallest and the largest of its sizes: no combination in it can be
better than the best design there. A box whose bound is no better than the best combinations found is left; any other is
halved between two sizes, and its halves are solved warm from it. The bound is local, it holds as far as the starts go:
so every different optimum they came to is a box of its own to begin with.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from tvimdesign.solve.discrete.discrete_choices import SAME_SIZE, Box, is_one
from tvimdesign.solve.discrete.relaxation import Relaxation, order
from tvimdesign.solve.nlp.solver_run import Run

GAP = 1e-6
"""Share by which a box must promise better than what is known to be looked into."""
_NEXT_RECORDS = 3
"""Records of each mixture, by cost, that are tried beside a tree's first combination."""
_DATA = 20
"""Boxes between two words of progress."""


@dataclass(frozen=True, eq=False)
class Node:
    """A box that may hold better combinations: its bound, and its best design where one was found."""

    relaxation: Relaxation
    box: Box
    bound: float
    run: Run | None
    depth: int
    number: int


@dataclass
class BranchAndBound:
    """One search over the trees of all records; `found` are the runs of single combinations, by tree and box."""

    trees: Sequence[Relaxation]
    keep: int
    """Combinations that are to be found for certain: bounds are held against the last of them."""
    found: dict[tuple[int, Box], Run] = field(default_factory=dict)
    inside: float = 0.0
    """Largest share by which a design within a box was better than the box's bound."""
    _open: list[Node] = field(default_factory=list)
    _made: int = 0
    _told: int = 0
    _tried_others: set[int] = field(default_factory=set)
    _bounded: list[NDArray[np.bool_]] = field(default_factory=list)

    def run(self) -> None:
        """Search until no box promises better."""
        self._bounded = [np.zeros(relaxation.sizes.shape, dtype=bool) for relaxation in self.trees]
        for relaxation in self.trees:
            whole = relaxation.sizes.whole
            for optimum in relaxation.optima:
                self._add(relaxation, whole, optimum.start.objective, optimum, 0)
                self._try(relaxation, relaxation.sizes.nearest(relaxation.values(optimum), whole), optimum)
            if not relaxation.optima:
                self._add(relaxation, whole, -math.inf, None, 0)
        while self._open and not self.stopped:
            node = self._open.pop(min(range(len(self._open)), key=lambda i: self._urgency(self._open[i])))
            if node.bound >= self.cutoff:
                self._bounded[node.relaxation.place][_slices(node.box)] = True
            else:
                self._split(node)
                self._tell(node.relaxation)
        if not self.stopped:
            self._begin_afresh()

    @property
    def stopped(self) -> bool:
        """Whether the time is over: what is open stays so."""
        return self.trees[0].optimizer.deadline.passed

    def _begin_afresh(self) -> None:
        """Solve the best combinations again from all else there is: their boxes may have led to a worse optimum."""
        best = sorted(self.found, key=lambda key: (order(self.found[key]), key))
        for place, box in best[: self.keep]:
            if self.stopped:
                return
            before = self.found[place, box]
            again = self.trees[place].thoroughly(box, None)
            if again is not None and order(again) < order(before):
                self.found[place, box] = again
                objective = before.start.objective
                self.inside = max(self.inside, (objective - again.start.objective) / abs(objective))

    @property
    def cutoff(self) -> float:
        """The bound from which on a box is left."""
        objectives = sorted(run.start.objective for run in self.found.values())
        return objectives[self.keep - 1] * (1.0 - GAP) if len(objectives) >= self.keep else math.inf

    @property
    def pruned(self) -> int:
        """Combinations that were left by their bound."""
        solved = sum(bool(self._bounded[place][tuple(first for first, _ in box)]) for place, box in self.found)
        return sum(int(bounded.sum()) for bounded in self._bounded) - solved

    def _urgency(self, node: Node) -> tuple[float, float, int]:
        """The best bound first; until enough combinations are known, the deepest box first."""
        deep = 0.0 if math.isfinite(self.cutoff) else -float(node.depth)
        return deep, node.bound, node.number

    def _split(self, node: Node) -> None:
        if is_one(node.box):
            self._try(node.relaxation, node.box, node.run)
            return
        if node.run is not None and node.relaxation.sizes.are_sizes(node.relaxation.values(node.run), node.box):
            self._try(
                node.relaxation, node.relaxation.sizes.nearest(node.relaxation.values(node.run), node.box), node.run
            )
        for box in self._halves(node):
            self._bound(node, box)

    def _bound(self, node: Node, box: Box) -> None:
        """Solve one half of a box, and keep it where it may hold better combinations."""
        relaxation, near = node.relaxation, node.run
        if near is not None and relaxation.sizes.hold(relaxation.values(near), box):
            self._add(relaxation, box, node.bound, near, node.depth + 1)
            return
        run, certain = relaxation.best_within(box, near)
        if run is None:
            if not certain:
                self._add(relaxation, box, node.bound, near, node.depth + 1)
            return
        objective = run.start.objective
        if math.isfinite(node.bound):
            self.inside = max(self.inside, (node.bound - objective) / abs(node.bound))
        self._add(relaxation, box, objective, run, node.depth + 1)

    def _add(self, relaxation: Relaxation, box: Box, bound: float, run: Run | None, depth: int) -> None:
        self._open.append(Node(relaxation, box, bound, run, depth, self._made))
        self._made += 1

    def _try(self, relaxation: Relaxation, box: Box, near: Run | None) -> None:
        """Solve one combination; the better of two where another box came to it too, and promises better."""
        key = (relaxation.place, box)
        if key in self.found and near is not None:
            known, promised = self.found[key].start.objective, near.start.objective
            if known <= promised + GAP * abs(promised):
                return
        run, _ = relaxation.exactly(box, near)
        if run is not None and (key not in self.found or order(run) < order(self.found[key])):
            best = min((one.start.objective for one in self.found.values()), default=math.inf)
            self.found[key] = run
            if run.start.objective < best:
                self._say(relaxation)
            self._try_other_records(relaxation, box, run)

    def _try_other_records(self, relaxation: Relaxation, box: Box, run: Run) -> None:
        """Solve what differs from a tree's first combination in one record: good ones rule out much from then on."""
        if relaxation.place in self._tried_others:
            return
        self._tried_others.add(relaxation.place)
        for axis in range(len(box) - len(relaxation.sizes.mixtures), len(box)):
            for place in range(min(_NEXT_RECORDS, len(relaxation.sizes.sizes[axis]))):
                if place != box[axis][0] and not self.stopped:
                    self._try(relaxation, (*box[:axis], (place, place), *box[axis + 1 :]), run)

    def _halves(self, node: Node) -> tuple[Box, Box]:
        """Split where a number lies farthest from its sizes, in shares of it; else the longest list in the middle."""
        sizes = node.relaxation.sizes
        values = node.relaxation.values(node.run) if node.run is not None else {}
        chosen, cut, far = -1, 0, 0.0
        for i, (name, listed, (first, last)) in enumerate(zip(sizes.names, sizes.sizes, node.box, strict=True)):
            if first == last or name not in values:
                continue
            below = int(np.searchsorted(listed[first : last + 1], values[name] * (1.0 + SAME_SIZE), side="right"))
            below = min(max(first + below - 1, first), last - 1)
            distance = min(sizes.apart(i, values[name], listed[place]) for place in (below, below + 1))
            if distance > far:
                chosen, cut, far = i, below, distance
        if chosen < 0 or far <= SAME_SIZE:
            chosen = max(range(len(node.box)), key=lambda i: node.box[i][1] - node.box[i][0])
            cut = sum(node.box[chosen]) // 2
        first, last = node.box[chosen]
        before, after = node.box[:chosen], node.box[chosen + 1 :]
        return (*before, (first, cut), *after), (*before, (cut + 1, last), *after)

    def _tell(self, relaxation: Relaxation) -> None:
        self._told += 1
        if self._told % _DATA == 1:
            self._say(relaxation)

    def _say(self, relaxation: Relaxation) -> None:
        """How far the search is, and the best objective so far."""
        left, best = len(self._open), min((run.start.objective for run in self.found.values()), default=None)
        so_far = "" if best is None else f", objective {best:.5g} so far"
        said = f"{len(self.found)} combinations solved, {left} boxes of them still open{so_far}"
        relaxation.optimizer.progress(said)


def _slices(box: Box) -> tuple[slice, ...]:
    return tuple(slice(first, last + 1) for first, last in box)
