"""A sweep as planned: the study without its sweep, positions of the cells, what each stores; the work as plain data."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import from_si, parse_quantity
from tvimdesign.device import Choice
from tvimdesign.study import Study, StudyTree, read_swept, read_tree, with_value, without_section
from tvimdesign.study.sections.sweeps import EVERY_OUTPUT, SweepBlock, SweptAxis, SweptRange
from tvimdesign.study.text.mistakes import StudyError
from tvimdesign.study.text.yaml_text import Node, Text

Texts = tuple[str, ...]
_DIGITS = 12  # Of a number between two ends: as many as parse to the same value to 1e-12, and a table still shows


def written(axis: SweptAxis, value: float) -> str:
    """Return a number of an axis (SI) as a study would write it: `>= 12.5 N*m`."""
    text = f"{from_si(value, axis.unit):.{_DIGITS}g}"
    unit = "" if axis.unit == "1" else f" {axis.unit}"
    return f"{axis.sense} {text}{unit}".strip()


def axis_value(axis: SweptAxis, text: str) -> float | str:
    """Return a number of an axis in its unit, of a limit as well; a word as it is written."""
    if is_words(axis):
        return text
    return rounded(from_si(parse_quantity(text.lstrip("<>= "), axis.unit), axis.unit))


def is_words(axis: SweptAxis) -> bool:
    """Return whether an axis has no one number: words, settings, limits in both senses."""
    return not axis.unit or len(senses(axis)) > 1


def senses(axis: SweptAxis) -> set[str]:
    """Return `<=` and `>=`, as far as an axis has them."""
    if axis.range:
        return {axis.sense} if axis.sense else set()
    return {text.value.strip()[:2] for text in axis.values} & {"<=", ">="}


def rounded(value: float) -> float:
    """Round to twelve digits: a conversion of units adds noise in the sixteenth."""
    return float(f"{value:.{_DIGITS}g}") if math.isfinite(value) else value


def _length(axis: SweptAxis) -> int:
    return axis.range.count if axis.range else len(axis.values)


def _nth(axis: SweptAxis, place: int) -> str:
    """Return a value of a grid: one of the list, or evenly between the ends."""
    if axis.range is None:
        return axis.values[place].value
    return written(axis, _between(axis.range, place / (axis.range.count - 1) if axis.range.count > 1 else 0.0))


def _at_share(axis: SweptAxis, share: float) -> str:
    """Return a value of a sample: each of a list, or each whole number, as often as the others."""
    span = axis.range
    if span is None:
        return axis.values[int(share * len(axis.values))].value
    if axis.whole:
        return written(axis, span.lower + math.floor(share * (span.upper - span.lower + 1.0)))
    return written(axis, _between(span, share))


def _between(span: SweptRange, share: float) -> float:
    if span.logarithmic:
        return float(span.lower * (span.upper / span.lower) ** share)
    return span.lower + share * (span.upper - span.lower)


ALWAYS = ("module_mass", "envelope_diameter", "response_time")
"""Outputs that every table has, whatever the study minimises and requires."""


@dataclass(frozen=True)
class SweepPlan:
    """Plan of a sweep, cell by cell: of a grid the last axis changes fastest. It can be pickled."""

    tree: StudyTree  # The study without `sweep` and `front`; its folder is a whole path, as workers may start elsewhere
    study: Study
    block: SweepBlock
    written: StudyTree  # As it was written, its sweep included

    @cached_property
    def count(self) -> int:
        """Return how many cells there are."""
        if self.block.method == "list":
            return len(self.block.rows)
        return self.block.count or math.prod(_length(axis) for axis in self.block.axes)

    def texts(self, cell: int) -> Texts:
        """Return what each axis is set to in a cell, by its number from 0."""
        axes = self.block.axes
        if self.block.method == "list":
            return tuple(text.value for text in self.block.rows[cell])
        if self.block.method == "grid":
            return tuple(_nth(axis, place) for axis, place in zip(axes, self._places(cell), strict=True))
        return tuple(_at_share(axis, share) for axis, share in zip(axes, self._shares[cell], strict=True))

    def _places(self, cell: int) -> Sequence[int]:
        places = []
        for axis in reversed(self.block.axes):
            cell, place = divmod(cell, _length(axis))
            places.append(place)
        return places[::-1]

    @cached_property
    def _shares(self) -> NDArray[np.float64]:
        """A row a cell of a sample, each number from 0 up to 1."""
        from scipy.stats import qmc

        axes, count, seed = len(self.block.axes), self.block.count, self.block.seed
        if self.block.method == "sobol":  # of a power of two, so that the sequence is balanced; the first are taken
            return qmc.Sobol(axes, rng=seed).random_base2(max(count - 1, 1).bit_length())[:count]
        return qmc.LatinHypercube(axes, rng=seed).random(count)

    def __getstate__(self) -> dict[str, Any]:
        """Return what a pickle holds; a sample is drawn again where it is read."""
        return {name: value for name, value in vars(self).items() if name != "_shares"}

    @cached_property
    def first(self) -> Study:
        """The study of the first cell, as what is free and what is limited is the same in every cell."""
        return read_tree(self.cell_tree(self.texts(0)))

    @property
    def task(self) -> Literal["evaluate", "optimize"]:
        """Return what is done in each cell."""
        return "optimize" if self.first.task == "optimize" and self.block.task != "evaluate" else "evaluate"

    def axis_values(self, cell: int) -> list[float | str]:
        """Return where a cell stands on each axis: numbers in the axis's unit, of limits as well; else the words."""
        return [axis_value(axis, text) for axis, text in zip(self.block.axes, self.texts(cell), strict=True)]

    def words(self, texts: Texts) -> Texts:
        """Return what a cell is set to, without what a search can follow from another cell's optimum."""
        return tuple("" if axis.number else text for axis, text in zip(self.block.axes, texts, strict=True))

    def cell_tree(self, texts: Texts) -> StudyTree:
        """Return the study of a cell, as it would be written."""
        return set_in(self.tree, [axis.name for axis in self.block.axes], texts)

    @cached_property
    def columns(self) -> tuple[str, ...]:
        """Return the outputs of each cell by full name: those the study asks about, and those the block names."""
        study = self.first
        if EVERY_OUTPUT in self.block.outputs:
            rows = [row for row in study.table.outputs if not (row.instant or row.hidden)]
            points = tuple(study.operating_points)
            names = [f"{row.name}@{point}" if row.per_point else row.name
                     for row in rows for point in (points if row.per_point else ("",))]  # fmt: skip
            return tuple(dict.fromkeys([*study.vary, *names]))
        return tuple(dict.fromkeys([*self.study_outputs, *self.block.outputs]))

    @property
    def study_outputs(self) -> tuple[str, ...]:
        """Return the outputs the study asks about: those it minimises, limits and varies, and those every table has."""
        study = self.first
        limits = [limit.output for limit in study.require]
        return tuple(dict.fromkeys([*study.minimize, *limits, *ALWAYS, *study.vary]))

    def unit(self, column: str) -> str:
        """Return the unit of a column; empty for words."""
        row = self.study.table.by_name.get(column.partition("@")[0])
        return "" if row is None or isinstance(row, Choice) else str(row.unit)


def set_in(tree: StudyTree, names: Sequence[str], texts: Sequence[str]) -> StudyTree:
    """Return the study's tree with values set, as `--set` does it. Raises StudyError."""
    for name, text in zip(names, texts, strict=True):
        tree = _with(tree, name, Text(0, 0, text, plain=False, file=f"{name} = {text}"))
    return tree


def _with(tree: StudyTree, name: str, value: Node) -> StudyTree:
    return replace(with_value(tree, name, value, "sweep"), changes=tree.changes)


def plan_of(tree: StudyTree) -> SweepPlan:
    """Read what a study asks to be swept, each value of each axis.

    Raises StudyError with every mistake, InputError where nothing is swept, or more cells than `sweep.most`.
    """
    study, block = read_swept(tree)
    if block is None:
        raise InputError(
            f"{tree.file}: there is no `sweep:`; add, for one, "
            "sweep: {over: {pcl_thickness: {from: 0.6 mm, to: 2 mm, count: 20}}}"
        )
    if study.simulated:
        listed = ", ".join(limit.output for limit in study.simulated)
        raise InputError(
            f"require: {listed}: a sweep simulates no duty and no controller; leave it out, or `run` a cell"
        )
    cells_tree = replace(without_section(without_section(tree, "sweep"), "front"), folder=tree.folder.resolve())
    plan = SweepPlan(cells_tree, study, block, tree)
    if plan.count > block.most:
        raise InputError(
            f"{tree.file}: sweep: {plan.count} cells; the limit is {block.most}; take fewer values on an axis, sample "
            f"(`method: latin_hypercube, count: 2000`), or say `most: {plan.count}` where you mean it"
        )
    _refuse_wrong_values(plan)
    return plan


def swept_cells(tree: StudyTree) -> int:
    """Return how many cells a study asks to be swept; 0 where none. Raises as `plan_of` does."""
    return plan_of(tree).count if read_swept(tree)[1] else 0


def _refuse_wrong_values(plan: SweepPlan) -> None:
    """Read the study once with each listed value, the other axes as in the first cell."""
    start, problems = plan.texts(0), []
    for place, axis in enumerate(plan.block.axes):
        listed = [row[place] for row in plan.block.rows] if plan.block.rows else list(axis.values)
        seen = set()
        ends = [axis.range.lower, axis.range.upper] if axis.range else []
        for node in listed or [Text(0, 0, written(axis, end), plain=False) for end in ends]:
            if node.value in seen:
                continue
            seen.add(node.value)
            texts = (*start[:place], node.value, *start[place + 1 :])
            tree = plan.cell_tree(texts)
            try:
                read_tree(_with(tree, axis.name, node))
            except StudyError as error:
                problems += [problem for problem in error.problems if problem not in problems]
    if problems:
        raise StudyError(problems)


class Cell(NamedTuple):
    """One cell: its key, and what each axis is set to."""

    key: str
    texts: Texts


class CellAnswer(NamedTuple):
    """The answer of a cell."""

    status: str  # `evaluated`, `optimal`, `above_rating`, ... or `infeasible`, `refused`, `crashed`.
    reason: str  # Why there is no design, or what it violates; empty where there is nothing to say
    violated: int | None  # Count of limits that are violated; None where there is no design
    margin: float | None  # The least margin over all limits, as a share
    values: tuple[float | str | None, ...]
    """SI, in the order of the columns; words of what is chosen; None where there is none."""
    warm: bool = False  # True if the search began at another cell's optimum and found this one's
