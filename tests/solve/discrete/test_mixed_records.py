"""Records mixed and records chosen whole."""

import numpy as np
import pytest
from choosing import listed, with_each_record
from support import sample_text

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.discrete.combinations import MAX_MIXED, refuse_too_many
from tvimdesign.solve.discrete.discrete_choices import Sizes
from tvimdesign.solve.discrete.record_families import families_of
from tvimdesign.solve.nlp.mixture import MixedDevice, Mixture, discrete_records, with_records
from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.search import optimize
from tvimdesign.study import Study, given, read_study, read_study_text

SHEAR = sample_text("mixed_shear")
COMPRESSION = sample_text("mixed_compression")


def _as_enumerated(study: Study, solution: Solution) -> None:
    """Compare the best combinations with each solved alone, cold, from as many starts as the search has."""
    choosing = solution.choosing
    alone = sorted(with_each_record(study, solution.reference, study.solver.starts).items(), key=lambda item: item[1])
    assert solution.status == "optimal"
    assert len(solution.free_starts) >= study.solver.starts
    assert [listed.objective for listed in choosing.best] == pytest.approx([value for _, value in alone[:3]], rel=1e-6)
    known = dict(alone)
    for candidate in choosing.best:
        key = tuple(candidate.choices.values())
        assert known[min(known, key=lambda other: _apart(other, key))] == pytest.approx(candidate.objective, rel=1e-6)
    assert choosing.bound <= choosing.best[0].objective * (1.0 + 1e-6)
    assert choosing.solved + choosing.pruned + choosing.without_design == choosing.combinations
    assert choosing.solved + choosing.pruned >= len(alone)
    assert choosing.work.warm + choosing.work.cold < len(alone)


def _apart(first: tuple[str | float, ...], other: tuple[str | float, ...]) -> float:
    """Return how far two combinations are apart: words that differ, and what the numbers differ by."""
    return sum(
        float(a != b) if isinstance(a, str) or isinstance(b, str) else abs(a - b)
        for a, b in zip(first, other, strict=True)
    )


@pytest.mark.slow
@pytest.mark.parametrize("text", [SHEAR, COMPRESSION], ids=["shear", "compression"])
def test_the_best_three_are_those_of_enumeration(text):
    study = listed(text)
    _as_enumerated(study, optimize(study))


HEATER = sample_text("mixed_heater")


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_so_they_are_on_random_shelves(tmp_path, seed):
    draw = np.random.default_rng(seed)
    folder = tmp_path / "records" / "heaters"
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


def test_records_of_one_structure_are_one_family(study):
    (family,) = families_of(study)
    assert [mixture.name for mixture in family.mixtures] == ["heater_module", "process", "spring_material"]
    assert family.count == len(discrete_records(study, study.table)) == 12
    # What is read of a steel beside its numbers is a table of strengths, which come to a number.
    assert set(family.mixtures[2].read_by) == {"spring_tensile_strength", "wire_range_margin"}


def test_records_of_another_structure_are_another_family():
    """Rigid modules lie below a spreader, sheets have none."""
    text = SHEAR.replace("[flexible_1600, silicone_9ar_08_24v, polyimide_foil_24v]",
                         "[flexible_1600, cp30138, tm_31_14_85, silicone_9ar_08_24v]")  # fmt: skip
    sheets, rigid = families_of(listed(text))
    names = [record["heater_module"] for record in sheets.mixtures[0].records]
    assert names == ["flexible_1600", "silicone_9ar_08_24v"]
    assert [record["heater_module"] for record in rigid.mixtures[0].records] == ["cp30138", "tm_31_14_85"]
    assert sheets.count == rigid.count == 8


def test_at_a_corner_a_mixture_is_the_device_of_its_records(study):
    # Every output without a cycle, for each record of each mixture alone.
    family = families_of(study)[0]
    points = tuple(study.operating_points)
    mixed = MixedDevice(study.table, given(with_records(study, family.records)), points, 6, family.mixtures)
    cycle = dict.fromkeys(mixed.switch_names, 1.0)
    for mixture in family.mixtures:
        for place, records in enumerate(mixture.records):
            chosen = with_records(study, {**family.records, **records})
            plain = DeviceFunctions(study.table, given(chosen), points, 6)
            inputs = mixed.start.copy()
            for other, name in enumerate(mixture.shares):
                inputs[mixed.index[name]] = float(other == place)
            expected, values = plain.values(plain.start, cycle), mixed.values(mixed.mixed(inputs), cycle)
            assert values == pytest.approx(expected, rel=1e-12, nan_ok=True)


MIXTURE = Mixture(({"a": "x"}, {"a": "y"}, {"a": "z"}), {"n": (1.0, 3.0, 9.0)}, ({}, {}, {}), ())


def test_a_box_of_records_leaves_the_others_no_share():
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
def test_a_mixed_design_lies_beside_the_record_it_has_most_of(shares, place):
    sizes = Sizes((), ()).mixed([MIXTURE])
    values = sizes.values(dict(zip(MIXTURE.shares, shares, strict=True)))
    assert values["a"] == pytest.approx(place, abs=2e-4)
    assert sizes.are_sizes(values, sizes.whole) == (max(shares) > 0.999)


def test_too_many_records_in_one_problem_are_refused_with_what_to_do(study):
    records = tuple({"a": str(i)} for i in range(MAX_MIXED + 1))
    family = families_of(study)[0]
    crowded = type(family)({}, (Mixture(records, {}, tuple({} for _ in records), ()),))
    with pytest.raises(InputError, match=f"{MAX_MIXED + 1} records to choose from; the limit is {MAX_MIXED}"):
        refuse_too_many([crowded], Sizes((), ()))


MODULES = ("cp30138", "qc_17", "ma10_063_05_1")
STUDY = sample_text("whole_records")


def solved(chosen: str, listed: str) -> Solution:
    text = STUDY.replace("  CHOSEN\n", f"  {chosen}\n" if chosen else "").replace("  LISTED\n", listed)
    return optimize(read_study_text(text, "a test"), lambda _: None)


@pytest.mark.slow
def test_the_best_module_of_a_list_is_the_best_of_each_alone():
    best = solved("", f"  heater_module: {{choose: [{', '.join(MODULES)}]}}\n")
    alone = {name: solved(f"heater_module: {name}", "") for name in MODULES}
    masses = {name: solution.values["module_mass"] for name, solution in alone.items() if solution.feasible}
    assert len(masses) == 3
    lightest = min(masses, key=masses.__getitem__)
    assert best.feasible
    assert best.values["module_mass"] == pytest.approx(masses[lightest], rel=1e-5)
    assert best.values["heater_count"] == alone[lightest].values["heater_count"]


# Springs of the paper's size, as a maker might list them: d, D, coils.
SPRINGS = {"soft": (2.3, 24.0, 4.25), "middle": (2.4, 24.0, 3.25), "strong": (2.6, 26.0, 3.25)}
SPRING_STUDY = sample_text("whole_springs")


def _record(wire: float, coil: float, count: float) -> str:
    sizes = {
        "wire_diameter": (wire, "mm"), "outer_diameter": (coil + wire, "mm"), "coil_diameter": (coil, "mm"),
        "coil_count": (count, '"1"'), "leg_length": (60, "mm"), "largest_torque": (3000, "mN*m"),
        "deflection": (30, "deg"),
    }  # fmt: skip
    lines = [f'  {name}: {{value: {value}, unit: {unit}, status: measured, source: "a test"}}'
             for name, (value, unit) in sizes.items()]  # fmt: skip
    words = "words: {spring_material: music_wire, hands: both, number: own}"
    return "\n".join(["title: A spring of the shelf", "values:", *lines, words])


@pytest.mark.slow
def test_the_best_stock_spring_of_a_list_is_the_best_of_each_alone(tmp_path):
    folder = tmp_path / "records" / "torsion_springs"
    folder.mkdir(parents=True)
    for name, sizes in SPRINGS.items():
        (folder / f"{name}.yaml").write_text(_record(*sizes), encoding="utf-8")

    def solved(chosen: str, listed: str) -> Solution:
        path = tmp_path / "study.yaml"
        path.write_text(SPRING_STUDY.replace("CHOSEN", chosen).replace("  LISTED\n", listed), encoding="utf-8")
        return optimize(read_study(path))

    best = solved("", f"  stock_spring: {{choose: [{', '.join(SPRINGS)}]}}\n")
    alone = {name: solved(f"module: {{stock_spring: {name}}}", "") for name in SPRINGS}
    # Objectives are over each study's own start; that of the study that lists all is the common measure.
    objectives = {
        name: sum(solution.values[weighed] / best.reference[weighed] for weighed in best.reference)
        for name, solution in alone.items() if solution.feasible
    }  # fmt: skip
    assert len(objectives) >= 2
    name = min(objectives, key=objectives.__getitem__)
    assert best.objective == pytest.approx(objectives[name], rel=1e-5)
    numbers = dict(zip(best.model.names, best.inputs, strict=True))
    listed_spring = (1e3 * numbers["wire_diameter"], 1e3 * numbers["coil_diameter"], numbers["coil_count"])
    assert listed_spring == pytest.approx(SPRINGS[name])
