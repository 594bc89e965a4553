"""A motor below the module: where its parts stand, what they weigh and turn, and the rules that keep them apart."""

import numpy as np
import pytest
from device_values import inputs_of, values_of

from tvimdesign.device import table_for

MM = 1e-3
RULES = {
    "motor_retainer_gap", "motor_foot_gap", "motor_spoke_gap", "motor_spoke_wall_margin", "mount_thread_margin",
    "mount_tip_margin",
    "motor_tube_gap", "motor_hub_wall_margin", "motor_wall_margin", "motor_barrel_gap", "motor_lip_margin",
    "motor_journal_wall_margin", "motor_thread_margin", "motor_disc_margin", "motor_retainer_wall_margin",
    "motor_base_thread_margin", "motor_base_hole_gap",
}  # fmt: skip
ENCODER_RULES = {"encoder_ledge_margin", "encoder_floor_margin"}
DRIVEN = {"motor": "ilm_e70x10", "encoder": "on_axis_28"}


def test_the_motor_stands_below_the_feet_and_the_envelope_has_it():
    rows = "drive_height motor_plate_level stator_top_level stator_bottom_level motor_bottom_level envelope_height"
    bare, driven = values_of("envelope_height envelope_diameter"), values_of(rows, **DRIVEN)
    # A floor of 4 mm, feet of 6, a disc of 6, 1 mm of air, a stator of 22.7 and a base of 8 mm.
    levels = [driven[f"{name}_level"] / MM for name in ("motor_plate", "stator_top", "stator_bottom", "motor_bottom")]
    assert levels == pytest.approx([-16.0, -17.0, -39.7, -47.7])
    assert driven["drive_height"] == pytest.approx(37.7 * MM)
    assert driven["envelope_height"] - bare["envelope_height"] == pytest.approx(37.7 * MM)
    narrow = inputs_of(**DRIVEN) | {"housing_outer_radius": 30.0 * MM}
    wide = table_for("shear").evaluate(narrow, ["envelope_diameter"])["envelope_diameter"]
    assert wide == pytest.approx((69.0 + 2 * 0.2 + 2 * 2.5) * MM)
    assert values_of("envelope_diameter", **DRIVEN)["envelope_diameter"] == bare["envelope_diameter"]


def test_parts_have_their_seats_and_the_magnet_its_gap():
    rows = "stator_seat_radius motor_disc_radius motor_seat_radius motor_journal_radius"
    printed, milled = values_of(rows, **DRIVEN), values_of(rows, **DRIVEN | {"process": "machine_6061"})
    # 69 mm stator, 42 mm rotor bore, bearing of 15 and 24 mm.
    assert list(printed.values()) == pytest.approx([34.7 * MM, 20.8 * MM, 12.05 * MM, 7.45 * MM])
    assert list(milled.values()) == pytest.approx([34.55 * MM, 20.95 * MM, 12.0015 * MM, 7.4985 * MM])
    rows = "motor_bottom_level motor_retainer_level motor_retainer_thickness encoder_board_height motor_sink_radius"
    values = values_of(rows, **DRIVEN)
    # Below the head of 1.65 mm: 1 mm of gap and a magnet of 2.5 mm; it looks at a board 3 mm high, 1 mm away.
    assert values["motor_retainer_thickness"] == pytest.approx((2.0 + 1.65 + 1.0 + 2.5) * MM)
    magnet = values["motor_retainer_level"] - values["motor_retainer_thickness"]
    assert magnet - (values["motor_bottom_level"] + 3.0 * MM) == pytest.approx(1.0 * MM)
    assert values["motor_sink_radius"] == pytest.approx((2.85 + 0.4) * MM)
    # 12.2 mm in the middle of 22.7 mm.
    assert values_of("motor_rotor_bottom_level", **DRIVEN)["motor_rotor_bottom_level"] == pytest.approx(-34.45 * MM)
    small = values_of("motor_sink_radius", **DRIVEN | {"motor_screw": "iso_4762_m2"})
    assert small["motor_sink_radius"] == pytest.approx((3.0 + 0.2) * MM)  # now the magnet of 6 mm is the wider


def test_the_drive_is_in_the_mass_and_inertia_of_the_module():
    rows = "module_mass drive_mass parts_inertia drive_inertia motor_hub_inertia structure_stiffness"
    bare, driven = values_of(rows), values_of(rows, **DRIVEN)
    assert bare["drive_mass"] == bare["drive_inertia"] == 0.0
    assert driven["module_mass"] - bare["module_mass"] == pytest.approx(driven["drive_mass"])
    assert driven["parts_inertia"] == bare["parts_inertia"]
    assert driven["structure_stiffness"] == bare["structure_stiffness"]
    rows = "driven_inertia drive_inertia housing_inertia springs_mass pcl_mass heater_mass lead_mass cutout_mass"
    values = values_of(rows, **DRIVEN)
    springs = values["springs_mass"] * ((57.0 * MM) ** 2 + (0.5 * 24.4094 * MM) ** 2)
    on_arcs = values["pcl_mass"] + values["heater_mass"] + values["lead_mass"] + values["cutout_mass"]
    between = on_arcs * ((26.0 * MM) ** 2 + (40.0 * MM) ** 2) / 2.0
    whole = values["drive_inertia"] + values["housing_inertia"] + springs + between
    assert values["driven_inertia"] == pytest.approx(whole)
    assert values_of("driven_inertia") == {"driven_inertia": 0.0}


def test_the_drive_weighs_and_turns_what_its_parts_do_one_by_one():
    values = values_of("drive_mass drive_inertia motor_hub_volume motor_hub_inertia motor_housing_volume", **DRIVEN)

    def tube(inner: float, outer: float, length: float) -> np.ndarray:
        """Volume [mm^3] and polar moment of volume [mm^5] of a tube about its own axis."""
        area = np.pi * (outer**2 - inner**2)
        return np.array([area * length, 0.5 * area * length * (inner**2 + outer**2)])

    def groove(inner: float, outer: float) -> float:
        y = np.linspace(-4.0, 4.0, 2001)
        return float(np.trapezoid(np.sqrt(outer**2 - y**2) - np.sqrt(inner**2 - y**2), y))

    # Base of 8 with four holes of 2.5 x 6.8, wall and tube as high as the stator, 22.7. The bore: 24.1 wide up to the
    # lower bearing's upper end, 16.15 above the ground, and for 5 at the top; 22 between. A way out for wires, 8 wide.
    housing = tube(0.0, 37.2, 8.0) + tube(34.7, 37.2, 22.7) + tube(0.0, 14.55, 22.7)
    housing -= tube(0.0, 12.05, 16.15 + 5.0) + tube(0.0, 11.0, 30.7 - 21.15) + 4 * tube(0.0, 1.25, 6.8)
    board = tube(12.05, 14.2, 3.0)[0] + 3.0 * groove(14.2, 37.2)
    assert values["motor_housing_volume"] / MM**3 == pytest.approx(housing[0] - 5.0 * groove(34.7, 37.2) - board)
    retainer = tube(1.7, 8.5, 2.0) + tube(3.25, 8.5, 5.15)
    screw = tube(0.0, 1.25, 12.0) + tube(0.0, 2.85, 1.65)
    mounts = 4 * (tube(0.0, 1.25, 16.0) + tube(0.0, 2.75, 3.0))
    mounts[1] += mounts[0] * 57.0**2
    magnet = tube(0.0, 3.0, 2.5)
    made = 1270.0 * (values["motor_hub_volume"] / MM**3 + housing[0] - 5.0 * groove(34.7, 37.2) - board + retainer[0])
    grams = 1e-6 * (made + 7900.0 * screw[0] + 7850.0 * mounts[0] + 7500.0 * magnet[0])
    # Stator 117.3 g and rotor 44.88 g, two bearings of 7 g, a board of 3 g.
    assert 1e3 * values["drive_mass"] == pytest.approx(grams + 117.3 + 44.88 + 14.0 + 3.0)
    # The rotor's 23.2 kg mm^2 is its record's; of a bearing of 15 and 24 turns what is inside of 19.5.
    inner = 14.0 / tube(7.5, 12.0, 1.0)[0] * tube(7.5, 9.75, 1.0)[1]
    turning = 1e-6 * (1270.0 * retainer[1] + 7900.0 * screw[1] + 7850.0 * mounts[1] + 7500.0 * magnet[1]) + inner
    hub = values["motor_hub_inertia"] * 1e9
    assert values["drive_inertia"] * 1e9 - hub == pytest.approx(23.2e3 + turning)


def test_the_motor_turns_cover_and_adjusters_as_well():
    rows = "driven_inertia drive_inertia housing_inertia springs_mass pcl_mass heater_mass lead_mass cutout_mass "
    radii = "adjusters_mass housing_inner_radius housing_outer_radius"
    values = values_of(rows + radii, **DRIVEN | {"cover": "plate", "preload_adjuster": "rotary"})
    springs = (values["springs_mass"] + values["adjusters_mass"]) * ((57.0 * MM) ** 2 + (0.5 * 24.4094 * MM) ** 2)
    on_arcs = values["pcl_mass"] + values["heater_mass"] + values["lead_mass"] + values["cutout_mass"]
    between = on_arcs * ((26.0 * MM) ** 2 + (40.0 * MM) ** 2) / 2.0
    # A plate of 1.5 mm, less the core's hole of 10.4 mm, four of 1.2 mm on the wall's radius and four of 3.5 on 57 mm.
    polar = 0.5 * np.pi * (values["housing_outer_radius"] ** 4 - (10.4 * MM) ** 4)
    for radius, circle in ((1.2 * MM, values["housing_inner_radius"]), (3.5 * MM, 57.0 * MM)):
        polar -= 4 * np.pi * radius**2 * (circle**2 + 0.5 * radius**2)
    whole = values["drive_inertia"] + values["housing_inertia"] + springs + between + 1270.0 * 1.5 * MM * polar
    assert values["driven_inertia"] == pytest.approx(whole)


def test_torque_and_tilt_are_borne_by_motor_and_bearings():
    rows = "motor_torque_margin spring_stiffness"
    values = values_of(rows, **DRIVEN)
    assert values["motor_torque_margin"] == pytest.approx(0.62 - 0.104 * values["spring_stiffness"])
    weak = values_of("motor_torque_margin", **DRIVEN | {"motor": "ilm_e50x08", "motor_bearing": "ball_6700"})
    assert weak["motor_torque_margin"] < 0.0  # 0.3 N m against the paper's springs
    rows = "motor_bearing_load motor_bearing_margin holding_torque link_length link_bottom_level motor_retainer_level"
    values = values_of(rows, **DRIVEN)
    # Moments about the lower bearing, 5 mm wide above the retainer; the upper one is below -17 mm, the link 4 mm thick.
    lower, upper = values["motor_retainer_level"] + 2.5 * MM, (-17.0 - 2.5) * MM
    middle = values["link_bottom_level"] + 2.0 * MM
    force = values["holding_torque"] / values["link_length"]
    assert values["motor_bearing_load"] == pytest.approx(force * (middle - lower) / (upper - lower))
    assert values["motor_bearing_margin"] == pytest.approx(1260.0 - values["motor_bearing_load"])


def test_each_gap_of_a_motor_mount_is_what_its_drawing_gives():
    # In mm: a disc of 20.8 with corners of 0.2, printed walls of 1.2, 0.4 to turn in, M3 in plastic (5.25 of thread).
    drawn = {
        "motor_foot_gap": 57.0 - 20.8 - 0.2, "motor_spoke_gap": 21.0 * np.sqrt(0.5) - 3.5 - 0.2,
        "motor_retainer_gap": (6.0 + 4.0 - 4.0 - 0.4 - 2.5 - 1.65) - 0.4, "motor_spoke_wall_margin": 3.5 - 1.25 - 1.35,
        "mount_thread_margin": 16.0 - 10.0 - 5.25, "mount_tip_margin": 6.0 + 10.0 - 16.0,
        "motor_tube_gap": (20.8 - 2.5) - (12.05 + 2.5) - 0.4, "motor_hub_wall_margin": 1.3, "motor_wall_margin": 1.3,
        "motor_barrel_gap": 0.5 * (22.7 - 12.2) - 0.4, "motor_journal_wall_margin": 7.45 - 1.25 - 1.35,
        # From the stator's upper end at -17 to the retainer: above a board of 3, 1 of air and its own 7.15.
        "motor_lip_margin": (47.7 - 3.0 - 1.0 - 7.15) - 17.0 - 10.0 - 1.2,
        # A screw of 12 through 2 of retainer and 0.4 of air, with 0.5 for its tip; from the journal's end at -36.15.
        "motor_thread_margin": 12.0 - 2.0 - 0.4 - 5.25, "motor_disc_margin": (36.15 - 10.0) - (9.6 + 0.5) - 1.2,
        "motor_retainer_wall_margin": 8.5 - 3.25 - 1.2, "motor_base_thread_margin": (8.0 - 1.2) - 0.5 - 5.25,
        # Midway between the stator's 24.85 and 34.5, around the recess for a board of 14.
        "motor_base_hole_gap": 0.5 * (24.85 + 34.5) - 1.25 - 14.2 - 1.35, "encoder_ledge_margin": 14.0 - 12.05 - 1.2,
        "encoder_floor_margin": 8.0 - 3.0 - 1.2,
    }  # fmt: skip
    assert set(drawn) == RULES | ENCODER_RULES
    gaps = {name: value / MM for name, value in values_of(" ".join(drawn), **DRIVEN).items()}
    assert gaps == pytest.approx(drawn, abs=1e-9)
