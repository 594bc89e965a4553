"""Which way results move when an input grows, over the range in which people build such modules."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions

TABLE = table_for("shear")
# (input, output, which way): mechanics and rheology say so whatever the rest of the module.
GROWS = [
    ("wire_diameter", "spring_stiffness"), ("wire_diameter", "springs_mass"), ("coil_count", "springs_mass"),
    ("preload_angle", "spring_stress"), ("preload_angle", "preload_margin"), ("stroke", "spring_stress"),
    ("stroke", "layer_strain"), ("pcl_outer_radius", "pcl_stiffness@cold"), ("arc_span", "layer_holding_torque"),
    ("core_radius", "core_holding_torque"),
    ("arc_span", "pcl_damping@hot"), ("core_radius", "structure_stiffness"), ("rotor_thickness", "structure_stiffness"),
    ("frequency@hot", "storage_modulus@hot"), ("placement_radius", "envelope_diameter"),
    ("link_thickness", "envelope_height"), ("moving_inertia", "critical_damping"),
]  # fmt: skip
FALLS = [
    ("coil_diameter", "spring_stiffness"), ("coil_count", "spring_stiffness"), ("wire_diameter", "spring_index"),
    ("pcl_thickness", "pcl_stiffness@hot"), ("pcl_thickness", "layer_strain"), ("temperature@hot", "loss_modulus@hot"),
    ("temperature@cold", "storage_modulus@cold"), ("stroke", "spring_fatigue_safety"),
    ("moving_inertia", "natural_frequency@cold"), ("frequency@hot", "pcl_damping@hot"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("source", "result", "sign"), [(*pair, 1.0) for pair in GROWS] + [(*pair, -1.0) for pair in FALLS]
)
@settings(max_examples=15, deadline=None)
@given(factor=st.floats(1.005, 1.25), seed=st.integers(0, 2**20))
def test_result_follows_its_input(
    source: str, result: str, sign: float, factor: float, seed: int, inputs: dict[str, Any]
) -> None:
    random = np.random.default_rng(seed)
    # Not the geometry's own module but one near it; what does not depend on the source stays out of the way.
    module = {
        row.name: inputs[row.name] * random.uniform(0.92, 1.08) for row in TABLE.inputs if row.variable
    }  # fmt: skip
    before = {**inputs, **module}
    after = {**before, source: _changed(source, before[source], factor)}
    low, high = (TABLE.evaluate(given, [result])[result] for given in (before, after))
    assert sign * (high - low) > 0.0


def _changed(name: str, value: float, factor: float) -> float:
    return value + 20.0 * (factor - 1.0) if name.startswith("temperature") else value * factor


@pytest.mark.gate
@settings(max_examples=12, deadline=None)
@given(
    change=st.sampled_from(
        [
            ("current", 1.2, -1.0),  # more heat
            ("pcl_thickness", 0.7e-3, 1.0),  # more to melt, and a longer way
            ("rotor_thickness", 2.5e-3, 1.0),  # more to warm
            ("hot_contact", 5e2, -1.0),  # above 2.6e3 hardly anything follows: 1e-4, most of it at the layer's corner
            ("ambient_temperature", 283.15, -1.0),
            ("pcl_latent_heat", 60e3, 1.0),
            ("target_temperature", 365.0, 1.0),
            ("pcl_conductivity_melt", 0.15, -1.0),
        ]
    ),
    shares=st.tuples(st.floats(0.0, 1.0), st.floats(0.0, 1.0)).filter(lambda pair: abs(pair[0] - pair[1]) > 0.05),
)
def test_response_time_follows_its_input(
    change: tuple[str, float, float], shares: tuple[float, float], unity: DeviceFunctions, simulator: Simulator
) -> None:
    name, lowest, sign = change
    span = 15.0 if name.endswith("temperature") else 0.6 * lowest
    times = []
    for share in sorted(shares):
        place = unity.start.copy()
        place[unity.index[name]] = lowest + share * span
        times.append(simulator.run(place).values["far_face_time"])
    assert sign * (times[1] - times[0]) > 0.0
