"""The judge in two dimensions (`validation/heat_sector/plane.py`) against analytic solutions and its own energy."""

import sys

import numpy as np
import pytest
from support import ROOT

sys.path.insert(0, str(ROOT / "validation" / "heat_sector"))

from compare import STUDIES, Judge, model_of, plane_of
from plane import Border, Material, Plane, Polymer, Pump, drawn, lines

NEVER = 1e6
SOLID = Material(0.25, 0.25, 1.5e6)
# Weightless sides of the pads: what the current heats goes into what lies beside them at once.
SHEET = Material(1e4, 1e4, 1.0)
HEAVY = Material(1e4, 1e4, 1e9)


def pcl(latent: float = 0.0, start: float = NEVER) -> Polymer:
    return Polymer(1000.0, 0.25, 0.25, 1500.0, 1500.0, latent, start, start + 10.0)


def heated_slab(polymer: Polymer, depth: float, count: int, power: float) -> Plane:
    """A layer on pads that heat it evenly with a power for an area of one; its other side is insulated."""
    y = lines((-2e-6, 0.0, 2, 1.0), (0.0, depth, count, 1.0))
    x = np.array([0.0, 1e-3])
    names = drawn(x, y, lambda _, b: "layer" if b > 0.0 else "hot" if b > -1e-6 else "cold")
    apart = {frozenset(("hot", "cold")): 1e-12}
    pump = Pump(0.0, 2.0 * power, 0.0, 1.0)
    return Plane(x, y, names, {"hot": SHEET, "cold": HEAVY}, polymer, pump, True, apart, 20.0)


@pytest.mark.parametrize(("fourier", "front", "back"), [(0.1, 0.35683, 0.00789), (0.5, 0.83188, 0.33479),
                                                        (1.0, 1.33332, 0.83333)])  # fmt: skip
def test_constant_flux_into_an_insulated_slab(fourier: float, front: float, back: float) -> None:
    # theta k/(q L) of a slab of one in thickness (Carslaw and Jaeger, Conduction of Heat in Solids, section 3.8).
    depth, power, count = 1e-3, 2500.0, 60
    found = heated_slab(pcl(), depth, count, power)
    seconds = fourier * depth**2 * 1.5e6 / 0.25
    _, states = found.heat(seconds, 200)
    risen = (states[-1][found.cells("layer")] - 20.0) * 0.25 / (power * depth)
    first = risen[0] + 0.5 / count * (1.0 - 0.5 / count)
    assert first == pytest.approx(front, abs=2e-3)
    assert risen[-1] == pytest.approx(back, abs=2e-3)


def test_what_is_melted_is_as_warm_as_the_heat_of_the_current_makes_it() -> None:
    # 5 kW/m2 for 40 s into 1 kg/m2: 77 kJ melt it, the rest is 1500 J/kg K above 20 degC.
    found = heated_slab(pcl(latent=77e3, start=50.0), 1e-3, 20, 5000.0)
    _, states = found.heat(40.0, 160)
    layer = states[-1][found.cells("layer")]
    assert np.all(found.polymer.molten(layer) == 1.0)
    assert np.mean(layer) - 20.0 == pytest.approx((5000.0 * 40.0 - 77e3) / 1500.0, rel=1e-3)


def test_a_fin_heated_at_its_root_is_as_warm_as_the_formula_says() -> None:
    # theta_root = q/sqrt(h k t) / tanh(m L), m = sqrt(h/(k t)), one face open (Incropera, ch. 3, insulated tip).
    length, thickness, coefficient, power = 20e-3, 1e-3, 12.0, 800.0
    x = lines((-2e-6, 0.0, 2, 1.0), (0.0, length, 60, 1.05))
    y = lines((0.0, thickness, 2, 1.0))
    names = drawn(x, y, lambda a, _: "plate" if a > 0.0 else "hot" if a > -1e-6 else "cold")
    apart = {frozenset(("hot", "cold")): 1e-12}
    found = Plane(x, y, names, {"hot": SHEET, "cold": HEAVY, "plate": SOLID}, pcl(), Pump(0.0, 2.0 * power, 0.0, 1.0),
                  False, apart, 20.0)  # fmt: skip
    found.borders.append(Border(*found.facing("plate", "above"), coefficient))
    _, states = found.heat(4e4, 200)
    root = np.mean(states[-1][found.cells("hot")]) - 20.0
    m = np.sqrt(coefficient / (0.25 * thickness))
    assert root == pytest.approx(power * thickness / np.sqrt(coefficient * 0.25 * thickness) / np.tanh(m * length),
                                 rel=5e-3)  # fmt: skip


def test_half_the_current_s_heat_leaves_legs_at_either_end() -> None:
    # I^2 R of 800 W/m2 in legs of 1 mm between two sheets kept cold: (I^2 R)/(8 K) above them (Incropera, ch. 3).
    x = lines((-1e-6, 0.0, 1, 1.0), (0.0, 1e-3, 40, 1.0), (1e-3, 1.001e-3, 1, 1.0))
    y = np.array([0.0, 1.0])
    names = drawn(x, y, lambda a, _: "hot" if a < 0.0 else "legs" if a < 1e-3 else "cold")
    kept = Material(1e4, 1e4, 1e13)
    parts = {"hot": kept, "legs": Material(0.25, 0.25, 1.0), "cold": kept}
    found = Plane(x, y, names, parts, pcl(), Pump(0.0, 800.0, 0.0, 1.0), False, {}, 20.0)
    _, states = found.heat(1.0, 5)
    legs = states[-1][found.cells("legs")] - 20.0
    assert np.max(legs) == pytest.approx(800.0 / (8.0 * 0.25 / 1e-3), rel=2e-3)
    assert np.mean(legs) == pytest.approx(800.0 / (12.0 * 0.25 / 1e-3), rel=2e-3)


@pytest.mark.slow
def test_the_ring_takes_as_long_with_half_as_many_cells_again() -> None:
    model = model_of(STUDIES / "wrist_compression.yaml")
    coarse, fine = (Judge(model, plane_of(model, cells)) for cells in (1.0, 1.5))
    times = [judge.time("softening_time", judge.heated(150.0, 60)) for judge in (coarse, fine)]
    assert times[0] == pytest.approx(times[1], rel=0.01)
