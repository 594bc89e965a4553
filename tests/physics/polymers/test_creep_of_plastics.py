"""Creep of plastics, and layers that shrink between plates."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from scipy.integrate import quad, solve_ivp
from support import cases_of

from tvimdesign.catalog import Catalog
from tvimdesign.physics.polymers import plastics, transitions
from tvimdesign.physics.polymers.viscoelasticity import KelvinVoigt, Maxwell, StandardLinearSolid

HOURS = 3600.0
FE = yaml.safe_load((Path(__file__).parents[3] / "validation/fe_spring_holds/results.yaml").read_text())


def law(material: str) -> plastics.Creep:
    record = Catalog().record("structure_materials", material)
    return plastics.Creep(*(record.value(name) for name in ("creep_share", "creep_exponent", "creep_energy")))


def test_creep_and_ageing_are_those_of_the_sheets():
    # Makrolon 2405, ISO 899-1: 2200 MPa after 1 h and 1900 MPa after 1000 h; tensile modulus 2400 MPa.
    for hours, sheet in ((1.0, 2200.0), (1000.0, 1900.0)):
        assert 2400.0 / (1.0 + plastics.growth(hours * HOURS, law("polycarbonate"))) == pytest.approx(sheet, rel=2e-3)
    # 150 kJ/mol from 23 to 60 degC: exp(150e3/8.314 (1/296.15 - 1/333.15)) = 868.
    assert plastics.aged(1.0, 333.15, law("petg")) == pytest.approx(868.0, rel=2e-3)
    assert plastics.aged(5.0, 296.15, law("petg")) == 5.0


@pytest.mark.parametrize("give", [0.02, 0.1])
def test_preload_that_is_left_is_that_of_volterras_equation(give):
    # Winding a, spring k, support J(t) = c (1 + m t^n): M/k + J * dM = a, stepped over 4000 moments spaced as the log.
    rate, creep_law = 1.3, law("petg")
    compliance = give / rate
    times = np.concatenate([[0.0], np.geomspace(1e-3, 1000.0, 4000)]) * HOURS

    def support(since: np.ndarray) -> np.ndarray:
        return compliance * (1.0 + plastics.growth(since, creep_law))

    steps = [1.0 / (1.0 / rate + compliance)]
    for i in range(1, len(times)):
        # Each change of the moment creeps on from the middle of its step.
        middle = np.concatenate([[0.0], 0.5 * (times[: i - 1] + times[1:i])])[: len(steps)]
        crept = float(np.sum(np.array(steps) * support(times[i] - middle))) + sum(steps) / rate
        last = 0.5 * (times[i] - times[i - 1])
        steps.append((1.0 - crept) / (1.0 / rate + float(support(np.array(last)))))
    left = float(np.sum(steps)) / rate
    at_once = plastics.winding_left(rate, (compliance, 0.0))
    quick = plastics.winding_left(rate, (compliance, plastics.growth(times[-1], creep_law)))
    # The loss, not what is left, within 2 %.
    assert at_once - quick == pytest.approx(at_once - left, rel=0.02)


def test_holes_and_pegs_give_as_rings_and_cantilevers():
    shear, radius, length = 0.76e9, 0.8e-3, 3.5e-3
    # A ring of radius r turns against the next by M/(2 pi r^2 L G) dr/r.
    angle, _ = quad(lambda r: 1.0 / (2.0 * np.pi * r**3 * length * shear), radius, np.inf)
    assert plastics.twisted_hole_give(shear, 2.0 * radius, length) == pytest.approx(angle, rel=1e-9)
    modulus, poisson, radius = 2.1e9, 0.38, 2e-3
    tall = 0.5**3 / (3.0 * modulus * 0.25 * np.pi * radius**4)
    assert plastics.peg_give(modulus, poisson, 2.0 * radius, 0.5) == pytest.approx(tall, rel=0.01)
    # A rigid disc tilts on a half-space by 3 (1 - nu) M/(8 G r^3).
    shear = modulus / (2.0 * (1.0 + poisson))
    foot = 3.0 * (1.0 - poisson) * 4e-3**2 / (8.0 * shear * radius**3)
    whole = 4e-3**3 / (3.0 * modulus * 0.25 * np.pi * radius**4) + foot + 4e-3 / (0.9 * shear * np.pi * radius**2)
    assert plastics.peg_give(modulus, poisson, 2.0 * radius, 4e-3) == pytest.approx(whole, rel=1e-9)


@pytest.mark.parametrize("study", FE["pins"])
def test_pins_and_holes_give_as_fe_of_the_exported_parts_does(study):
    modulus, poisson = FE["modulus"], FE["poissons_ratio"]  # N/mm^2
    pin, hole = FE["pins"][study], FE["holes"][study]
    peg = plastics.peg_give(modulus, poisson, pin["diameter"], pin["height"])
    twisted = plastics.twisted_hole_give(modulus / (2.0 * (1.0 + poisson)), hole["diameter"], hole["length"])
    assert peg == pytest.approx(pin["give"], rel=0.05)
    assert twisted == pytest.approx(hole["give"], rel=0.05)


@pytest.mark.parametrize("study", FE["bosses"])
def test_a_boss_with_a_dowel_pin_gives_at_most_as_a_solid_one(study):
    boss = FE["bosses"][study]
    solid = plastics.peg_give(FE["modulus"], FE["poissons_ratio"], boss["foot"], boss["height"])
    assert 1.0 < solid / boss["give"] < 1.6


BODIES = [Maxwell(3.0, 0.6), StandardLinearSolid(2.0, 3.0, 0.6)]


@pytest.mark.parametrize("body", BODIES, ids=lambda body: type(body).__name__)
@pytest.mark.parametrize("time", [0.05, 0.7, 4.0])
def test_creep_and_relaxation_convolve_to_the_time(body, time):
    whole, _ = quad(lambda s: body.relaxation(time - s) * body.creep(s), 0.0, time)
    assert whole == pytest.approx(time, rel=1e-8)


@pytest.mark.parametrize("body", BODIES, ids=lambda body: type(body).__name__)
@pytest.mark.parametrize("omega", [0.4, 5.0])
def test_modulus_is_the_fourier_integral_of_relaxation(body, omega):
    relaxed = float(body.relaxation(1e9))
    sine, _ = quad(lambda t: body.relaxation(t) - relaxed, 0.0, np.inf, weight="sin", wvar=omega, limlst=500)
    cosine, _ = quad(lambda t: body.relaxation(t) - relaxed, 0.0, np.inf, weight="cos", wvar=omega, limlst=500)
    assert body.modulus(omega) == pytest.approx(relaxed + omega * (sine + 1j * cosine), rel=1e-6)


def test_kelvin_voigt_obeys_its_equation_and_maxwell_forgets_all():
    # sigma = G gamma + eta gamma'; under a constant stress of one, and in a sine.
    body = KelvinVoigt(4.0, 2.0)
    solved = solve_ivp(lambda _, strain: (1.0 - 4.0 * strain) / 2.0, (0.0, 1.3), [0.0], rtol=1e-10, atol=1e-12)
    assert body.creep(1.3) == pytest.approx(solved.y[0, -1], rel=1e-8)
    assert body.modulus(3.0) == pytest.approx(4.0 + 6.0j)
    assert KelvinVoigt(4.0, 2.0).relaxation(1e6) == 4.0
    assert Maxwell(4.0, 2.0).relaxation(1e6) == 0.0
    assert KelvinVoigt(4.0, 2.0).creep(1e6) == pytest.approx(0.25)
    assert Maxwell(4.0, 2.0).creep(1e6) == pytest.approx(5e5, rel=1e-6)


FIELDS = ("modulus_slope", "softening_temperature", "softening_width", "softened_share", "loss_factor",
          "softening_loss_factor")  # fmt: skip


def warm_law(material: str) -> plastics.Softening:
    record = Catalog().record("structure_materials", material)
    return plastics.Softening(*(record.value(name) for name in FIELDS))


def modulus(material: str, celsius: float, at_23: float) -> float:
    return at_23 * float(plastics.modulus_share(celsius + 273.15, warm_law(material)))


@cases_of("creep_of_plastics", "deflection_temperatures")
def test_plastics_are_as_stiff_as_their_deflection_temperatures_say(material, celsius, at_23, stress, strain):
    assert modulus(material, celsius, at_23) == pytest.approx(stress / strain, rel=0.25)


def test_aluminium_is_as_stiff_as_eurocode_9_says():
    for celsius, share in ((50, 0.990), (100, 0.970), (150, 0.930), (200, 0.860), (250, 0.780)):
        stiffness_ratio = modulus("aluminum_6061_t6", celsius, 1.0) / modulus("aluminum_6061_t6", 20, 1.0)
        assert stiffness_ratio == pytest.approx(share, rel=0.01), celsius


@pytest.mark.parametrize("material", ["petg", "abs", "polycarbonate", "aluminum_6061_t6", "aluminum_7075_t6"])
def test_modulus_falls_smoothly_and_never_to_nothing(material):
    temperatures = np.linspace(233.15, 523.15, 2901)
    share = plastics.modulus_share(temperatures, warm_law(material))
    assert np.all(np.diff(share) < 0.0)
    assert 0.0005 < share[-1] < share[0] < 1.35
    assert np.max(np.abs(np.diff(np.log(share), 2))) < 1e-2
    assert plastics.modulus_share(296.15, warm_law(material)) == 1.0


def test_loss_peaks_where_the_plastic_softens_and_is_the_records_far_below():
    softening_law = warm_law("petg")
    temperatures = np.linspace(296.15, 400.0, 2000)
    loss = plastics.loss_factor(temperatures, softening_law)
    assert temperatures[np.argmax(loss)] == pytest.approx(softening_law.temperature, abs=0.1)
    assert np.max(loss) == pytest.approx(1.5, rel=1e-4)
    assert loss[0] == pytest.approx(0.03, rel=1e-3)


def test_parts_in_series_are_the_sum_of_their_complex_compliances():
    parts = [(1e-3, 0.9, 0.03), (2e-4, 0.1, 0.12), (0.0, 1e-3, 0.0), (5e-5, 1.0, 0.0)]
    star = 1.0 / sum(compliance / complex(real, loss) for compliance, real, loss in parts)
    assert plastics.series(parts) == pytest.approx((star.real, star.imag), rel=1e-12)


def beam(
    foundation: float, rigidity: float, shear: float, span: float, length: float, shortened: float, force: float
) -> float:
    """Traction [Pa] at the edge of a layer of a finite length, by cubic beam elements.

    Those of the span deform in shear as well (Timoshenko). They do not turn at the hub; a force [N/m] parts them
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
def test_the_edge_pulls_as_a_beam_on_springs_does(thickness, span):
    rigidity = transitions.flexural_rigidity(2.1e9, 0.37, thickness)
    shear = transitions.shear_rigidity(0.77e9, thickness)
    foundation, shortened = 1.8e11, 65e-6
    # Long against the way on which the plates bend after the layer, as the formula has it.
    length = 12.0 / transitions.decay_rate(foundation, rigidity)
    expected = beam(foundation, rigidity, shear, span, length, shortened, 0.0)
    assert transitions.edge_traction(shortened, foundation, rigidity, shear, span) == pytest.approx(expected, rel=1e-3)


def test_the_edge_of_a_free_rotor_pulls_as_the_force_at_the_hub_asks():
    rigidity, foundation, span = transitions.flexural_rigidity(2.1e9, 0.37, 4e-3), 1.8e11, 12.6e-3
    length = 12.0 / transitions.decay_rate(foundation, rigidity)
    expected = beam(foundation, rigidity, 2.6e6, span, length, 0.0, 50.0)
    traction = transitions.edge_traction_of_force(50.0, foundation, rigidity, span)
    assert traction == pytest.approx(expected, rel=1e-3)


def test_arcs_are_long_enough_and_spans_limit_what_gives_way():
    # Arcs of 14 mm between plates of 4 mm PETG; the formula's have no end.
    rigidity, foundation = 12.0, 1.77e11
    expected = beam(foundation, rigidity, 2.4e6, 12.6e-3, 14e-3, 65e-6, 0.0)
    assert transitions.edge_traction(65e-6, foundation, rigidity, 2.4e6, 12.6e-3) == pytest.approx(expected, rel=0.1)
    assert transitions.edge_traction(65e-6, 1.8e11, 12.0, 2.4e6, 0.0) == pytest.approx(65e-6 * 1.8e11)
    assert transitions.edge_traction(65e-6, 1.8e11, 12.0, 2.4e6, 1.0) < 1e-3 * 65e-6 * 1.8e11


def test_moduli_and_shares_by_handbook():
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


@cases_of("creep_of_plastics", "in_finite_elements")
def test_solids_in_finite_elements_pull_no_harder_and_not_much_less(youngs, poisson, plate, solid):
    # `solid`: peak at mid-thickness of a full ring, 26 to 40 mm, 1 mm of PCL on a pad of 1.5 mm and 300 MPa, floor
    # 4 mm, clamped at 13.4 mm; the layer shrinks by 6.55 % of its thickness. Axisymmetric, quadratic quadrilaterals,
    # scikit-fem 12.0.
    both = (plate, 4e-3)
    bending, shear = (
        1.0 / sum(1.0 / rigidity for rigidity in rigidities)
        for rigidities in (
            [transitions.flexural_rigidity(youngs, poisson, h) for h in both],
            [transitions.shear_rigidity(youngs / (2.0 * (1.0 + poisson)), h) for h in both],
        )
    )
    layer = transitions.confined_modulus(411e6, 0.45)
    foundation = 1.0 / (1e-3 / layer + 1.5e-3 / 300e6 + 0.5 * sum(both) / youngs)
    traction = transitions.edge_traction(65.5e-6, foundation, bending, shear, 12.6e-3)
    assert solid < traction < 1.35 * solid
