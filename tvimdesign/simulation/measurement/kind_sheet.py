"""Needs and settings of each kind of measurement, as `kinds.yaml` lists them; nothing heavy is loaded."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tvimdesign.base.errors import InputError, UnitError
from tvimdesign.base.units import parse_quantity, to_si
from tvimdesign.base.yaml_data import plain_data

if TYPE_CHECKING:
    from tvimdesign.simulation.measurement.reading.data_file import Block

_FILE = Path(__file__).with_name("kinds.yaml")
_KELVIN = 6.0
_THIRD, _STRAY, _TAKEN_OFF, _ON = 0.33, 0.1, 0.1, 3


@dataclass(frozen=True)
class KindSheet:
    """A kind of measurement."""

    name: str
    function: str
    """That fits its tables: folder, file and name in `kinds/`."""
    about: str
    needs: tuple[tuple[str, ...], ...]
    """Columns; of each tuple one."""
    takes: tuple[str, ...]
    """Columns that are used where they are there."""
    category: str
    """Of the catalogue's record that follows; empty where none does."""
    settings: Mapping[str, Mapping[str, Any]]
    varies: tuple[str, ...] = ()
    """Columns; one of them must change, where it is there."""
    constant: tuple[str, ...] = ()
    """Columns that must not change, where they are there."""
    only_asked: bool = False
    """Whether it is fitted only where it is asked for."""
    decided_by: tuple[str, ...] = ()
    """Columns; any of them decides for this kind."""
    rather_than: str = ""
    """Kind that is not taken where a table may be of both."""
    excluded_by: tuple[str, ...] = ()
    """Columns; any of them rules it out, unless it is asked for."""

    def column(self, block: Block, need: tuple[str, ...]) -> str | None:
        """Return the first of the columns that will do and that a block has."""
        return next((name for name in need if name in block.columns), None)

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
            _refuse_beyond(name, settings[name], self.settings[name])
        return settings


def _refuse_beyond(name: str, value: float, setting: Mapping[str, Any]) -> None:
    """Raise InputError for a number that is not among those a setting may be."""
    low, high = setting.get("from", value), setting.get("to", value)
    if not low <= value <= high:
        raise InputError(f"--set {name}: {value:g} is not between {low} and {high}")


def _changes(block: Block, name: str, *, settled: bool = False) -> bool:
    """Return whether a column changes: a temperature by some kelvin, all else by more than a third from its middle.

    With `settled` the second half of the rows counts, for at first it may rise. Values near zero are none of its own:
    what is taken off, as the stress of a recovery. A tenth of the rows may stray, and what is on in fewer than three is
    not constant.
    """
    import numpy as np

    values = np.abs(block.values(name)[np.isfinite(block.values(name))])
    if name == "temperature":
        return bool(np.quantile(values, 0.95) - np.quantile(values, 0.05) > _KELVIN)
    counted = values[len(values) // 2 :] if settled else values
    on = counted[counted > _TAKEN_OFF * np.max(values)] if len(values) else values
    if len(on) < _ON:
        return len(on) > 0
    middle = float(np.median(on))
    return bool(np.mean(np.abs(on / middle - 1.0) > _THIRD) > _STRAY)


@cache
def kind_sheets() -> dict[str, KindSheet]:
    """Return every kind by its name."""
    tree = plain_data(_FILE.read_text(encoding="utf-8"))
    return {
        name: KindSheet(
            name, entry["function"], entry["about"], tuple(map(_words, entry["needs"])), tuple(entry.get("takes", ())),
            entry.get("category", ""), entry["settings"], _words(entry.get("varies", "")),
            _words(entry.get("constant", "")), entry.get("only_asked", False), _words(entry.get("decided_by", "")),
            entry.get("rather_than", ""), _words(entry.get("excluded_by", "")),
        )
        for name, entry in tree.items()
    }  # fmt: skip


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
