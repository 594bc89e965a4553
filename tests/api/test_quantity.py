"""Quantities know their unit: other units of the same kind, and no others."""

from __future__ import annotations

import math

import pytest

import tvimdesign as tvim


@pytest.mark.parametrize(
    ("quantity", "unit", "value"),
    [
        (tvim.Quantity(66.5, "g"), "kg", 0.0665),
        (tvim.Quantity(1.0, "in"), "mm", 25.4),
        (tvim.Quantity(100.0, "degC"), "degC", 100.0),
        (tvim.Quantity(180.0, "deg"), "rad", math.pi),
        (tvim.Quantity(math.inf, "s"), "min", math.inf),
    ],
    ids=str,
)
def test_other_units(quantity: tvim.Quantity, unit: str, value: float) -> None:
    assert quantity.to(unit).value == pytest.approx(value, rel=1e-12)
    assert quantity.to(unit).unit == unit


def test_another_kind_of_unit_is_refused() -> None:
    with pytest.raises(tvim.UnitError, match="expected a length"):
        tvim.Quantity(1.0, "g").to("mm")


def test_it_is_written_with_its_unit() -> None:
    torque = tvim.Quantity(12.3456, "N*m")
    assert (str(torque), f"{torque:.1f}", float(torque)) == ("12.35 N·m", "12.3 N·m", 12.3456)
    assert str(tvim.Quantity(0.5)) == "0.5"


def test_si_is_what_equations_use() -> None:
    assert tvim.Quantity(0.0, "degC").si == pytest.approx(273.15)
    assert tvim.Quantity.parse("2 mm").si == pytest.approx(2e-3)
    assert tvim.Quantity.parse("3.25") == tvim.Quantity(3.25, "1")


def test_linspace_has_both_ends_and_the_first_unit() -> None:
    found = tvim.linspace("0.6 mm", "0.2 cm", 8)
    assert [q.unit for q in found] == ["mm"] * 8
    assert [q.value for q in found] == pytest.approx([0.6 + 0.2 * i for i in range(8)])
    assert [q.value for q in tvim.linspace(1, 3, 3)] == [1.0, 2.0, 3.0]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [(("1 mm", "2 s", 3), "expected"), (("1 mm", "2 mm", 1), "two or more"), (("1 furlong", "2 mm", 3), "no unit"),
     (("thick", "2 mm", 3), "does not start with a number")],
)  # fmt: skip
def test_what_linspace_refuses(arguments: tuple[str, str, int], said: str) -> None:
    with pytest.raises(tvim.InputError, match=said):
        tvim.linspace(*arguments)
