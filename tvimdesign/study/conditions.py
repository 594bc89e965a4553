"""The conditions that studies share in a comparison, and the messages where they differ.

Compared are designs, not tasks: what the joint must do (stroke, load, requirements, objective), where it does it
(surroundings, operating points) and what it is made of apart from its springs (Peltier module and current, structure,
PCL) must be the same. Layout and springs are each study's own; so are limits on outputs that one mode alone has.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from tvimdesign.base.record import Record
from tvimdesign.base.units import format_quantity
from tvimdesign.device import Choice, Input
from tvimdesign.study.resolve import given
from tvimdesign.study.study import Range, Requirement, Robust, Study, Vary
from tvimdesign.study.text.mistakes import At, Mistake, Mistakes, StudyError, printable, read_text
from tvimdesign.study.text.values import ROUNDING
from tvimdesign.study.text.yaml_text import LOADER, place_of

_OWN_GROUPS = ("Layout", "Springs", "Cost")
_OWN_CHOICES = ("spring_material", "heater_fuse")  # a fuse goes by its design's temperatures
_ASKED_OF_THE_LAYOUT = ("stroke",)
"""Inputs that stand with the layout and are no dimension of it: what the joint must do."""


@dataclass(frozen=True)
class Case:
    """One study that is to be compared."""

    path: Path
    study: Study

    @property
    def file(self) -> str:
        """Its file, as messages name it."""
        return printable(self.path)

    @cached_property
    def _root(self) -> Any:
        return yaml.compose(read_text(self.path, Mistakes(self.file)), Loader=LOADER)

    def at(self, path: str) -> At:
        """Return the place of a key such as `module.current`, or of the section that it would stand in."""
        return place_of(self._root, path)

    def place(self, path: str) -> str:
        """Return that place as `file:line:column`."""
        at = self.at(path)
        return f"{self.file}:{at.line}:{at.column}"

    @cached_property
    def values(self) -> dict[str, Any]:
        """Its inputs and choices, ranges at their start."""
        return given(self.study)


class _Condition(NamedTuple):
    """Something that must be the same: its name, where it stands in the study, what it is, and that in words."""

    name: str
    path: str
    value: Any
    words: str


def refuse_unequal(cases: Sequence[Case]) -> None:
    """Raise StudyError with everything in which studies differ that must be the same, each with both places."""
    refuse_repeated(cases)
    problems = differences(cases)
    if problems:
        raise StudyError(problems)


def differences(cases: Sequence[Case]) -> list[Mistake]:
    """Return everything in which studies differ that is the same in a fair comparison, each with both places."""
    problems = [*_evaluated_only(cases)]
    for other in cases[1:]:
        problems += _unequal_conditions(cases[0], other)
        problems += _unequal_requirements(cases, other)
    return problems


def _problem(of: Case, path: str, message: str, expected: str, hint: str = "") -> Mistake:
    at = of.at(path)
    return Mistake(of.file, at.line, at.column, path, message, expected, hint)


def refuse_repeated(cases: Sequence[Case]) -> None:
    """Raise StudyError if a file is given twice."""
    paths = [case.path.resolve() for case in cases]
    repeated = [case for i, case in enumerate(cases) if paths[i] in paths[:i]]
    if repeated:
        raise StudyError([Mistake(case.file, 0, 0, "", "given twice", "different studies") for case in repeated])


def _evaluated_only(cases: Sequence[Case]) -> Iterator[Mistake]:
    """Yield the studies that are only evaluated beside others that are optimised."""
    optimised = [case for case in cases if case.study.vary]
    for case in cases:
        if optimised and not case.study.vary:
            other = optimised[0].place("vary")
            yield _problem(
                case, "vary", f"missing: this study is evaluated only, that of {other} is optimised",
                "`vary` and `minimize` in every study or in none", "each is to be optimised for itself",
            )  # fmt: skip


def _unequal_conditions(first: Case, other: Case) -> Iterator[Mistake]:
    theirs, mine = ({condition.name: condition for condition in _conditions(case)} for case in (first, other))
    differing = {name for name in theirs.keys() & mine.keys() if not _same(theirs[name].value, mine[name].value)}
    for name in (name for name in mine if name in differing):
        row = first.study.table.by_name.get(name)
        if isinstance(row, Input) and row.record and row.record[0] in differing:
            continue  # another record, which is reported
        message = f"{mine[name].words} here, {theirs[name].words} in {first.place(theirs[name].path)}"
        yield _problem(other, mine[name].path, message, "the same in every study that is compared")
    for case, lacking, names in ((first, other, theirs), (other, first, mine)):
        for point in dict.fromkeys(name.partition(".")[0] for name in names if "." in name):
            if point not in lacking.study.operating_points:
                message = f"there is no operating point {point} here, as in {case.place(f'operating_points.{point}')}"
                yield _problem(lacking, "operating_points", message, "the same operating points in every study")


def _conditions(of: Case) -> Iterator[_Condition]:
    """Yield everything that must be the same, apart from requirements."""
    study = of.study
    for row in of.study.table.quantities:
        if isinstance(row, Input | Choice) and _is_condition(row):
            vary, value = study.vary.get(row.name), of.values[row.name]
            path = f"vary.{row.name}" if vary else f"module.{row.name}"
            plain = replace(value, file="") if isinstance(value, Record) else value
            yield _Condition(row.name, path, (plain, _limits(vary)), _in_words(row, value, vary))
    for point, values in study.operating_points.items():
        for name, value in values.items():
            words = format_quantity(value, of.study.table.unit(name))
            yield _Condition(f"{point}.{name}", f"operating_points.{point}.{name}", value, words)
    for phase, pieces in study.profile.model_dump().items():
        yield _Condition(f"profile of {phase}", f"profile.{phase}", pieces, f"{pieces} pieces")
    for name in ("cells", "fineness"):
        value = getattr(study.solver, name)
        yield _Condition(name, f"solver.{name}", value, str(value))
    robust = study.robust and (study.robust.sigma, study.robust.share, study.robust.plausible)
    yield _Condition("robust", "robust", robust, _robust_in_words(study.robust))
    if study.vary:
        shares = ", ".join(f"{name} {weight:g}" for name, weight in study.minimize.items())
        yield _Condition("objective", "minimize", dict(study.minimize), f"the objective is {shares}")


def _robust_in_words(robust: Robust | None) -> str:
    if robust is not None and robust.share is not None:
        plausible = f", each in {robust.plausible:.3g} of the plausible cases" if robust.plausible else ""
        return f"{robust.share:.3g} of the modules satisfy the limits{plausible}"
    return f"limits are satisfied by {robust.sigma if robust and robust.sigma else 0.0:.3g} standard deviations"


def _is_condition(row: Input | Choice) -> bool:
    if isinstance(row, Choice):
        return row.group not in _OWN_GROUPS and row.name not in _OWN_CHOICES
    if row.per_point or row.mode is not None:
        return False
    if row.record is not None:
        return row.record[0] not in _OWN_CHOICES and row.group not in _OWN_GROUPS
    return row.group not in _OWN_GROUPS or row.name in _ASKED_OF_THE_LAYOUT


def _limits(vary: Vary | None) -> tuple[Any, ...]:
    if vary is None:
        return ()
    return (vary.lower, vary.upper) if isinstance(vary, Range) else vary.values


def _in_words(row: Input | Choice, value: Any, vary: Vary | None) -> str:
    if isinstance(row, Choice):
        word = value.name if isinstance(value, Record) else str(value)
        return word if vary is None else f"one of {', '.join(str(v) for v in _limits(vary))}, drawn with {word}"
    shown = format_quantity(value, row.unit)
    if vary is None:
        return shown
    ends = [format_quantity(float(end), row.unit) for end in _limits(vary)]
    return f"{' to '.join(ends) if isinstance(vary, Range) else ', '.join(ends)}, drawn with {shown}"


def _same(a: Any, b: Any) -> bool:
    """Return whether two values mean the same, quantities up to rounding."""
    if isinstance(a, float | int) and isinstance(b, float | int):
        return math.isclose(a, b, rel_tol=ROUNDING)
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(_same(x, y) for x, y in zip(a, b, strict=True))
    return bool(a == b)


def _unequal_requirements(cases: Sequence[Case], other: Case) -> Iterator[Mistake]:
    """Limits of `other` against those of the first study whose mode has the output."""
    reported: set[str] = set()
    for earlier in cases[: cases.index(other)]:
        common = (earlier.study.table.by_name.keys() & other.study.table.by_name.keys()) - reported
        reported |= common
        theirs, mine = (
            {(limit.output, limit.sense): limit for limit in case.study.require
             if limit.output.partition("@")[0] in common}
            for case in (earlier, other)
        )  # fmt: skip
        for key in dict.fromkeys([*mine, *theirs]):
            if key not in mine:
                place = earlier.place(f"require.{key[0]}")
                message = f"{_limit(other, theirs[key])} is not required here, and is in {place}"
                yield _problem(other, "require", message, _ALIKE, f"add {_line(theirs[key])}")
            elif key not in theirs:
                message = f"{_limit(other, mine[key])} is required here, and not in {earlier.place('require')}"
                yield _problem(other, f"require.{key[0]}", message, _ALIKE, f"add {_line(mine[key])} there")
            elif not _same(mine[key].limit, theirs[key].limit):
                place = earlier.place(f"require.{key[0]}")
                message = f"{_limit(other, mine[key])} here, {_limit(other, theirs[key])} in {place}"
                yield _problem(other, f"require.{key[0]}", message, _ALIKE)


_ALIKE = "the same limits in every study that is compared"


def _limit(of: Case, requirement: Requirement) -> str:
    value = format_quantity(requirement.limit, of.study.table.unit(requirement.output))
    return f"{requirement.output} {requirement.sense} {value}"


def _line(requirement: Requirement) -> str:
    return f'`{requirement.output}: "{requirement.text}"`'
