"""A sweep as it is to be done: the study without its sweep, the cells, what is kept of each; read before it begins."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

from tvimdesign.base.errors import InputError
from tvimdesign.device import Choice
from tvimdesign.study import Study, read_tree
from tvimdesign.study.reader import read_swept
from tvimdesign.study.sections.sweep_block import EVERY_OUTPUT, SweepBlock, SweptAxis
from tvimdesign.study.text.mistakes import StudyError
from tvimdesign.study.text.yaml_text import Node, Text
from tvimdesign.study.tree import StudyTree, with_value, without_section
from tvimdesign.sweep.points import CellPoints, Texts, axis_value, written

ALWAYS = ("module_mass", "envelope_diameter", "response_time")
"""Outputs that every table has, whatever the study minimises and requires."""


@dataclass(frozen=True)
class SweepPlan:
    """Plan of a sweep, cell by cell."""

    tree: StudyTree
    """The study without `sweep` and `front`."""
    study: Study
    block: SweepBlock
    written: StudyTree
    """As it was written, its sweep included."""

    @cached_property
    def points(self) -> CellPoints:
        """Return the values of the cells."""
        return CellPoints(self.block)

    @property
    def axes(self) -> tuple[SweptAxis, ...]:
        """Return the swept axes."""
        return self.block.axes

    @property
    def count(self) -> int:
        """Return how many cells there are."""
        return self.points.count

    @cached_property
    def first(self) -> Study:
        """The study of the first cell, as what is free and what is limited is the same in every cell."""
        return read_tree(self.cell_tree(self.points.texts(0)))

    @property
    def task(self) -> Literal["evaluate", "optimize"]:
        """Return what is done in each cell."""
        return "optimize" if self.first.task == "optimize" and self.block.task != "evaluate" else "evaluate"

    def axis_values(self, cell: int) -> list[float | str]:
        """Return where a cell stands on each axis: numbers in the axis's unit, of limits as well; else the words."""
        return [axis_value(axis, text) for axis, text in zip(self.axes, self.points.texts(cell), strict=True)]

    def cell_tree(self, texts: Texts) -> StudyTree:
        """Return the study of a cell, as it would be written."""
        return set_in(self.tree, [axis.name for axis in self.axes], texts)

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
        return tuple(dict.fromkeys([*self.asked, *self.block.outputs]))

    @property
    def asked(self) -> tuple[str, ...]:
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
    plan = SweepPlan(without_section(without_section(tree, "sweep"), "front"), study, block, tree)
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
    start, problems = plan.points.texts(0), []
    for place, axis in enumerate(plan.axes):
        listed = [row[place] for row in plan.block.rows] if plan.block.rows else list(axis.values)
        seen = set()
        for node in listed or [_end(axis, share) for share in (0, 1)]:
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


def _end(axis: SweptAxis, share: int) -> Text:
    assert axis.range is not None  # an axis without values has one
    return Text(0, 0, written(axis, (axis.range.lower, axis.range.upper)[share]), plain=False)
