"""Screws against the tables of VDI 2230 and ISO 898-1, pegs against a worked example."""

from __future__ import annotations

import numpy as np
import pytest

from tvimdesign.physics.solids import fasteners
from tvimdesign.physics.solids.fasteners import peg_bearing_force as bearing_force
from tvimdesign.physics.solids.fasteners import peg_shear_force as shear_force

# Makers of screws print the tables of VDI 2230 (Mastik, catalogue, page 685: fine threads, edition of 2001): most
# force of a screw of class 8.8 that uses 90 % of its yield strength, 640 MPa up to M16, and the torque for it.
TABLE = [
    # diameter, pitch [mm], friction, force [kN], torque [N*m], mean diameter of a hexagon head's face and its hole [mm]
    # (ISO 4014, ISO 273)
    (8.0, 1.0, 0.10, 20.7, 22.8, 10.3), (8.0, 1.0, 0.12, 20.2, 26.1, 10.3), (8.0, 1.0, 0.14, 19.7, 29.2, 10.3),
    (10.0, 1.25, 0.12, 31.6, 51.0, 12.8), (12.0, 1.25, 0.12, 48.0, 90.0, 15.05), (16.0, 1.5, 0.12, 87.6, 218.0, 20.0),
]  # fmt: skip


@pytest.mark.parametrize(("diameter", "pitch", "friction", "force", "torque", "head"), TABLE)
def test_the_force_that_uses_nine_tenths_of_the_yield(
    diameter: float, pitch: float, friction: float, force: float, torque: float, head: float
) -> None:
    d, p, F = 1e-3 * diameter, 1e-3 * pitch, 1e3 * force
    twist = fasteners.twist_stress(fasteners.thread_torque(F, d, p, friction), d, p)
    # The tables take the section as yielding all over: its torque is 4/3 of the elastic one.
    tension = F / fasteners.stress_area(d, p)
    assert np.sqrt(tension**2 + 3.0 * (0.75 * twist) ** 2) == pytest.approx(0.9 * 640e6, rel=0.01)
    whole = fasteners.thread_torque(F, d, p, friction) + 0.5e-3 * head * friction * F
    assert whole == pytest.approx(torque, rel=0.02)
    assert fasteners.thread_friction(whole / (F * d), d, p, 1e-3 * head) == pytest.approx(friction, rel=1e-9)


@pytest.mark.parametrize(("diameter", "pitch", "area"), [(3.0, 0.5, 5.03), (4.0, 0.7, 8.78), (5.0, 0.8, 14.2)])
def test_stress_area_of_iso_898(diameter: float, pitch: float, area: float) -> None:
    assert fasteners.stress_area(1e-3 * diameter, 1e-3 * pitch) == pytest.approx(1e-6 * area, rel=3e-3)


def test_a_peg_of_20_mm_in_single_shear_bears_what_the_textbook_says() -> None:
    # Area 314.16 mm^2, 100 MPa: 31.4 kN; on 15 mm of plate at 240 MPa: 72 kN.
    assert shear_force(100e6, 20e-3) == pytest.approx(31.416e3, rel=1e-4)
    assert bearing_force(240e6, 20e-3, 15e-3) == pytest.approx(72e3)


def test_a_deep_peg_in_its_own_material_shears_off_first() -> None:
    # sigma/sqrt(3) pi d^2/4 = sigma d h at h = pi d/(4 sqrt(3)) = 0.45345 d.
    depth = 0.45345 * 3e-3
    assert bearing_force(16e6, 3e-3, depth) == pytest.approx(shear_force(16e6 / np.sqrt(3.0), 3e-3), rel=1e-4)
