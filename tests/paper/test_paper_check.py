"""The paper check computes what it prints, from the paper's tables; the pair calibrated to 70 and 140 s takes them."""

import json
import math
from functools import cache

import numpy as np
import pytest

from tvimdesign.catalog import Catalog
from tvimdesign.paper import paper_case, paper_check
from tvimdesign.paper.paper_case import claims, published_values
from tvimdesign.paper.paper_check import findings
from tvimdesign.study import given, read_study_text

computed = cache(paper_check.computed)


def record(name: str) -> float:
    return Catalog().record("polymers", "pcl_80k").value(name)


def solid_modulus(celsius: float) -> float:
    """G of the frozen layer [Pa] from the record's own formula, written here again; its spectrum has it at 1 Hz."""
    slope, width = record("softening_slope"), record("softening_width")
    onset, reference = (record(name) - 273.15 for name in ("softening_onset", "reference_temperature"))
    fall = [slope * width * math.log(1.0 + math.exp((t - onset) / width)) for t in (reference, celsius)]
    return record("flexural_modulus") * math.exp(fall[0] - fall[1]) / (2.0 * (1.0 + record("poissons_ratio")))


RATE = 210e9 * 2.413e-3**4 / (64 * 24.4094e-3 * 3.25)
MOMENT = 4 * math.radians(48.962) / 4 * (40e-3**4 - 26e-3**4)


@pytest.mark.gate
@pytest.mark.parametrize(
    ("row", "numbers"),
    [
        # Worked by hand from the paper's table, or from its text.
        ("torsion_rate", ["1.4023", "12.41", "8.91", "4.17"]),
        ("output_stiffness", ["5.61", "N·m·rad"]),
        ("inertia", ["18.5", "4.156e-04"]),
        ("motion", ["0.0966"]),
        ("creep", ["200", "600"]),
        ("area", ["1579.2", "416%"]),
        ("response", ["far face", "70 s at"]),
        ("ratio", ["28.5", "5.61", "22.4"]),
        # Shigley, table 10-5: 196.5 GPa for 0.063 to 0.125 in.
        ("modulus", ["196.5", f"{RATE * 196.5 / 210:.4f}", f"{4 * RATE * 196.5 / 210:.2f}", "6.4%", "193 to 203.4"]),
        ("inch_sizes", ["0.0950 in", "0.9610 in", "1.056 in", "0.095 in", "12.41 in·lbf/rad"]),
        # 2211 MPa/2.413^0.145 by Shigley, table 10-4; K_bi = 1.077 of an index of 10.1.
        ("implied", ["50.0 N·m/rad", f"{math.sqrt(50 / 4.156e-4) / 2 / math.pi:.1f} Hz", "1946 MPa", "1957 MPa"]),
        ("pretension", [f"{2 * RATE:.2f}", "0.104", "4.53"]),  # 4.53: an independent geometry of legs on their pins
        ("symbols", ["38 mm", "2.00", "22.4", f"{4 * RATE / 4:.2f}", "16"]),
        ("frequency", [f"{628 / 2 / math.pi:.2f} Hz"]),
        ("case", ["70.0 s in shear", "140.0 s in compression"]),
    ],
)
def test_a_row_gives_the_numbers_of_the_paper_s_own_formulas(row, numbers):
    text = computed(row)
    for number in numbers:
        assert number in text, text


@pytest.mark.parametrize("angle", [0.1, 0.104, 0.2])
def test_each_of_the_three_angles_has_its_torque_strain_and_ratio(angle):
    # A pin at half the radius: the spring turns by atan2(p sin f, r - p cos f); its slope by differences.
    def turned(f: float) -> float:
        return math.atan2(0.5 * math.sin(f), 1.0 - 0.5 * math.cos(f))

    ratio = (turned(angle + 1e-6) - turned(angle - 1e-6)) / 2e-6
    expected = f"{angle:g} rad: {4 * RATE * angle:.2f} N·m, melt sheared by {40 * angle:.0%}, ratio {ratio:.3f}"
    assert expected in computed("angles")


def test_a_solid_layer_is_stiffer_by_four_orders_and_breaks_in_a_release():
    stiffness = solid_modulus(30.0) * MOMENT / 1e-3
    text = computed("parallel_springs")
    assert f"{stiffness:.3g} N·m/rad" in text
    times = float(text.split("N·m/rad, ")[1].split(" times")[0].replace(",", ""))
    assert times == pytest.approx(stiffness / (4 * RATE), rel=1e-3)
    text, stiffness = computed("release"), published_values()["joint_stiffness@cold"]
    assert text.startswith(f"{0.1 * stiffness:.0f} N·m")
    assert "400% of strain" in text  # 40 mm times 0.1 rad over 1 mm
    assert f"yields at {record('tensile_yield') / math.sqrt(3) / solid_modulus(30.0):.1%}" in text


def test_ten_percent_is_a_strain_that_a_solid_and_a_rheometer_do_not_bear():
    stress = 0.1 * solid_modulus(30.0)
    text = computed("strain_as_rate")
    assert float(text.split("30 °C ")[1].split(" MPa")[0]) * 1e6 == pytest.approx(stress, rel=5e-3)
    assert f"{record('tensile_yield') / math.sqrt(3) / 1e6:.1f} MPa" in text
    assert f"{math.pi * 12.5e-3**3 / 2 * stress:.0f} N·m between" in text
    assert "125 mN·m (100 to 230, assumed)" in text
    assert "3000% after 300 s" in text
    assert f"{0.1 * record('zero_shear_viscosity'):.0f} Pa in the melt" in text


def test_what_the_rheometer_cannot_resolve():
    # Far below its relaxation rates a melt is Newtonian: |G*| = eta omega.
    torque = math.pi * 12.5e-3**3 / 2 * record("zero_shear_viscosity") * 0.1 * 1e-4
    text = computed("small_strain")
    assert float(text.split("answers with ")[1].split(" µN·m")[0]) * 1e-6 == pytest.approx(torque, rel=0.02)
    assert "8 µrad" in text  # 0.01 % of 1 mm over 12.5 mm
    assert torque < paper_case.instrument("least_torque").value
    first = float(text.split("from about ")[1].split(" rad/s")[0])
    assert 1.0 < first * torque / 0.1 / 1e-6 < 1.5  # a Newtonian liquid would reach it a little sooner
    # The torque of a stress at the rim, linear to the axis: pi R^3/2 tau.
    text = computed("loss_modulus")
    assert f"{math.pi * 0.0125**3 / 2 * 0.1 * 1e-4 * 1e12:.2g} pN·m" in text
    frequencies = [0.1 * 6280 ** (k / 19) for k in range(20)]
    minutes = sum(2 * math.pi / frequency for frequency in frequencies) / 60
    assert f"20 points of one period each {minutes:.1f} min" in computed("sweep_time")


def test_a_solid_specimen_is_stiffer_than_any_rheometer_assumed():
    specimen = math.pi * 12.5e-3**4 * solid_modulus(30.0) / 2e-3
    text = computed("stiff_specimen")
    assert float(text.split("spring of ")[1].split(" N·m/rad")[0]) == pytest.approx(specimen, rel=5e-3)
    frame = paper_case.instrument("torsional_stiffness")
    assert specimen > 5.0 * frame.high
    read = [float(part) / 100 for part in text.split("uncorrected, ")[1].replace("(", "").split("%")[0].split()]
    assert read[0] == pytest.approx(1 / (1 + specimen / frame.value), abs=1e-3)


def test_sixty_degrees_lie_inside_the_melting_range():
    # The enthalpy of a third of the window is left: fraction (end - T)/(end - start) but for the sensible heats.
    start, end = (record(name) - 273.15 for name in ("melting_start", "melting_end"))
    assert start < 60.0 < end
    text = computed("premelt")
    solid = float(text.split("at 60 °C ")[1].split("%")[0]) / 100
    assert solid == pytest.approx((end - 60.0) / (end - start), abs=0.02)
    assert f"{record('equilibrium_melting_temperature') - 273.15:.0f} °C" in text


def test_the_housing_is_hotter_than_its_material_may_be():
    text, service = computed("housing"), Catalog().record("structure_materials", "petg").value("service_temperature")
    rotor = published_values()["peak_rotor_temperature"]
    assert f"{service - 273.15:.0f} °C in continuous service" in text
    assert f"{rotor - service:.0f} K above" in text
    assert rotor > service + 15.0  # above the glass transition, 75 degC and more


def test_one_sensor_measures_a_frozen_and_a_soft_release_badly():
    text, values = computed("torque_sensor"), published_values()
    frozen, springs = 0.1 * values["joint_stiffness@cold"], 0.1 * values["spring_stiffness"]
    assert f"{frozen:.0f} N·m frozen, for {springs:.2f} N·m" in text
    assert f"off by {0.2 * frozen / springs:.0f} % " in text


def test_a_module_shrunk_to_a_finger_s_width_loses_the_cube_of_its_torque():
    text, values = computed("small_joint"), published_values()
    factor = 0.045 / values["envelope_diameter"]
    assert f"every length times {factor:.2f} makes it 45 mm wide" in text
    held, springs = (float(part.split(" N·m")[0]) for part in (text.split("wide: ")[1], text.split("frozen, ")[1]))
    assert held == pytest.approx(factor**3 * values["holding_torque"], rel=0.03)
    assert springs == pytest.approx(factor**3 * values["spring_stiffness"], rel=0.03)
    assert "vary by 0.25 mm; violated: cutout ground gap" in text


def test_every_claim_has_place_computation_verdict_and_json(capsys):
    rows = findings()
    assert len(rows) == len(claims()["rows"]) == len(claims()["rows"])
    assert all(row["claim"] and row["where"] and row["computed"] and row["verdict"] for row in rows)
    assert len({row["row"] for row in claims()["rows"]}) == len(rows)
    paper_check.print_paper_check(as_json=True)
    assert len(json.loads(capsys.readouterr().out)) == len(claims()["rows"])


def test_what_is_assumed_of_the_instrument_has_a_range_and_a_reason():
    for name in claims()["instrument"]:
        value = paper_case.instrument(name)
        assert value.low < value.value < value.high
        assert value.source.startswith("assumed: ") == (value.status == "assumed")


def test_the_numbers_follow_the_stated_inputs(monkeypatch):
    thicker = {**claims(), "numbers": {**claims()["numbers"], "wire_diameter": {"value": 4.826, "unit": "mm"}}}
    monkeypatch.setattr(paper_case, "claims", lambda: thicker)
    rate = float(paper_check.computed("torsion_rate").split("= ")[1].split()[0])
    assert rate == pytest.approx(16 * RATE, rel=1e-4)
    narrower = {**claims(), "numbers": {**claims()["numbers"], "plate_diameter": {"value": 8, "unit": "mm"}}}
    monkeypatch.setattr(paper_case, "claims", lambda: narrower)
    specimen = float(paper_check.computed("stiff_specimen").split("spring of ")[1].split()[0])
    assert specimen == pytest.approx(np.pi * 4e-3**4 * solid_modulus(30.0) / 2e-3, rel=0.01)


STATED = (70.0, 140.0)  # the paper, Discussion
OF_ONE_MODE = {"coil_diameter", "coil_count", "pcl_inner_radius", "pcl_outer_radius", "rotor_rim"}
"""Inputs of both modes that belong to the geometry of one: room for its PCL, and for springs beside that."""


def test_the_pair_takes_the_paper_s_times():
    assert [times["mean_time"] for times in paper_case.pair_times()] == pytest.approx(STATED, rel=0.01)


def test_both_modules_differ_by_geometry_alone():
    shear, compression = (given(read_study_text(text)) for text in paper_case.case()["studies"].values())
    different = {name for name in shear.keys() & compression.keys() if shear[name] != compression[name]}
    assert different == OF_ONE_MODE


def test_the_ratio_can_turn_round():
    metal = paper_case.pair_times(structure_material=paper_case.case()["material"])
    # A metal rotor takes the shear layer's heat, and hardly the blocks'.
    assert metal[1]["mean_time"] < metal[0]["mean_time"]
    near, far = ([times[f"{place}_face_time"] for times in paper_case.pair_times()] for place in ("near", "far"))
    assert near[1] < 1.1 * near[0]  # heat that has just entered does not know how deep the PCL is
    assert far[1] > 2.0 * far[0]
