"""Records in one mixed problem: as each alone at its corners, as enumeration, and started at other records' optimum."""

from pathlib import Path

import numpy as np
import pytest
from choosing import listed, with_each_record

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.discrete.discrete_choices import Sizes
from tvimdesign.solve.discrete.record_families import families_of
from tvimdesign.solve.discrete.trees import MAX_MIXED, refuse_too_many
from tvimdesign.solve.nlp.mixture import MixedDevice, Mixture, discrete_records, with_records
from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.search import optimize
from tvimdesign.study import Study, given, read_study

SHEAR = """
mode: shear
vary:
  peltier_module: {choose: [flexible_1600, silicone_9ar_08_24v, polyimide_foil_24v]}
  process: {choose: [print_pei_1010, print_pc]}
  spring_material: {choose: [music_wire, stainless_302]}
  wire_diameter: {catalog: metric, from: 2.4 mm, to: 2.6 mm}
  arc_count: {choose: [3, 4]}
  coil_count: [3, 5]
  coil_diameter: [12 mm, 30 mm]
  pcl_outer_radius: [32 mm, 40 mm]
  pcl_thickness: [0.6 mm, 2 mm]
  current: [0.1 A, 2 A]
require:
  spring_stiffness: ">= 5 N.m/rad"
  spring_fatigue_safety: ">= 1.2"
  peak_voltage: "<= 24 V"
  layer_holding_torque: ">= 40 N.m"
accept: [peltier_temperature_margin, structure_temperature_margin, stiffening_structure_margin, current_margin]
minimize: {envelope_volume: 1, module_mass: 1, response_time: 1}
solver: {starts: 2, cells: 6, fineness: 0.67, max_iterations: 100, alternatives: 3}
"""
COMPRESSION = """
mode: compression
module: {response_criterion: mean, core_radius: 8 mm, link_dowel: iso_8734_2, rotor_rim: 8 mm, pcl_inner_radius: 13 mm,
         block_height: 11 mm}
vary:
  peltier_module: {choose: [flexible_1600, silicone_9ar_08_24v, silicone_9ar_08_12v]}
  process: {choose: [print_petg, print_pc]}
  spring_material: {choose: [music_wire, stainless_302]}
  wire_diameter: {catalog: metric, from: 2.4 mm, to: 2.6 mm}
  vane_count: {from: 5, to: 6}
  coil_count: [3, 5]
  coil_diameter: [10 mm, 16 mm]
  pcl_outer_radius: [18 mm, 30 mm]
  block_height: [4 mm, 14 mm]
  block_depth: [2 mm, 8 mm]
  vane_thickness: [2 mm, 6 mm]
  current: [0.1 A, 2.5 A]
require:
  spring_stiffness: ">= 5 N.m/rad"
  holding_torque: ">= 5 N.m"
  peak_voltage: "<= 24 V"
accept: [peltier_temperature_margin, structure_temperature_margin, stiffening_structure_margin, current_margin]
minimize: {envelope_volume: 1, module_mass: 1, response_time: 1}
solver: {starts: 2, cells: 6, fineness: 0.67, max_iterations: 100, alternatives: 3}
"""


def _as_enumerated(study: Study, solution: Solution) -> None:
    """Compare the best combinations with each solved alone, cold, from as many starts as the search has."""
    choosing = solution.choosing
    alone = sorted(with_each_record(study, solution.reference, study.solver.starts).items(), key=lambda one: one[1])
    assert solution.status == "optimal"
    assert len(solution.free_starts) >= study.solver.starts
    assert [one.objective for one in choosing.best] == pytest.approx([value for _, value in alone[:3]], rel=1e-6)
    known = dict(alone)
    for one in choosing.best:
        key = tuple(one.choices.values())
        assert known[min(known, key=lambda other: _apart(other, key))] == pytest.approx(one.objective, rel=1e-6)
    assert choosing.bound <= choosing.best[0].objective * (1.0 + 1e-6)
    assert choosing.solved + choosing.pruned + choosing.without_design == choosing.combinations
    assert choosing.solved + choosing.pruned >= len(alone)
    assert choosing.work.warm + choosing.work.cold < len(alone)


def _apart(one: tuple[str | float, ...], other: tuple[str | float, ...]) -> float:
    """Return how far two combinations are apart: words that differ, and what the numbers differ by."""
    return sum(
        float(a != b) if isinstance(a, str) or isinstance(b, str) else abs(a - b)
        for a, b in zip(one, other, strict=True)
    )


@pytest.mark.slow
@pytest.mark.parametrize("text", [SHEAR, COMPRESSION], ids=["shear", "compression"])
def test_the_best_three_are_those_of_enumeration(text: str) -> None:
    study = listed(text)
    _as_enumerated(study, optimize(study))


HEATER = """title: A foil heater of a random shelf
based_on: {base}
values:
  resistance: {{value: {resistance}, unit: ohm, status: measured, source: "a test"}}
  thickness: {{value: {thickness}, unit: mm, status: measured, source: "a test"}}
  max_temperature: {{value: {hottest}, unit: degC, status: measured, source: "a test"}}
  max_current: {{value: {most}, unit: A, status: measured, source: "a test"}}
"""


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_so_they_are_on_random_shelves(tmp_path: Path, seed: int) -> None:
    draw = np.random.default_rng(seed)
    folder = tmp_path / "records" / "peltiers"
    folder.mkdir(parents=True)
    for place in range(3):
        text = HEATER.format(
            base="silicone_9ar_08_24v", resistance=draw.uniform(8.0, 60.0), thickness=draw.uniform(0.5, 2.5),
            hottest=draw.uniform(110.0, 200.0), most=draw.uniform(0.4, 2.0),
        )  # fmt: skip
        (folder / f"shelf_{place}.yaml").write_text(text, encoding="utf-8")
    names = ", ".join(f"shelf_{place}" for place in range(3))
    text = SHEAR.replace("flexible_1600, silicone_9ar_08_24v, polyimide_foil_24v", names)
    path = tmp_path / "study.yaml"
    path.write_text(text.replace("mode: shear", "mode: shear\ncatalog: records"), encoding="utf-8")
    study = read_study(path)
    _as_enumerated(study, optimize(study))


@pytest.fixture(scope="module")
def study() -> Study:
    return listed(SHEAR)


def test_records_of_one_structure_are_one_family(study: Study) -> None:
    (family,) = families_of(study)
    assert [mixture.name for mixture in family.mixtures] == ["peltier_module", "process", "spring_material"]
    assert family.count == len(discrete_records(study, study.table)) == 12
    # What is read of a steel beside its numbers is a table of strengths, which come to a number.
    assert set(family.mixtures[2].read_by) == {"spring_tensile_strength", "wire_range_margin"}


def test_records_of_another_structure_are_another_family() -> None:
    """Rigid modules lie below a spreader, sheets have none."""
    text = SHEAR.replace("[flexible_1600, silicone_9ar_08_24v, polyimide_foil_24v]",
                         "[flexible_1600, cp30138, tm_31_14_85, silicone_9ar_08_24v]")  # fmt: skip
    sheets, rigid = families_of(listed(text))
    assert [one["peltier_module"] for one in sheets.mixtures[0].records] == ["flexible_1600", "silicone_9ar_08_24v"]
    assert [one["peltier_module"] for one in rigid.mixtures[0].records] == ["cp30138", "tm_31_14_85"]
    assert sheets.count == rigid.count == 8


def test_at_a_corner_a_mixture_is_the_device_of_its_records(study: Study) -> None:
    # Every output without a cycle, for each record of each mixture alone.
    family = families_of(study)[0]
    points = tuple(study.operating_points)
    mixed = MixedDevice(study.table, given(with_records(study, family.records)), points, 6, family.mixtures)
    cycle = dict.fromkeys(mixed.switch_names, 1.0)
    for mixture in family.mixtures:
        for place, records in enumerate(mixture.records):
            asked = with_records(study, {**family.records, **records})
            plain = DeviceFunctions(study.table, given(asked), points, 6)
            inputs = mixed.start.copy()
            for other, name in enumerate(mixture.shares):
                inputs[mixed.index[name]] = float(other == place)
            expected, found = plain.values(plain.start, cycle), mixed.values(mixed.mixed(inputs), cycle)
            assert found == pytest.approx(expected, rel=1e-12, nan_ok=True)


MIXTURE = Mixture(({"a": "x"}, {"a": "y"}, {"a": "z"}), {"n": (1.0, 3.0, 9.0)}, ({}, {}, {}), ())


def test_a_box_of_records_leaves_the_others_no_share() -> None:
    sizes = Sizes(("d",), ((2.0, 3.0),)).mixed([MIXTURE])
    assert sizes.count == 6
    ends = sizes.ends(((0, 1), (0, 1)))
    assert ends == {"d": (2.0, 3.0), "share of x": (0.0, 1.0), "share of y": (0.0, 1.0), "share of z": (0.0, 0.0)}
    assert sizes.ends(((0, 0), (2, 2)))["share of z"] == (1.0, 1.0)
    assert sizes.records(((0, 0), (1, 1))) == {"a": "y"}


@pytest.mark.parametrize(
    ("shares", "place"),
    [((1.0, 0.0, 0.0), 1.0), ((0.0, 0.9999, 0.0001), 2.0), ((0.3, 0.6, 0.1), 1.6), ((0.0, 0.8, 0.2), 2.2),
     ((0.4, 0.2, 0.4), 1.45)],
)  # fmt: skip
def test_a_mixed_design_lies_beside_the_record_it_has_most_of(shares: tuple[float, ...], place: float) -> None:
    sizes = Sizes((), ()).mixed([MIXTURE])
    values = sizes.values(dict(zip(MIXTURE.shares, shares, strict=True)))
    assert values["a"] == pytest.approx(place, abs=2e-4)
    assert sizes.are_sizes(values, sizes.whole) == (max(shares) > 0.999)


def test_too_many_records_in_one_problem_are_refused_with_what_to_do(study: Study) -> None:
    records = tuple({"a": str(i)} for i in range(MAX_MIXED + 1))
    family = families_of(study)[0]
    crowded = type(family)({}, (Mixture(records, {}, tuple({} for _ in records), ()),))
    with pytest.raises(InputError, match=f"{MAX_MIXED + 1} records to choose from; the limit is {MAX_MIXED}"):
        refuse_too_many([crowded], Sizes((), ()))
