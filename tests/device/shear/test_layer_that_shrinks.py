"""The layer that shrinks as it freezes, and the lip beside it."""

from collections.abc import Callable
from math import exp, pi, radians
from typing import Any

import numpy as np
import pytest
from device_values import all_of, values_of
from support import cases_of, study_path

from tvimdesign.device import table_for
from tvimdesign.physics.heat_flow import heat
from tvimdesign.physics.heat_flow.conduction import Conductivities, mean_conductivity
from tvimdesign.physics.heat_flow.layer_end import warm_lip
from tvimdesign.physics.heat_flow.lumps import STRIP, Place
from tvimdesign.physics.polymers.polymer import fraction_at
from tvimdesign.study import given, read_study, read_study_text

TABLE = table_for("shear")
STEEL_RATE = 6.75e3  # N/m of 21 x 25 x 0.2 mm with three waves, by hand from the makers' formula
G = 9.80665


def advised(row: str, value: float) -> bool:
    """Return whether an advice on a row is followed."""
    (rule,) = TABLE.output(row).advice
    return value >= rule.value if rule.sense == ">=" else value <= rule.value


def test_layers_shrink_and_leave_play_where_nothing_holds_the_rotor():
    values = values_of("freezing_shrinkage freezing_travel", key_count=0)
    # 1040 to 1100 of 1145 kg/m3: 4 to 9 %.
    assert 0.04 < values["freezing_shrinkage"] < 0.092
    assert values["freezing_shrinkage"] == pytest.approx(1.0 - 1070.0 / 1145.0)
    assert values["freezing_travel"] == pytest.approx(70.1e-6, rel=1e-3)
    rows = "axial_play layer_play expansion_travel rotor_bottom_level hub_bottom_level core_temperature@hot"
    bare = values_of(rows, pcl_thickness="0.6 mm", structure_expansion="6e-5 1/K")
    assert bare["axial_play"] == pytest.approx(0.4e-3)  # the running clearance of a print, below the hub
    # 15 mm of PETG and 50 K would be 45 um; plate and hub are nearer to each other, and the core is cooler.
    length, warmer = bare["rotor_bottom_level"] - bare["hub_bottom_level"], bare["core_temperature@hot"] - 295.15
    assert bare["expansion_travel"] == pytest.approx(45e-6 * length / 15e-3 * warmer / 50.0, rel=1e-9)
    assert bare["layer_play"] == pytest.approx((0.4e-3 + bare["expansion_travel"]) / 0.6e-3)
    assert not advised("layer_play", bare["layer_play"])
    for held in ({"axial_preload": "wave_21x25"}, {"bearing": "ball_6802"}):
        clamped = values_of("layer_play expansion_travel", pcl_thickness="0.6 mm", **held)
        assert clamped["layer_play"] == pytest.approx(clamped["expansion_travel"] / 0.6e-3)
        assert advised("layer_play", clamped["layer_play"])


def test_a_held_layer_pulls_on_its_bond_and_one_that_is_followed_does_not():
    rows = "freezing_traction freezing_safety"
    printed, milled = (values_of(rows, process=word, key_count=0) for word in ("print_petg", "machine_6061"))
    # By hand: layer 411 MPa, nu 0.45 -> 1559 MPa over 1 mm; pad 300 MPa over 1.5 mm; k in series. Plates of 4 mm.
    youngs, poisson, share = 2.1e9, 0.37, 4.0 * radians(48.962) / (2.0 * pi)
    rigidity = youngs * 4e-3**3 / (12.0 * (1.0 - poisson**2)) / 2.0 / share
    shear = 5.0 / 6.0 * youngs / (2.0 * (1.0 + poisson)) * 4e-3 / 2.0 / share
    foundation = 1.0 / (1e-3 / 1.5590e9 + 1.5e-3 / 300e6 + 4e-3 / youngs)
    rate = (foundation / (4.0 * rigidity)) ** 0.25
    slack = (foundation / (4.0 * rigidity)) ** 0.25 * (26.0 - 13.4) * 1e-3
    by_hand = foundation * 65.5e-6 * (1.0 + slack)
    by_hand /= 1.0 + slack * (1.0 + foundation / (rate**2 * shear)) + slack**2 + slack**3 / 3.0
    assert printed["freezing_traction"] == pytest.approx(by_hand, rel=0.02)
    assert milled["freezing_traction"] > 2.5 * printed["freezing_traction"]
    assert not advised("freezing_safety", milled["freezing_safety"])
    followed = values_of(rows, process="machine_6061", axial_preload="wave_21x25")
    assert followed["freezing_traction"] < 0.02 * milled["freezing_traction"]
    assert advised("freezing_safety", followed["freezing_safety"])


def test_a_layer_that_shrinks_pulls_until_it_yields_or_has_no_spring():
    thick = {"rotor_thickness": "20 mm", "floor_thickness": "20 mm", "heater_shear_modulus": "1 GPa"}
    stiff = values_of("freezing_traction", process="machine_7075", **thick)
    assert stiff["freezing_traction"] == pytest.approx(16e6)
    rows = "preload_rate frozen_preload molten_preload stop_force_margin preload_spring_mass stop_play"
    assert set(values_of(rows).values()) == {0.0}
    values = values_of("melt_lip_margin melt_lip_hub_gap", melt_lip="rings", pcl_thickness="0.45 mm")
    assert values["melt_lip_margin"] == pytest.approx(-0.05e-3)  # 0.05 mm high
    assert values["melt_lip_hub_gap"] == pytest.approx((26.0 - 1.5 - 13.4 - 0.4) * 1e-3)


def test_the_spring_holds_some_times_the_weight_and_rubs_little():
    rows = ("preload_rate frozen_preload molten_preload stop_force_margin turning_mass preload_friction_torque "
            "spring_stiffness preload_spring_mass preload_spring_stress stop_play")  # fmt: skip
    values = values_of(rows, axial_preload="wave_21x25", key_count=0)
    assert values["preload_rate"] == pytest.approx(STEEL_RATE, rel=0.005)
    assert values["frozen_preload"] == pytest.approx(STEEL_RATE * 0.6e-3, rel=0.005)
    assert values["molten_preload"] == pytest.approx(STEEL_RATE * (0.6e-3 - 70.1e-6), rel=0.005)
    assert values["stop_force_margin"] == pytest.approx(values["molten_preload"] - 2.0 * G * values["turning_mass"])
    assert advised("stop_force_margin", values["stop_force_margin"])
    # At 11.5 mm on the spring and 11.8 mm on the retainer, friction 0.2: two faces rub.
    torque = 0.2 * values["molten_preload"] * (11.5e-3 + 11.75e-3)
    assert values["preload_friction_torque"] == pytest.approx(torque, rel=0.01)
    assert values["preload_spring_mass"] == pytest.approx(pi / 4.0 * (25.0**2 - 21.0**2) * 0.2 * 7.85e-6, rel=1e-6)
    assert values["preload_spring_stress"] < 0.5 * 1500e6  # of spring-steel strip


def test_melt_creeps_by_its_viscosity_along_arcs_and_out_of_edges():
    values = values_of("melt_creep pcl_viscosity@hot", melt_lip="rings")
    # As between flat faces, by hand: h^2 rho g/(12 eta), 1.07 mm high, an hour.
    speed = 1.0701e-3**2 * 1070.0 * G / (12.0 * values["pcl_viscosity@hot"])
    assert values["melt_creep"] == pytest.approx(3600.0 * speed, rel=1e-3)
    assert values["melt_creep"] < 3e-3  # the narrowest web between two pads
    rows = "melt_loss melt_head melt_hold pcl_viscosity@hot"
    bare = values_of(rows)
    # 14 mm of melt stand on the lower edge, nothing holds it: the layer slides at h^2 rho g/(12 eta).
    speed = 1.0701e-3**2 * 1070.0 * G / (12.0 * bare["pcl_viscosity@hot"])
    assert bare["melt_head"] == pytest.approx(1070.0 * G * 14e-3)
    assert bare["melt_loss"] == pytest.approx(3600.0 * speed / 14e-3, rel=1e-3)
    assert not advised("melt_loss", bare["melt_loss"])
    lipped = values_of(rows, melt_lip="rings")
    # 36 mN/m between lip and floor, 0.47 mm apart, hold 153 Pa of the 147.
    assert lipped["melt_hold"] == pytest.approx(2.0 * 0.036 / 0.4701e-3, rel=1e-3)
    assert lipped["melt_loss"] == 0.0
    wide = values_of(rows, melt_lip="rings", pcl_inner_radius="22 mm")
    excess, length = 1070.0 * G * 18e-3 - wide["melt_hold"], 18e-3 + 1.5e-3 * (1.0701 / 0.4701) ** 3
    slow = 1.0701e-3**2 * excess / length / (12.0 * wide["pcl_viscosity@hot"])
    assert wide["melt_loss"] == pytest.approx(3600.0 * slow / 18e-3, rel=1e-3)


def test_the_viscosity_is_that_of_the_record_at_its_temperature():
    # By the record's law at its reference, 100 degC: of 80 kg/mol from 171 Pa s at 35.5, as the molar mass to the 3.94.
    viscosity = 171.0 * (80.0 / 35.5) ** 3.94
    assert values_of("pcl_viscosity@hot")["pcl_viscosity@hot"] == pytest.approx(viscosity, rel=2e-3)
    # 20 K below, by Arrhenius with 35 kJ/mol.
    colder = viscosity * exp(35e3 / 8.314462618 * (1.0 / 353.15 - 1.0 / 373.15))
    at_80 = (
        "mode: shear\noperating_points:\n  cold: {temperature: 30 degC, frequency: 1 Hz}\n"
        "  hot: {temperature: 80 degC, frequency: 1 Hz}\n"
    )
    known = given(read_study_text(at_80, "a test"))
    assert TABLE.evaluate(known, ["pcl_viscosity@hot"])["pcl_viscosity@hot"] == pytest.approx(colder, rel=2e-3)


def test_a_rotor_that_hangs_on_the_melt_draws_it_thicker_in_minutes():
    values = values_of("layer_drawing_time turning_mass pcl_viscosity@hot")
    length = 4.0 * radians(48.962) * 33e-3
    force = G * values["turning_mass"]
    steps, time = 2000, 0.0
    for i in range(steps):  # h' = F h^3/(eta L w^3), by the midpoint rule in thickness
        h = 1e-3 * (1.0 + 0.1 * (i + 0.5) / steps)
        time += (0.1e-3 / steps) * values["pcl_viscosity@hot"] * length * 14e-3**3 / (force * h**3)
    assert values["layer_drawing_time"] == pytest.approx(time, rel=1e-4)
    assert 60.0 < values["layer_drawing_time"] < 600.0


def test_a_derated_bond_loses_by_cycles_and_temperature():
    names = "bond_derating bond_strength layer_holding_torque layer_edge_safety freezing_safety"
    # ln E falls by 0.45 ln(1 + exp((T - 42)/5)) from 23 degC on; the cold point is at 30 degC.
    warm = ((1.0 + exp(-19.0 / 5.0)) / (1.0 + exp(-12.0 / 5.0))) ** 0.45
    new, old, damp, still = (
        values_of(names, **given)
        for given in (
            {}, {"bond_rating": "derated"},
            # Laps of polycarbonate lost 48 % over heat cycles in damp air (Sakai and Nassar).
            {"bond_rating": "derated", "bond_cycle_loss": 0.2}, {"bond_rating": "derated", "bond_cycles": 0},
        )
    )  # fmt: skip
    assert still["bond_derating"] == pytest.approx(warm, rel=1e-9)
    assert new["bond_derating"] == old["bond_derating"] == pytest.approx(warm * 0.95**3, rel=1e-4)
    assert damp["bond_derating"] / warm == pytest.approx(1.0 - 0.48, rel=0.02)
    assert new["bond_strength"] == pytest.approx(2e6)
    for name in names.split()[1:]:
        assert old[name] == pytest.approx(new[name] * old["bond_derating"], rel=1e-9), name


MM = 1e-3
CELLS = 12


def evaluated(*names: str, **module: Any) -> dict[str, Any]:
    """Values of a milled module with lips and some inputs changed (SI, records by name), beside its inputs."""
    milled = {"process": "machine_6061", "melt_lip": "rings", "pcl_thickness": 1.5 * MM, "running_clearance": 0.1 * MM}
    return all_of(names, **{**milled, **module})


def test_a_metal_lip_takes_what_a_cold_wall_takes():
    values = evaluated("cold_end", hot_contact=1e9, rotor_contact=1e9)
    conductivity = 0.5 * (values["pcl_conductivity_solid"] + values["pcl_conductivity_melt"])
    # Slices that fall evenly from a kelvin to none are half a kelvin above it; a cold wall takes 2/pi ln cot(pi f/4).
    wall = -2.0 / pi * np.log(np.tan(0.25 * pi * 0.1 / 1.5))
    given_heat = 0.5 * values["cold_end"].of_layer + values["cold_end"].of_pads
    # Slices keep less than an even fall leaves them, so that they are asked for more by that.
    assert conductivity * wall < given_heat < 1.2 * conductivity * wall


def alike(_: Any) -> tuple[Any, Any]:
    """Return a polymer whose phases conduct alike."""
    return np.ones(CELLS), 1.0


def at_the_edge(excess: float) -> Callable[[Place], float]:
    """Pads an excess above a plate of one temperature."""
    return lambda place: excess if place[0] == "hot" else 0.0


def test_temperature_of_metal_and_plastic_lips():
    metal, plastic = (
        warm_lip(evaluated("lip", structure_conductivity=k)["lip"], np.full(CELLS, 0.5), at_the_edge(1.0), alike)
        for k in (167.0, 0.2)
    )
    assert metal.temperature == pytest.approx(0.0, abs=0.01)
    assert 0.1 < plastic.temperature < 0.45


@cases_of("layer_that_shrinks", "plastic_lips")
def test_a_plastic_lip_takes_what_the_plane_says(study, warm, given_heat):
    inputs = given(read_study(study_path(study)))
    values = TABLE.evaluate(inputs, ["lip", "edge_length", "pcl_melting"])
    names = [("spreader", 0), ("layer", 0), ("face", 0), ("plate", 0), *(("beside", i) for i in range(3)),
             ("around", 7), ("around", 1), ("around", 2)]  # fmt: skip
    at = dict(zip(names, warm, strict=True))
    phases = Conductivities(inputs["pcl_conductivity_solid"], inputs["pcl_conductivity_melt"])
    melting, cells = values["pcl_melting"], np.full(CELLS, at["layer", 0])

    def conducting(wall: float) -> tuple[Any, Any]:
        kelvin, pads, cold = (celsius + 273.15 for celsius in (cells, at["spreader", 0], wall))
        own = phases.mixed(fraction_at(kelvin, melting))
        mean = 0.5 * (phases.solid + phases.melt)
        to_lip = (mean_conductivity(place, own[0], cold, phases, melting) / mean for place in (kelvin, pads))
        return next(to_lip), next(to_lip)

    lip = warm_lip(values["lip"], cells, at.__getitem__, conducting)
    taken = np.sum(lip.from_layer) + lip.from_places["spreader", 0]
    assert taken / values["edge_length"] == pytest.approx(given_heat, rel=0.12)


def test_a_lip_gives_what_it_takes_and_less_from_the_melt():
    values = evaluated("lip", structure_conductivity=0.2)
    at = {("spreader", 0): 90.0, ("face", 0): 60.0, ("plate", 0): 55.0, ("around", 7): 50.0, ("around", 1): 40.0,
          ("around", 2): 30.0, ("beside", 0): 45.0, ("beside", 1): 35.0, ("beside", 2): 25.0}  # fmt: skip
    cells = np.linspace(85.0, 62.0, CELLS)
    lip = warm_lip(values["lip"], cells, at.__getitem__, lambda _: (np.linspace(0.9, 1.1, CELLS), 0.9))
    assert np.sum(lip.from_layer) + sum(lip.from_places.values()) == pytest.approx(0.0, abs=1e-9)
    values = evaluated("lip")["lip"]
    molten, frozen = (
        warm_lip(values, np.full(CELLS, 0.5), at_the_edge(1.0), lambda _, k=k: (np.full(CELLS, k), k))
        for k in (0.9, 1.1)
    )
    assert np.sum(molten.from_layer) / np.sum(frozen.from_layer) == pytest.approx(0.9 / 1.1, rel=0.01)


def test_lips_stand_over_the_floor_and_stiffen_the_plate_s_heat():
    names = ("rotor_beside", "melt_lip_moments", "beside_area")
    lips, bare = (evaluated(*names, melt_lip=kind) for kind in ("rings", "none"))
    more = sum(a.capacity - b.capacity for a, b in zip(lips["rotor_beside"], bare["rotor_beside"], strict=True))
    volumetric = lips["structure_density"] * lips["structure_specific_heat"]
    assert more == pytest.approx(lips["melt_lip_moments"].area * volumetric, rel=0.05)
    deeper = (lips["rotor_thickness"] + 1.4 * MM) / lips["rotor_thickness"]
    second = [values["rotor_beside"][1].conductance for values in (lips, bare)]
    assert 1.0 < second[0] / second[1] < deeper
    values = evaluated("below_lips", "beside_area", "edge_length")
    # Air and, as between 335 and 295 K, radiation of grey faces of 0.9.
    shine = 5.670374419e-8 / (2.0 / 0.9 - 1.0) * (335.0**2 + 295.0**2) * (335.0 + 295.0)
    more = (values["air_conductivity"] / (0.1 * MM) + shine) * values["edge_length"]
    assert 0.9 * values["rotor_rim"] < sum(values["below_lips"]) / more < 1.005 * values["rotor_rim"]
    widths = np.array(STRIP) * values["beside_area"] / values["edge_length"]
    assert np.all(np.array(values["below_lips"]) / more < widths)
    values = evaluated("cold_end", "below_lips", melt_lip="none")
    assert values["cold_end"] is None
    assert sum(values["below_lips"]) == 0.0


@pytest.mark.parametrize("thickness", [0.05, 0.3, 0.4, 0.45])
def test_a_lip_that_has_no_room_has_finite_numbers_and_a_rule_that_says_so(thickness):
    values = evaluated("cold_end", "melt_lip_margin", pcl_thickness=thickness * MM, running_clearance=0.4 * MM)
    assert values["melt_lip_margin"] < 0.0
    assert all(np.isfinite(value) for value in values["cold_end"])
    assert values["cold_end"].near > 0.0


def test_a_stack_s_layer_gives_to_its_lip_as_its_phase_conducts():
    values = evaluated("stack")
    stack = values["stack"]
    for celsius, phase in ((90.0, "melt"), (40.0, "solid")):
        state = heat.initial_state(stack, CELLS, celsius + 273.15)
        edge = 2 + CELLS + stack.plate_cells
        state[edge] -= 0.05
        now = heat.profile(state, stack)
        mean = 0.5 * (values["pcl_conductivity_solid"] + values["pcl_conductivity_melt"])
        excess = celsius + 273.15 - now.lip.temperature
        assert excess > 1.0
        given_heat = stack.lip.slices * values[f"pcl_conductivity_{phase}"] / mean * excess
        assert np.sum(now.lip.from_layer) == pytest.approx(given_heat, rel=2e-3)
