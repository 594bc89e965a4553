"""The structure at its own temperatures: put together by hand at the operating points, in phases, and as strength."""

from typing import Any

import numpy as np
import pytest
from device_values import inputs_of

from tvimdesign.device import table_for
from tvimdesign.device.core.impedance.warm_structure import parts_now
from tvimdesign.device.table.module import Module
from tvimdesign.physics.heat_flow import heat

LEFT = ["structure_stiffness", "core_stiffness", "plate_stiffness", "floor_stiffness", "core_radius",
        "pcl_inner_radius", "pcl_outer_radius", "layer_polar_moment", "pad_compliance", "driven_share",
        "joint_stiffness@hot", "joint_damping@hot", "pcl_stiffness@hot", "pcl_damping@hot", "spring_stiffness",
        "part_temperatures@hot", "plate_temperature@hot", "core_temperature@hot", "hot_structure_share"]  # fmt: skip


def star(celsius: Any) -> Any:
    """E*/E(23) of printed PETG as its record has it, with a loss of 0.01 in clamped joints."""
    done, before = (1.0 / (1.0 + np.exp((78.5 - t) / 4.0)) for t in (celsius, 23.0))
    storage = 0.0025 ** (done - before) * np.exp(-0.003 * (celsius - 23.0))
    return storage * (1.0 + 1j * (0.01 + 0.03 + 1.47 * 4.0 * done * (1.0 - done)))


def test_hot_joint_is_put_together_from_parts_as_warm_as_they_are() -> None:
    table, given = table_for("shear"), inputs_of("shear")
    found = table.evaluate(given, LEFT)
    warm = found["part_temperatures@hot"]
    # The plate under torque: the ring above the arcs, which the layer relieves in proportion to the radius and drives
    # on one face, and all of it further in.
    shear_modulus, thick = 2.1e9 / (2.0 * 1.38), given["rotor_thickness"]
    inner, outer = found["pcl_inner_radius"], found["pcl_outer_radius"]
    radius = np.linspace(inner, outer, 20001)
    left = (outer**4 - radius**4) / (outer**4 - inner**4)
    above = np.trapezoid(left**2 / radius**3, radius) / (2.0 * np.pi * shear_modulus * thick)
    above /= np.sqrt(found["driven_share"])
    above += thick / (3.0 * shear_modulus * found["layer_polar_moment"])
    slices = np.mean([star(t - 273.15) for t in warm.plate])
    whole = (
        1.0 / found["core_stiffness"] / star(warm.core - 273.15)
        + (1.0 / found["plate_stiffness"] - above) / star(warm.beside - 273.15)
        + above / slices
        + 1.0 / found["floor_stiffness"] / star(22.0)
        + found["pad_compliance"] / (1.0 + 0.04j)
    )
    layer = complex(found["pcl_stiffness@hot"], 2.0 * np.pi * found["pcl_damping@hot"])
    joint = found["spring_stiffness"] + 1.0 / (1.0 / layer + whole)
    assert found["joint_stiffness@hot"] == pytest.approx(joint.real, rel=1e-6)
    assert found["joint_damping@hot"] == pytest.approx(joint.imag / (2.0 * np.pi), rel=1e-6)
    assert found["hot_structure_share"] == pytest.approx((1.0 / whole).real / found["structure_stiffness"], rel=1e-6)


@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_the_hot_structure_is_softer_and_lossier(mode: str) -> None:
    rows = ("warm_structure_stiffness", "warm_structure_loss")
    names = ["structure_stiffness", *(f"{name}@{point}" for name in rows for point in ("cold", "hot"))]
    found = table_for(mode).evaluate(inputs_of(mode), names)
    # PCL at 30 degC for good, air at 22: the parts are within seven kelvin of 23 degC, 0.3 % a kelvin.
    assert found["warm_structure_stiffness@cold"] == pytest.approx(found["structure_stiffness"], rel=0.01)
    assert found["warm_structure_stiffness@hot"] < 0.9 * found["warm_structure_stiffness@cold"]
    cold, hot = (found[f"warm_structure_loss@{p}"] / found[f"warm_structure_stiffness@{p}"] for p in ("cold", "hot"))
    assert cold == pytest.approx(0.04, rel=0.01)
    assert hot > 2.0 * cold


def test_metal_hardly_softens_and_a_warm_cold_point_weakens() -> None:
    given = inputs_of("shear", process="machine_6061")
    found = table_for("shear").evaluate(given, ["hot_structure_share"])
    assert 0.95 < found["hot_structure_share"] < 1.0
    given = {**inputs_of("shear"), "temperature@hot": 473.15}
    found = table_for("shear").evaluate(given, ["joint_stiffness@hot", "warm_structure_stiffness@hot"])
    assert 0.0 < found["warm_structure_stiffness@hot"] < 200.0
    assert found["joint_stiffness@hot"] > 0.0
    table = table_for("shear")
    names = ["core_holding_torque"]
    cold, warmer = (table.evaluate({**inputs_of("shear"), "temperature@cold": t + 273.15}, names) for t in (23.0, 45.0))
    for name in names:
        assert warmer[name] / cold[name] == pytest.approx(np.exp(-0.003 * 22.0), rel=2e-3), name


def test_structure_in_a_phase_is_as_warm_as_the_stack_is(inputs: dict[str, Any]) -> None:
    stack = table_for("shear").evaluate(inputs, ["stack"])["stack"]
    state = heat.initial_state(stack, 6, 320.0)
    profile = heat.profile(state, stack)._replace(cold=300.0, hot=340.0)
    parts = parts_now(Module(stack_profile=profile))
    assert [parts.core, parts.beside, *parts.plate] == pytest.approx([320.0] * 10, abs=1e-9)
    assert (parts.walls, parts.floor) == (320.0, 300.0)
