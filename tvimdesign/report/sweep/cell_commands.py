"""The commands that make one cell of a sweep a run of its own, or open it in the explorer."""

from __future__ import annotations

import shlex
from pathlib import Path

from tvimdesign.base.units import from_si
from tvimdesign.device import Choice
from tvimdesign.study import given
from tvimdesign.sweep.plan import SweepPlan

_DIGITS = 12
_PLAIN = frozenset('"$`\\!')
"""Characters that double quotes do not keep as they are."""


class CellCommands:
    """Writes the commands of a sweep's cells; `out` is its folder."""

    def __init__(self, plan: SweepPlan, out: Path) -> None:
        """Find what every command has: the study, and what a run of it is to leave out."""
        self._plan, self._out = plan, out
        path = plan.tree.path
        changed = path is None or bool(plan.written.changes)
        study = str(out / "study.yaml" if path is None or changed else path)
        self._study = shlex.quote(study)
        folder = plan.study.catalog_folder
        self._always = [f"catalog={Path(folder).resolve()}"] if changed and folder else []
        self._always += ["front="] if plan.written.section("front") else []
        self._always += _starts(plan) if plan.task == "evaluate" else []

    def run(self, cell: int) -> str:
        """Do the cell, by its number from 1, as a study of its own."""
        return f"tvimdesign run {self._study} {self._settings(cell)} --out {shlex.quote(f'{self._out}-cell-{cell}')}"

    def explore(self, cell: int) -> str:
        """Open the cell in the explorer."""
        out = shlex.quote(f"{self._out}-cell-{cell}-explore")
        return f"tvimdesign explore {self._study} {self._settings(cell)} --out {out}"

    def _settings(self, cell: int) -> str:
        texts = self._plan.points.texts(cell - 1)
        here = [f"{axis.name}={text}" for axis, text in zip(self._plan.axes, texts, strict=True)]
        return " ".join(f"--set {_quoted(setting)}" for setting in [*here, *self._always])


def _starts(plan: SweepPlan) -> list[str]:
    """What a cell that is only evaluated has where the study varies something: its start, which a run would leave."""
    numbers, settings = given(plan.first), []
    for name in plan.first.vary:
        value, row = numbers[name], plan.study.table.by_name[name]
        if isinstance(row, Choice):
            settings.append(f"{name}={getattr(value, 'name', value)}")
            continue
        unit = plan.unit(name)
        settings.append(f"{name}={from_si(float(value), unit):.{_DIGITS}g}{'' if unit == '1' else f' {unit}'}")
    return settings


def _quoted(setting: str) -> str:
    """A setting as shells of all systems take it."""
    return shlex.quote(setting) if _PLAIN & set(setting) else f'"{setting}"'
