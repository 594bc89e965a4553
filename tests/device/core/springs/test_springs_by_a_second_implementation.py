"""The springs on their pins against a second, plain implementation that shares no code with the package."""

from typing import Any

import numpy as np
import plain_module
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tvimdesign.device import table_for
from tvimdesign.solve.nlp.constraints import constraints_of
from tvimdesign.study import given as given_of
from tvimdesign.study import read_study_text

TABLE = table_for("shear")
# Table I of the paper, with E 210 GPa and the coils alone, as it counts.
PUBLISHED = {
    "placement_radius": 57e-3, "pin_radius_ratio": 0.5, "coil_diameter": 24.4094e-3, "wire_diameter": 2.413e-3,
    "pin_diameter": 4e-3, "coil_count": 3.25, "leg_model": "ignored", "spring_youngs_modulus": 210e9,
    "preload_angle": 0.15, "spring_pairs": 2, "stroke": 0.104,
}  # fmt: skip
AT = (
    "spring_stiffness",
    *(f"spring_stiffness_{share}_stroke" for share in ("half", "seven_tenths", "six_sevenths", "full")),
)


def test_both_say_the_same_of_the_published_module(inputs: dict[str, Any]) -> None:
    # An independent reading of the drawn module (own geometry) found 4.53 N*m/rad at rest and 4.09 at full stroke.
    assert plain_module.stiffness({**PUBLISHED, "transmission": "unity"}, 0.0) == pytest.approx(5.61, rel=5e-3)
    assert plain_module.stiffness(PUBLISHED, 0.0) == pytest.approx(4.53, abs=0.005)
    assert plain_module.stiffness(PUBLISHED, 0.104) == pytest.approx(4.09, abs=0.005)
    names = [*AT, "least_spring_stiffness"]
    found = TABLE.evaluate({**inputs, **PUBLISHED, "transmission": "geometry"}, names)
    for name, angle in zip(names, (0.0, 0.052, 0.0728, 0.624 / 7.0, 0.104, 0.104), strict=True):
        assert found[name] == pytest.approx(plain_module.stiffness(PUBLISHED, angle), rel=1e-5), name
    study = read_study_text("mode: shear\n")
    assert given_of(study)["transmission"] == "geometry"
    assert inputs["transmission"] == "geometry"


@pytest.mark.gate
@settings(max_examples=40, deadline=None)
@given(
    ratio=st.floats(0.3, 0.75), preload=st.floats(0.0, 0.5), wire=st.floats(1.2e-3, 3e-3), index=st.floats(4.0, 12.0),
    placement=st.floats(20e-3, 60e-3), stroke=st.floats(0.03, 0.2),
)  # fmt: skip
def test_every_number_of_the_springs_is_that_of_the_second_implementation(
    ratio: float, preload: float, wire: float, index: float, placement: float, stroke: float, inputs: dict[str, Any]
) -> None:
    module = {**inputs, "pin_radius_ratio": ratio, "preload_angle": preload, "wire_diameter": wire,
              "coil_diameter": index * wire, "placement_radius": placement, "stroke": stroke}  # fmt: skip
    offset = 0.5 * (index * wire + wire + module["pin_diameter"])
    assume((1.0 - ratio) * placement > 1.05 * offset)  # the leg reaches its pin
    found = TABLE.evaluate(module, ["spring_tensile_strength", *plain_module.DRAWN, *plain_module.COMPARED])
    assume(found["preload_margin"] > 0.0)
    module |= {name: found[name] for name in plain_module.DRAWN}
    plain = plain_module.statics(plain_module.with_strength(module, found))
    # Geometry can take the stiffness through zero: digits are those of the stiffness that the springs' rates give.
    of_rates = plain_module.stiffness({**module, "transmission": "unity"}, 0.0)
    for name in plain_module.COMPARED:
        scale = max(abs(plain[name]), 1e-2 * of_rates if "stiffness" in name else 0.0)
        assert found[name] == pytest.approx(plain[name], abs=1e-4 * scale), name


def test_a_limit_on_the_stiffness_is_one_at_every_angle_of_the_stroke() -> None:
    text = (
        "mode: shear\nrequire: {{spring_stiffness: ['>= 5 N.m/rad', '<= 6 N.m/rad']}}\nmodule: {{transmission: {}}}\n"
    )
    drawn = constraints_of((study := read_study_text(text.format("geometry"))), TABLE, study.module)
    assert [(one.output, one.sense) for one in drawn if one.origin == "require"] == [
        (name, sense) for sense in (">=", "<=") for name in AT
    ]
    # By a ratio of one it is the same at every angle, and two limits that are one have no price.
    unity = constraints_of((study := read_study_text(text.format("unity"))), TABLE, study.module)
    assert [one.output for one in unity if one.origin == "require"] == ["spring_stiffness"] * 2


def test_the_least_over_the_stroke_is_no_more_than_at_any_angle(inputs: dict[str, Any]) -> None:
    for ratio in (0.35, 0.5, 0.65):
        module = {**inputs, "pin_radius_ratio": ratio, "preload_angle": 0.2}
        found = TABLE.evaluate(module, ["least_spring_stiffness", *plain_module.DRAWN])
        least = found.pop("least_spring_stiffness")
        module |= found
        all_angles = [plain_module.stiffness(module, angle) for angle in np.linspace(0.0, module["stroke"], 21)]
        assert least == pytest.approx(min(all_angles), rel=1e-4)
