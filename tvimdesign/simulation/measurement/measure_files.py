"""Files to a measurement: read, the kind found where it is not said, its tables fitted."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.kind_sheet import KindSheet, kind_sheet, kind_sheets
from tvimdesign.simulation.measurement.kinds.measurement import LEAST_ROWS, Measurement
from tvimdesign.simulation.measurement.reading.column_map import ColumnMap
from tvimdesign.simulation.measurement.reading.data_file import Block, DataFile, read_data_file

_FLOW = "flow_curve"
_NEAREST = 3
"""Kinds that a refusal names with their needs."""


@dataclass(frozen=True)
class Measured:
    """The fit of some files."""

    kind: KindSheet
    files: tuple[DataFile, ...]
    blocks: tuple[Block, ...]
    """The tables that were fitted."""
    measurement: Measurement

    def read(self) -> list[str]:
        """Return lines on what was understood of the files, and how many of their tables were fitted."""
        return [*(line for file in self.files for line in file.shown()), self._taken()]

    def read_for_the_fit(self, most: int) -> list[str]:
        """Return lines on the first few tables that were fitted, and the columns that the fit uses."""
        uses = [name for need in self.kind.needs for name in need] + list(self.kind.takes)
        lines = [f"{file.path}: {file.how}" for file in self.files]
        lines += [line for block in self.blocks[:most] for line in block.shown(uses)]
        lines += [f"  and {len(self.blocks) - most} more like these"] if len(self.blocks) > most else []
        return [*lines, self._taken()]

    def _taken(self) -> str:
        there = sum(len(file.blocks) for file in self.files)
        return f"fitted as {self.kind.name}: {len(self.blocks)} of {there} {'table' if there == 1 else 'tables'}"

    @property
    def source(self) -> str:
        """The files with their hashes, as a record's source has them."""
        named = ", ".join(f"{file.path.name} (sha256 {file.sha256})" for file in self.files)
        return f"fitted to {named} as {self.kind.name}"


def measure_files(
    paths: Sequence[Path], kind: str = "", settings: Mapping[str, str] | None = None, columns: ColumnMap | None = None
) -> Measured:
    """Fit files, all together. Raises InputError for what cannot be read or lacks."""
    if not paths:
        raise InputError("give at least one file of measured data")
    files = tuple(read_data_file(path, columns) for path in paths)
    blocks = [block for file in files for block in file.blocks]
    sheet = kind_sheet(kind) if kind else _likely_kind(blocks)
    values = sheet.values(settings or {})
    fitting = tuple(
        block
        for block in blocks
        if sheet.fits(block) and _rows(block, sheet) >= LEAST_ROWS and not _other_flow(block, sheet)
    )
    if not fitting:
        raise InputError(_refusal(blocks, sheet))
    measurement = measure_of(sheet)(fitting, values)
    for block in reversed(fitting):
        if block.flagged:
            measurement = measurement.with_note(f"{block.place}: {block.flagged}, and left out.")
    return Measured(sheet, files, fitting, measurement)


def _other_flow(block: Block, sheet: KindSheet) -> bool:
    """Return whether a table is a flow curve, which tells another kind nothing."""
    return (
        sheet.name != _FLOW
        and {"shear_rate", "viscosity"} <= block.columns.keys()
        and (kind_sheet(_FLOW).decided(block))
    )


def _refusal(blocks: Sequence[Block], sheet: KindSheet) -> str:
    """Say why no table is of a kind, and what to do."""
    flows = [block for block in blocks if _other_flow(block, sheet)]
    if flows:
        return (
            f"{flows[0].place}: shear rate and viscosity without strain or moduli are a flow curve, not {sheet.name}; "
            f"--as {_FLOW} fits it"
        )
    most = max(blocks, key=lambda block: sum(sheet.column(block, need) is not None for need in sheet.needs))
    few = f"{most.place}: fewer than {LEAST_ROWS} whole rows"
    why = sheet.lacking(most) or (few if sheet.fits(most) else f"{most.place}: {sheet.mismatch(most)}")
    return (
        f"{why}; {sheet.name} needs {_needed(sheet)}. A column map (--columns) says which column is what"
        + _not_understood(blocks)
    )


def _not_understood(blocks: Sequence[Block]) -> str:
    """Return a line on the headings that were not understood; empty where there is none."""
    unused = dict.fromkeys(f"{name!r}" for block in blocks for name in block.unused)
    return f"\nnot used: {', '.join(unused)}" if unused else ""


def measure_of(sheet: KindSheet) -> Callable[..., Measurement]:
    """Return the function that fits tables of a kind."""
    module, _, function = sheet.function.rpartition(".")
    measure: Callable[..., Measurement] = getattr(import_module(f"{__package__}.kinds.{module}"), function)
    return measure


def _rows(block: Block, sheet: KindSheet) -> int:
    return block.complete([name for need in sheet.needs if (name := sheet.column(block, need))])


def _likely_kind(blocks: Sequence[Block]) -> KindSheet:
    """Return the one kind whose columns a table has. Raises InputError where there is none, or several."""
    sheets = kind_sheets().values()
    likely = [sheet for sheet in sheets if any(sheet.decided(block) for block in blocks)] or [
        sheet for sheet in sheets if not sheet.only_asked and any(sheet.likely(block) for block in blocks)
    ]
    likely = [sheet for sheet in likely if sheet.name not in {other.rather_than for other in likely}]
    if len(likely) == 1:
        return likely[0]
    headings = sorted({name for block in blocks for name in block.columns})
    columns = f"the columns ({', '.join(headings) or 'none of a known name'})"
    problems = [why for block in blocks for why in block.problems.values()]
    ends = (f"\n{problems[0]}" if problems else "") + _not_understood(blocks)
    if likely:
        kinds = "; ".join(
            f"{sheet.name}" + (f", if a column is {' or '.join(sheet.decided_by)}" if sheet.decided_by else "")
            for sheet in likely
        )
        raise InputError(f"{columns} may be {kinds}; name the column so, or say which with --as{ends}")
    near = sorted(sheets, key=lambda sheet: min(_lacks(block, sheet) for block in blocks))
    needs = "; ".join(f"{sheet.name} needs {_needed(sheet)}" for sheet in near[:_NEAREST])
    raise InputError(f"{columns} are of no kind there is ({', '.join(kind_sheets())}). The nearest: {needs}{ends}")


def _lacks(block: Block, sheet: KindSheet) -> int:
    """Count the columns of a kind that a table lacks."""
    return sum(sheet.column(block, need) is None for need in sheet.needs)


def _needed(sheet: KindSheet) -> str:
    return ", ".join(" or ".join(need) for need in sheet.needs)
