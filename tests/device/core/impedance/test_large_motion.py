"""The molten joint over its whole stroke, against plain calculations on the drawn optimum's numbers."""

from typing import Any

import numpy as np
import pytest
from device_values import inputs_of
from scipy.integrate import quad
from stiff_when_warm import STIFF_WHEN_WARM

from tvimdesign.device import table_for
from tvimdesign.physics.polymers import melt, polymer

ROWS = ["hot_stiffness_at_stroke", "hot_damping_at_stroke", "hot_damping_at_stroke_least", "melt_stress",
        "melt_stress_safety", "edge_fracture_angle", "joint_stiffness@hot", "joint_damping@hot",
        "spring_stiffness", "storage_modulus@hot", "loss_modulus@hot", "structure_stiffness"]  # fmt: skip
# The optimum of paper_shear as it stood at 2.8 kPa s: 413 % of strain at the rim at its stroke.
OPTIMUM = {"pcl_outer_radius": 23.8434e-3, "pcl_inner_radius": 11.9293e-3, "pcl_thickness": 0.6e-3, "stroke": 0.104}
SMOOTH = {"pin_friction": 0.0, "bore_friction": 0.0}
INNER = OPTIMUM["pcl_inner_radius"] / OPTIMUM["pcl_outer_radius"]


def module(mode: str = "shear", **changes: Any) -> dict[str, Any]:
    found = {**inputs_of(mode), **STIFF_WHEN_WARM, **SMOOTH, **changes}
    return {**found, **table_for(mode).evaluate(found, ROWS)}


def melt_modes(viscosity: float) -> list[tuple[float, float]]:
    """Six modes, two a decade, moduli as time to the power -0.2, with the sums of viscosity and 0.95 MPa."""
    times = 10.0 ** (-0.5 * np.arange(6))
    moduli = times**-0.2 / np.sum(times**-0.2) * 0.95e6
    return [(viscosity / float(moduli @ times) * t, g) for t, g in zip(times, moduli, strict=True)]


@pytest.mark.parametrize(("hertz", "kilopascal"), [(1.0, 73.0), (3.0, 208.0), (5.0, 321.0)])
def test_stress_at_full_stroke_is_what_an_independent_reading_found(hertz: float, kilopascal: float) -> None:
    angular = 2.0 * np.pi * hertz
    star = sum(g * 1j * angular * t / (1.0 + 1j * angular * t) for t, g in melt_modes(2824.889))
    assert 4.133 * abs(star) / 1e3 == pytest.approx(kilopascal, rel=5e-3)
    storage, loss = polymer.maxwell_moduli(angular, polymer.melt_spectrum(2824.889, 0.95e6, 6))
    assert melt.shear_stress(4.133, storage, loss) / 1e3 == pytest.approx(kilopascal, rel=5e-3)


def test_damping_falls_to_a_seventh_if_the_melt_remembers_the_whole_stroke() -> None:
    # Found for the drawn optimum: linear 1.85, at 413 % 0.25 N m s/rad. Its strain law alone, over the ring's torque.
    found = module(**OPTIMUM, pcl_zero_shear_viscosity=2824.889)
    law, _ = quad(lambda r: r**3 / (1.0 + (4.133 * r / 0.3) ** 2 / 19.0), INNER, 1.0)
    whole, _ = quad(lambda r: r**3, INNER, 1.0)
    assert law / whole == pytest.approx(0.25 / 1.85, rel=0.02)
    ratio = found["hot_damping_at_stroke_least"] / found["joint_damping@hot"]
    assert ratio == pytest.approx(law / whole, rel=5e-3)


def test_damping_at_stroke_is_wagners_over_the_ring() -> None:
    found = module(**OPTIMUM)
    angular, modes = 2.0 * np.pi, melt_modes(4200.0)

    def share(radius: float, part: int) -> float:
        return melt.wagner_moduli(4.133 * radius, angular, modes, 0.3)[part] * radius**3

    whole, _ = quad(lambda r: r**3, INNER, 1.0)
    storage, loss = (quad(share, INNER, 1.0, args=(part,))[0] / whole for part in (0, 1))
    small = polymer.maxwell_moduli(angular, modes)
    assert small[1] > loss > 0.6 * small[1]
    # The structure in series is hundreds of times stiffer than the melt.
    damping = found["joint_damping@hot"] * loss / small[1]
    assert found["hot_damping_at_stroke"] == pytest.approx(damping, rel=0.03)
    assert 0.0 < found["hot_damping_at_stroke_least"] < found["hot_damping_at_stroke"]
    stiffness = (found["joint_stiffness@hot"] - found["spring_stiffness"]) * storage / small[0]
    assert found["hot_stiffness_at_stroke"] - found["spring_stiffness"] == pytest.approx(stiffness, rel=0.1)


# At 30 Hz the melt is stiff enough for the structure's own loss to count: 2.5 % of the damping.
@pytest.mark.parametrize("hertz", [1.0, 30.0])
@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_at_a_small_stroke_it_is_the_joint_of_small_motions(mode: str, hertz: float) -> None:
    found = module(mode, stroke=1e-3, **{"frequency@hot": hertz})
    assert found["hot_stiffness_at_stroke"] == pytest.approx(found["joint_stiffness@hot"], rel=1e-3)
    assert found["hot_damping_at_stroke"] == pytest.approx(found["joint_damping@hot"], rel=1e-3)
    assert found["hot_damping_at_stroke_least"] == pytest.approx(found["joint_damping@hot"], rel=0.02)


def test_stress_and_the_free_edge_follow_from_the_strain_at_the_rim() -> None:
    found = module()
    stress = 40.0 * 0.104 / 1.0 * np.hypot(found["storage_modulus@hot"], found["loss_modulus@hot"])
    assert found["melt_stress"] == pytest.approx(stress, rel=1e-9)
    assert found["melt_stress_safety"] == pytest.approx(0.2e6 / stress, rel=1e-9)
    strain = found["edge_fracture_angle"] * 40e-3 / 1e-3
    assert 0.2 * found["storage_modulus@hot"] * strain**2 == pytest.approx(2.0 * 0.035 / (3.0 * 1e-3), rel=1e-9)
    assert found["edge_fracture_angle"] < 0.2 * found["stroke"]


def test_strain_of_a_block_costs_what_its_squeeze_costs() -> None:
    found = {**module("compression")}
    found |= table_for("compression").evaluate(found, ["block_strain", "shape_factor"])
    squeeze, shape = found["block_strain"], found["shape_factor"]
    modulus = np.hypot(found["storage_modulus@hot"], found["loss_modulus@hot"])
    energy = 0.5 * 3.0 * modulus * (1.0 + 2.0 * shape**2) * squeeze**2
    assert 0.5 * found["melt_stress"] ** 2 / modulus == pytest.approx(energy, rel=1e-9)


@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_friction_adds_at_the_stroke_what_its_energy_in_a_cycle_says(mode: str) -> None:
    more = ["pin_friction_torque", "bearing_friction_torque", "spring_torque_full_stroke", "holding_torque", "stroke"]
    cold_rows = [f"{name}@cold" for name in ("joint_stiffness", "joint_damping", "bearing_damping")]
    names = [*ROWS, *more, *cold_rows, "cold_stroke", "cold_damping_at_stroke"]
    rough = {"pin_friction": 0.25, "bore_friction": 0.3}
    table, smooth = table_for(mode), module(mode)
    found = {**smooth, **table.evaluate({**{k: v for k, v in smooth.items() if k not in ROWS}, **rough}, names)}
    omega, phase = 2.0 * np.pi, np.linspace(0.0, 2.0 * np.pi, 100_001)

    def damping(stiffness: float, viscous: float, reach: float) -> float:
        load = stiffness * reach * np.sin(phase) + viscous * omega * reach * np.cos(phase)
        share = found["bearing_friction_torque"] / found["spring_torque_full_stroke"]
        rubbed = found["pin_friction_torque"] + share * np.abs(load)
        return float(np.trapezoid(rubbed * np.abs(reach * np.cos(phase)), phase) / (np.pi * omega * reach**2))

    viscous = smooth["hot_damping_at_stroke"]
    hot = damping(found["hot_stiffness_at_stroke"], viscous, found["stroke"])
    assert found["hot_damping_at_stroke"] == pytest.approx(viscous + hot, rel=1e-6)
    stiffness, small = found["joint_stiffness@cold"], found["joint_damping@cold"]
    reach = min(found["stroke"], found["holding_torque"] / stiffness)
    assert found["cold_stroke"] == pytest.approx(reach, rel=1e-12)
    cold = damping(stiffness, small, reach)
    assert found["cold_damping_at_stroke"] == pytest.approx(small + cold, rel=1e-6)
    # Small motions and pure torques know nothing of it.
    assert smooth["joint_damping@hot"] == found["joint_damping@hot"]
