"""Reads and writes quantities with units: strict text in, SI floats out, and text for people.

Run as `python -m tvimdesign.base.units` to write `units_read.json`: what pint makes of the usual units, so that a
study that uses no others never waits for pint.

SI inside: an angle is in radians, a temperature (`degC`) and a difference (`K`) in kelvin; a frequency in `Hz` stays in
cycles a second, one in `rad/s` in radians a second. Text is never evaluated: a pattern reads the number, a pattern and
pint's `parse_units` the unit.
"""

from __future__ import annotations

import json
import math
import re
from dataclasses import asdict, dataclass
from decimal import Decimal
from difflib import get_close_matches
from functools import cache, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from tvimdesign.base.errors import UnitError
from tvimdesign.base.record import own_data

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pint

LONGEST_TEXT = 200
ZERO_CELSIUS = 273.15
_ZERO = Decimal("273.15")
_FLOAT_DIGITS = 17  # Digits beyond which a number is multiplied as a decimal, before it is rounded
_NUMBER = re.compile(r"([+-]?[0-9]++(?:\.[0-9]++)?+(?:[eE][+-]?[0-9]++)?+)(.*)", re.DOTALL)
# Possessive quantifiers: hostile text must not make the pattern backtrack. Exponents are one digit, and none follows a
# parenthesis, so that no product of powers can grow without limit.
_UNIT = re.compile(r"(?:[A-Za-z_]++(?:\^-?[1-9](?![0-9]))?+|(?<![A-Za-z0-9])1(?![A-Za-z0-9])|[()*/ ])++")
_SPELLINGS = {"Δ°C": "K", "°C": "degC", "°": "deg", "\u2126": "ohm", "Ω": "ohm", "µ": "u", "μ": "u", "%": "percent"}
_OPERATORS = {"**": "^", "²": "^2", "³": "^3", ".": "*", "·": "*", "⋅": "*"}
_PRETTY = {"degC": "°C", "deg": "°", "ohm": "Ω", "um": "µm", "percent": "%"}
_DIFFERENCE = "write temperature differences in K"

_COMMON = (
    "mm cm m um in ft meter metre millimeter millimetre inch mm^2 cm^2 m^2 in^2 mm^3 cm^3 m^3 L deg degree rad radian "
    "turn g kg gram kilogram s ms min h second minute hour A mA ampere V mV volt ohm mohm W mW watt J kJ joule N kN "
    "newton Nm N.m mN.m N.mm Nm/rad N.m/rad N.m/deg Nm.s/rad N.m.s/rad kg.m^2 kg.mm^2 g.mm^2 Pa kPa MPa GPa bar "
    "pascal psi Pa.s mPa.s kg/m^3 g/cm^3 K kelvin degC Celsius 1/K Hz kHz hertz rpm rad/s W/K mW/K W/m/K W/(m.K) "
    "W/m^2/K W/(m^2.K) J/kg/K kJ/kg/K J/(kg.K) kJ/(kg.K) kJ/kg J/g J/kg kJ/mol J/mol mV/K V/K uV/K % percent "
    "kg*mm^2 1/h A/s rad/s^2 J/K K^2 m^4 1/rad mrad N/m N/mm N*m/A K*mm^2/W mN*m ohm*m mm^3/(N*m)"
)


def _examples() -> dict[str, tuple[str, str]]:
    """Return by unit what it is of, and an example."""
    examples: dict[str, tuple[str, str]] = own_data(__file__, "unit_examples.yaml")
    return examples


@dataclass(frozen=True)
class _Unit:
    """A unit as pint reads it; `si` is the SI unit of its kind in base units, 2 pi for hertz and 1 for all others."""

    factor: float
    si: float
    dimensions: Mapping[str, float]
    celsius: bool

    def may_stand_for(self, wanted: _Unit) -> bool:
        """Tell whether the dimensions agree, or would with the `/rad` that is often left out."""
        angle = wanted.dimensions.get("[angle]", 0.0)
        added = dict(self.dimensions) | ({"[angle]": angle} if angle < 0.0 and "[angle]" not in self.dimensions else {})
        return added == wanted.dimensions


USUAL_UNITS = Path(__file__).with_name("units_read.json")


@cache
def _usual() -> dict[str, _Unit]:
    """Return the usual units as pint reads them, by their text."""
    return {text: _Unit(**reported) for text, reported in json.loads(USUAL_UNITS.read_text(encoding="utf-8")).items()}


def read_by_pint() -> dict[str, dict[str, Any]]:
    """Read the usual units by pint, for `units_read.json`."""
    texts = {"1", *_examples(), *_COMMON.split()}
    return {text: asdict(_ask_pint(text)) for text in sorted(texts)}


@cache
def _registry() -> pint.UnitRegistry[Any]:
    """Load the small registry, once; pint takes a tenth of a second to import."""
    import pint

    return pint.UnitRegistry(str(Path(__file__).with_name("units.txt")))


def _respell(text: str) -> str:
    for spelling, plain in (_SPELLINGS | _OPERATORS).items():
        text = text.replace(spelling, plain)
    return text


@lru_cache(maxsize=1024)
def _read_unit(text: str) -> _Unit:
    """Read a unit; raises UnitError with the bare reason."""
    return _usual().get(text) or _ask_pint(text)


def _ask_pint(text: str) -> _Unit:
    """Read a unit by pint; raises UnitError with the bare reason."""
    plain = _respell(text)
    if not plain.strip() or not _UNIT.fullmatch(plain):
        hint = " (write a power as in mm^2)" if re.fullmatch(r"[A-Za-z]+[0-9]", plain) else ""
        raise UnitError(f"{text!r} is no unit{hint}")
    registry = _registry()
    for name in re.findall(r"[A-Za-z_]+", plain):
        readings = set(registry.parse_unit_name(name))
        # pint takes a final s for a plural: "Nms" would be newton metres. Only whole words have plurals here.
        singular = set(registry.parse_unit_name(name[:-1])) if len(name) > 1 and name.endswith("s") else set()
        if not readings - singular and not any(prefix + root == name[:-1] for prefix, root, _ in singular):
            raise UnitError(f"{name!r} is no unit")
    try:
        unit = registry.parse_units(plain)
        root: Any = registry.get_root_units(unit)[0]
        counted: dict[str, Any] = dict(unit._units)
        measured: dict[str, Any] = dict(unit.dimensionality)
        factor = float(root)
        powers = {name: float(power) for name, power in counted.items()}
        dimensions = {name: float(power) for name, power in measured.items()}
        si = math.tau ** sum(power for name, power in powers.items() if name.endswith("hertz"))
    except Exception as error:  # whatever pint's parser makes of hostile text, the text is no unit
        raise UnitError(f"{text!r} is no unit") from error
    celsius = any(name.endswith("degree_Celsius") for name in powers)
    if celsius and powers != {"degree_Celsius": 1.0}:
        raise UnitError(f"{text!r}: {_DIFFERENCE}")
    if not (0.0 < factor < math.inf and 0.0 < si < math.inf):
        raise UnitError(f"{text!r} is out of range")
    return _Unit(factor, si, dimensions, celsius)


def _named(unit: str) -> str:
    """Say what a unit measures, with an example."""
    for exact in (True, False):
        for known, (noun, example) in _examples().items():
            if known == unit or (not exact and _read_unit(known).dimensions == _read_unit(unit).dimensions):
                return f"{noun} such as {example}"
    return f"a quantity in {unit}, such as 1 {unit}"


def _fail(text: str, unit: str, reason: str, unit_text: str = "") -> NoReturn:
    """Raise UnitError naming the text, the reason, what was expected, and the nearest unit that would do."""
    by_letters: dict[str, str] = {}
    for name in _COMMON.split():
        known, wanted = _read_unit(name), _read_unit(unit)
        if known.dimensions == wanted.dimensions and (known.celsius == wanted.celsius or unit == "degC"):
            by_letters.setdefault(name.lower().replace(".", ""), name)
    letters = re.sub(r"[.*·]", "", unit_text.lower())
    close = get_close_matches(letters, by_letters, n=1, cutoff=0.6) if letters else []
    hint = f"; did you mean {by_letters[close[0]]}?" if close and by_letters[close[0]] != unit_text else ""
    shown = text if len(text) <= 60 else text[:57] + "..."
    raise UnitError(f"{shown!r}: {reason}, expected {_named(unit)}{hint}")


def _split(text: str, unit: str) -> tuple[float, str, str]:
    """Return the number, its digits and the text of its unit."""
    match = _NUMBER.fullmatch(text)
    if match is None:
        _fail(text, unit, "this does not start with a number")
    digits, unit_text = match.groups()
    if re.match(r",\s?[0-9]", unit_text):
        _fail(text, unit, "a decimal comma is not read; write a decimal point")
    if unit_text[:1] in {".", ",", "_"}:
        _fail(text, unit, f"{digits + unit_text.split(' ')[0]!r} is no number")
    number = float(digits)
    if not math.isfinite(number) or (number == 0.0 and re.search(r"[1-9]", re.split("[eE]", digits)[0])):
        _fail(text, unit, f"the number {digits} is out of range")
    unit_text = unit_text.removeprefix(" ")
    if unit_text[:1].isspace():
        _fail(text, unit, "write one blank between number and unit")
    return number, digits, unit_text


def parse_quantity(text: str, unit: str) -> float:
    """Read a quantity such as "2.413 mm" where `unit`'s kind is wanted, and return it in SI.

    `degC` wants a temperature and returns kelvin, `K` wants a difference. Where the unit is `1` a bare number will do.
    A missing `/rad` is forgiven (N.m for N.m/rad), any other missing or superfluous angle is not. Raises UnitError.
    """
    if not isinstance(text, str) or len(text) > LONGEST_TEXT:
        _fail(str(text)[:LONGEST_TEXT], unit, f"a quantity is text of at most {LONGEST_TEXT} characters")
    text = text.strip()
    number, digits, unit_text = _split(text, unit)
    if not unit_text and unit != "1":
        _fail(text, unit, "say the unit")
    try:
        given = _read_unit(unit_text or "1")
    except UnitError as error:
        _fail(text, unit, str(error), unit_text)
    wanted = _read_unit(unit)
    if not given.may_stand_for(wanted):
        _fail(text, unit, f"{unit_text or 'a bare number'} is not of that kind", unit_text)
    if given.celsius and not wanted.celsius:
        _fail(text, unit, _DIFFERENCE)
    value = number * (given.factor / wanted.si) + (ZERO_CELSIUS if given.celsius else 0.0)
    if sum(map(str.isdigit, digits)) > _FLOAT_DIGITS:
        value = float(Decimal(digits) * _factor(given, wanted) + (_ZERO if given.celsius else 0))
    if not math.isfinite(value):
        _fail(text, unit, "the number is out of range")
    if wanted.celsius and value < 0.0:
        _fail(text, unit, "that is below absolute zero")
    return value


def _factor(given: _Unit, wanted: _Unit) -> Decimal:
    """Return the factor between two units with the digits people know: 0.001 of the millimetre."""
    return Decimal(repr(given.factor / wanted.si))


def exact_digits(value: float, unit: str) -> str:
    """Write an SI value in a unit with the digits that `parse_quantity` reads as the same number, whatever they take.

    Of most numbers 17 digits of another unit read as one of the two beside it.
    """
    known = _read_unit(unit)
    number = (Decimal(value) - (_ZERO if known.celsius else 0)) / _factor(known, known)
    return f"{number:.{_FLOAT_DIGITS + 3}g}"


def to_si(value: float, unit: str) -> float:
    """Convert a number in `unit` to SI; `degC` is a temperature and gives kelvin."""
    known = _read_unit(unit)
    return value * (known.factor / known.si) + (ZERO_CELSIUS if known.celsius else 0.0)


def from_si(value: float, unit: str) -> float:
    """Convert a number in SI to `unit`; `degC` is a temperature and takes kelvin."""
    known = _read_unit(unit)
    return (value - (ZERO_CELSIUS if known.celsius else 0.0)) / (known.factor / known.si)


@cache
def pretty(unit: str) -> str:
    """Write a unit for people: "N·m/rad", "mm²", "°C", and nothing for "1"."""
    if unit == "1":
        return ""
    text = re.sub(r"[A-Za-z]+", lambda match: _PRETTY.get(match[0], match[0]), _respell(unit))
    powers = str.maketrans("-123456789", "⁻¹²³⁴⁵⁶⁷⁸⁹")
    return re.sub(r"\^(-?[1-9])", lambda match: match[1].translate(powers), text).replace("*", "·")


_SI_UNITS = {
    "mm": "m", "cm": "m", "um": "m", "g": "kg", "deg": "rad", "degC": "K", "percent": "1", "MPa": "Pa", "GPa": "Pa",
    "kPa": "Pa", "kJ": "J", "mV": "V", "mA": "A", "mrad": "rad", "ms": "s", "min": "s", "h": "s",
}  # fmt: skip


@cache
def si_unit(unit: str) -> str:
    """Return the SI unit of a unit's numbers inside: "N*m/rad" for itself, "m" for "mm", "K" for "degC"."""
    return re.sub(r"[A-Za-z]+", lambda match: _SI_UNITS.get(match[0], match[0]), _respell(unit))


def _number(value: float, digits: int) -> str:
    """Write a number to so many digits, without an exponent from 1e-4 to 1e7 and without rounding whole digits away."""
    if not math.isfinite(value) or value == 0.0:
        return "0" if value == 0.0 else str(value)
    if not 1e-4 <= abs(value) < 1e7:
        mantissa, _, exponent = f"{value:.{digits - 1}e}".partition("e")
        return f"{mantissa.rstrip('0').rstrip('.') if '.' in mantissa else mantissa}e{int(exponent)}"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    text = f"{value:.{decimals}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def format_quantity(value_si: float, unit: str, digits: int = 4) -> str:
    """Write an SI value in `unit` for people, such as "2.413 mm"."""
    name = pretty(unit)
    return _number(from_si(value_si, unit), digits) + ("" if name in {"", "°"} else " ") + name


if __name__ == "__main__":
    lines = (f"{json.dumps(text)}: {json.dumps(reported)}" for text, reported in read_by_pint().items())
    USUAL_UNITS.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
