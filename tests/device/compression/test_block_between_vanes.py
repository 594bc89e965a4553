"""Blocks, vanes and springs put together once more: by quadrature over the sector, with complex numbers, by hand."""

from typing import Any

import numpy as np
import pytest
from device_values import values_of
from scipy.integrate import quad
from stiff_when_warm import STIFF_WHEN_WARM

from tvimdesign.device import table_for
from tvimdesign.physics.solids import wedge

TABLE = table_for("compression")
HERTZ = 3.0


@pytest.fixture(scope="module")
def joint(squeezed: dict[str, Any]) -> dict[str, Any]:
    sizes = {"block_height": 10e-3, "block_depth": 5e-3}
    given = {**squeezed, **STIFF_WHEN_WARM, **sizes, "frequency@cold": HERTZ, "frequency@hot": HERTZ}
    names = [name for name in TABLE.names(("cold", "hot")) if TABLE.output(name).group == "Impedance"]
    more = ["link_bottom_level", "rotor_top_level", "housing_vane_angle", "pcl_moment", "block_lean_out"]
    more += [f"support@{point}" for point in ("cold", "hot")]
    return {**given, **TABLE.evaluate(given, [*names, *more])}


def apparent(joint: dict[str, Any], point: str) -> complex:
    """Apparent modulus: the incompressible block by its shape, and the volume as [Gent and Lindley] give it, in series.

    E = 411 MPa and nu = 0.45 at 23 degC make a bulk modulus of 1370 MPa. The mean pressure is a share of the stress.
    """
    shear = complex(joint[f"storage_modulus@{point}"], joint[f"loss_modulus@{point}"])
    width, height, depth = 14e-3, 10e-3, 5e-3
    shape = width * height / (2.0 * (width + height) * depth)
    whole = 1.0 + 2.0 * shape**2
    pressure = (1.0 / 3.0 + 2.0 * shape**2) / whole
    return 1.0 / (1.0 / (3.0 * shear * whole) + pressure**2 / 1370e6)


@pytest.mark.parametrize("point", ["cold", "hot"])
def test_six_of_twelve_blocks_push_each_with_its_pressure_at_every_radius(joint: dict[str, Any], point: str) -> None:
    # A sector of the angle a is strained by theta/a at every radius: torque = E theta/a times the integral of r h dr.
    angle = 5e-3 / 33e-3
    arm, _ = quad(lambda r: r * 10e-3, 26e-3, 40e-3)
    star = 6 * apparent(joint, point) / angle * arm
    assert joint[f"pcl_stiffness@{point}"] == pytest.approx(star.real, rel=1e-9)
    assert joint[f"pcl_damping@{point}"] == pytest.approx(star.imag / (2.0 * np.pi * HERTZ), rel=1e-9)


@pytest.mark.parametrize("point", ["cold", "hot"])
def test_joint_is_the_springs_parallel_to_blocks_and_structure_in_series(joint: dict[str, Any], point: str) -> None:
    springs = TABLE.evaluate(joint, ["spring_stiffness"])["spring_stiffness"]
    omega = 2.0 * np.pi * HERTZ
    blocks = complex(joint[f"pcl_stiffness@{point}"], omega * joint[f"pcl_damping@{point}"])
    star = springs + 1.0 / (1.0 / blocks + 1.0 / (joint["structure_stiffness"] * (1.0 + 0.04j)))  # PETG, clamped
    assert joint[f"joint_stiffness@{point}"] == pytest.approx(star.real, rel=1e-9)
    assert joint[f"joint_damping@{point}"] == pytest.approx(star.imag / omega, rel=1e-9)
    # What the simulations use: shear modes in series with one support, structure and volume together.
    shear = complex(joint[f"storage_modulus@{point}"], joint[f"loss_modulus@{point}"])
    modes = shear * joint["pcl_moment"] / 5e-3
    again = springs + 1.0 / (1.0 / modes + 1.0 / complex(*joint[f"support@{point}"]))
    assert again == pytest.approx(star, rel=1e-9)


def test_a_molten_film_softens_the_joint_as_a_block_of_its_own_depth_would(squeezed: dict[str, Any]) -> None:
    storage, loss = np.full(12, 1e15), np.zeros(12)
    storage[:3], loss[:3] = 2e4, 3e4  # a quarter has melted, the rest is rigid
    names = ["impedance_now", "spring_stiffness"]
    support = complex(700.0, 30.0)
    whole = 1.0 / np.mean(1.0 / (storage + 1j * loss))
    moduli = {"slice_moduli": (storage, loss), "layer_moduli": (whole.real, whole.imag)}
    found = TABLE.evaluate({**squeezed, **moduli, "support_now": (support.real, support.imag)}, names)
    width, height, thick = 14e-3, 3.5e-3, 0.25 * 7e-3
    shape = width * height / (2.0 * thick * (width + height))
    film = 6 * 3.0 * complex(2e4, 3e4) * (1.0 + 2.0 * shape**2) * width * height * 33e-3**2 / thick
    star = found["spring_stiffness"] + 1.0 / (1.0 / film + 1.0 / support)
    assert found["impedance_now"] == pytest.approx(abs(star), rel=1e-6)


def test_structure_and_strain_of_blocks_are_by_hand(joint: dict[str, Any]) -> None:
    mean = 33e-3
    parts = ["core_stiffness", "plate_stiffness", "floor_stiffness", "rotor_vane_stiffness", "housing_vane_stiffness"]
    pads = 1.0 / (6 * TABLE.evaluate(joint, ["pad_press_stiffness"])["pad_press_stiffness"] * mean**2)
    whole = sum(1.0 / value for value in TABLE.evaluate(joint, parts).values()) + pads
    assert joint["structure_stiffness"] == pytest.approx(1.0 / whole, rel=1e-9)
    assert joint["block_strain"] == pytest.approx(0.104 * 33.0 / 5.0, rel=1e-9)


def test_a_slender_block_has_three_times_the_shear_modulus(squeezed: dict[str, Any]) -> None:
    ideal = {
        **squeezed, "pcl_poissons_ratio": 0.5 - 1e-9, "block_height": 1e-6, "structure_youngs_modulus": 1e20,
        "peltier_shear_modulus": 1e20, "preload_angle": 0.15,
    }  # fmt: skip
    found = TABLE.evaluate(
        ideal, ["joint_stiffness@hot", "spring_stiffness", "storage_modulus@hot", "joint_damping@hot"]
    )
    blocks = 6 * 3.0 * found["storage_modulus@hot"] * 14e-3 * 1e-6 * 33e-3**2 / 7e-3
    assert found["joint_stiffness@hot"] - found["spring_stiffness"] == pytest.approx(blocks, rel=1e-4)


def test_joint_holds_what_its_weakest_part_holds(joint: dict[str, Any]) -> None:
    # 16 MPa on six faces of 14 x 10 mm at 33 mm.
    assert joint["block_holding_torque"] == pytest.approx(6 * 16e6 * 140e-6 * 33e-3, rel=1e-9)
    parts = [joint[f"{part}_holding_torque"] for part in ("block", "rotor_vane", "housing_vane", "core", "link")]
    assert joint["holding_torque"] == min(parts)
    lean = joint["block_lean_out"]
    assert 0.01 < lean < 0.1
    for part, width, thickness, angle in (
        ("rotor_vane", 14e-3, 5e-3, lean),
        ("housing_vane", 7e-3, joint["housing_vane_thickness"], 0.0),
    ):
        force = 1.25 * joint[f"{part}_holding_torque"] / (6 * 33e-3)  # with the safety it is stated by
        across, along = 6.0 / (width * thickness**2), 6.0 / (width**2 * thickness)
        bending = force * 5.4e-3 * (np.cos(angle) * across + np.sin(angle) * along)
        twist = 33e-3 * (1.0 - np.cos(angle)) * wedge.stress_of_twist(width, thickness)
        shear = force * (1.0 / (width * thickness) + twist)
        assert bending**2 + 3.0 * shear**2 == pytest.approx((31e6) ** 2, rel=1e-9), part


def test_each_gap_of_the_chamber_is_what_its_drawing_gives(squeezed: dict[str, Any]) -> None:
    # In mm: six vanes of 5 and twelve blocks of 7 on 33, from 26 to 40, pads of 1.5, slots of 7 from 29.5 to 36.5.
    mm = 1e-3
    housing = np.pi / 3.0 - (2 * 7.0 + 5.0) / 33.0
    reach = np.hypot(0.5 * 24.4094, 2.0 * 2.413) + 0.5 * 2.413
    block, stop = 7.0 / 33.0, squeezed["stroke"] + squeezed["stop_margin"]
    seat = 1.5 - 0.2 * (1.0 + 1.5 / 33.0) - 0.05
    roof = np.sqrt(36.5**2 - 1.5**2) - np.sqrt(29.5**2 - 1.5**2)
    # Squeezed, a block keeps its area and its inner radius: (r^2 - 26^2) (a - stop) = (40^2 - 26^2) a.
    pressed_out = np.sqrt(26.0**2 + (40.0**2 - 26.0**2) * block / (block - stop))
    drawn = {
        "hub_block_gap": 26.0 - (10.0 + 0.4 + 3.0) - 1.0, "block_breadth": 14.0,
        "slot_opening": 29.5 * (housing - 2.0 * np.arcsin(1.5 / 29.5)), "slot_reach": 3.5 - 2.0,
        "slot_web": 0.5 * (14.0 - 7.0), "slot_web_margin": 3.5 - 1.2, "slot_width_margin": 7.0 - 2.1 * 0.2,
        "vane_root": 5.0 * 26.0 / 33.0, "vane_root_margin": 5.0 * 26.0 / 33.0 - 1.2,
        "mount_slot_gap": 57.0 - 3.5 - 36.5 - 1.0, "pad_seat": seat, "pad_seat_margin": seat - 1.2,
        "slot_edge_margin": 0.05 + 0.1, "slot_bridge_margin": 10.0 - roof,
        "squeezed_block_gap": 57.0 - reach - pressed_out - 1.0,
    }  # fmt: skip
    found = TABLE.evaluate(squeezed, list(drawn))
    assert {name: value / mm for name, value in found.items()} == pytest.approx(drawn)


def test_blocks_shrink_from_their_vanes_and_creep_at_their_sides() -> None:
    rows = "freezing_gap freezing_travel stop_play axial_play"
    found = values_of(rows, "compression", block_depth="7 mm", axial_preload="wave_21x25")
    assert found["freezing_gap"] == pytest.approx(7e-3 * (1.0 - (1070.0 / 1145.0) ** (1.0 / 3.0)), rel=1e-9)
    assert found["freezing_gap"] == pytest.approx(0.156e-3, rel=0.01)
    # Blocks have room above and below: the rotor stands still and its stop touches.
    assert found["freezing_travel"] == found["stop_play"] == found["axial_play"] == 0.0
    found = values_of("melt_creep pcl_viscosity@hot", "compression", block_depth="4 mm")
    # Between two vanes 4 mm apart, upright: h^2 rho g/(12 eta), by hand. A thin layer creeps a twentieth of that.
    speed = 4e-3**2 * 1070.0 * 9.80665 / (12.0 * found["pcl_viscosity@hot"])
    assert found["melt_creep"] == pytest.approx(3600.0 * speed, rel=1e-6)
    assert found["melt_creep"] > 10e-3
