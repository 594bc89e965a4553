"""A number with its unit, as results give it and studies take it."""

from __future__ import annotations

from dataclasses import dataclass

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import from_si, parse_quantity, pretty, read_quantity, to_si


@dataclass(frozen=True)
class Quantity:
    """A value and its unit, such as `66.5 g`. It belongs to no unit registry, so it mixes with none.

    `float(q)` and `q.value` are the number in `q.unit`; `q.to("kg")` is the same quantity in another unit. A time that
    never comes is infinite.
    """

    value: float
    unit: str = "1"

    @classmethod
    def parse(cls, text: str) -> Quantity:
        """Read text such as "1.2 mm". Raises UnitError for what is no number or no unit."""
        return cls(*read_quantity(text))

    @property
    def si(self) -> float:
        """The value in SI: radians, kelvin, cycles a second."""
        return to_si(self.value, self.unit)

    @property
    def magnitude(self) -> float:
        """The value, by pint's name for it."""
        return self.value

    @property
    def units(self) -> str:
        """The unit, by pint's name for it."""
        return self.unit

    def to(self, unit: str) -> Quantity:
        """Convert the quantity to another unit of its kind. Raises UnitError where it is of another kind."""
        parse_quantity(f"1 {self.unit}", unit)
        return Quantity(from_si(self.si, unit), unit)

    def __float__(self) -> float:
        """Return the value in its own unit."""
        return self.value

    def __format__(self, form: str) -> str:
        """Return the value in a format for numbers, then the unit: `f"{q:.3g}"` is "66.5 g"."""
        return f"{self.value:{form or '.4g'}} {pretty(self.unit)}".rstrip()

    def __str__(self) -> str:
        """Return the value to four digits, and the unit."""
        return f"{self}"


def linspace(start: str | Quantity | float, stop: str | Quantity | float, count: int) -> list[Quantity]:
    """Return `count` evenly spaced quantities from `start` to `stop`, both included, in the unit of `start`.

    Raises UnitError where the two are of different kinds, InputError for a count below two.
    """
    if count < 2:
        raise InputError(f"linspace: a count of {count}; two or more values have two ends")
    first = _quantity(start)
    last = _quantity(stop).to(first.unit)
    width = (last.value - first.value) / (count - 1)
    return [*(Quantity(first.value + i * width, first.unit) for i in range(count - 1)), last]


def _quantity(value: str | Quantity | float) -> Quantity:
    if isinstance(value, Quantity):
        return value
    return Quantity.parse(value) if isinstance(value, str) else Quantity(float(value))
