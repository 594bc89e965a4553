"""A pressed pad against the pressure in a thin bonded layer, plain compression, and FE of single pads."""

import csv

import numpy as np
import pytest
from support import ROOT

from tvimdesign.physics.layers import block

RIGID = 1e15
with (ROOT / "validation/fe_structure/pads.csv").open(newline="") as file:
    PADS = [{name: float(cell) for name, cell in row.items()} for row in csv.DictReader(file)]


@pytest.mark.parametrize(("width", "height"), [(20.0, 20.0), (20.0, 40.0)])
def test_a_thin_pad_is_as_stiff_as_the_pressure_in_it_makes_it(width: float, height: float) -> None:
    # Of incompressible rubber pressed by e, bonded on both faces: grad^2 p = -12 G e/t^3 with p 0 at the edges, like
    # Prandtl's membrane, so F = 3 G e J/t^3 with Saint-Venant's series for the torsion constant J of a rectangle.
    a, b = height, width
    odd = np.arange(1, 60, 2)
    torsion = a * b**3 / 3.0 * (1.0 - 192.0 * b / (np.pi**5 * a) * np.sum(np.tanh(odd * np.pi * a / (2 * b)) / odd**5))
    thin = 0.1
    found = block.pad_stiffness((1.0, RIGID), (width, height), thin, (0.0, 0.0))
    # Gent and Lindley's shape factor is a few percent to 12 % below the series for rectangles.
    assert 0.87 < found / (3.0 * torsion / thin**3) < 1.01


def test_a_tall_pad_without_a_slot_is_a_bar() -> None:
    youngs = 9.0 * 5.0 * 1.0 / (3.0 * 5.0 + 1.0)
    found = block.pad_stiffness((1.0, 5.0), (1.0, 2.0), 100.0, (0.0, 0.0))
    assert found == pytest.approx(youngs * 2.0 / 100.0, rel=1e-3)


@pytest.mark.parametrize(
    "pad", PADS, ids=lambda pad: f"{pad['width']:g} x {pad['height']:g}, slot {pad['slot_width']:g}"
)
def test_a_pad_over_a_slot_gives_as_in_fe(pad: dict[str, float]) -> None:
    sides, slot = (pad["width"], pad["height"]), (pad["slot_width"], pad["slot_height"])
    moduli = 1.0, 2.0 * (1.0 + pad["poissons_ratio"]) / (3.0 * (1.0 - 2.0 * pad["poissons_ratio"]))
    found = block.pad_stiffness(moduli, sides, pad["thickness"], slot)
    plain = 3.0 * sides[0] * sides[1] / pad["thickness"]
    assert found / plain == pytest.approx(pad["over_three_g"], rel=0.13 if slot[0] == 0.0 else 0.09)


def test_a_slot_that_narrows_to_nothing_leaves_the_whole_pad() -> None:
    widths = np.linspace(0.0, 4.0, 400)
    found = np.array([block.pad_stiffness((1.0, 1e3), (8.0, 10.0), 1.6, (w, 8.0)) for w in widths])
    assert found[0] == pytest.approx(block.pad_stiffness((1.0, 1e3), (8.0, 10.0), 1.6, (0.0, 0.0)), rel=1e-12)
    assert np.all(np.diff(found) <= 1e-9)
