"""Stiffness of a warm structure, and lost motion by its sources."""

from typing import Any

import numpy as np
import pytest
from device_values import inputs_of, values_of

from tvimdesign.device import MODES, table_for
from tvimdesign.device.core.impedance.warm_structure import parts_now
from tvimdesign.device.table import Module
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


def test_hot_joint_is_put_together_from_parts_as_warm_as_they_are():
    table, given = table_for("shear"), inputs_of("shear")
    values = table.evaluate(given, LEFT)
    warm = values["part_temperatures@hot"]
    # The plate under torque: the ring above the arcs, which the layer relieves in proportion to the radius and drives
    # on one face, and all of it further in.
    shear_modulus, thick = 2.1e9 / (2.0 * 1.38), given["rotor_thickness"]
    inner, outer = values["pcl_inner_radius"], values["pcl_outer_radius"]
    radius = np.linspace(inner, outer, 20001)
    left = (outer**4 - radius**4) / (outer**4 - inner**4)
    above = np.trapezoid(left**2 / radius**3, radius) / (2.0 * np.pi * shear_modulus * thick)
    above /= np.sqrt(values["driven_share"])
    above += thick / (3.0 * shear_modulus * values["layer_polar_moment"])
    slices = np.mean([star(t - 273.15) for t in warm.plate])
    whole = (
        1.0 / values["core_stiffness"] / star(warm.core - 273.15)
        + (1.0 / values["plate_stiffness"] - above) / star(warm.beside - 273.15)
        + above / slices
        + 1.0 / values["floor_stiffness"] / star(22.0)
        + values["pad_compliance"] / (1.0 + 0.04j)
    )
    layer = complex(values["pcl_stiffness@hot"], 2.0 * np.pi * values["pcl_damping@hot"])
    joint = values["spring_stiffness"] + 1.0 / (1.0 / layer + whole)
    assert values["joint_stiffness@hot"] == pytest.approx(joint.real, rel=1e-6)
    assert values["joint_damping@hot"] == pytest.approx(joint.imag / (2.0 * np.pi), rel=1e-6)
    assert values["hot_structure_share"] == pytest.approx((1.0 / whole).real / values["structure_stiffness"], rel=1e-6)


@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_the_hot_structure_is_softer_and_lossier(mode):
    rows = ("warm_structure_stiffness", "warm_structure_loss")
    names = ["structure_stiffness", *(f"{name}@{point}" for name in rows for point in ("cold", "hot"))]
    values = table_for(mode).evaluate(inputs_of(mode), names)
    # PCL at 30 degC for good, air at 22: the parts are within seven kelvin of 23 degC, 0.3 % a kelvin.
    assert values["warm_structure_stiffness@cold"] == pytest.approx(values["structure_stiffness"], rel=0.01)
    assert values["warm_structure_stiffness@hot"] < 0.9 * values["warm_structure_stiffness@cold"]
    cold, hot = (values[f"warm_structure_loss@{p}"] / values[f"warm_structure_stiffness@{p}"] for p in ("cold", "hot"))
    assert cold == pytest.approx(0.04, rel=0.01)
    assert hot > 2.0 * cold


def test_metal_hardly_softens_and_a_warm_cold_point_weakens():
    given = inputs_of("shear", process="machine_6061")
    values = table_for("shear").evaluate(given, ["hot_structure_share"])
    assert 0.95 < values["hot_structure_share"] < 1.0
    given = {**inputs_of("shear"), "temperature@hot": 473.15}
    values = table_for("shear").evaluate(given, ["joint_stiffness@hot", "warm_structure_stiffness@hot"])
    assert 0.0 < values["warm_structure_stiffness@hot"] < 200.0
    assert values["joint_stiffness@hot"] > 0.0
    table = table_for("shear")
    names = ["core_holding_torque"]
    cold, warmer = (table.evaluate({**inputs_of("shear"), "temperature@cold": t + 273.15}, names) for t in (23.0, 45.0))
    for name in names:
        assert warmer[name] / cold[name] == pytest.approx(np.exp(-0.003 * 22.0), rel=2e-3), name


def test_structure_in_a_phase_is_as_warm_as_the_stack_is(inputs):
    stack = table_for("shear").evaluate(inputs, ["stack"])["stack"]
    state = heat.initial_state(stack, 6, 320.0)
    profile = heat.profile(state, stack)._replace(cold=300.0, hot=340.0)
    parts = parts_now(Module(stack_profile=profile))
    assert [parts.core, parts.beside, *parts.plate] == pytest.approx([320.0] * 10, abs=1e-9)
    assert (parts.walls, parts.floor) == (320.0, 300.0)


MM = 1e-3


@pytest.mark.parametrize("transmission", ["unity", "geometry"])
def test_friction_on_the_pins_of_the_published_module(transmission):
    rows = "pin_force pin_friction_torque friction_play spring_stiffness spring_rate leg_arm"
    values = values_of(rows, transmission=transmission, coil_count="3.25", leg_model="ignored")
    # The leg bears at sqrt(28.5^2 - 15.41^2) mm from the coil; its pin of 4 mm and the leg turn against each other.
    assert values["leg_arm"] == pytest.approx(np.sqrt(28.5**2 - (0.5 * (24.4094 + 2.413 + 4.0)) ** 2) * MM, rel=1e-9)
    assert values["pin_force"] == pytest.approx(values["spring_rate"] * 0.15 / values["leg_arm"], rel=1e-9)
    torque = 4 * 0.25 * values["pin_force"] * (2.0 * MM + 2.0 * MM)
    assert values["pin_friction_torque"] == pytest.approx(torque, rel=1e-9)
    # 8 mrad at a friction of 0.25, by a reading from outside of the drawn springs (4.53 N.m/rad).
    if transmission == "geometry":
        assert values["friction_play"] == pytest.approx(8e-3, rel=0.06)
    assert values["friction_play"] == pytest.approx(torque / values["spring_stiffness"], rel=1e-9)
    assert values_of(rows, pin_friction="0")["friction_play"] == 0.0


@pytest.mark.parametrize("mode", MODES)
def test_lost_motion_is_what_its_sources_come_to(mode):
    rows = "lost_motion friction_play link_play bearing_play"
    fitted, loose = values_of(rows, mode), values_of(rows, mode, link_fit="clearance")
    for joint in (fitted, loose):
        parts = joint["friction_play"] + joint["link_play"] + joint["bearing_play"]
        assert joint["lost_motion"] == pytest.approx(parts, rel=1e-12)
    assert loose["lost_motion"] - fitted["lost_motion"] == pytest.approx(
        loose["link_play"] - fitted["link_play"], rel=1e-9
    )
    if mode == "lock":
        return
    rows = (
        "friction_share pin_friction_torque bearing_friction_torque preload_friction_torque spring_torque_full_stroke"
    )
    share, *friction, springs = values_of(rows, mode).values()
    assert share == pytest.approx(sum(friction) / springs, rel=1e-12)


def test_cores_lean_in_bores_until_they_are_stopped():
    rows = "bearing_play link_bottom_level hub_top_level hub_bottom_level hub_radius link_length"
    values = values_of(rows)
    play, height = 0.4, 1e3 * (values["link_bottom_level"] + 2.0 * MM - values["hub_top_level"])
    # Where the retainer, a running clearance below the hub, meets it on one side, the plate lies on it on the other.
    lean = min(
        2.0 * play / (1e3 * (values["hub_top_level"] - values["hub_bottom_level"])), play / (2e3 * values["hub_radius"])
    )
    assert values["bearing_play"] == pytest.approx((play + lean * height) / (1e3 * values["link_length"]), rel=1e-9)
    rows = "core_lean bearing_play link_bottom_level hub_top_level hub_radius pcl_outer_radius link_length"
    values = values_of(rows, axial_preload="wave_21x25")
    # 1.2 mm high frozen, 0.2 mm of wire; a layer of 1 mm grows by 70 um, by which the retainer is below the hub.
    free = (1.2 - 0.2) + 0.0701
    assert values["core_lean"] == pytest.approx(free / (2e3 * values["hub_radius"]), rel=1e-4)
    height = 1e3 * (values["link_bottom_level"] + 2.0 * MM - values["hub_top_level"])
    shift = 0.4 + values["core_lean"] * height
    assert values["bearing_play"] == pytest.approx(shift / (1e3 * values["link_length"]), rel=1e-9)
    # Lips, 0.4 mm above the floor while the layer is frozen and 1.5 mm wide, come down before that.
    lipped = values_of(rows, axial_preload="wave_21x25", melt_lip="rings")
    reach = 1e3 * (lipped["hub_radius"] + lipped["pcl_outer_radius"]) + 1.5
    assert lipped["core_lean"] == pytest.approx((0.4 + 0.0701) / reach, rel=1e-4)
    values = values_of("core_lean hub_radius pcl_outer_radius", "compression", axial_preload="wave_21x25")
    # Vanes are 0.4 mm above the floor and reach as far out as the blocks.
    assert values["core_lean"] == pytest.approx(
        0.4 * MM / (values["hub_radius"] + values["pcl_outer_radius"]), rel=1e-9
    )


def test_bearings_have_the_gaps_of_their_seats_and_of_their_balls():
    module = {"bearing": "ball_6702", "hub_depth": "5 mm", "foot_height": "11 mm", "core_radius": "7.5 mm"}
    rows = "bearing_play link_bottom_level hub_top_level hub_bottom_level link_length"
    values = values_of(rows, **module)
    play, width = 2 * 0.05 + 0.5 * 0.018, 4.0  # two seats of a print, half of ISO 5753-1's largest; the ring's width
    upper = 1e3 * values["hub_top_level"] - 0.5 * width
    spread = 1e3 * (values["hub_top_level"] - values["hub_bottom_level"]) - width
    height = 1e3 * values["link_bottom_level"] + 2.0 - upper
    shift = np.polyval(np.polyfit([upper, upper - spread], [play, -play], 1), upper + height)
    assert values["bearing_play"] == pytest.approx(shift / (1e3 * values["link_length"]), rel=1e-9)
    # A milled seat leaves a hundredth of a millimetre.
    milled = values_of(rows, process="machine_6061", **module)
    assert milled["bearing_play"] < 0.2 * values["bearing_play"]


def test_keys_are_loose_and_legs_wear_by_archards_law():
    values = values_of("key_play lost_motion")
    # A key of 2.5 mm that shrinks by 2.4 % has 30 um to each side, at 33 mm from the axis.
    assert values["key_play"] == pytest.approx(0.5 * 0.024 * 2.5 / 33.0, rel=1e-9)
    other = values_of("key_play lost_motion", key_count="0")
    assert other["key_play"] == 0.0
    assert other["lost_motion"] == pytest.approx(values["lost_motion"], rel=1e-12)
    values = values_of("pin_wear pin_friction_torque")
    # The legs' friction torque has force and slip: T = N mu F s', here four springs at 0.25.
    work = 4e6 * 0.104 * values["pin_friction_torque"] / (4 * 0.25)
    volume = 1e-14 * work  # 1e-5 mm3/(N m)
    assert values["pin_wear"] == pytest.approx(np.sqrt(volume / (np.pi * np.sqrt(0.5 * 2.413e-3 * 2e-3))), rel=1e-9)
