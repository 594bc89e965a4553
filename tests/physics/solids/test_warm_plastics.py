"""Modulus and loss of warm structures, against data sheets, a code of practice, and complex numbers."""

import numpy as np
import pytest

from tvimdesign.catalog import Catalog
from tvimdesign.physics.polymers import plastics

FIELDS = ("modulus_slope", "softening_temperature", "softening_width", "softened_share", "loss_factor",
          "softening_loss_factor")  # fmt: skip


def law(material: str) -> plastics.Softening:
    record = Catalog().record("structure_materials", material)
    return plastics.Softening(*(record.value(name) for name in FIELDS))


def modulus(material: str, celsius: float, at_23: float) -> float:
    return at_23 * float(plastics.modulus_share(celsius + 273.15, law(material)))


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
    share = plastics.modulus_share(temperatures, law(material))
    assert np.all(np.diff(share) < 0.0)
    assert 0.0005 < share[-1] < share[0] < 1.35
    assert np.max(np.abs(np.diff(np.log(share), 2))) < 1e-2
    assert plastics.modulus_share(296.15, law(material)) == 1.0


def test_loss_peaks_where_the_plastic_softens_and_is_the_records_far_below() -> None:
    found = law("petg")
    temperatures = np.linspace(296.15, 400.0, 2000)
    loss = plastics.loss_factor(temperatures, found)
    assert temperatures[np.argmax(loss)] == pytest.approx(found.temperature, abs=0.1)
    assert np.max(loss) == pytest.approx(1.5, rel=1e-4)
    assert loss[0] == pytest.approx(0.03, rel=1e-3)


def test_parts_in_series_are_the_sum_of_their_complex_compliances() -> None:
    parts = [(1e-3, 0.9, 0.03), (2e-4, 0.1, 0.12), (0.0, 1e-3, 0.0), (5e-5, 1.0, 0.0)]
    star = 1.0 / sum(compliance / complex(real, loss) for compliance, real, loss in parts)
    assert plastics.series(parts) == pytest.approx((star.real, star.imag), rel=1e-12)
