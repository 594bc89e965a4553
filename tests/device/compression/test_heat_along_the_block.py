"""Time to heat a block: by the flux alone, by diffusion, and in between, as its depth doubles."""

from typing import Any

import numpy as np
import pytest
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
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.study import given as resolve
from tvimdesign.study import read_study

TABLE = table_for("compression")
# Nothing but block and pads takes heat, and nothing loses it.
ALONE: dict[str, Any] = {
    "structure_specific_heat": 1.0, "structure_conductivity": 1e-3, "rotor_coefficient": 1e-3,
    "surface_emissivity": 0.0, "peltier_specific_heat": 1e-4, "hot_contact": 1e6, "rotor_contact": 1e5,
    "peltier_conductance": 1e-4, "peltier_seebeck": 0.0, "cold_side_coefficient": 1e3, "horizon": 1e5,
    "response_criterion": "far_face", "air_conductivity": 1e-6, "housing_coefficient": 1e-4,
}  # fmt: skip


def far_face_time(module: dict[str, Any], **changed: Any) -> float:
    model = DeviceFunctions(TABLE, {**module, **ALONE, **changed}, ("cold", "hot"), 24)
    return float(tight(model).run(model.start, phases=["softening"]).values["far_face_time"])


def conducting(factor: float) -> dict[str, Any]:
    return {"pcl_conductivity_solid": 0.225 * factor, "pcl_conductivity_melt": 0.18 * factor}


def test_a_block_that_conducts_well_takes_its_heat_over_the_flux(squeezed: dict[str, Any]) -> None:
    # Half of I^2 R goes to the hot side; 231 kJ/kg take polycaprolactone from 22 to 100 degC, a third of it latent.
    area = 12 * 14e-3 * 3.5e-3
    power = 0.5 * 1.5**2 * 3.0 * area / 1600e-6
    time = far_face_time(squeezed, current=1.5, **conducting(100.0))
    assert time == pytest.approx(1145.0 * area * 7e-3 * 231e3 / power, rel=0.02)


@pytest.mark.parametrize(("factor", "current", "low", "high"), [(100.0, 1.5, 1.98, 2.05), (1.0, 40.0, 3.3, 4.0)])
def test_twice_the_depth_by_flux_and_by_diffusion(
    factor: float, current: float, low: float, high: float, squeezed: dict[str, Any]
) -> None:
    times = [
        far_face_time(squeezed, block_depth=depth, current=current, **conducting(factor)) for depth in (3e-3, 6e-3)
    ]
    assert low < times[1] / times[0] < high


@pytest.mark.gate
def test_twice_the_depth_takes_two_to_four_times_as_long(squeezed: dict[str, Any]) -> None:
    ratios = []
    for current in (0.5, 1.5, 4.0, 12.0):
        times = [far_face_time(squeezed, block_depth=depth, current=current) for depth in (3e-3, 6e-3)]
        ratios.append(times[1] / times[0])
    assert np.all(np.diff(ratios) > 0.0)
    assert 2.0 < ratios[0] < ratios[-1] < 4.0


@pytest.mark.gate
def test_twice_the_depth_of_a_whole_module() -> None:
    # Pads and vanes of both sides take heat as well, which does not double: at 1.5 A twice takes less than twice as
    # long. The deeper it is and the more heat comes in, the more diffusion counts; the joint is soft when a film of the
    # block is. What the free sides lose grows with the depth and is left out. Five vanes: in a ring of six, blocks of
    # more than 6.2 mm leave the housing's vanes no thickness, and those of more than 4.7 mm the pads no slot.
    study = read_study(study_path("paper_compression"))
    lossless = {"air_conductivity": 1e-6, "housing_coefficient": 0.1, "surface_emissivity": 1e-3}
    module = {**resolve(study), **STIFF_WHEN_WARM, **lossless, "horizon": 1e5, "vane_count": 5.0}

    def ratios(depth: float, current: float) -> tuple[float, float]:
        found = []
        for times in (1.0, 2.0):
            given = {**module, "block_depth": times * depth, "current": current}
            model = DeviceFunctions(TABLE, given, ("cold", "hot"), 24)
            assert float(TABLE.evaluate(given, ["slot_opening"])["slot_opening"]) > 2e-3
            values = tight(model).run(model.start, phases=["softening"]).values
            found.append((values["far_face_time"], values["softening_time"]))
        return found[1][0] / found[0][0], found[1][1] / found[0][1]

    weak, deep, strong = ratios(2e-3, 1.5), ratios(3.25e-3, 1.5), ratios(3.25e-3, 10.0)
    assert 1.4 < weak[0] < deep[0] < 2.0 < strong[0] < 4.0
    assert strong[0] > 2.25
    assert weak[1] > deep[1] > strong[1] > 1.0
    assert strong[1] < 1.2


def test_heat_of_the_rotor_is_all_in_vanes_plate_and_core(squeezed: dict[str, Any]) -> None:
    found = TABLE.evaluate(squeezed, ["stack", "rotor_mass", "link_mass", "retainer_mass"])
    stack = found["stack"]
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
    parts = found["rotor_mass"] + found["link_mass"] + found["retainer_mass"]
    around = sum(stack.around[place].capacity for place in (RIM, WITHIN, *ABOVE_WALLS, ABOVE_PADS))
    assert vanes + around + sum(lump.capacity for lump in stack.beside) == pytest.approx(1200.0 * parts, rel=1e-9)


def test_floor_below_pads_gives_by_mean_and_cosine(squeezed: dict[str, Any]) -> None:
    found = TABLE.evaluate(squeezed, ["stack", "wall_depth"])
    deep, wall, pad, wide = squeezed["floor_thickness"], found["wall_depth"], squeezed["peltier_thickness"], 12 * 14e-3
    links = {(link.first, link.second): link.conductance for link in found["stack"].links}
    upper, _, lower = (("around", place) for place in BELOW_PADS)
    # 0.029 of the vane's depth from its edge is what is next to the pads; 0.087 and 0.666 are shares of the depth.
    even = 0.24 * wide * deep / (0.25 * pad + 0.029 * wall)
    uneven = 0.24 * wide * deep / (0.25 * pad + deep / np.pi / np.tanh(np.pi * wall / deep))
    assert links[lower, ("around", BELOW_WALLS[0])] == pytest.approx(0.666 * even, rel=1e-9)
    # Bodies that differ from their mean by d give (even - uneven) d less for their share: they conduct so much less.
    assert links[upper, lower] == pytest.approx(0.087 * 0.666 * (uneven - even), rel=1e-9)


def test_cold_sides_are_open_where_the_slots_are(squeezed: dict[str, Any]) -> None:
    stack = TABLE.evaluate(squeezed, ["stack"])["stack"]
    # Twelve pads, 7 of 14 mm wide, from the floor's side to 2 mm below the top of 3.5 mm.
    assert stack.cold_surface.area == pytest.approx(12 * 7e-3 * 1.5e-3, rel=1e-9)
