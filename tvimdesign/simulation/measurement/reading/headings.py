"""Quantity and unit of a column by its heading (`headings.yaml`), or by the user's map of columns."""

import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from tvimdesign.base.errors import InputError, UnitError
from tvimdesign.base.record import own_data
from tvimdesign.base.units import parse_quantity, pretty, si_unit
from tvimdesign.simulation.measurement.reading.sheets import DECIMALS, SEPARATORS

known = partial(own_data, __file__, "headings.yaml")
_IN_BRACKETS = re.compile(r"(.*\S)\s*[\[(]([^\[\]()]*(?:\([^()]*\)[^\[\]()]*)?)[\])]")
_AFTER_SLASH = re.compile(r"([^/]*[^/\s.])\.?\s*/\s*(\S.*)")
_IN_WORDS = re.compile(r"(.*\S)(?:\s+in|\s*,)\s+(\S+)")
_WORD_ENDS = re.compile(r"[\s_]+")
_CAMEL = re.compile(r"(?<=[a-z])(?=[A-Z][a-z])")
_WRITTEN_SMALL = {
    "nm": "N*m", "mnm": "mN*m", "degc": "degC", "c": "degC", "k": "K", "ma": "mA", "a": "A", "mv": "mV", "v": "V",
    "w": "W", "mw": "mW", "pa": "Pa", "kpa": "kPa", "hz": "Hz", "n": "N", "pas": "Pa*s", "mpas": "mPa*s",
    "rads": "rad/s", "pct": "%", "percent": "%", "1s": "1/s", "s1": "1/s", "wg": "W/g", "mwmg": "mW/mg", "wkg": "W/kg",
    "1pa": "1/Pa", "deg": "deg", "sec": "s", "seconds": "s", "min": "min", "celsius": "degC", "kelvin": "K",
}  # fmt: skip
"""Units as column names in programs have them."""
_SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_ALONE = {"-", "--", "[-]", "[1]", "[]", "()", "a.u.", "°", "1"}


class Heading(NamedTuple):
    """A column heading: the quantity by its name in `headings.yaml`, or none, and the unit, or none."""

    text: str
    quantity: str
    unit: str


@cache
def _by_name() -> dict[str, list[str]]:
    """Return the quantities a name may stand for."""
    quantities_by_name: dict[str, list[str]] = {}
    for key, entry in known()["quantities"].items():
        for name in [*entry["names"], key]:
            quantities_by_name.setdefault(plain(name), []).append(key)
    return quantities_by_name


def plain(name: str) -> str:
    """Return a name in small letters, without accents, signs before and after it, and double blanks."""
    folded = unicodedata.normalize("NFKD", name.replace("″", '"').replace("′", "'").replace("''", '"'))
    letters = (
        _CAMEL.sub(" ", "".join(sign for sign in folded if not unicodedata.combining(sign))).lower().replace("_", " ")
    ).replace(". ", " ")
    return " ".join(letters.strip(" #:.*/").split())


def heading(text: str, unit: str = "") -> Heading:
    """Read a heading such as `Storage Modulus`, `Time (s)`, `Temp./°C` or `G'`; `unit` is from a row of its own."""
    if unit or plain(text) in _by_name():
        return _named(text, text, read_unit(unit))
    fallback = Heading(text, "", "")
    for pattern in (_IN_BRACKETS, _IN_WORDS, _AFTER_SLASH):
        match = pattern.fullmatch(text.strip().lstrip("#"))
        if match and is_unit(match[2]):
            candidate = _named(text, match[1], read_unit(match[2]))
            if candidate.quantity:
                return candidate
            fallback = fallback if fallback.unit else candidate
    return _with_suffix(text) or fallback


def _named(text: str, name: str, unit: str) -> Heading:
    """Return a heading whose quantity follows from its name; of an angular frequency 1/s are radians a second."""
    # The quantity of a name: of several, the one that has such a unit.
    without = _IN_BRACKETS.fullmatch(name)
    may_be = _by_name().get(plain(name)) or (_by_name().get(plain(without[1])) if without else None) or [""]
    quantity = next(
        (quantity for quantity in may_be if quantity and unit and conversion(unit, unit_of(quantity)) is not None),
        may_be[0],
    )
    radians = (quantity, unit) == ("angular_frequency", "1/s") and len(set(_by_name()[plain(name)])) == 1
    return Heading(text, quantity, "rad/s" if radians else unit)


def rank(heading: Heading) -> int:
    """Return the place of a heading's name among those of its quantity: of two columns, the first counts."""
    names = [plain(name) for name in known()["quantities"][heading.quantity]["names"]]
    text = plain(heading.text)
    return next(
        (i for i, name in enumerate(names) if text == name),
        next((i for i, name in enumerate(names) if len(name) > 2 and text.startswith(name)), len(names)),
    )


def _with_suffix(text: str) -> Heading | None:
    """Read a heading such as `torque_nm` or `viscosity_pa_s`: a known name, then a unit of its quantity."""
    words = _WORD_ENDS.split(_CAMEL.sub(" ", text.strip()))
    for first in range(len(words) - 1, 0, -1):
        suffix = "".join(word for word in words[first:] if word.lower() != "per")
        for unit in (read_unit(suffix), _WRITTEN_SMALL.get(suffix.lower(), "")) if not suffix.isdigit() else ():
            for quantity in _by_name().get(plain(" ".join(words[:first])), []) if unit else []:
                if conversion(unit, unit_of(quantity)) is not None:
                    return Heading(text, quantity, unit)
    return None


def read_unit(text: str) -> str:
    """Return a unit as instruments write it, in this package's spelling; empty where there is none."""
    inner = text.strip()
    while len(inner) > 1 and (inner[0], inner[-1]) in {("[", "]"), ("(", ")")}:
        inner = inner[1:-1].strip()
    if not inner and text.strip():
        return "1"
    if inner.startswith("/"):  # `/ degC` under a name, as a quantity over its unit
        inner = inner[1:].strip()
    inner = inner.replace("�", "°").replace("º", "°") if inner.endswith("C") else inner
    inner = inner.translate(_SUPERSCRIPTS).replace("µ", "u").replace("μ", "u")
    inner = re.sub(r"(?<=[A-Za-z])-(?=[A-Za-z])", "*", inner)
    inner = re.sub(r"^s\^?-1$", "1/s", inner)
    inner = re.sub(r"^(m?)Pa\.?s(ec)?$", r"\1Pa*s", inner)
    return "1" if inner in _ALONE - {"°"} else inner


def is_unit(text: str) -> bool:
    """Return whether a cell can be a unit: one in brackets, or one this package reads."""
    stripped = text.strip()
    if not stripped or stripped in _ALONE or re.fullmatch(r"\[[^\]]*\]|[hms.:]*m+:s+[.s]*|h+:m+", stripped, re.I):
        return True
    return conversion(read_unit(stripped), "") is not None


@cache
def conversion(unit: str, wanted: str) -> tuple[float, float] | None:
    """Return offset and factor from `unit` to SI; None where `unit` is not of the kind of `wanted`.

    Without `wanted` any unit will do.
    """
    kinds = [wanted] if wanted else [unit, "degC"]
    for kind in kinds:
        for text in {unit, unit.replace("C", "degC") if unit in {"C", "°C"} else unit}:
            try:
                zero, unit_value = (
                    parse_quantity(f"{count} {text}" if text != "1" else count, kind) for count in ("0", "1")
                )
            except UnitError:
                continue
            return zero, unit_value - zero
    return None


def unit_of(quantity: str) -> str:
    """Return a unit of the kind a quantity has."""
    return str(known()["quantities"][quantity]["unit"])


def setting_name(text: str) -> str:
    """Return the setting a line before a table is about; empty for one that is of no use here."""
    name = plain(text).replace("/", "").replace("  ", " ")
    return next((key for key, entry in known()["settings"].items() if name in entry["names"]), "")


_WORDS: dict[str, Mapping[str, str]] = {"separator": SEPARATORS, "decimal": DECIMALS, "units": {"SI": ""}}
_ENTRY = ("heading", "column", "unit")


@dataclass(frozen=True)
class ColumnMap:
    """Columns by quantity, each `heading`, or `column` from 1, and `unit` where the file has none or a wrong one."""

    columns: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    separator: str = ""
    decimal: str = ""
    units: str = ""  # `SI`: what has no unit is in SI

    def applied(self, headings: list[Heading]) -> list[Heading]:
        """Return the headings with what the map says; a quantity it names is no longer found elsewhere."""
        taken = [heading._replace(quantity="") if heading.quantity in self.columns else heading for heading in headings]
        for quantity, entry in self.columns.items():
            for i, heading in enumerate(taken):
                meant = (
                    plain(heading.text) == plain(str(entry["heading"]))
                    if "heading" in entry
                    else i + 1 == entry["column"]
                )
                if meant:
                    taken[i] = heading._replace(quantity=quantity, unit=str(entry.get("unit", heading.unit)))
        if not self.units:
            return taken
        return [
            heading._replace(unit=pretty(si_unit(unit_of(heading.quantity))))
            if heading.quantity and not heading.unit else heading
            for heading in taken
        ]  # fmt: skip


def read_column_map(path: Path) -> ColumnMap:
    """Read a column map: YAML such as `{angle: {column: 2, unit: deg}, decimal: comma}`. Raises InputError."""
    try:
        tree = yaml.safe_load(path.read_text(encoding="utf-8-sig"))
    except (OSError, ValueError, yaml.YAMLError) as error:
        raise InputError(f"{path}: cannot be read as a column map in YAML ({str(error)[:80]})") from None
    return column_map(tree, str(path))


def column_map(tree: Any, file: str) -> ColumnMap:
    """Return a column map from plain data. Raises InputError naming the key and what was expected."""
    if not isinstance(tree, Mapping):
        raise InputError(f"{file}: expected quantities with their columns, as in `angle: {{column: 2, unit: deg}}`")
    quantities = known()["quantities"]
    columns = {}
    for key, entry in tree.items():
        if key in _WORDS:
            if not isinstance(entry, str) or entry not in _WORDS[key]:
                raise InputError(f"{file}: {key}: expected {', '.join(_WORDS[key])}")
            continue
        if key not in quantities:
            raise InputError(f"{file}: {str(key)[:40]} is no quantity; there are {', '.join(quantities)}")
        columns[key] = _entry(key, entry, file)
    return ColumnMap(columns, str(tree.get("separator", "")), str(tree.get("decimal", "")), str(tree.get("units", "")))


def _entry(key: str, entry: Any, file: str) -> Mapping[str, Any]:
    if isinstance(entry, str):
        return {"heading": entry}
    if isinstance(entry, int) and not isinstance(entry, bool):
        return {"column": entry}
    if not isinstance(entry, Mapping) or set(entry) - set(_ENTRY) or not {"heading", "column"} & set(entry):
        raise InputError(f"{file}: {key}: expected a heading, the count of the column, or {{column: 2, unit: deg}}")
    if "unit" in entry and conversion(str(entry["unit"]), unit_of(key)) is None:
        raise InputError(f"{file}: {key}: {entry['unit']!r} is no unit of it, such as {unit_of(key)}")
    return entry
