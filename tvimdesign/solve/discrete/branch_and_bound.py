"""Branch and bound over listed sizes and records: boxes of sizes, each bounded by its relaxed optimum.

Within a box every listed number is free between the smallest and the largest of its sizes: no combination in it can be
better than the best design there. A box whose bound is no better than the best combinations found is left; any other is
halved between two sizes, and its halves are solved warm from it. The bound is local, it holds as far as the starts go:
so every different optimum they came to is a box of its own to begin with.

Pseudo-costs, the past rises of bounds after divisions, tell the list to divide a box along: T. Achterberg, T. Koch, A.
Martin, Branching rules revisited, Operations Research Letters 33 (2005) 42-54. A list whose division raises the bounds
of both halves is divided first; one whose entries are as good as one another is divided last.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from tvimdesign.solve.discrete.discrete_choices import SAME_SIZE, Box, is_one
from tvimdesign.solve.discrete.relaxation import Relaxation, order
from tvimdesign.solve.nlp.solver_run import Run

Side = int  # 0 is the half with the smaller sizes, 1 the one with the larger
_LEAST = 1e-6  # Least that a half is taken to raise the bound by, in shares of it, so that the other half counts
_WITHOUT_DESIGN = 0.1
"""What a half without a design counts for, in shares of the bound: it is left as one beyond every bound is."""


@dataclass
class PseudoCosts:
    """By list and side: how much the bound rose, in shares of it, over how far the number had to move."""

    _risen: dict[tuple[int, Side], float] = field(default_factory=dict)
    _moved: dict[tuple[int, Side], float] = field(default_factory=dict)

    def learn(self, axis: int, side: Side, moved: float, risen: float | None) -> None:
        """Take in one half: how far its number had to move, and the rise of its bound; None where it has no design."""
        if moved <= 0.0:
            return
        key = (axis, side)
        rise = _WITHOUT_DESIGN if risen is None else min(max(risen, 0.0), _WITHOUT_DESIGN)
        self._risen[key] = self._risen.get(key, 0.0) + rise
        self._moved[key] = self._moved.get(key, 0.0) + moved

    def score(self, axis: int, moves: tuple[float, float]) -> float:
        """Return the score of a list, higher is better: the product of the expected rises of both halves."""
        expected = (self._rate(axis, side) * moves[side] for side in (0, 1))
        first, second = (max(rise, _LEAST) for rise in expected)
        return first * second

    def _rate(self, axis: int, side: Side) -> float:
        """Return the rise per move; that of all lists together if this list has not been divided yet."""
        key = (axis, side)
        if key in self._moved:
            return self._risen[key] / self._moved[key]
        every = sum(self._moved.values())
        return sum(self._risen.values()) / every if every else 1.0


GAP = 1e-6  # Share by which a box must promise better than what is known to be looked into
_NEXT_RECORDS = 3  # Records of each mixture, by cost, that are tried beside a tree's first combination
_DATA = 20  # Boxes between two words of progress
Answer = tuple[Run | None, bool]


@dataclass(frozen=True, eq=False)
class Task:
    """One box of one tree: searched from a run `near` it, for one combination `exactly`, or `thoroughly` afresh."""

    place: int  # Of the tree
    box: Box
    near: Run | None
    way: Literal["within", "exactly", "thoroughly"]

    def answer(self, trees: Sequence[Relaxation]) -> Answer:
        """Return its best design, and where there is none, whether that is certain."""
        tree = trees[self.place]
        if self.way == "thoroughly":
            return tree.thoroughly(self.box, self.near), True
        return (tree.exactly if self.way == "exactly" else tree.best_within)(self.box, self.near)


@dataclass(frozen=True, eq=False)
class Node:
    """A box that may hold better combinations: its bound, and its best design where one was found."""

    relaxation: Relaxation
    box: Box
    bound: float
    run: Run | None
    depth: int
    number: int


@dataclass(frozen=True)
class Division:
    """Division of a box: the list it follows and the size after which it cuts."""

    axis: int
    after: int
    moves: tuple[float, float]  # How far the number lies from the nearest size of each half, in shares of it

    def halves(self, box: Box) -> tuple[Box, Box]:
        """Return the half with the smaller sizes and the half with the larger ones."""
        first, last = box[self.axis]
        before, behind = box[: self.axis], box[self.axis + 1 :]
        return (*before, (first, self.after), *behind), (*before, (self.after + 1, last), *behind)


_AFRESH = 2  # Combinations, the best first, that are solved again from all else there is


@dataclass
class BranchAndBound:
    """One search over the trees of all records; `runs` are the runs of single combinations, by tree and box."""

    trees: Sequence[Relaxation]
    keep: int  # Number of best combinations that the search must prove: bounds are compared with the last of them
    runs: dict[tuple[int, Box], Run] = field(default_factory=dict)
    inside: float = 0.0  # Largest share by which a design within a box was better than the box's bound
    unknown: set[tuple[int, Box]] = field(default_factory=set)
    """Combinations without a design so far, though it is not certain that they have none."""
    _open: list[Node] = field(default_factory=list)
    _made: int = 0
    _reports: int = 0
    _tried_others: set[int] = field(default_factory=set)
    _starts_tried: set[tuple[int, Box, bytes]] = field(default_factory=set)
    """Combinations with the unknowns that each was solved from."""
    _bounded: list[NDArray[np.bool_]] = field(default_factory=list)
    _pseudo_costs: dict[int, PseudoCosts] = field(default_factory=dict)  # By tree

    def run(self) -> None:
        """Search until no box promises better."""
        self._bounded = [np.zeros(relaxation.sizes.shape, dtype=bool) for relaxation in self.trees]
        started: list[Task] = []
        for relaxation in self.trees:
            whole = relaxation.sizes.whole
            for optimum in relaxation.optima:
                self._add(relaxation, whole, optimum.start.objective, optimum, 0)
                nearest = relaxation.sizes.nearest(relaxation.values(optimum), whole)
                started.append(Task(relaxation.place, nearest, optimum, "exactly"))
            if not relaxation.optima:
                self._add(relaxation, whole, -math.inf, None, 0)
        self._try(started)
        while self._open and not self.stopped:
            node = min(self._open, key=self._urgency)
            self._open.remove(node)
            if node.bound >= self.cutoff:
                box = tuple(slice(first, last + 1) for first, last in node.box)
                self._bounded[node.relaxation.place][box] = True
                continue
            self._try(self._combinations_of(node))
            if not is_one(node.box):
                self._divide(node)
            self._tell(node.relaxation)
        if not self.stopped:
            self._begin_afresh()

    @property
    def stopped(self) -> bool:
        """Return whether time is up; open boxes stay open."""
        return self.trees[0].optimizer.deadline.passed

    @property
    def start_infeasible(self) -> bool:
        """Return whether no combination has a design, as far as searches from all optima show."""
        return not (self.runs or self.unknown or self.stopped)

    def _begin_afresh(self) -> None:
        """Solve the best combinations again from all else there is: their boxes may have led to a worse optimum."""
        best = sorted(self.runs, key=lambda key: (order(self.runs[key]), key))[:_AFRESH]
        for key, (again, _) in zip(best, self._answers([Task(*key, None, "thoroughly") for key in best]), strict=False):
            before = self.runs[key]
            if again is not None and order(again) < order(before):
                self.runs[key] = again
                objective = before.start.objective
                self.inside = max(self.inside, (objective - again.start.objective) / abs(objective))

    def _answers(self, tasks: Sequence[Task]) -> list[Answer]:
        """Tasks answered; none any more once the time is over."""
        return [] if self.stopped else [task.answer(self.trees) for task in tasks]

    @property
    def cutoff(self) -> float:
        """The bound from which on a box is left."""
        objectives = sorted(run.start.objective for run in self.runs.values())
        return objectives[self.keep - 1] * (1.0 - GAP) if len(objectives) >= self.keep else math.inf

    @property
    def pruned(self) -> int:
        """Combinations that were left by their bound."""
        solved = sum(bool(self._bounded[place][tuple(first for first, _ in box)]) for place, box in self.runs)
        return sum(int(bounded.sum()) for bounded in self._bounded) - solved

    def _urgency(self, node: Node) -> tuple[float, float, int]:
        """Return the order of a box: best bound first, but deepest first until enough combinations are known."""
        deep = 0.0 if math.isfinite(self.cutoff) else -float(node.depth)
        return deep, node.bound, node.number

    def _combinations_of(self, node: Node) -> list[Task]:
        """Return the only combination of a box, or the combination of its best design."""
        relaxation, run = node.relaxation, node.run
        if is_one(node.box):
            return [Task(relaxation.place, node.box, run, "exactly")]
        if run is None or not relaxation.sizes.are_sizes(relaxation.values(run), node.box):
            return []
        return [Task(relaxation.place, relaxation.sizes.nearest(relaxation.values(run), node.box), run, "exactly")]

    def _divide(self, node: Node) -> None:
        """Solve both halves of a box, and keep those that may hold better combinations."""
        division, sizes = self._division(node), node.relaxation.sizes
        values = node.run and node.relaxation.values(node.run)
        halves = division.halves(node.box)
        searched = [box for box in halves if not (values and sizes.hold(values, box))]
        answers = self._answers([Task(node.relaxation.place, box, node.run, "within") for box in searched])
        solved = dict(zip(searched, answers, strict=False))
        for side, box in enumerate(halves):
            if box in solved:
                self._take(node, division, side, box, *solved[box])
            elif box not in searched:  # the best design lies in it
                self._add(node.relaxation, box, node.bound, node.run, node.depth + 1)

    def _take(self, node: Node, division: Division, side: int, box: Box, run: Run | None, certain: bool) -> None:
        """Keep one half, and learn from how much worse it is."""
        if run is None and not certain:
            self._add(node.relaxation, box, node.bound, node.run, node.depth + 1)
            return
        risen = None
        if run is not None:
            objective = run.start.objective
            self._add(node.relaxation, box, objective, run, node.depth + 1)
            risen = (objective - node.bound) / abs(node.bound)
        if math.isfinite(node.bound):
            self.inside = max(self.inside, -(risen or 0.0))
            self._pseudo_costs_of(node).learn(division.axis, side, division.moves[side], risen)

    def _add(self, relaxation: Relaxation, box: Box, bound: float, run: Run | None, depth: int) -> None:
        self._open.append(Node(relaxation, box, bound, run, depth, self._made))
        self._made += 1

    def _try(self, tasks: Sequence[Task]) -> None:
        """Solve combinations; the better of two where another box came to one too, and promises better."""
        first: dict[tuple[int, Box], Task] = {}
        for task in tasks:
            start = task.place, task.box, b"" if task.near is None else task.near.unknowns.tobytes()
            if start not in self._starts_tried and self._promises(task):
                self._starts_tried.add(start)
                first.setdefault((task.place, task.box), task)
        others: list[Task] = []
        for key, (run, certain) in zip(first, self._answers(list(first.values())), strict=False):
            self.unknown.discard(key)
            if run is None and not certain:
                self.unknown.add(key)
            if run is not None and (key not in self.runs or order(run) < order(self.runs[key])):
                others += self._record(key, run)
        if others:
            self._try(others)

    def _promises(self, task: Task) -> bool:
        """Return whether a combination is new, or the run nearby is better than its known result."""
        known = self.runs.get((task.place, task.box))
        if known is None or task.near is None:
            return True
        promised = task.near.start.objective
        return known.start.objective > promised + GAP * abs(promised)

    def _record(self, key: tuple[int, Box], run: Run) -> list[Task]:
        """Keep a combination's design; what is to be tried beside the first one of its tree."""
        relaxation = self.trees[key[0]]
        best = min((solved.start.objective for solved in self.runs.values()), default=math.inf)
        self.runs[key] = run
        relaxation.note(run)
        if run.start.objective < best:
            self._say(relaxation)
        if relaxation.place in self._tried_others:
            return []
        self._tried_others.add(relaxation.place)
        box, sizes = key[1], relaxation.sizes  # combinations that differ in one record: good ones rule out many others
        return [
            Task(relaxation.place, (*box[:axis], (place, place), *box[axis + 1 :]), run, "exactly")
            for axis in range(len(box) - len(sizes.mixtures), len(box))
            for place in range(min(_NEXT_RECORDS, len(sizes.sizes[axis])))
            if place != box[axis][0]
        ]

    def _division(self, node: Node) -> Division:
        """Return the best division of a box by pseudo-costs; if every number has one size, divide the longest list.

        That is cut beside the size, as what lies beyond is likely worse than the best combinations; without a design,
        in its middle.
        """
        sizes, best, most = node.relaxation.sizes, None, 0.0
        values = node.relaxation.values(node.run) if node.run is not None else {}
        for axis, (name, listed, (first, last)) in enumerate(zip(sizes.names, sizes.sizes, node.box, strict=True)):
            if first == last or name not in values:
                continue
            below = int(np.searchsorted(listed[first : last + 1], values[name] * (1.0 + SAME_SIZE), side="right"))
            below = min(max(first + below - 1, first), last - 1)
            moves = (sizes.apart(axis, values[name], listed[below]), sizes.apart(axis, values[name], listed[below + 1]))
            score = self._pseudo_costs_of(node).score(axis, moves)
            if min(moves) > SAME_SIZE and score > most:
                best, most = Division(axis, below, moves), score
        if best is None:
            axis = max(range(len(node.box)), key=lambda i: node.box[i][1] - node.box[i][0])
            first, last = node.box[axis]
            place = sizes.nearest(values, node.box)[axis][0] if values else (first + last) // 2
            best = Division(axis, min(place, last - 1), (0.0, 0.0))
        return best

    def _pseudo_costs_of(self, node: Node) -> PseudoCosts:
        return self._pseudo_costs.setdefault(node.relaxation.place, PseudoCosts())

    def _tell(self, relaxation: Relaxation) -> None:
        self._reports += 1
        if self._reports % _DATA == 1:
            self._say(relaxation)

    def _say(self, relaxation: Relaxation) -> None:
        """Report the progress of the search and the best objective so far."""
        counts = ((len(self.runs), "combination", "solved"), (len(self._open), "group", "of combinations left"))
        parts = [f"{count} {what}{'s' if count != 1 else ''} {state}" for count, what, state in counts if count]
        best = min((run.start.objective for run in self.runs.values()), default=None)
        so_far = "" if best is None else f": objective {best:.5g} so far"
        relaxation.optimizer.progress(f"{', '.join(parts) or 'looking for combinations to solve'}{so_far}")
