"""Creep, modulus and loss of warm plastics against sheets, FE and a code of practice; simple bodies."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from scipy.integrate import quad, solve_ivp

from tvimdesign.catalog import Catalog
from tvimdesign.physics.polymers import plastics
from tvimdesign.physics.polymers.viscoelasticity import Body, KelvinVoigt, Maxwell, StandardLinearSolid

HOURS = 3600.0
FE = yaml.safe_load((Path(__file__).parents[3] / "validation/fe_spring_holds/results.yaml").read_text())


def law(material: str) -> plastics.Creep:
    record = Catalog().record("structure_materials", material)
    return plastics.Creep(*(record.value(name) for name in ("creep_share", "creep_exponent", "creep_energy")))


def test_creep_and_ageing_are_those_of_the_sheets() -> None:
    # Makrolon 2405, ISO 899-1: 2200 MPa after 1 h and 1900 MPa after 1000 h; tensile modulus 2400 MPa.
    for hours, sheet in ((1.0, 2200.0), (1000.0, 1900.0)):
        assert 2400.0 / (1.0 + plastics.growth(hours * HOURS, law("polycarbonate"))) == pytest.approx(sheet, rel=2e-3)
    # 150 kJ/mol from 23 to 60 degC: exp(150e3/8.314 (1/296.15 - 1/333.15)) = 868.
    assert plastics.aged(1.0, 333.15, law("petg")) == pytest.approx(868.0, rel=2e-3)
    assert plastics.aged(5.0, 296.15, law("petg")) == 5.0


@pytest.mark.parametrize("give", [0.02, 0.1])
def test_preload_that_is_left_is_that_of_volterras_equation(give: float) -> None:
    # Winding a, spring k, support J(t) = c (1 + m t^n): M/k + J * dM = a, stepped over 4000 moments spaced as the log.
    rate, found = 1.3, law("petg")
    compliance = give / rate
    times = np.concatenate([[0.0], np.geomspace(1e-3, 1000.0, 4000)]) * HOURS

    def support(since: np.ndarray) -> np.ndarray:
        return compliance * (1.0 + plastics.growth(since, found))

    steps = [1.0 / (1.0 / rate + compliance)]
    for i in range(1, len(times)):
        # Each change of the moment creeps on from the middle of its step.
        middle = np.concatenate([[0.0], 0.5 * (times[: i - 1] + times[1:i])])[: len(steps)]
        crept = float(np.sum(np.array(steps) * support(times[i] - middle))) + sum(steps) / rate
        last = 0.5 * (times[i] - times[i - 1])
        steps.append((1.0 - crept) / (1.0 / rate + float(support(np.array(last)))))
    left = float(np.sum(steps)) / rate
    at_once = plastics.winding_left(rate, (compliance, 0.0))
    quick = plastics.winding_left(rate, (compliance, plastics.growth(times[-1], found)))
    # The loss, not what is left, within 2 %.
    assert at_once - quick == pytest.approx(at_once - left, rel=0.02)


def test_holes_and_pegs_give_as_rings_and_cantilevers() -> None:
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
def test_pins_and_holes_give_as_fe_of_the_exported_parts_does(study: str) -> None:
    modulus, poisson = FE["modulus"], FE["poissons_ratio"]  # N/mm^2
    pin, hole = FE["pins"][study], FE["holes"][study]
    peg = plastics.peg_give(modulus, poisson, pin["diameter"], pin["height"])
    twisted = plastics.twisted_hole_give(modulus / (2.0 * (1.0 + poisson)), hole["diameter"], hole["length"])
    assert peg == pytest.approx(pin["give"], rel=0.05)
    assert twisted == pytest.approx(hole["give"], rel=0.05)


BODIES = [Maxwell(3.0, 0.6), StandardLinearSolid(2.0, 3.0, 0.6)]


@pytest.mark.parametrize("body", BODIES, ids=lambda body: type(body).__name__)
@pytest.mark.parametrize("time", [0.05, 0.7, 4.0])
def test_creep_and_relaxation_convolve_to_the_time(body: Body, time: float) -> None:
    whole, _ = quad(lambda s: body.relaxation(time - s) * body.creep(s), 0.0, time)
    assert whole == pytest.approx(time, rel=1e-8)


@pytest.mark.parametrize("body", BODIES, ids=lambda body: type(body).__name__)
@pytest.mark.parametrize("omega", [0.4, 5.0])
def test_modulus_is_the_fourier_integral_of_relaxation(body: Body, omega: float) -> None:
    rest = float(body.relaxation(1e9))
    sine, _ = quad(lambda t: body.relaxation(t) - rest, 0.0, np.inf, weight="sin", wvar=omega, limlst=500)
    cosine, _ = quad(lambda t: body.relaxation(t) - rest, 0.0, np.inf, weight="cos", wvar=omega, limlst=500)
    assert body.modulus(omega) == pytest.approx(rest + omega * (sine + 1j * cosine), rel=1e-6)


def test_kelvin_voigt_obeys_its_equation_and_maxwell_forgets_all() -> None:
    # sigma = G gamma + eta gamma'; under a constant stress of one, and in a sine.
    body = KelvinVoigt(4.0, 2.0)
    found = solve_ivp(lambda _, strain: (1.0 - 4.0 * strain) / 2.0, (0.0, 1.3), [0.0], rtol=1e-10, atol=1e-12)
    assert body.creep(1.3) == pytest.approx(found.y[0, -1], rel=1e-8)
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


# A bar that bends by its standard strain under its standard stress has a modulus of stress over strain: ISO 75,
# 0.45 and 1.80 MPa at 0.2 %; ASTM D648, 0.455 and 1.82 MPa at 0.1875 % (0.25 mm on 100 mm, 12.7 mm deep).
@pytest.mark.parametrize(
    ("material", "celsius", "at_23", "sheet", "within"),
    [
        ("petg", 76.2, 2100.0, 225.0, 0.25),  # Ultimaker PETG, ISO 75 B
        ("abs", 98.9, 2350.0, 1.82 / 0.001875, 0.25),  # Terluran GP-22, annealed
        ("abs", 103.9, 2350.0, 0.455 / 0.001875, 0.25),
        ("polycarbonate", 125.0, 2400.0, 900.0, 0.25),  # Makrolon 2805
        ("polycarbonate", 137.0, 2400.0, 225.0, 0.25),
    ],
)
def test_plastics_are_as_stiff_as_their_deflection_temperatures_say(
    material: str, celsius: float, at_23: float, sheet: float, within: float
) -> None:
    assert modulus(material, celsius, at_23) == pytest.approx(sheet, rel=within)


def test_aluminium_is_as_stiff_as_eurocode_9_says() -> None:
    for celsius, share in ((50, 0.990), (100, 0.970), (150, 0.930), (200, 0.860), (250, 0.780)):
        found = modulus("aluminum_6061_t6", celsius, 1.0) / modulus("aluminum_6061_t6", 20, 1.0)
        assert found == pytest.approx(share, rel=0.01), celsius


@pytest.mark.parametrize("material", ["petg", "abs", "polycarbonate", "aluminum_6061_t6", "aluminum_7075_t6"])
def test_modulus_falls_smoothly_and_never_to_nothing(material: str) -> None:
    temperatures = np.linspace(233.15, 523.15, 2901)
    share = plastics.modulus_share(temperatures, warm_law(material))
    assert np.all(np.diff(share) < 0.0)
    assert 0.0005 < share[-1] < share[0] < 1.35
    assert np.max(np.abs(np.diff(np.log(share), 2))) < 1e-2
    assert plastics.modulus_share(296.15, warm_law(material)) == 1.0


def test_loss_peaks_where_the_plastic_softens_and_is_the_records_far_below() -> None:
    found = warm_law("petg")
    temperatures = np.linspace(296.15, 400.0, 2000)
    loss = plastics.loss_factor(temperatures, found)
    assert temperatures[np.argmax(loss)] == pytest.approx(found.temperature, abs=0.1)
    assert np.max(loss) == pytest.approx(1.5, rel=1e-4)
    assert loss[0] == pytest.approx(0.03, rel=1e-3)


def test_parts_in_series_are_the_sum_of_their_complex_compliances() -> None:
    parts = [(1e-3, 0.9, 0.03), (2e-4, 0.1, 0.12), (0.0, 1e-3, 0.0), (5e-5, 1.0, 0.0)]
    star = 1.0 / sum(compliance / complex(real, loss) for compliance, real, loss in parts)
    assert plastics.series(parts) == pytest.approx((star.real, star.imag), rel=1e-12)
