"""A built problem looked at before it is solved: scaling and conditioning, derivatives, what depends on what."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.errors import InputError
from tvimdesign.device import Choice
from tvimdesign.solve.nlp.constraints import constraints_of, in_words, is_constant
from tvimdesign.solve.nlp.problem import Problem
from tvimdesign.solve.nlp.problem_parts import Objective
from tvimdesign.solve.nlp.solution import Start
from tvimdesign.solve.nlp.solver_run import Array
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Range, Study

STEP = 1e-4
"""Step of the differences, in unknowns, which are logarithms or of order one; fourth order, so its error is 1e-16."""
DERIVATIVE_TOLERANCE = 1e-4
"""Largest difference, over the size of a row's derivatives, that comes of rounding and of steps in time that are solved
to so many digits."""
DEPENDENT = 1e-9
"""Singular value, as a share of the greatest, below which a direction changes nothing."""
_FLAT = 1e-3
"""Size of a row's derivatives below which it is flat, and differences are rounding."""
_PART = 0.1
_BADLY_SCALED = 1e8
_NEARLY_SINGULAR = 1e12
_WORST = 3
_RANDOM = 4


@dataclass(frozen=True)
class ValueRange:
    """Range of the sizes of rows, or columns, of a Jacobian, with the names of the smallest and largest."""

    largest: tuple[str, float]
    smallest: tuple[str, float]

    @property
    def ratio(self) -> float:
        """Largest over smallest."""
        return self.largest[1] / self.smallest[1]

    @property
    def good(self) -> bool:
        """True if the solver need not mind the range."""
        return self.ratio < _BADLY_SCALED


@dataclass(frozen=True)
class Conditioning:
    """Effect of the free numbers on limits and objective over their whole ranges, with the equations satisfied."""

    equations: float
    """Condition number of the equations that states and times follow from, rows scaled to one; 1-norm."""
    decisions: float
    """Greatest over least singular value of limits and objective by the free numbers, rows scaled to one."""
    objectives: tuple[tuple[str, ...], ...]
    """Free numbers that can be traded for each other without any limit or the objective noticing."""

    @property
    def good(self) -> bool:
        """True if the equations are far from singular."""
        return self.equations < _NEARLY_SINGULAR


@dataclass(frozen=True)
class DerivativeCheck:
    """Exact derivatives against central differences at the first point."""

    worst: tuple[tuple[str, str, float], ...]
    """(row, by what, difference as a share of the size of the row's derivatives), the greatest first."""

    @property
    def right(self) -> bool:
        """Return whether that explains all of it."""
        return all(error <= DERIVATIVE_TOLERANCE for _, _, error in self.worst)


@dataclass(frozen=True)
class Structure:
    """Free numbers without effect, and limits that no free number changes."""

    idle: tuple[str, ...]
    """Free numbers that neither a limit nor the objective depends on."""
    unchangeable: tuple[str, ...]
    """Limits of the study that nothing free can change, though they hold."""
    goal_flat: bool
    """True where the goal has no derivative by any unknown."""


class Inspection:
    """A problem at the first point it would be solved from."""

    def __init__(self, optimizer: Optimizer) -> None:
        """Evaluate rows, objective and their exact derivatives there."""
        problem = optimizer.problem
        self.optimizer, self.problem = optimizer, problem
        self.begin = next(optimizer.multistart.points())
        self._x = optimizer.guess(self.begin)
        self._parameters = optimizer.parameters(Objective(optimizer.study.minimize))
        problem.place_grids(self._x, self._parameters)
        here = problem.at(self._x, self._parameters)
        self._jacobian = np.vstack([here.jacobian, here.gradient])
        self._columns = unknown_names(problem)
        self._rows = [*row_names(problem), "goal"]

    def scaling(self) -> tuple[ValueRange, ValueRange]:
        """Rows, then columns; those without any entry are left to `structure`."""
        triplets = np.nonzero(self._jacobian)
        entries = np.abs(self._jacobian[triplets])
        return self._spread(triplets[0], entries, self._rows), self._spread(triplets[1], entries, self._columns)

    @staticmethod
    def _spread(places: NDArray[np.int_], entries: Array, names: Sequence[str]) -> ValueRange:
        greatest = np.zeros(len(names))
        np.maximum.at(greatest, places, entries)
        used = np.flatnonzero(greatest)
        ends = used[np.argmax(greatest[used])], used[np.argmin(greatest[used])]
        return ValueRange(*((names[i], float(greatest[i])) for i in ends))

    def conditioning(self) -> Conditioning:
        """Return the equations' condition number and the effect of the free numbers on limits and objective."""
        decided, along, equations = self._along()
        first = self.problem.equation_count
        seen = [*range(first, first + len(self.problem.limits)), len(self._rows) - 1]
        matrix = self._jacobian[seen] @ along * self._widths(decided)
        sizes = np.linalg.norm(matrix, axis=1)
        matrix = matrix[sizes > 0.0] / sizes[sizes > 0.0, None]
        directions = np.linalg.svd(matrix)
        values = np.zeros(len(decided))
        values[: len(directions.S)] = directions.S
        lost = [directions.Vh[i] for i in np.flatnonzero(values <= DEPENDENT * values[0])]
        names = np.array([self._columns[i] for i in decided])
        objectives = tuple(dict.fromkeys(tuple(names[np.abs(direction) > _PART]) for direction in lost))
        least = values[-1] if not lost else 0.0
        return Conditioning(equations, float(values[0] / least) if least > 0.0 else np.inf, objectives)

    def _widths(self, decided: Sequence[int]) -> Array:
        """Return the range of each decision, in unknowns."""
        lower, upper = self.optimizer.vector.bounds({})
        return np.array([upper[i] - lower[i] for i in decided])

    def _along(self) -> tuple[list[int], Array, float]:
        """Return the free numbers' places, derivatives of all unknowns by them, and the equations' condition number."""
        problem = self.problem
        decided = [*range(len(problem.free))]
        stay = {i for _, place in self.optimizer.vector.places_of_currents() for i in range(place.start, place.stop)}
        follow = [i for i in range(len(decided), problem.unknown_count) if i not in stay]
        along = np.zeros((problem.unknown_count, len(decided)))
        along[decided, range(len(decided))] = 1.0
        if not follow:
            return decided, along, 1.0
        nothing = np.zeros(problem.row_count)
        by = self._jacobian[[*range(len(problem.free_currents)), *problem.tied(nothing, self._values(self._x)[:-1])]]
        square = by[:, follow] / np.max(np.abs(by[:, follow]), axis=1, keepdims=True)
        along[follow] = -np.linalg.solve(by[:, follow], by[:, decided])
        return decided, along, float(np.linalg.cond(square, 1))

    def derivatives(self) -> DerivativeCheck:
        """Along every free number, and along random directions of the other unknowns."""
        count, free = self.problem.unknown_count, len(self.problem.free)
        random = np.random.default_rng(self.optimizer.study.solver.seed)
        directions = [(self._columns[i], np.eye(1, count, i).ravel()) for i in range(free)]
        if count > free:
            others = random.choice([-1.0, 1.0], (_RANDOM, count))
            others[:, :free] = 0.0
            directions += [("currents, times and peaks together", direction) for direction in others]
        sizes = np.linalg.norm(self._jacobian, axis=1)
        differences = []
        for name, direction in directions:
            exact = self._jacobian @ direction
            error = np.abs(self._difference(direction) - exact) / np.maximum(sizes, _FLAT)
            worst = int(np.argmax(error))
            differences.append((self._rows[worst], name, float(error[worst])))
        return DerivativeCheck(tuple(sorted(differences, key=lambda difference: -difference[2])[:_WORST]))

    def _difference(self, direction: Array) -> Array:
        """(f(-2h) - 8 f(-h) + 8 f(h) - f(2h))/12h."""
        weights = ((-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0))
        total: Any = sum(w * self._values(self._x + k * STEP * direction) for k, w in weights)
        return np.asarray(total) / (12.0 * STEP)

    def _values(self, x: Array) -> Array:
        point = self.problem.at(x, self._parameters)
        return np.append(point.rows, point.objective)

    def structure(self) -> Structure:
        """Return the free numbers without effect on limits or objective, and the limits that no free number changes."""
        optimizer = self.optimizer
        table, free = optimizer.table, [number.name for number in optimizer.free]
        used = set(np.flatnonzero(np.any(self._jacobian != 0.0, axis=0)).tolist())
        current_profiles = [current.row for current in optimizer.currents]
        own = [
            limit
            for limit in constraints_of(optimizer.study, table, optimizer.model.words)
            if limit.origin == "require"
        ]
        fixed = [limit for limit in own if is_constant(limit, table, [*free, *current_profiles])]
        return Structure(
            idle=tuple(name for i, name in enumerate(free) if i not in used),
            unchangeable=tuple(in_words(limit, table) for limit in fixed),
            goal_flat=not np.any(self._jacobian[-1]),
        )


def unknown_names(problem: Problem) -> list[str]:
    """Return a name for every unknown."""
    names = [free.name for free in problem.free]
    for current in problem.free_currents:
        names += [f"{current.row} during {current.phase}"] * current.nodes + [f"length of {current.phase}"]
    return names + [peak.row.name for peak in problem.peaks]


def row_names(problem: Problem) -> list[str]:
    """Return a name for every row."""
    names = [f"end of {current.phase}" for current in problem.free_currents]
    names += [f"shares of {mixture.name}" for mixture in problem.mixtures]
    names += [limit.name for limit in problem.limits]
    names += [f"bound {i + 1} on what is traded" for i in range(len(problem.objectives))]
    names += ["slew of the supply"] * problem.slope_count
    names += [f"{event} within the horizon" for event in problem.unlimited]
    return names + ["samples below their peak"] * problem.sample_count


@dataclass(frozen=True)
class Diagnostics:
    """Everything the check found."""

    rows: ValueRange
    columns: ValueRange
    conditioning: Conditioning
    derivatives: DerivativeCheck
    structure: Structure
    start: Start
    """One run of the solver from the first point."""

    @property
    def sound(self) -> bool:
        """True if nothing speaks against the problem."""
        return (
            self.derivatives.right
            and not self.structure.idle
            and not self.structure.goal_flat
            and self.conditioning.good
            and self.rows.good
            and self.columns.good
        )


def inspect_study(study: Study, progress: Callable[[str], None]) -> Diagnostics:
    """Build the problem of a study at its start's records, inspect it, and solve it once. Raises InputError."""
    table = study.table
    if not any(isinstance(vary, Range) for vary in study.vary.values()):
        raise InputError(f"{study.name}: varies no number between limits, so there is no problem to look at deeper")
    numbers = {name: vary for name, vary in study.vary.items() if not isinstance(table.quantity(name), Choice)}
    words = {
        name: str(vary.values[0])
        for name, vary in study.vary.items()
        if name not in numbers and not isinstance(vary, Range) and name not in study.module
    }
    study = study.model_copy(update={"vary": numbers, "module": {**study.module, **words}})
    progress("building the problem")
    optimizer = Optimizer(study, progress=progress)
    inspection = Inspection(optimizer)
    rows, columns = inspection.scaling()
    progress("comparing derivatives with differences")
    derivatives = inspection.derivatives()
    progress("conditioning")
    conditioning = inspection.conditioning()
    structure = inspection.structure()
    progress("solving once")
    start = optimizer.solve(begin=inspection.begin).start
    return Diagnostics(rows, columns, conditioning, derivatives, structure, start)
