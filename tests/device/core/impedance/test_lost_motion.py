"""Lost motion by source: friction on the pins by virtual work over a turn, the core in its bore or bearings."""

import numpy as np
import pytest
from device_values import values_of

from tvimdesign.device import MODES

MM = 1e-3


@pytest.mark.parametrize("transmission", ["unity", "geometry"])
def test_friction_on_the_pins_of_the_published_module(transmission: str) -> None:
    rows = "pin_force pin_friction_torque friction_play spring_stiffness spring_rate leg_arm"
    found = values_of(rows, transmission=transmission, coil_count="3.25", leg_model="ignored")
    # The leg bears at sqrt(28.5^2 - 15.41^2) mm from the coil; its pin of 4 mm and the leg turn against each other.
    assert found["leg_arm"] == pytest.approx(np.sqrt(28.5**2 - (0.5 * (24.4094 + 2.413 + 4.0)) ** 2) * MM, rel=1e-9)
    assert found["pin_force"] == pytest.approx(found["spring_rate"] * 0.15 / found["leg_arm"], rel=1e-9)
    torque = 4 * 0.25 * found["pin_force"] * (2.0 * MM + 2.0 * MM)
    assert found["pin_friction_torque"] == pytest.approx(torque, rel=1e-9)
    # 8 mrad at a friction of 0.25, by a reading from outside of the drawn springs (4.53 N.m/rad).
    if transmission == "geometry":
        assert found["friction_play"] == pytest.approx(8e-3, rel=0.06)
    assert found["friction_play"] == pytest.approx(torque / found["spring_stiffness"], rel=1e-9)
    assert values_of(rows, pin_friction="0")["friction_play"] == 0.0


@pytest.mark.parametrize("mode", MODES)
def test_lost_motion_is_what_its_sources_come_to(mode: str) -> None:
    rows = "lost_motion friction_play link_play bearing_play"
    fitted, loose = values_of(rows, mode), values_of(rows, mode, link_fit="clearance")
    for found in (fitted, loose):
        parts = found["friction_play"] + found["link_play"] + found["bearing_play"]
        assert found["lost_motion"] == pytest.approx(parts, rel=1e-12)
    assert loose["lost_motion"] - fitted["lost_motion"] == pytest.approx(
        loose["link_play"] - fitted["link_play"], rel=1e-9
    )
    rows = (
        "friction_share pin_friction_torque bearing_friction_torque preload_friction_torque spring_torque_full_stroke"
    )
    share, *friction, springs = values_of(rows, mode).values()
    assert share == pytest.approx(sum(friction) / springs, rel=1e-12)


def test_cores_lean_in_bores_until_they_are_stopped() -> None:
    rows = "bearing_play link_bottom_level hub_top_level hub_bottom_level hub_radius link_length"
    found = values_of(rows)
    play, height = 0.4, 1e3 * (found["link_bottom_level"] + 2.0 * MM - found["hub_top_level"])
    # Where the retainer, a running clearance below the hub, meets it on one side, the plate lies on it on the other.
    lean = min(
        2.0 * play / (1e3 * (found["hub_top_level"] - found["hub_bottom_level"])), play / (2e3 * found["hub_radius"])
    )
    assert found["bearing_play"] == pytest.approx((play + lean * height) / (1e3 * found["link_length"]), rel=1e-9)
    rows = "core_lean bearing_play link_bottom_level hub_top_level hub_radius pcl_outer_radius link_length"
    found = values_of(rows, axial_preload="wave_21x25")
    # 1.2 mm high frozen, 0.2 mm of wire; a layer of 1 mm grows by 70 um, by which the retainer is below the hub.
    free = (1.2 - 0.2) + 0.0701
    assert found["core_lean"] == pytest.approx(free / (2e3 * found["hub_radius"]), rel=1e-4)
    height = 1e3 * (found["link_bottom_level"] + 2.0 * MM - found["hub_top_level"])
    shift = 0.4 + found["core_lean"] * height
    assert found["bearing_play"] == pytest.approx(shift / (1e3 * found["link_length"]), rel=1e-9)
    # Lips, 0.4 mm above the floor while the layer is frozen and 1.5 mm wide, come down before that.
    lipped = values_of(rows, axial_preload="wave_21x25", melt_lip="rings")
    reach = 1e3 * (lipped["hub_radius"] + lipped["pcl_outer_radius"]) + 1.5
    assert lipped["core_lean"] == pytest.approx((0.4 + 0.0701) / reach, rel=1e-4)
    found = values_of("core_lean hub_radius pcl_outer_radius", "compression", axial_preload="wave_21x25")
    # Vanes are 0.4 mm above the floor and reach as far out as the blocks.
    assert found["core_lean"] == pytest.approx(0.4 * MM / (found["hub_radius"] + found["pcl_outer_radius"]), rel=1e-9)


def test_bearings_have_the_gaps_of_their_seats_and_of_their_balls() -> None:
    module = {"bearing": "ball_6702", "hub_depth": "5 mm", "foot_height": "11 mm", "core_radius": "7.5 mm"}
    rows = "bearing_play link_bottom_level hub_top_level hub_bottom_level link_length"
    found = values_of(rows, **module)
    play, width = 2 * 0.05 + 0.5 * 0.018, 4.0  # two seats of a print, half of ISO 5753-1's largest; the ring's width
    upper = 1e3 * found["hub_top_level"] - 0.5 * width
    spread = 1e3 * (found["hub_top_level"] - found["hub_bottom_level"]) - width
    height = 1e3 * found["link_bottom_level"] + 2.0 - upper
    shift = np.polyval(np.polyfit([upper, upper - spread], [play, -play], 1), upper + height)
    assert found["bearing_play"] == pytest.approx(shift / (1e3 * found["link_length"]), rel=1e-9)
    # A milled seat leaves a hundredth of a millimetre.
    milled = values_of(rows, process="machine_6061", **module)
    assert milled["bearing_play"] < 0.2 * found["bearing_play"]


def test_keys_are_loose_and_legs_wear_by_archards_law() -> None:
    found = values_of("key_play lost_motion")
    # A key of 2.5 mm that shrinks by 2.4 % has 30 um to each side, at 33 mm from the axis.
    assert found["key_play"] == pytest.approx(0.5 * 0.024 * 2.5 / 33.0, rel=1e-9)
    other = values_of("key_play lost_motion", key_count="0")
    assert other["key_play"] == 0.0
    assert other["lost_motion"] == pytest.approx(found["lost_motion"], rel=1e-12)
    found = values_of("pin_wear pin_friction_torque")
    # The legs' friction torque has force and slip: T = N mu F s', here four springs at 0.25.
    work = 4e6 * 0.104 * found["pin_friction_torque"] / (4 * 0.25)
    volume = 1e-14 * work  # 1e-5 mm3/(N m)
    assert found["pin_wear"] == pytest.approx(np.sqrt(volume / (np.pi * np.sqrt(0.5 * 2.413e-3 * 2e-3))), rel=1e-9)
