"""Files to a measurement: read, their kind found by `kinds.yaml`, and their tables fitted."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from tvimdesign.base.errors import InputError, UnitError
from tvimdesign.base.record import own_data
from tvimdesign.base.units import parse_quantity, to_si
from tvimdesign.simulation.measurement.measurement import LEAST_ROWS, Measurement
from tvimdesign.simulation.measurement.reading.data_file import Block, DataFile, read_data_file
from tvimdesign.simulation.measurement.reading.headings import ColumnMap

_KELVIN = 6.0
_THIRD, _STRAY, _TAKEN_OFF, _ON = 0.33, 0.1, 0.1, 3


@dataclass(frozen=True)
class KindSheet:
    """A kind of measurement."""

    name: str
    function: str  # That fits its tables: folder, file and name in `kinds/`
    about: str
    needs: tuple[tuple[str, ...], ...]  # Columns; of each tuple one
    takes: tuple[str, ...]  # Columns that are used where they are there
    category: str  # Of the catalogue's record that follows; empty where none does
    settings: Mapping[str, Mapping[str, Any]]
    varies: tuple[str, ...] = ()  # Columns; one of them must change, where it is there
    constant: tuple[str, ...] = ()  # Columns that must not change, where they are there
    only_asked: bool = False  # True if it is fitted only where it is asked for
    decided_by: tuple[str, ...] = ()  # Columns; any of them decides for this kind
    rather_than: str = ""  # Kind that is not taken where a table may be of both
    excluded_by: tuple[str, ...] = ()  # Columns; any of them rules it out, unless it is asked for

    def column(self, block: Block, need: tuple[str, ...]) -> str | None:
        """Return the first of the columns that will do and that a block has."""
        return next((name for name in need if name in block.columns), None)

    def rows(self, block: Block) -> int:
        """Return how many rows of a block have all that is needed."""
        return block.complete([name for need in self.needs if (name := self.column(block, need))])

    @property
    def _in_time(self) -> bool:
        return any("time" in need for need in self.needs)

    def fits(self, block: Block) -> bool:
        """Return whether a block has every column, and what must change in it changes, what must not does not."""
        there = [name for name in self.varies if name in block.columns]
        return (
            all(self.column(block, need) for need in self.needs)
            and (not there or any(_changes(block, name) for name in there))
            and not any(_changes(block, name, settled=self._in_time) for name in self.constant if name in block.columns)
        )

    def likely(self, block: Block) -> bool:
        """Return whether a block may be of this kind."""
        return self.fits(block) and not any(name in block.columns for name in self.excluded_by)

    def decided(self, block: Block) -> bool:
        """Return whether a column decides that a block is of this kind."""
        return self.likely(block) and any(name in block.columns for name in self.decided_by)

    def lacking(self, block: Block) -> str:
        """Say what a block lacks, or why a column of that name could not be read."""
        for need in self.needs:
            if self.column(block, need) is None:
                why = next((block.problems[name] for name in need if name in block.problems), "")
                return why or f"{block.place}: no column is {' or '.join(need)}"
        return ""

    def mismatch(self, block: Block) -> str:
        """Say which column that must change does not, or the other way round."""
        changing = [
            name for name in self.constant if name in block.columns and _changes(block, name, settled=self._in_time)
        ]
        if changing:
            return f"{changing[0]} changes from row to row, which rules {self.name} out"
        return f"{' or '.join(self.varies)} does not change, which rules {self.name} out"

    def values(self, given: Mapping[str, str]) -> dict[str, Any]:
        """Return settings in SI: those given, as `name=value with unit`, and the defaults. Raises InputError."""
        settings: dict[str, Any] = {
            name: to_si(float(entry["default"]), entry["unit"])
            for name, entry in self.settings.items()
            if "default" in entry
        }
        for name, text in given.items():
            if name not in self.settings:
                close = get_close_matches(name, self.settings, n=1)
                hint = f"did you mean {close[0]}?" if close else f"there are {', '.join(self.settings)}"
                raise InputError(f"--set {name}: {self.name} has no such setting; {hint}")
            if self.settings[name]["unit"] == "text":
                settings[name] = text
                continue
            try:
                settings[name] = parse_quantity(text, self.settings[name]["unit"])
            except UnitError as error:
                raise InputError(f"--set {name}: {error}") from None
            low, high = (self.settings[name].get(end, settings[name]) for end in ("from", "to"))
            if not low <= settings[name] <= high:
                raise InputError(f"--set {name}: {settings[name]:g} is not between {low} and {high}")
        return settings


def _changes(block: Block, name: str, *, settled: bool = False) -> bool:
    """Return whether a column changes: a temperature by some kelvin, all else by more than a third from its middle.

    Values near zero are none of its own: what is taken off, as the stress of a recovery. With `settled` the second half
    of the others counts, for at first it may rise. A tenth of them may stray, and what is on in fewer than three rows
    is not constant.
    """
    import numpy as np

    values = np.abs(block.values(name)[np.isfinite(block.values(name))])
    if name == "temperature":
        return bool(np.quantile(values, 0.95) - np.quantile(values, 0.05) > _KELVIN)
    on = values[values > _TAKEN_OFF * np.max(values)] if len(values) else values
    if len(on) < _ON:
        return len(on) > 0
    on = on[len(on) // 2 :] if settled else on
    middle = float(np.median(on))
    return bool(np.mean(np.abs(on / middle - 1.0) > _THIRD) > _STRAY)


@cache
def kind_sheets() -> dict[str, KindSheet]:
    """Return every kind by its name."""
    sheets = {}
    for name, entry in own_data(__file__, "kinds.yaml").items():
        columns = {key: _words(entry.get(key, "")) for key in ("varies", "constant", "decided_by", "excluded_by")}
        needs, takes = tuple(map(_words, entry["needs"])), tuple(entry.get("takes", ()))
        sheets[name] = KindSheet(name=name, **{**entry, **columns, "needs": needs, "takes": takes})
    return sheets


def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split(" | ")) if text else ()


def kind_sheet(name: str) -> KindSheet:
    """Return a kind by its name. Raises InputError with the nearest."""
    sheets = kind_sheets()
    if name in sheets:
        return sheets[name]
    close = get_close_matches(name, sheets, n=1)
    hint = f"did you mean {close[0]}? " if close else ""
    raise InputError(f"no kind of measurement is named {name[:40]!r}; {hint}there are {', '.join(sheets)}")


_FLOW = "flow_curve"
_NEAREST = 3  # Kinds that a refusal names with their needs


@dataclass(frozen=True)
class Measured:
    """The fit of some files."""

    kind: KindSheet
    files: tuple[DataFile, ...]
    blocks: tuple[Block, ...]  # The tables that were fitted
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
        if sheet.fits(block) and sheet.rows(block) >= LEAST_ROWS and not _other_flow(block, sheet)
    )
    if not fitting:
        raise InputError(_refusal(blocks, sheet))
    try:
        measurement = measure_of(sheet)(fitting, values)
    except InputError as error:
        raise InputError(f"{error}{_not_understood(fitting)}") from None
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
    near = sorted(
        sheets,
        key=lambda sheet: min(sum(sheet.column(block, need) is None for need in sheet.needs) for block in blocks),
    )
    needs = "; ".join(f"{sheet.name} needs {_needed(sheet)}" for sheet in near[:_NEAREST])
    raise InputError(f"{columns} are of no kind there is ({', '.join(kind_sheets())}). The nearest: {needs}{ends}")


def _needed(sheet: KindSheet) -> str:
    return ", ".join(" or ".join(need) for need in sheet.needs)
