"""Mean and deviation of an output where inputs spread, against what a power of one input has."""

import math

import numpy as np
import pytest

from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.resolved_module import resolve_study
from tvimdesign.solve.nlp.spread import moments
from tvimdesign.study import read_study_text

WIRE = 2e-3  # m


def _moments(tolerance: str) -> tuple[float, float, float]:
    """Value of the springs' rate, which goes with the fourth power of the wire; shift of its mean; its deviation."""
    text = f"mode: shear\nmodule: {{wire_diameter: 2 mm, leg_model: ignored}}\ntolerances: {{{tolerance}}}\n"
    module = resolve_study(read_study_text(text, "a test"))
    model = DeviceFunctions(module.table, module.values, module.points, 2)
    function = moments(model, module.study.tolerances, ["spring_rate"], [1.0])
    shift, deviation = (float(np.asarray(part).ravel()[0]) for part in function(model.start))
    return float(module.quantity("spring_rate")), shift, deviation


@pytest.mark.parametrize(
    ("tolerance", "sigma"),
    [
        ("{plus_minus: 0.03 mm}", 0.01e-3),
        ("{plus_minus: 0.03 mm, sigma: 2}", 0.015e-3),
        ("{plus_minus: 0.03 mm, distribution: uniform}", 0.03e-3 / math.sqrt(3.0)),
        ("1.5 %", 0.01e-3),
        ("{plus_minus: 0.03 mm, adjustable: true, adjusted_to: 0.006 mm}", 0.002e-3),
        ("{plus_minus: 0.03 mm, adjustable: true, adjusted_to: 0.05 mm}", 0.01e-3),
    ],
)
def test_a_fourth_power_has_the_moments_of_one(tolerance: str, sigma: float) -> None:
    """Of k = c d^4, to second order: deviation 4 k sigma/d, shift of the mean 6 k (sigma/d)^2."""
    rate, shift, deviation = _moments(f"wire_diameter: {tolerance}")
    assert deviation == pytest.approx(4.0 * rate * sigma / WIRE, rel=1e-9)
    assert shift == pytest.approx(6.0 * rate * (sigma / WIRE) ** 2, rel=1e-9)


def test_two_inputs_add_their_variances() -> None:
    # The rate is proportional to Young's modulus: 3 % at three sigma are a hundredth of it.
    rate, _, deviation = _moments("wire_diameter: {plus_minus: 0.03 mm}, spring_youngs_modulus: 3 %")
    assert deviation == pytest.approx(rate * math.hypot(4.0 * 0.01e-3 / WIRE, 0.01), rel=1e-9)
