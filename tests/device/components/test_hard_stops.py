"""Hard stops: where posts and teeth stand, what they bear by a gear's tooth, and what their rules refuse."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

from tvimdesign.device import table_for
from tvimdesign.physics.solids.shapes import tooth
from tvimdesign.physics.solids.structure import stub_stress

TABLE = table_for("shear")
MM = 1e-3
SMALL = {
    "placement_radius": 30 * MM, "pcl_inner_radius": 14 * MM, "pcl_outer_radius": 20 * MM, "coil_diameter": 9 * MM,
    "wire_diameter": 1.4 * MM, "core_radius": 9 * MM,
}  # fmt: skip


def of(inputs: dict[str, Any], *names: str) -> list[float]:
    return [float(value) for value in TABLE.evaluate(inputs, names).values()]


def test_a_tooth_bends_and_weighs_as_its_outline() -> None:
    # Shigley, Mechanical Engineering Design, 10th ed., eq. 14-1, sigma = 6 W l/(F t^2): 100 N at 3 mm on 4 x 5 mm.
    bending, shear = 6.0 * 100.0 * 3.0 / (4.0 * 5.0**2), 100.0 / 20.0
    assert stub_stress(100.0, 3 * MM, 5 * MM, 4 * MM) == pytest.approx(1e6 * np.hypot(bending, np.sqrt(3.0) * shear))
    radius, outer, corner, span = 30.0, 33.0, 1.5, 0.2
    reach = radius + corner
    beside = np.arcsin(corner / reach)

    def angle(r: float) -> float:
        """Angle the tooth covers at a radius: beside each side, up to the fillet's circle where that is."""
        cosine = (r**2 + reach**2 - corner**2) / (2.0 * r * reach)
        return span + 2.0 * (beside - np.arccos(min(cosine, 1.0)) if r < np.sqrt(reach**2 - corner**2) else 0.0)

    edges = [radius, np.sqrt(reach**2 - corner**2), outer]
    area, polar = (
        sum(quad(lambda r, k=k: angle(r) * r**k, *ends, epsabs=1e-11)[0] for ends in pairwise(edges)) for k in (1, 3)
    )
    assert tooth(span, radius, outer, corner) == pytest.approx((area, polar), rel=1e-9)


def test_stops_take_the_room_between_feet_and_springs(inputs: dict[str, Any]) -> None:
    module = {**inputs, **SMALL}
    inner, outer, tooth_span, post_span, angle, reach = of(
        module, "stop_inner_radius", "stop_outer_radius", "stop_tooth_span", "stop_post_span", "stop_angle",
        "spring_reach",
    )  # fmt: skip
    assert angle == pytest.approx(0.104 + 0.02)
    assert inner == pytest.approx(20 * MM + 1.5 * MM + 0.4 * MM)  # PCL, rim, running clearance
    assert outer <= 30 * MM - 3.5 * MM + 1e-9  # the holes above the feet
    # The post ends where a circle around the spring, by its clearance wider, begins.
    end = 0.5 * tooth_span + angle + post_span
    corner = outer * np.exp(1j * (np.pi / 4.0 - end))
    room = abs(corner - 30 * MM) - reach - module["radial_clearance"]
    assert -1e-9 < room < 0.1 * MM


def test_the_stops_bear_their_torque_by_statics(inputs: dict[str, Any]) -> None:
    module = {**inputs, **SMALL}
    torque, radius, width, length, top, post, tooth_stress, pressure, least, holding, layers = of(
        module, "stop_torque", "stop_contact_radius", "stop_width", "stop_post_length", "rotor_top_level",
        "stop_post_stress", "stop_tooth_stress", "stop_contact_stress", "stop_tooth_safety", "holding_torque",
        "cold_layer_strength",
    )  # fmt: skip
    force = holding / (2.0 * radius)
    assert pressure == pytest.approx(force / (width * 4 * MM))
    lever = top - 2 * MM
    assert post == pytest.approx(np.hypot(6 * force * lever / (width * length**2), 3**0.5 * force / (width * length)))
    bent = 6 * force * (0.4 * MM + 0.5 * width) / (4 * MM * (5 * MM) ** 2)
    assert tooth_stress == pytest.approx(np.hypot(bent, 3**0.5 * force / (20 * MM**2)))
    safety = min(least, layers / (module["holding_safety"] * post))
    assert torque == pytest.approx(holding * safety)


def test_no_room_for_stops_is_a_rule(inputs: dict[str, Any]) -> None:
    crowded = {**inputs, **SMALL, "pcl_outer_radius": 24.5 * MM}
    assert of(crowded, "stop_width_margin")[0] < 0.0
    many = {**inputs, **SMALL, "spring_pairs": 4, "coil_diameter": 14 * MM}
    assert of(many, "stop_length_margin")[0] < 0.0
    close = {**inputs, **SMALL, "stop_margin": 0.005}
    assert of(close, "stop_fit_margin")[0] < 0.0
