"""Contradictions that bounds alone prove, before anything is solved: which limits, and what the ranges allow at best.

Only limits on algebraic outputs are looked at: times, and what depends on them, are out of an interval's reach.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from tvimdesign.base.errors import InfeasibleError
from tvimdesign.base.units import format_quantity
from tvimdesign.catalog import Catalog
from tvimdesign.device import Input, Table
from tvimdesign.simulation.casadi_setup import ca
from tvimdesign.simulation.device_functions import DeviceFunctions
from tvimdesign.solve.infeasibility.enclosure import Array, Enclosure
from tvimdesign.solve.infeasibility.interval_search import Paver
from tvimdesign.solve.nlp.constraints import Constraint, constraints_of, in_words, is_constant, on_cycle, unchangeable
from tvimdesign.solve.optimizer.optimizer import ALGEBRAIC_TOLERANCE
from tvimdesign.study import Options, Range, Study, given

_BOXES = 16
"""Boxes a proof may take: it costs a tenth of a second, and what it finds does not depend on the machine."""
_MOST_RECORDS = 20
_BISECTIONS = 10
_FARTHEST = 1e3
"""Scales of a limit beyond which no peace is looked for."""


@dataclass(frozen=True)
class Ranges:
    """A study with its records chosen: its algebraic limits over what its numbers may be."""

    table: Table
    model: DeviceFunctions
    free: tuple[str, ...]
    low: Array
    high: Array
    limits: tuple[Constraint, ...]

    def enclosure(self, outputs: Sequence[str]) -> Enclosure:
        """Outputs as functions of the free numbers."""
        return Enclosure(self.model, outputs, self.free)


def ranges_of(study: Study, catalog: Catalog, table: Table) -> Ranges:
    """The numbers a study varies, listed ones between their ends; a current that follows a profile is none of them."""
    model = DeviceFunctions(table, given(study, catalog, table), tuple(study.operating_points), study.solver.cells)
    driven = {table.phase(phase).current_input for phase in study.profile.pieces()}
    ends = {name: _ends(vary) for name, vary in study.vary.items() if name in model.index and name not in driven}
    limits = tuple(limit for limit in constraints_of(study, table, model.words) if not on_cycle(table, limit.output))
    low, high = (np.array([end[i] for end in ends.values()]) for i in (0, 1))
    return Ranges(table, model, tuple(ends), low, high, limits)


def _ends(vary: Range | Options) -> tuple[float, float]:
    if isinstance(vary, Range):
        return vary.lower, vary.upper
    numbers = [float(value) for value in vary.values]
    return min(numbers), max(numbers)


@dataclass(frozen=True)
class InfeasibilityProof:
    """Limits no design within the ranges keeps together; one fewer, and nothing is proved any more."""

    limits: tuple[Constraint, ...]
    at_best: tuple[float, ...]
    """For each limit (SI): where it would have to stand, at least, for the proof to fail while the others stay."""
    widen: tuple[tuple[str, Literal["<=", ">="], float], ...] = ()
    """Of a single limit: the ends of ranges that keep it from holding, those that matter most first."""


def refuse_infeasible(study: Study, catalog: Catalog, table: Table) -> None:
    """Raise InfeasibleError, naming limits and ranges, where bounds prove that no design keeps the study's limits."""
    if not study.vary:
        return
    records = {
        name: vary.values
        for name, vary in study.vary.items()
        if isinstance(vary, Options) and not isinstance(table.quantity(name), Input)
    }
    combinations = list(itertools.product(*records.values()))
    if len(combinations) > _MOST_RECORDS:
        return
    every = []
    for words in combinations:
        chosen = {name: str(word) for name, word in zip(records, words, strict=True)}
        module = study.model_copy(update={"module": {**study.module, **chosen}, "vary": _without(study, records)})
        every.append(ranges_of(module, catalog, table))
        if not proved(every[-1], every[-1].limits):
            return
    found = infeasibility_proof(every[0])
    if found is None:
        return
    reported = _in_words(found, every[0])
    also = f" So it is with every listed {' and '.join(records)}." if records else ""
    raise InfeasibleError(f"{study.name}: {reported}{also}")


def at_a_glance(model: DeviceFunctions, study: Study, table: Table, limits: Sequence[Constraint]) -> bool:
    """Whether one look at the ranges, operation by operation, shows a limit that cannot hold: a hundredth of a second,
    where a proof takes half a one. It misses what only limits together, or parts of ranges, would show.
    """
    free = {name: _ends(vary) for name, vary in study.vary.items() if name in model.index}
    algebraic = [limit for limit in limits if not on_cycle(table, limit.output)]
    outputs = list(dict.fromkeys(limit.output for limit in algebraic))
    if not free or not outputs:
        return False
    low, high = (np.array([[end[i] for end in free.values()]]) for i in (0, 1))
    seen = Enclosure(model, outputs, tuple(free)).natural(low, high)
    place = {name: i for i, name in enumerate(outputs)}
    ends = {"<=": seen.low[0], ">=": seen.high[0]}
    return any(limit.residual(ends[limit.sense][place[limit.output]]) > ALGEBRAIC_TOLERANCE for limit in algebraic)


def _without(study: Study, names: dict[str, tuple[float | str, ...]]) -> dict[str, Range | Options]:
    return {name: vary for name, vary in study.vary.items() if name not in names}


def infeasibility_proof(ranges: Ranges, boxes: int = _BOXES) -> InfeasibilityProof | None:
    """A smallest set of limits that bounds prove cannot hold together; None where they prove nothing."""
    limits = ranges.limits
    if not limits or not ranges.free:
        return None
    enclosure = ranges.enclosure(list(dict.fromkeys(limit.output for limit in limits)))
    proof = Paver(enclosure, limits, ALGEBRAIC_TOLERANCE).pave(ranges.low, ranges.high, np.inf, boxes)
    if not proof.empty:
        return None
    left = [limits[k] for k in proof.cutting]
    for limit in sorted(left, key=lambda one: one.origin == "require"):  # the machine's rules go first
        fewer = [one for one in left if one is not limit]
        if proved(ranges, fewer, boxes):
            left = fewer
    return InfeasibilityProof(
        limits=tuple(left),
        at_best=tuple(_at_best(ranges, left, limit, boxes) for limit in left),
        widen=_in_the_way(ranges, left[0]) if len(left) == 1 else (),
    )


def proved(ranges: Ranges, limits: Sequence[Constraint], boxes: int = _BOXES) -> bool:
    """Whether bounds prove that nothing keeps the limits."""
    if not limits or not ranges.free:
        return False
    enclosure = ranges.enclosure(list(dict.fromkeys(limit.output for limit in limits)))
    return Paver(enclosure, limits, ALGEBRAIC_TOLERANCE).pave(ranges.low, ranges.high, np.inf, boxes).empty


def _at_best(ranges: Ranges, limits: Sequence[Constraint], limit: Constraint, boxes: int) -> float:
    """The easiest value of one of the limits with which the proof still holds; infinite where it always does."""
    sign = 1.0 if limit.sense == "<=" else -1.0
    enclosure = ranges.enclosure(list(dict.fromkeys(one.output for one in limits)))

    def proved(eased: float) -> bool:
        moved = replace(limit, limit=limit.limit + sign * eased * limit.scale)
        with_it = [moved if one is limit else one for one in limits]
        return Paver(enclosure, with_it, ALGEBRAIC_TOLERANCE).pave(ranges.low, ranges.high, np.inf, boxes).empty

    holds, fails = 0.0, 0.01
    while proved(fails):
        holds, fails = fails, 2.0 * fails
        if fails > _FARTHEST:
            return sign * np.inf
    for _ in range(_BISECTIONS):
        middle = 0.5 * (holds + fails)
        holds, fails = (middle, fails) if proved(middle) else (holds, middle)
    return limit.limit + sign * holds * limit.scale


def _in_the_way(ranges: Ranges, limit: Constraint) -> tuple[tuple[str, Literal["<=", ">="], float], ...]:
    """The ends of ranges a limit would have moved, those first that move its output most over their range."""
    enclosure = ranges.enclosure([limit.output])
    slopes = enclosure.slopes(ranges.low[None], ranges.high[None])
    wanted = -1.0 if limit.sense == "<=" else 1.0
    found = []
    for i, name in enumerate(ranges.free):
        low, high = (end[0, 0, i] for end in (slopes.low, slopes.high))
        strength = min(abs(low), abs(high)) * (ranges.high[i] - ranges.low[i])
        if low > 0.0 or high < 0.0:
            up = (low > 0.0) == (wanted > 0.0)
            end: tuple[str, Literal["<=", ">="], float] = (
                (name, "<=", float(ranges.high[i])) if up else (name, ">=", float(ranges.low[i]))
            )
            found.append((strength, end))
    return tuple(end for _, end in sorted(found, key=lambda pair: -pair[0]))


def _fixed(ranges: Ranges, limit: Constraint) -> str | None:
    """The input that could be varied and is not, where a hundredth of it moves a limit's output most of all."""
    model, table = ranges.model, ranges.table
    inputs = ca.SX.sym("inputs", len(model.names))
    cycle = np.full(len(model.switch_names), np.nan)  # read by none of these outputs
    value = model.outputs([limit.output]).call([inputs, cycle], True, False)[0]
    point = model.start.copy()
    point[[model.index[name] for name in ranges.free]] = 0.5 * (ranges.low + ranges.high)
    slopes = np.asarray(ca.Function("slopes", [inputs], [ca.gradient(value, inputs)])(point)).ravel()
    moved = dict(zip(model.names, np.abs(slopes * point), strict=True))
    fixed = [row.name for row in table.inputs if row.variable and row.name in moved]
    most = max([*ranges.free, *fixed], key=moved.__getitem__)
    if most in ranges.free:
        return None
    return f"{most} ({format_quantity(float(point[model.index[most]]), table.unit(most))})"


_ENDS_SHOWN = 3


def _in_words(found: InfeasibilityProof, ranges: Ranges) -> str:
    """The contradiction for people, with what to do."""
    table = ranges.table
    if len(found.limits) == 1:
        limit, best = found.limits[0], found.at_best[0]
        if is_constant(limit, table, ranges.free):
            return unchangeable(limit, table)
        ends = "; ".join(_end(end, table) for end in found.widen[:_ENDS_SHOWN])
        widen = f"Widen what holds it there most ({ends})" if ends else "Widen a range"
        fixed = _fixed(ranges, limit)
        widen += f", vary {fixed}, which moves it more than all that is varied" if fixed else ""
        return (
            f"{_named(limit, table)} cannot hold: within the ranges under `vary` "
            f"{limit.output} is {_best(limit, best, table)}; bounds prove it, nothing was solved. "
            f"{widen}, or ease the limit beyond that."
        )
    lines = [
        "these cannot hold together, whatever is chosen within the ranges under `vary`; bounds prove it, nothing was "
        "solved:"
    ]
    for limit, best in zip(found.limits, found.at_best, strict=True):
        alone = "no value of it alone is known to help"
        if np.isfinite(best):
            alone = f"alone it would have to go beyond {_quantity(limit, best, table)}"
        lines.append(f"  {_named(limit, table)}: {alone}")
    lines.append("Ease one of them that far or farther, or widen a range under `vary`.")
    return "\n".join(lines)


def _named(limit: Constraint, table: Table) -> str:
    words = in_words(limit, table)
    return words if limit.origin == "require" else f"{words} ({limit.origin})"


def _quantity(limit: Constraint, value: float, table: Table) -> str:
    return format_quantity(value, table.unit(limit.output))


def _best(limit: Constraint, best: float, table: Table) -> str:
    if not np.isfinite(best):
        return "never near it"
    return f"{'at least' if limit.sense == '<=' else 'at most'} {_quantity(limit, best, table)}"


def _end(end: tuple[str, Literal["<=", ">="], float], table: Table) -> str:
    name, sense, value = end
    return f"{name} {sense} {format_quantity(value, table.unit(name))}"
