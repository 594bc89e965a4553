"""The block between vanes: forces and heat."""

from typing import Any

import numpy as np
import pytest
from device_values import values_of
from scipy.integrate import quad
from stiff_when_warm import STIFF_WHEN_WARM
from support import study_path, tight

from tvimdesign.device import table_for
from tvimdesign.device.compression.ring_heat import (
    ABOVE_PADS,
    ABOVE_WALLS,
    BELOW_PADS,
    BELOW_WALLS,
    HOUSING,
    RIM,
    WITHIN,
)
from tvimdesign.physics.heat_flow import lumps, shape_factors
from tvimdesign.physics.solids import wedge
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.study import given as resolve
from tvimdesign.study import read_study

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
def test_six_of_twelve_blocks_push_each_with_its_pressure_at_every_radius(joint, point):
    # A sector of the angle a is strained by theta/a at every radius: torque = E theta/a times the integral of r h dr.
    angle = 5e-3 / 33e-3
    arm, _ = quad(lambda r: r * 10e-3, 26e-3, 40e-3)
    star = 6 * apparent(joint, point) / angle * arm
    assert joint[f"pcl_stiffness@{point}"] == pytest.approx(star.real, rel=1e-9)
    assert joint[f"pcl_damping@{point}"] == pytest.approx(star.imag / (2.0 * np.pi * HERTZ), rel=1e-9)


@pytest.mark.parametrize("point", ["cold", "hot"])
def test_joint_is_the_springs_parallel_to_blocks_and_structure_in_series(joint, point):
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


def test_a_molten_film_softens_the_joint_as_a_block_of_its_own_depth_would(squeezed):
    storage, loss = np.full(12, 1e15), np.zeros(12)
    storage[:3], loss[:3] = 2e4, 3e4  # a quarter has melted, the rest is rigid
    names = ["impedance_now", "spring_stiffness"]
    support = complex(700.0, 30.0)
    whole = 1.0 / np.mean(1.0 / (storage + 1j * loss))
    moduli = {"slice_moduli": (storage, loss), "layer_moduli": (whole.real, whole.imag)}
    values = TABLE.evaluate({**squeezed, **moduli, "support_now": (support.real, support.imag)}, names)
    width, height, thick = 14e-3, 3.5e-3, 0.25 * 7e-3
    shape = width * height / (2.0 * thick * (width + height))
    film = 6 * 3.0 * complex(2e4, 3e4) * (1.0 + 2.0 * shape**2) * width * height * 33e-3**2 / thick
    star = values["spring_stiffness"] + 1.0 / (1.0 / film + 1.0 / support)
    assert values["impedance_now"] == pytest.approx(abs(star), rel=1e-6)


def test_structure_and_strain_of_blocks_are_by_hand(joint):
    mean = 33e-3
    parts = ["core_stiffness", "plate_stiffness", "floor_stiffness", "rotor_vane_stiffness", "housing_vane_stiffness"]
    pads = 1.0 / (6 * TABLE.evaluate(joint, ["pad_press_stiffness"])["pad_press_stiffness"] * mean**2)
    pads += TABLE.evaluate(joint, ["leaned_on_compliance"])["leaned_on_compliance"]
    whole = sum(1.0 / value for value in TABLE.evaluate(joint, parts).values()) + pads
    assert joint["structure_stiffness"] == pytest.approx(1.0 / whole, rel=1e-9)
    assert joint["block_strain"] == pytest.approx(0.104 * 33.0 / 5.0, rel=1e-9)


def test_a_slender_block_has_three_times_the_shear_modulus(squeezed):
    ideal = {
        **squeezed, "pcl_poissons_ratio": 0.5 - 1e-9, "block_height": 1e-6, "structure_youngs_modulus": 1e20,
        "heater_shear_modulus": 1e20, "preload_angle": 0.15,
    }  # fmt: skip
    values = TABLE.evaluate(
        ideal, ["joint_stiffness@hot", "spring_stiffness", "storage_modulus@hot", "joint_damping@hot"]
    )
    blocks = 6 * 3.0 * values["storage_modulus@hot"] * 14e-3 * 1e-6 * 33e-3**2 / 7e-3
    assert values["joint_stiffness@hot"] - values["spring_stiffness"] == pytest.approx(blocks, rel=1e-4)


def test_joint_holds_what_its_weakest_part_holds(joint):
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


def test_each_gap_of_the_chamber_is_what_its_drawing_gives(squeezed):
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
    values = TABLE.evaluate(squeezed, list(drawn))
    assert {name: value / mm for name, value in values.items()} == pytest.approx(drawn)


def test_blocks_have_room_to_shrink_and_creep_at_their_sides():
    rows = "freezing_travel stop_play axial_play"
    values = values_of(rows, "compression", block_depth="7 mm", axial_preload="wave_21x25")
    # Blocks have room above and below: the rotor stands still and its stop touches.
    assert values["freezing_travel"] == values["stop_play"] == values["axial_play"] == 0.0
    values = values_of("melt_creep pcl_viscosity@hot", "compression", block_depth="4 mm")
    # Between two vanes 4 mm apart, upright: h^2 rho g/(12 eta), by hand. A thin layer creeps a twentieth of that.
    speed = 4e-3**2 * 1070.0 * 9.80665 / (12.0 * values["pcl_viscosity@hot"])
    assert values["melt_creep"] == pytest.approx(3600.0 * speed, rel=1e-6)
    assert values["melt_creep"] > 10e-3


# Nothing but block and pads takes heat, and nothing loses it.
ALONE: dict[str, Any] = {
    "structure_specific_heat": 1.0, "structure_conductivity": 1e-3, "rotor_coefficient": 1e-3,
    "surface_emissivity": 0.0, "heater_specific_heat": 1e-4, "hot_contact": 1e6, "rotor_contact": 1e5,
    "heater_conductance": 1e-4, "heater_seebeck": 0.0, "cold_side_coefficient": 1e3, "horizon": 1e5,
    "response_criterion": "far_face", "air_conductivity": 1e-6, "housing_coefficient": 1e-4,
}  # fmt: skip


def far_face_time(module: dict[str, Any], **changed: Any) -> float:
    model = DeviceFunctions(TABLE, {**module, **ALONE, **changed}, ("cold", "hot"), 24)
    return float(tight(model).run(model.start, phases=["softening"]).values["far_face_time"])


def conducting(factor: float) -> dict[str, Any]:
    return {"pcl_conductivity_solid": 0.225 * factor, "pcl_conductivity_melt": 0.18 * factor}


@pytest.mark.gate
def test_a_block_that_conducts_well_takes_its_heat_over_the_flux(squeezed):
    # Half of I^2 R goes to the hot side; 231 kJ/kg take polycaprolactone from 22 to 100 degC, a third of it latent.
    area = 12 * 14e-3 * 3.5e-3
    power = 0.5 * 1.5**2 * 3.0 * area / 1600e-6
    time = far_face_time(squeezed, current=1.5, **conducting(100.0))
    assert time == pytest.approx(1145.0 * area * 7e-3 * 231e3 / power, rel=0.02)


@pytest.mark.gate
@pytest.mark.parametrize(("factor", "current", "low", "high"), [(100.0, 1.5, 1.98, 2.05), (1.0, 40.0, 3.3, 4.0)])
def test_twice_the_depth_by_flux_and_by_diffusion(factor, current, low, high, squeezed):
    times = [
        far_face_time(squeezed, block_depth=depth, current=current, **conducting(factor)) for depth in (3e-3, 6e-3)
    ]
    assert low < times[1] / times[0] < high


@pytest.mark.slow
def test_twice_the_depth_takes_two_to_four_times_as_long(squeezed):
    ratios = []
    for current in (0.5, 1.5, 4.0, 12.0):
        times = [far_face_time(squeezed, block_depth=depth, current=current) for depth in (3e-3, 6e-3)]
        ratios.append(times[1] / times[0])
    assert np.all(np.diff(ratios) > 0.0)
    assert 2.0 < ratios[0] < ratios[-1] < 4.0


@pytest.mark.gate
def test_twice_the_depth_of_a_whole_module():
    # Pads and vanes of both sides take heat as well, which does not double: at 1.5 A twice takes less than twice as
    # long. The deeper it is and the more heat comes in, the more diffusion counts; the joint is soft when a film of the
    # block is. What the free sides lose grows with the depth and is left out. Five vanes: in a ring of six, blocks of
    # more than 6.2 mm leave the housing's vanes no thickness, and those of more than 4.7 mm the pads no slot.
    study = read_study(study_path("paper_compression"))
    lossless = {"air_conductivity": 1e-6, "housing_coefficient": 0.1, "surface_emissivity": 1e-3}
    module = {**resolve(study), **STIFF_WHEN_WARM, **lossless, "horizon": 1e5, "vane_count": 5.0}

    def ratios(depth: float, current: float) -> tuple[float, float]:
        pairs_of_times = []
        for times in (1.0, 2.0):
            given = {**module, "block_depth": times * depth, "current": current}
            model = DeviceFunctions(TABLE, given, ("cold", "hot"), 24)
            assert float(TABLE.evaluate(given, ["slot_opening"])["slot_opening"]) > 2e-3
            values = tight(model).run(model.start, phases=["softening"]).values
            pairs_of_times.append((values["far_face_time"], values["softening_time"]))
        return pairs_of_times[1][0] / pairs_of_times[0][0], pairs_of_times[1][1] / pairs_of_times[0][1]

    weak, deep, strong = ratios(2e-3, 1.5), ratios(3.25e-3, 1.5), ratios(3.25e-3, 10.0)
    assert 1.4 < weak[0] < deep[0] < 2.0 < strong[0] < 4.0
    assert strong[0] > 2.25
    assert weak[1] > deep[1] > strong[1] > 1.0
    assert strong[1] < 1.2


def test_heat_of_the_rotor_is_all_in_vanes_plate_and_core(squeezed):
    values = TABLE.evaluate(squeezed, ["stack", "rotor_mass", "link_mass", "retainer_mass"])
    stack = values["stack"]
    assert stack.plate_thickness == pytest.approx(2.5e-3, rel=1e-12)  # half of a vane of 5 mm
    # Six roots of 14 by 5 mm. Where no heat passes the clearance below, the mean of a vane's heated 3.5 mm is a third
    # of these away, and 0.4 mm beside the clearance come before the plate, where heat turns to the side.
    airless = {**squeezed, "air_conductivity": 1e-9, "surface_emissivity": 1e-9}
    tight = TABLE.evaluate(airless, ["stack", "rotor_thickness"])
    thickness = tight["rotor_thickness"]
    root = 0.24 * 6 * 14e-3 * 5e-3 / (3.5e-3 / 3.0 + 0.4e-3)
    above = 0.24 * 12 * 14e-3 / shape_factors.ledge_ways(2.5e-3 / thickness)[0]
    assert tight["stack"].beside[0].conductance == pytest.approx(1.0 / (1.0 / root + 1.0 / above), rel=1e-6)
    # 0.4 mm of the vanes stand beside the clearance above the blocks.
    volume = 6 * 14e-3 * 5e-3 * (thickness + 0.4e-3)
    assert stack.beside[0].capacity == pytest.approx(stack.plate_heat_capacity * volume, rel=1e-9)
    # Half a vane's two rims of 3.5 mm face the chamber.
    rims, (chamber,) = (
        12 * 2 * 3.5e-3 * 2.5e-3,
        [link.conductance for link in stack.links if (link.first, link.second) == (("plate", 0), ("around", HOUSING))],
    )
    shine = 4.0 * 0.9 * lumps.STEFAN_BOLTZMANN * squeezed["ambient_temperature"] ** 3
    assert chamber == pytest.approx((5.0 + shine) * rims, rel=1e-9)
    assert stack.plate_surface.coefficient == 0.0
    vanes = stack.plate_heat_capacity * stack.area * stack.plate_thickness
    parts = values["rotor_mass"] + values["link_mass"] + values["retainer_mass"]
    around = sum(stack.around[place].capacity for place in (RIM, WITHIN, *ABOVE_WALLS, *ABOVE_PADS))
    assert vanes + around + sum(lump.capacity for lump in stack.beside) == pytest.approx(1200.0 * parts, rel=1e-9)


def test_floor_below_pads_gives_by_mean_and_cosine(squeezed):
    values = TABLE.evaluate(squeezed, ["stack", "wall_depth"])
    deep, wall, pad, wide = squeezed["floor_thickness"], values["wall_depth"], squeezed["heater_thickness"], 12 * 14e-3
    links = {(link.first, link.second): link.conductance for link in values["stack"].links}
    upper, _, lower = (("around", place) for place in BELOW_PADS)
    # 0.029 of the vane's depth from its edge is what is next to the pads; 0.087 and 0.666 are shares of the depth.
    even = 0.24 * wide * deep / (0.25 * pad + 0.029 * wall)
    uneven = 0.24 * wide * deep / (0.25 * pad + deep / np.pi / np.tanh(np.pi * wall / deep))
    assert links[lower, ("around", BELOW_WALLS[0])] == pytest.approx(0.666 * even, rel=1e-9)
    # Bodies that differ from their mean by d give (even - uneven) d less for their share: they conduct so much less.
    assert links[upper, lower] == pytest.approx(0.087 * 0.666 * (uneven - even), rel=1e-9)


def test_cold_sides_are_open_where_the_slots_are(squeezed):
    stack = TABLE.evaluate(squeezed, ["stack"])["stack"]
    # Twelve pads, 7 of 14 mm wide, from the floor's side to 2 mm below the top of 3.5 mm.
    assert stack.cold_surface.area == pytest.approx(12 * 7e-3 * 1.5e-3, rel=1e-9)
