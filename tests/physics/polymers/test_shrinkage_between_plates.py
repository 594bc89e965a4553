"""A layer that shrinks between two plates: against beams in finite elements, and handbook moduli."""

import numpy as np
import pytest

from tvimdesign.physics.polymers import transitions


def beam(
    foundation: float, rigidity: float, shear: float, span: float, length: float, shortened: float, force: float
) -> float:
    """Traction [Pa] at the edge of a layer of a finite length, by cubic beam elements.

    Those of the span give way in shear as well (Timoshenko). They do not turn at the hub; a force [N/m] parts them
    there, or, where it is zero, they do not move there.
    """
    cells, layer = 100, 300
    nodes = np.concatenate([np.linspace(0.0, span, cells + 1), span + np.linspace(0.0, length, layer + 1)[1:]])
    stiffness, load = np.zeros((2 * nodes.size, 2 * nodes.size)), np.zeros(2 * nodes.size)
    for i, h in enumerate(np.diff(nodes)):
        at = slice(2 * i, 2 * i + 4)
        soft = 12.0 * rigidity / (shear * h * h) if i < cells else 0.0
        near, far = (4 + soft) * h * h, (2 - soft) * h * h
        bend = [[12, 6 * h, -12, 6 * h], [6 * h, near, -6 * h, far],
                [-12, -6 * h, 12, -6 * h], [6 * h, far, -6 * h, near]]  # fmt: skip
        stiffness[at, at] += rigidity / (h**3 * (1 + soft)) * np.array(bend)
        if i >= cells:
            bed = [[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h],
                   [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]]  # fmt: skip
            stiffness[at, at] += foundation * h / 420.0 * np.array(bed)
            load[at] += foundation * shortened * h * np.array([0.5, h / 12.0, 0.5, -h / 12.0])
    load[0] -= force
    held = [1] if force else [0, 1]
    free = np.delete(np.arange(load.size), held)
    approach = np.zeros_like(load)
    approach[free] = np.linalg.solve(stiffness[np.ix_(free, free)], load[free])
    return float(foundation * (shortened - approach[2 * cells]))


@pytest.mark.parametrize(("thickness", "span"), [(4e-3, 12.6e-3), (2.5e-3, 3.6e-3), (6e-3, 20e-3)])
def test_the_edge_pulls_as_a_beam_on_springs_does(thickness: float, span: float) -> None:
    rigidity = transitions.flexural_rigidity(2.1e9, 0.37, thickness)
    shear = transitions.shear_rigidity(0.77e9, thickness)
    foundation, shortened = 1.8e11, 65e-6
    # Long against the way on which the plates bend after the layer, as the formula has it.
    length = 12.0 / transitions.decay_rate(foundation, rigidity)
    expected = beam(foundation, rigidity, shear, span, length, shortened, 0.0)
    assert transitions.edge_traction(shortened, foundation, rigidity, shear, span) == pytest.approx(expected, rel=1e-3)


def test_the_edge_of_a_free_rotor_pulls_as_the_force_at_the_hub_asks() -> None:
    rigidity, foundation, span = transitions.flexural_rigidity(2.1e9, 0.37, 4e-3), 1.8e11, 12.6e-3
    length = 12.0 / transitions.decay_rate(foundation, rigidity)
    expected = beam(foundation, rigidity, 2.6e6, span, length, 0.0, 50.0)
    found = transitions.edge_traction_of_force(50.0, foundation, rigidity, span)
    assert found == pytest.approx(expected, rel=1e-3)


def test_arcs_are_long_enough_and_spans_limit_what_gives_way() -> None:
    # Arcs of 14 mm between plates of 4 mm PETG; the formula's have no end.
    rigidity, foundation = 12.0, 1.77e11
    expected = beam(foundation, rigidity, 2.4e6, 12.6e-3, 14e-3, 65e-6, 0.0)
    assert transitions.edge_traction(65e-6, foundation, rigidity, 2.4e6, 12.6e-3) == pytest.approx(expected, rel=0.1)
    assert transitions.edge_traction(65e-6, 1.8e11, 12.0, 2.4e6, 0.0) == pytest.approx(65e-6 * 1.8e11)
    assert transitions.edge_traction(65e-6, 1.8e11, 12.0, 2.4e6, 1.0) < 1e-3 * 65e-6 * 1.8e11


def test_moduli_and_shares_by_handbook() -> None:
    # Steel, handbook: K 160 GPa, G 79.3 GPa, E 207 GPa, nu 0.292 (Shigley, table A-5, for E, G and nu).
    youngs, poisson = 207e9, 0.292
    bulk, shear = youngs / (3.0 * (1.0 - 2.0 * poisson)), youngs / (2.0 * (1.0 + poisson))
    assert transitions.confined_modulus(youngs, poisson) == pytest.approx(bulk + 4.0 / 3.0 * shear)
    # Water to ice, backwards: 999.84 and 916.7 kg/m3 at 0 degC (CRC Handbook), ice is 9.07 % larger.
    assert transitions.growth(916.7, 999.84) == pytest.approx(0.0907, rel=1e-3)
    share = transitions.volume_share(1040.0, 1145.0)
    assert (1.0 - share) * 1145.0 == pytest.approx(1040.0)
    assert (1.0 - transitions.linear_share(share)) ** 3 == pytest.approx(1.0 - share)
    assert transitions.linear_share(share) == pytest.approx(share / 3.0, rel=0.04)


@pytest.mark.parametrize(
    ("youngs", "poisson", "plate", "solid"),
    [
        (2.1e9, 0.37, 4e-3, 0.90e6), (2.1e9, 0.37, 2.5e-3, 0.71e6),
        (68.9e9, 0.33, 4e-3, 4.25e6), (68.9e9, 0.33, 2.5e-3, 3.26e6),
    ],
)  # fmt: skip
def test_solids_in_finite_elements_pull_no_harder_and_not_much_less(
    youngs: float, poisson: float, plate: float, solid: float
) -> None:
    # `solid`: peak at mid-thickness of a full ring, 26 to 40 mm, 1 mm of PCL on a pad of 1.5 mm and 300 MPa, floor
    # 4 mm, clamped at 13.4 mm; the layer shrinks by 6.55 % of its thickness. Axisymmetric, quadratic quadrilaterals,
    # scikit-fem 12.0.
    both = (plate, 4e-3)
    bending, shear = (
        1.0 / sum(1.0 / one for one in rigidities)
        for rigidities in (
            [transitions.flexural_rigidity(youngs, poisson, h) for h in both],
            [transitions.shear_rigidity(youngs / (2.0 * (1.0 + poisson)), h) for h in both],
        )
    )
    layer = transitions.confined_modulus(411e6, 0.45)
    foundation = 1.0 / (1e-3 / layer + 1.5e-3 / 300e6 + 0.5 * sum(both) / youngs)
    found = transitions.edge_traction(65.5e-6, foundation, bending, shear, 12.6e-3)
    assert solid < found < 1.35 * solid
