"""Heat of the layer's edge to a lip of the rotor plate, in the links of a whole module."""

from collections.abc import Callable
from math import pi
from typing import Any

import numpy as np
import pytest
from device_values import all_of
from support import study_path

from tvimdesign.device import table_for
from tvimdesign.physics.heat_flow import heat
from tvimdesign.physics.heat_flow.conduction import Conductivities, mean_conductivity
from tvimdesign.physics.heat_flow.layer_end import warm_lip
from tvimdesign.physics.heat_flow.lumps import STRIP, Place
from tvimdesign.physics.polymers.polymer import fraction_at
from tvimdesign.study import given, read_study

MM = 1e-3
CELLS = 12
TABLE = table_for("shear")


def found(*names: str, **module: Any) -> dict[str, Any]:
    """Values of a milled module with lips, but for what is said (SI, records by name), beside its inputs."""
    milled = {"process": "machine_6061", "melt_lip": "rings", "pcl_thickness": 1.5 * MM, "running_clearance": 0.1 * MM}
    return all_of(names, **{**milled, **module})


def test_a_metal_lip_takes_what_a_cold_wall_takes() -> None:
    one = found("cold_end", hot_contact=1e9, rotor_contact=1e9)
    conductivity = 0.5 * (one["pcl_conductivity_solid"] + one["pcl_conductivity_melt"])
    # Slices that fall evenly from a kelvin to none are half a kelvin above it; a cold wall takes 2/pi ln cot(pi f/4).
    wall = -2.0 / pi * np.log(np.tan(0.25 * pi * 0.1 / 1.5))
    given_heat = 0.5 * one["cold_end"].of_layer + one["cold_end"].of_pads
    # Slices keep less than an even fall leaves them, so that they are asked for more by that.
    assert conductivity * wall < given_heat < 1.2 * conductivity * wall


def alike(_: Any) -> tuple[Any, Any]:
    """A polymer whose phases conduct alike."""
    return np.ones(CELLS), 1.0


def at_the_edge(excess: float) -> Callable[[Place], float]:
    """Pads an excess above a plate of one temperature."""
    return lambda place: excess if place[0] == "hot" else 0.0


def test_temperature_of_metal_and_plastic_lips() -> None:
    metal, plastic = (
        warm_lip(found("lip", structure_conductivity=k)["lip"], np.full(CELLS, 0.5), at_the_edge(1.0), alike)
        for k in (167.0, 0.2)
    )
    assert metal.temperature == pytest.approx(0.0, abs=0.01)
    assert 0.1 < plastic.temperature < 0.45


@pytest.mark.parametrize(
    ("study", "warm", "given_heat"),
    [
        # Pads, layer, the plate's lowest eighth above the arcs and its mean, plate with lips beside it in three parts,
        # floor below these; from the start to 107, 1095, 56 s by `validation/heat_sector/plane.py`, and what the
        # layer's end gives to lip and clearance [W/m].
        ("wrist_joint", (58.04, 52.29, 46.60, 40.83, 39.44, 36.59, 30.56, 53.38, 47.50, 36.47), 1.171),
        ("finger", (69.61, 65.68, 61.95, 59.63, 57.28, 52.50, 41.78, 60.83, 54.15, 42.49), 1.047),
        ("elbow_printed", (86.13, 68.08, 52.67, 39.53, 36.08, 30.76, 23.90, 46.71, 32.62, 24.34), 2.945),
    ],
)
def test_a_plastic_lip_takes_what_the_plane_says(study: str, warm: tuple[float, ...], given_heat: float) -> None:
    inputs = given(read_study(study_path(study)))
    one = TABLE.evaluate(inputs, ["lip", "edge_length", "pcl_melting"])
    names = [("hot", 0), ("layer", 0), ("face", 0), ("plate", 0), *(("beside", i) for i in range(3)),
             ("around", 7), ("around", 1), ("around", 2)]  # fmt: skip
    at = dict(zip(names, warm, strict=True))
    phases = Conductivities(inputs["pcl_conductivity_solid"], inputs["pcl_conductivity_melt"])
    melting, cells = one["pcl_melting"], np.full(CELLS, at["layer", 0])

    def conducting(wall: float) -> tuple[Any, Any]:
        kelvin, pads, cold = (celsius + 273.15 for celsius in (cells, at["hot", 0], wall))
        own = phases.mixed(fraction_at(kelvin, melting))
        mean = 0.5 * (phases.solid + phases.melt)
        to_lip = (mean_conductivity(place, own[0], cold, phases, melting) / mean for place in (kelvin, pads))
        return next(to_lip), next(to_lip)

    lip = warm_lip(one["lip"], cells, at.__getitem__, conducting)
    taken = np.sum(lip.from_layer) + lip.from_places["hot", 0]
    assert taken / one["edge_length"] == pytest.approx(given_heat, rel=0.12)


def test_a_lip_gives_what_it_takes_and_less_from_the_melt() -> None:
    one = found("lip", structure_conductivity=0.2)
    at = {("hot", 0): 90.0, ("face", 0): 60.0, ("plate", 0): 55.0, ("around", 7): 50.0, ("around", 1): 40.0,
          ("around", 2): 30.0, ("beside", 0): 45.0, ("beside", 1): 35.0, ("beside", 2): 25.0}  # fmt: skip
    cells = np.linspace(85.0, 62.0, CELLS)
    lip = warm_lip(one["lip"], cells, at.__getitem__, lambda _: (np.linspace(0.9, 1.1, CELLS), 0.9))
    assert np.sum(lip.from_layer) + sum(lip.from_places.values()) == pytest.approx(0.0, abs=1e-9)
    one = found("lip")["lip"]
    molten, frozen = (
        warm_lip(one, np.full(CELLS, 0.5), at_the_edge(1.0), lambda _, k=k: (np.full(CELLS, k), k)) for k in (0.9, 1.1)
    )
    assert np.sum(molten.from_layer) / np.sum(frozen.from_layer) == pytest.approx(0.9 / 1.1, rel=0.01)


def test_lips_stand_over_the_floor_and_stiffen_the_plate_s_heat() -> None:
    names = ("rotor_beside", "melt_lip_moments", "beside_area")
    lips, bare = (found(*names, melt_lip=kind) for kind in ("rings", "none"))
    more = sum(a.capacity - b.capacity for a, b in zip(lips["rotor_beside"], bare["rotor_beside"], strict=True))
    volumetric = lips["structure_density"] * lips["structure_specific_heat"]
    assert more == pytest.approx(lips["melt_lip_moments"].area * volumetric, rel=0.05)
    deeper = (lips["rotor_thickness"] + 1.4 * MM) / lips["rotor_thickness"]
    second = [one["rotor_beside"][1].conductance for one in (lips, bare)]
    assert 1.0 < second[0] / second[1] < deeper
    one = found("below_lips", "beside_area", "edge_length")
    # Air and, as between 335 and 295 K, radiation of grey faces of 0.9.
    shine = 5.670374419e-8 / (2.0 / 0.9 - 1.0) * (335.0**2 + 295.0**2) * (335.0 + 295.0)
    more = (one["air_conductivity"] / (0.1 * MM) + shine) * one["edge_length"]
    assert 0.9 * one["rotor_rim"] < sum(one["below_lips"]) / more < 1.005 * one["rotor_rim"]
    widths = np.array(STRIP) * one["beside_area"] / one["edge_length"]
    assert np.all(np.array(one["below_lips"]) / more < widths)
    one = found("cold_end", "below_lips", melt_lip="none")
    assert one["cold_end"] is None
    assert sum(one["below_lips"]) == 0.0


@pytest.mark.parametrize("thickness", [0.05, 0.3, 0.4, 0.45])
def test_a_lip_that_has_no_room_has_finite_numbers_and_a_rule_that_says_so(thickness: float) -> None:
    one = found("cold_end", "melt_lip_margin", pcl_thickness=thickness * MM, running_clearance=0.4 * MM)
    assert one["melt_lip_margin"] < 0.0
    assert all(np.isfinite(value) for value in one["cold_end"])
    assert one["cold_end"].near > 0.0


def test_a_stack_s_layer_gives_to_its_lip_as_its_phase_conducts() -> None:
    one = found("stack")
    stack = one["stack"]
    for celsius, phase in ((90.0, "melt"), (40.0, "solid")):
        state = heat.initial_state(stack, CELLS, celsius + 273.15)
        edge = 2 + CELLS + stack.plate_cells
        state[edge] -= 0.05
        now = heat.profile(state, stack)
        mean = 0.5 * (one["pcl_conductivity_solid"] + one["pcl_conductivity_melt"])
        excess = celsius + 273.15 - now.lip.temperature
        assert excess > 1.0
        given_heat = stack.lip.slices * one[f"pcl_conductivity_{phase}"] / mean * excess
        assert np.sum(now.lip.from_layer) == pytest.approx(given_heat, rel=2e-3)
