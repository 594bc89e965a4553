"""Feet, holes, ledges and spots in sheets, against beams, half planes and quadrature."""

from __future__ import annotations

import numpy as np
import pytest

from tvimdesign.physics.solids import structure


def test_of_two_ledges_the_outer_bears_all_where_nothing_leads_out_from_the_inner() -> None:
    assert structure.under_ledges_compliance((1.0, 1.0), 1e9, 3.0) == pytest.approx(3.0, rel=1e-6)
    # Compliances of 6 and 4 inside and 2 outside: the inner way bears 2/12, which costs 4 (2/12)^2.
    assert structure.under_ledges_compliance((6.0, 2.0), 4.0, 0.0) == pytest.approx(4.0 / 36.0, rel=1e-12)


def test_a_hole_in_even_shear_costs_twice_its_own_share() -> None:
    # A small hole of radius r at b in a shaft of radius R: its own polar moment is pi r^2 b^2 of pi R^4/2.
    own = np.pi * 0.1**2 * 5.0**2 / (0.5 * np.pi * 10.0**4)
    assert structure.hole_weakening(0.1, 5.0, 3, 10.0) == pytest.approx(3 * 2.0 * own, rel=1e-12)


def test_a_foot_between_two_floors_moves_as_timoshenkos_beam() -> None:
    # Steel pin of 10 mm, 300 mm long, both ends built in: 12 E I/h^3 = 4.494e4 N/m; the shear adds under 1 %.
    found = structure.foot_stiffness(206e9, 79e9, 5e-3, 0.0, 300e-3)
    assert found == pytest.approx(12.0 * 206e9 * 4.9087e-10 / 27e-3, rel=0.01)


def test_a_spot_at_the_edge_of_a_sheet_moves_as_a_force_on_a_half_plane() -> None:
    # Flamant, along the edge: u = 2 F ln(l/r)/(pi E h) but for what does not grow with l. The closed form is 14 %
    # stiffer at nu 0.3, and half as stiff as what a force within a sheet meets, (3 - nu)(1 + nu) F ln(l/r)/(4 pi E h).
    youngs, nu, h, spot, reach = 2.1e9, 0.3, 4e-3, 3.5e-3, 30e-3
    found = structure.spot_stiffness(structure.shear_modulus(youngs, nu), nu, h, spot, reach)
    assert found == pytest.approx(np.pi * youngs * h / (2.0 * np.log(reach / spot)), rel=0.15)
    whole = 4.0 * np.pi * youngs * h / ((3.0 - nu) * (1.0 + nu) * np.log(reach / spot))
    assert found == pytest.approx(0.5 * whole, rel=1e-9)


def test_a_foot_below_a_thick_floor_is_built_in_and_below_a_thin_one_free_to_turn() -> None:
    # A cantilever bends four times as far as a beam whose ends keep their directions: h^3/(3 E I) for h^3/(12 E I).
    assert structure.foot_tilt(3.5e-3, 1.7e-3, 6e-3, 1.0) == pytest.approx(1.0, abs=1e-3)
    assert structure.foot_tilt(3.5e-3, 1.7e-3, 6e-3, 1e-6) == pytest.approx(4.0, rel=1e-3)


def test_a_bar_pushed_along_evenly_keeps_a_twelfth_of_what_it_would_under_all_of_it() -> None:
    # Energy of N = q x from -L/2 to L/2, twice over the moment squared: by quadrature, of three bars at 15 mm.
    length, section, youngs, count, radius = 22e-3, 4e-6, 2.1e9, 3, 15e-3
    push = 1.0 / (count * radius * length)
    x = (np.arange(1000) + 0.5) / 1000 * length - 0.5 * length
    energy = count * np.mean((push * x) ** 2) * length / (youngs * section)
    assert structure.hoop_compliance(youngs, section, length, count, radius) == pytest.approx(energy, rel=1e-4)
