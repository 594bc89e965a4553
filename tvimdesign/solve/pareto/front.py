"""Pareto fronts of two or three outputs, from end to end: no design beats another in all of them.

The ends come first: the least of each output. Between them points are sought on lines along which every output falls
alike, spread evenly over the chord or the plane of the ends (`front_shape`); each line is one or two bounds on one
built problem (`tradeoff`), and each point begins from what its neighbours left behind.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.solve.nlp.problem_parts import Array, Objective
from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.nlp.solver_run import ABOVE_RATING, OPTIMAL, Progress, Run, Trace
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.optimizer.verify_optimum import exceeded, sorted_by_acceptance
from tvimdesign.solve.pareto import front_shape as shape
from tvimdesign.solve.pareto.front_shape import Frame
from tvimdesign.solve.pareto.tradeoff import ONE_POINT, OUT_OF_TIME, Failure, FolderMemory, Point, Tradeoff
from tvimdesign.study import Design, Study

SIDE_WEIGHT = 1e-2
"""Weight of the other outputs against the one that is made small, both as ratios to the optimum: a front ends where a
hundredth of one buys less than a ten-thousandth of the other, and no point gives anything away."""
BARELY = 0.02
"""Share of an output's least that its value at the least of another may lie above it where the two barely conflict."""
MOST_TRIES = 1.5
"""Designs that may be sought for each point that is asked for: some lines lead to a point that is there already."""
FAR = 3.0
"""Largest weight of a neighbour in a guess: beyond it the guess is further from all of them than they are apart."""


@dataclass(frozen=True)
class Front:
    """Pareto front, sorted by the first output."""

    outputs: tuple[str, ...]
    points: tuple[Point, ...]
    dominated: int = 0  # Count of points that were found and are no better in anything than another one
    failures: tuple[Failure, ...] = ()
    notes: tuple[str, ...] = ()
    sought: int = 0  # Count of designs that were sought, ends included
    yields: tuple[float, ...] = ()  # Share of random modules that satisfy all limits, at each point; empty if not drawn

    @property
    def lost(self) -> list[Failure]:
        """The failures that the time limit is not the reason of."""
        return [failure for failure in self.failures if failure.reason != OUT_OF_TIME]

    def joined(self, point: Point) -> list[Point]:
        """Return its points and another one, those that no other beats, by the first output."""
        points = undominated([*self.points, point], self.outputs)
        return sorted(points, key=lambda point: point.values[self.outputs[0]])

    @property
    def shares(self) -> Array:
        """Every point's outputs, from 0 (the least on the front) to 1 (the most)."""
        if not self.points:
            return np.zeros((0, len(self.outputs)))
        numbers = self._numbers
        ranges = np.ptp(numbers, axis=0)
        return np.asarray((numbers - numbers.min(axis=0)) / np.where(ranges > 0.0, ranges, 1.0))

    @property
    def spread(self) -> float:
        """The largest gap between neighbours over the mean one."""
        return shape.spread(self.shares)

    @property
    def _numbers(self) -> Array:
        """Every point's outputs, SI."""
        return np.array([[point.values[name] for name in self.outputs] for point in self.points])

    @property
    def little_traded(self) -> tuple[str, ...]:
        """The outputs that hardly change over the front: with them there is no trade to speak of."""
        return tuple(self.outputs[i] for i in shape.little_traded(self._numbers))

    @property
    def knee(self) -> int | None:
        """Place of the point beyond which any output gets dear; None where there is none, or nothing is traded."""
        return None if self.little_traded else shape.knee(self.shares)


def trace_front(trade: Tradeoff, outputs: Sequence[str], count: int) -> Front:
    """Return a front of about `count` points, of two or three outputs that a trade-off can trade."""
    return _Tracer(trade, tuple(outputs), count).front()


def completed(front: Front, trade: Tradeoff) -> Front:
    """Return a front whose points have every output, also those that no objective or limit depends on."""
    answers = [trade.completed(point) for point in front.points]
    failures = tuple(answer for answer in answers if isinstance(answer, Failure))
    return replace(
        front,
        points=tuple(answer for answer in answers if isinstance(answer, Point)),
        failures=(*front.failures, *failures),
    )


class FrontSearch:
    """The fronts of a study: it keeps what finds the optimum, and seeks them with that."""

    trade: Tradeoff

    def __init__(self, study: Study, folder: ResultsFolder | None = None) -> None:
        """Prepare; in a `folder` each point is stored on the way, so that another run can continue there.

        Raises InputError where the folder holds the beginning of another study's front.
        """
        self._study, self._memory = study, FolderMemory(folder, study) if folder else None
        self._built: list[tuple[Optimizer, list[Run]]] = []

    def keep(self, built: Optimizer, runs: list[Run]) -> None:
        """Take what found the study's optimum."""
        self._built.append((built, runs))

    def begin(self, optimum: Solution, progress: Progress) -> Point:
        """Return the optimum as a point."""
        self.trade = Tradeoff(self._study, optimum, *self._built[0], progress, self._memory)
        return self.trade.optimum

    def seek(self, outputs: Sequence[str], count: int, *, drawn: bool = False) -> Front:
        """Return a front whose points have every output, and their yields where modules are to be `drawn`."""
        trade, late = self.trade, self.trade.optimizer.deadline.late
        front = trace_front(trade, outputs, count)
        trade.progress("simulating the working cycle of each point of the front")
        front = completed(front, trade)
        if drawn:
            drawing = partial(kept_at, trade.optimizer, front, late)
            front = replace(front, yields=tuple(late.attempt("the yield of each point of the front", drawing) or ()))
        if left := len(front.failures) - len(front.lost):
            late.leave_out(f"{left} points of the front")
        return front


def kept_at(optimizer: Optimizer, front: Front, deadline: Deadline = NEVER) -> list[float]:
    """Return for each point the share of random modules that satisfy all limits. Raises TimeOverError."""
    from tvimdesign.solve.uncertainty.yields import yields_of  # it loads the compiler

    inputs = [np.array([point.values[name] for name in optimizer.model.names]) for point in front.points]
    yields = yields_of(optimizer)
    return [yields.at(values, deadline=deadline).together.share for values in inputs]


def design_at(design: Design, point: Point, number: int) -> Design:
    """Return a point of a design's front as a design of its own, with its number."""
    names = [limit.output for limit in exceeded(point.values, design.table)]
    above, accepting = sorted_by_acceptance(names, design.study.get("accept", ()))
    update = {
        "name": f"{design.name}, point {number} of its front", "status": ABOVE_RATING if above else OPTIMAL,
        "above_rating": above, "accepting": accepting, "values": point.values,
        "current_profiles": point.current_profiles, "intervals": {}, "solution": {"front": point.where},
    }  # fmt: skip
    return design.model_copy(update=update)


class _Tracer:
    """One front on its way."""

    def __init__(self, trade: Tradeoff, outputs: tuple[str, ...], count: int) -> None:
        self.trade, self.outputs, self.count = trade, outputs, count
        self.title = f"front of {' against '.join(outputs)}"
        self.failures: list[Failure] = []
        self.notes: list[str] = []
        self.ends: list[Point] = []
        self.between: list[Point] = []
        self.lost = 0
        self.first = trade.requests

    def front(self) -> Front:
        """Return the whole front, or the part that exists so far."""
        self._seek_ends()
        if self.failures:
            return self._done("an end has no design")
        self.ends = self._distinct(self.ends)
        points = undominated(self.ends, self.outputs)
        if len(points) == 1:
            self.ends = points
            return self._done(f"one point: {_and(self.outputs)} do not conflict")
        flat = [name for name in self.outputs if _alike([end.values[name] for end in points])]
        objectives = tuple(name for name in self.outputs if name not in flat)
        self.notes += [f"{name} is the same all along" for name in flat]
        self.notes += [
            f"{name} and {other} barely conflict: at the least of one the other is within {100.0 * BARELY:g} % of it"
            for name, other in itertools.combinations(self.outputs, 2)
            if all(self._together(first, then) for first, then in ((name, other), (other, name)))
        ]
        self.frame = Frame.of(objectives, [end.values for end in points])
        self.lost += len(self.ends) - len(points)
        self.ends = points
        if len(objectives) < 2:  # with what is the same all along left out, nothing is traded between the ends
            return self._done()
        if len(objectives) == 2 or shape.thin(np.array([self.frame.place(end.values) for end in self.ends])):
            self._along_a_line()
        else:
            self._over_a_surface()
        return self._done()

    def _done(self, *notes: str) -> Front:
        points = sorted([*self.ends, *self.between], key=lambda p: [p.values[name] for name in self.outputs])
        listed = self.trade.listed
        held = (f"{', '.join(listed)} as in the optimum: listed sizes and records are not traded",) if listed else ()
        return Front(
            self.outputs, tuple(points), self.lost, tuple(self.failures), (*notes, *self.notes, *held),
            self.trade.requests - self.first,
        )  # fmt: skip

    def _seek_ends(self) -> None:
        """Find the least of each output; of three also by which of the other two is minimised first."""
        for name in self.outputs:
            for others in itertools.permutations([other for other in self.outputs if other != name]):
                weights = {other: SIDE_WEIGHT ** (i + 1) for i, other in enumerate(others)}
                objective = Objective(self.trade.weights({name: 1.0, **weights}))
                near = next((end for end in self.ends if end.where.startswith(f"least {name}")), None)
                near = near or self.trade.ends.get(name)
                guess = near.trace if near else None
                answer = self._sought(objective, f"least {name}, then {_and(others)}", near, guess)
                if isinstance(answer, Point):
                    self.ends.append(replace(answer, root=len(self.ends)))
                    self.trade.ends.setdefault(name, answer)

    def _together(self, first: str, then: str) -> bool:
        least = {name: min(end.values[name] for end in self.ends) for name in (first, then)}
        there = [end.values[then] for end in self.ends if end.values[first] <= least[first] * (1.0 + ONE_POINT)]
        return min(there) <= least[then] + BARELY * abs(least[then])

    def _along_a_line(self) -> None:
        """Even steps from end to end, then back where the ends lie in different optima, then into gaps."""
        ends = sorted(self.ends, key=lambda end: end.values[self.frame.names[0]])
        begin, finish = (self.frame.place(end.values) for end in (ends[0], ends[-1]))
        steps = self.count - len(ends) + 1
        for step in range(1, steps):
            share = step / steps
            self._seek((1.0 - share) * begin + share * finish)
        self._settle()
        while len(self._all) < self.count and self._may_try:
            points = sorted(self._all, key=lambda point: point.values[self.frame.names[0]])
            places = [self.frame.place(point.values) for point in points]
            gaps = [(float(np.linalg.norm(b - a)), i) for i, (a, b) in enumerate(itertools.pairwise(places))]
            widest = max(gaps)[1]
            lost = self.lost
            if not self._seek(0.5 * (places[widest] + places[widest + 1])):
                separable = self.lost == lost
                self.notes.append(
                    "it has a jump: between two of its points there is no design"
                    if separable
                    else f"more points than {len(self._all)} would be closer than the simulation tells designs apart"
                )
                break
        self._settle()

    def _over_a_surface(self) -> None:
        """Always where it is farthest from all that was sought and found."""
        taken = [self.frame.place(end.values) for end in self.ends]
        places = shape.candidates(np.array(taken))
        for _ in range(2):
            while len(self._all) < self.count and self._may_try:
                place, _ = shape.farthest(places, np.array(taken))
                taken.append(place)
                if self._seek(place):
                    taken.append(self.frame.place(self.between[-1].values))
            self._settle()

    @property
    def _all(self) -> list[Point]:
        return [*self.ends, *self.between]

    @property
    def _may_try(self) -> bool:
        return self.trade.requests - self.first < MOST_TRIES * self.count

    def _seek(self, place: Array) -> bool:
        """Seek the design on the line through a place; whether it is a new one."""
        points = self._nearest(place)
        where = f"point {len(self._all) + 1} of {self.count}"
        weights = {name: 1.0 if name == self.outputs[0] else SIDE_WEIGHT for name in self.outputs}
        objective = Objective(self.trade.weights(weights), self.frame.bounds(place, self.trade.reference))
        point = self._sought(objective, where, points[0], self._guess(points, place))
        if not isinstance(point, Point):
            return False
        if any(self._same(point, other) for other in self._all):
            self.lost += 1
            return False
        self.between.append(point)
        return True

    def _nearest(self, place: Array) -> list[Point]:
        """Return all points, nearest first; of equally near ones the first traced."""
        return sorted(self._all, key=lambda point: float(np.linalg.norm(self.frame.place(point.values) - place)))

    def _guess(self, points: Sequence[Point], place: Array) -> Trace | None:
        """Return a start for the solver: straight through the nearest points that descend from the same end."""
        near = points[0]
        if near.trace is None:
            return None
        kin = [point for point in points if point.root == near.root and point.trace is not None][
            : len(self.frame.names)
        ]
        weights = shape.affine(np.array([self.frame.place(point.values) for point in kin]), place)
        if len(kin) == 1 or max(abs(weights)) > FAR:
            return near.trace
        unknowns = sum(w * p.trace.unknowns for w, p in zip(weights, kin, strict=True) if p.trace is not None)
        return near.trace._replace(unknowns=np.asarray(unknowns))

    def _settle(self) -> None:
        """Ends may lie in different optima: try neighbours from one another while that is better; drop the beaten."""
        tried: set[tuple[int, int]] = set()
        while (pair := self._next_pair(tried)) is not None:
            place, other = pair
            middle = self.between[place]
            tried.add((place, other.root))
            self.between[place] = self.trade.again(middle, other) or middle
        distinct = undominated(self._distinct(self._all), self.outputs)
        self.lost += len(self._all) - len(distinct)
        self.ends = [point for point in self.ends if any(point is chosen for chosen in distinct)]
        self.between = [point for point in self.between if any(point is chosen for chosen in distinct)]

    def _next_pair(self, tried: set[tuple[int, int]]) -> tuple[int, Point] | None:
        """Return the place of a point and an untried neighbour that descends from another end."""
        points, first = self._all, len(self.ends)
        for i, j, _ in shape.neighbours(np.array([self.frame.shares(point.values) for point in points])):
            for place, other in ((i, j), (j, i)):
                root = points[other].root
                if place >= first and points[place].root != root and (place - first, root) not in tried:
                    return place - first, points[other]
        return None

    def _sought(
        self, objective: Objective, where: str, near: Point | None, guess: Trace | None = None
    ) -> Point | Failure:
        answer = self.trade.best(objective, f"{self.title}: {where}", near, guess)
        answer = replace(answer, where=where)
        if isinstance(answer, Failure):
            self.failures.append(answer)
        return answer

    def _distinct(self, points: Sequence[Point]) -> list[Point]:
        distinct: list[Point] = []
        for point in points:
            if not any(self._same(point, other) for other in distinct):
                distinct.append(point)
        return distinct

    def _same(self, point: Point, other: Point) -> bool:
        return all(_alike([point.values[name], other.values[name]]) for name in self.outputs)


def undominated(points: Sequence[Point], names: Sequence[str]) -> list[Point]:
    """Return the points that no other matches in every named output (less is better); of equal ones the first."""
    if not points:
        return []
    return [points[i] for i in shape.efficient(np.array([[point.values[name] for name in names] for point in points]))]


def _alike(values: Sequence[float]) -> bool:
    return max(values) - min(values) <= ONE_POINT * max(abs(value) for value in values)


def _and(names: Sequence[str]) -> str:
    return " and ".join(names) if len(names) < 3 else f"{', '.join(names[:-1])} and {names[-1]}"
