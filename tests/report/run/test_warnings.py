"""Every warning has a line of a study that mends it; yield and assumptions of a first screen."""

import json
import re
from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import yaml
from comparable import COARSE, COMPRESSION, SHEAR
from stiff_when_warm import LOSSLESS
from support import study_path

from tvimdesign.base.deadline import NEVER
from tvimdesign.base.errors import TvimError
from tvimdesign.base.units import parse_quantity
from tvimdesign.device import table_for
from tvimdesign.report.output.numbers import label
from tvimdesign.report.run.blocks.warnings import (
    RunWarning,
    advice_text,
    filled,
    frozen_turn,
    hints,
    lines_of,
    missed_points,
    warnings_of,
)
from tvimdesign.report.run.first_screen import warning_lines
from tvimdesign.report.run.uncertainty_data import uncertainty_data
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule, resolve_design
from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.remedies import Bound, Remedies, _changes
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.solve.uncertainty.design_uncertainty import DesignUncertainty, UncertaintyModel
from tvimdesign.solve.uncertainty.tolerance import Tolerancing
from tvimdesign.study import drawn, read_study, read_study_text, standard_tolerances

ROWS = {row.name: (mode, row) for mode in ("compression", "shear") for row in table_for(mode).outputs}
ADVICE = {name: mode for name, (mode, row) in ROWS.items() if row.advice}
RATINGS = {name: mode for name, (mode, row) in ROWS.items() if row.ratings}
PLACES = {"point": "hot", "hot": "80 degC", "stiffness": "90"}
OTHERS = {kind: entry["mend"] for kind, entry in hints()["others"].items()}


def test_every_advice_has_a_cure_and_what_has_no_place_is_counted():
    assert hints()["advice"].keys() == ADVICE.keys()
    assert hints()["ratings"].keys() == RATINGS.keys()
    entries = [entry for kind in ("advice", "ratings") for entry in hints()[kind].values()]
    assert all(entry["mend"] or "ask" in entry for entry in entries)
    # The switch of a milled module is another one, and its mass several times that of a print.
    assert not any("machine" in line for entry in entries for line in entry["mend"])
    warnings = [RunWarning(f"warning {i} of something", "write module: {cover: plate}") for i in range(5)]
    lines = warning_lines(warnings, 80, 2)
    assert lines[0] == "Warning: warning 0 of something; write module: {cover: plate}"
    assert lines[2].strip() == "3 more: summary.txt"
    assert warning_lines(warnings, 80, 5)[-1] == "Warning: warning 4 of something; write module: {cover: plate}"


@pytest.mark.parametrize(
    ("mode", "line"),
    [
        (mode, line)
        for kind, of in (("advice", ADVICE), ("ratings", RATINGS))
        for name, mode in of.items()
        for line in hints()[kind][name]["mend"]
    ]
    + [("shear", f"accept: [{', '.join(RATINGS)}]")]
    + [("shear", line) for line in OTHERS.values()],
)
def test_what_is_to_be_written_is_read_without_a_complaint(tmp_path, mode, line):
    entry = yaml.safe_load(filled(line, PLACES))
    assert len(entry) == 1
    assert "<" not in filled(line, PLACES).replace('"<=', "")
    if "catalog" in entry:
        (tmp_path / "my_records").mkdir()
    others = {"mode": mode, **({"minimize": "module_mass"} if "vary" in entry else {})}
    (tmp_path / "study.yaml").write_text(yaml.safe_dump({**others, **entry}, sort_keys=False))
    read_study(tmp_path / "study.yaml")


@cache
def _published(extra: str = "") -> StudyResult:
    """Answer the published module, without what its study accepts."""
    text = re.sub(r"^accept:.*?\n\n", "", study_path("paper_reconstructed").read_text(), flags=re.M | re.S)
    study = read_study_text(text.replace("module:\n", f"module:\n{extra}", 1), "a test")
    return answer(study)


def _proposed() -> dict[str, str]:
    """Return the line for each warning of the published module."""
    result = _published()
    remedies = Remedies(result, NEVER)
    return {check.output: remedies.of(check.output, lines_of(check.output, result)).line for check in result.warnings}


@pytest.mark.slow
@pytest.mark.parametrize(
    "output",
    [
        *(pytest.param(name, marks=pytest.mark.slow) for name in ("stiffening_structure_margin", "melt_loss")),
        "sorted_share",
        "layer_play",
    ],
)
def test_the_line_that_is_proposed_mends(output):
    line = _proposed()[output]
    assert line.startswith("module: {")
    words = yaml.safe_load(line)["module"]
    again = _published("".join(f"  {name}: {word}\n" for name, word in words.items()))
    # With adjusters nothing is asked of the bond of tangs: what a module lacks has no advice.
    assert not {output, "tang_bond_safety"} & {check.output for check in again.warnings}


@pytest.mark.gate
def test_what_is_proposed_is_the_part_that_fits_or_what_a_study_can_ask():
    proposed = _proposed()
    # Of all wave springs the one that goes around the core of 10 mm and lies on the hub of 13.4.
    assert proposed["layer_play"] == "module: {axial_preload: wave_21x25}"
    # Of the prints only polyetherimide, 150 degC, bears the pads' 127 degC.
    assert proposed["structure_temperature_margin"] == "module: {process: print_pei_9085}"
    # A study that varies nothing cannot be asked to.
    warned = [warning.cure for warning in warnings_of(_published(), [])]
    assert any(cure.startswith("vary the current or a size, and try require: {") for cure in warned)


@pytest.mark.gate
def test_the_gravest_warning_comes_first():
    warnings = warnings_of(_published(), ["a sheet contradicts itself."])
    ranks = [("grave", "serious", "").index(warning.level) for warning in warnings]
    assert ranks == sorted(ranks)
    warnings = _published("  cooling_current: 1 A\n  heater_fuse: none\n")
    ranked = warnings_of(warnings, ["a sheet contradicts itself."])
    assert "no thermal fuse guards the heaters" in [warning.but for warning in ranked]
    assert "never gets stiff again" in ranked[0][0]
    assert ranked[0][1] == "may help: module: {cooling_current: 0.2 A, cold_side: sink}"
    assert ranked[-1][:2] == ("a sheet contradicts itself", "may help: catalog: my_records")


@pytest.mark.parametrize(("share", "level"), [(0.099, None), (0.101, ""), (0.501, "serious")])
def test_a_frozen_joint_that_turns_through_its_stroke_is_warned_of(share, level):
    result = answer(drawn(read_study_text(COARSE, "a test")))
    _, angle, _ = frozen_turn(result.design)
    values = result.design.values | {"stroke": angle / share}
    turned = replace(result, design=result.design.model_copy(update={"values": values}))
    warned = [warning for warning in warnings_of(turned, []) if warning.text.startswith("frozen, the link turns")]
    assert [warning.level for warning in warned] == ([] if level is None else [level])
    if warned:
        assert f"{100 * share:.0f} % of the stroke" in warned[0].text
        assert warned[0].cure == "require more in a wider module, or ask for a longer stroke or less torque"
        assert bool(warned[0].but) == bool(level)


@pytest.mark.slow
@pytest.mark.parametrize("extra", ["", "  response_criterion: softening\n  softening_band: 2\n"])
def test_a_run_has_each_warning_that_compare_has(extra):
    published = _published(extra)
    warned = {warning.text: warning for warning in warnings_of(published, [])}
    of_compare = {
        warning.output: advice_text(warning.output, warning.value, warning.origin, TABLE.unit(warning.output))
        for warning in published.warnings
    }
    assert set(of_compare.values()) <= set(warned)
    assert ("hot_point_margin" in of_compare) == bool(extra)
    if extra:
        assert missed_points(published) == {}
        assert warned[of_compare["hot_point_margin"]][1:] == ("", "", "")


def _warning_texts(text: str, **module: float) -> str:
    study = read_study_text(text, "test")
    study = study.model_copy(update={"module": {**study.module, **module}})
    return " ".join(warning.text for warning in warnings_of(answer(drawn(study)), []))


@pytest.mark.slow
def test_a_run_says_where_the_pcl_loses_contact():
    # In a hold of 10 s a printed structure creeps as its loss says: frozen blocks are left as well.
    texts = _warning_texts(COMPRESSION)
    assert "at hot no PCL touches the link for" in texts
    assert "at cold no PCL touches the link for" in texts
    texts = _warning_texts(COMPRESSION, **LOSSLESS)
    assert "at hot no PCL touches the link for" in texts
    assert "at cold no PCL" not in texts
    assert "no PCL touches the link" not in _warning_texts(SHEAR)


def test_a_requirement_is_tried_beside_the_remedies_before_it():
    """Strain of the molten layer is stroke times radius over thickness: least 0.104 * 32 / 2, and 5.9 takes 34 mm."""
    study = read_study_text(COARSE, "a test")
    nominal = answer(drawn(study))
    design = nominal.design.model_copy(update={"study": study.model_dump(mode="json")})
    optimised = replace(nominal, design=design, solution=cast(Solution, SimpleNamespace()))

    def tried(*lines: str) -> list[tuple[bool, Bound | None]]:
        remedies = Remedies(optimised, NEVER)
        each = [remedies.of(line.partition(":")[0], [f"require: {{{line}}}"]) for line in lines]
        return [(remedy.tried, remedy.bound) for remedy in each]

    ((possible, bound),) = tried('layer_strain: "<= 1.6"')
    assert not possible
    assert bound[:2] == ("layer_strain", False)
    assert bound.extreme.value == pytest.approx(1.664)
    assert set(bound.extreme.held_by[:2]) == {"the range of pcl_thickness", "the range of pcl_outer_radius"}
    assert tried('pcl_area: "<= 700 mm^2"') == [(True, None)]
    thin, (possible, bound) = tried('layer_strain: ">= 5.9"', 'pcl_area: "<= 700 mm^2"')
    assert thin == (True, None)
    assert not possible
    assert 700e-6 < bound.extreme.value < 900e-6
    assert tried('peak_power: "<= 9 W"') == [(False, None)]  # it depends on the switch


def test_a_remedy_with_a_unit_is_tried_in_si():
    changes = _changes({"module": {"target_temperature": "80 degC", "bore_friction": 0.15}}, table_for("shear"))
    assert changes == {"target_temperature": pytest.approx(353.15), "bore_friction": 0.15}


TABLE = table_for("shear")
TEXT = COARSE.replace("require:\n", 'require:\n  response_time: "<= 120 s"\n  impedance_range: ">= 3"\n')
STUDY = read_study_text(TEXT, "a test")
SAMPLES = 1024
OUTPUTS = [requirement.output for requirement in STUDY.require]


@pytest.fixture(scope="module")
def result() -> StudyResult:
    return answer(STUDY)


@pytest.fixture(scope="module")
def module(result: StudyResult) -> ResolvedModule:
    resolved = resolve_design(result.design)
    return replace(resolved, study=resolved.study.model_copy(update={"tolerances": standard_tolerances(TABLE)}))


@pytest.fixture(scope="module")
def model(module: ResolvedModule) -> UncertaintyModel:
    return UncertaintyModel(module, OUTPUTS)


@pytest.fixture(scope="module")
def spread(model: UncertaintyModel, module: ResolvedModule) -> DesignUncertainty:
    """Return the design's uncertainty with few samples, for what does not depend on them."""
    return model.at(module, 4, 8)


@pytest.mark.slow
def test_the_yield_is_what_tolerate_says(result, module, model):
    data = uncertainty_data(STUDY, result.design, SAMPLES)
    expected = Tolerancing(module, lambda _: None).analyse(SAMPLES, STUDY.solver.seed)
    assert 0.02 < expected.together.share < 0.98
    assert data["parts_yield"]["share"] == expected.together.share
    assert (data["limits"], data["tolerances"]) == (len(expected.limit_yields), "standard")
    alone = model.at(module, SAMPLES)  # by the design's own kernel
    assert data["parts_yield"]["share"] == alone.together.share


@pytest.mark.gate
def test_the_limit_most_in_doubt_is_met_up_to_the_value_named(result, module, model):
    data = uncertainty_data(STUDY, result.design, 0)
    limit = next(limit for limit in model.limits if limit.name == next(iter(data["held"])))
    main = next(iter(data["intervals"][limit.output]["shares"]))
    sense, number = data["needs"].removeprefix(f"{label(main)} ").split(" ", 1)

    def met(factor: float) -> bool:
        value = factor * parse_quantity(number, TABLE.unit(main))
        reached = TABLE.evaluate({**module.values, main: value}, [limit.output])[limit.output]
        return bool(limit.residual(float(reached)) <= 0.0)

    assert met(0.97) is (sense == "<=")
    assert met(1.03) is (sense == ">=")


@pytest.mark.gate
def test_limits_on_what_follows_a_profile_are_left_out_and_named(result):
    profiled = STUDY.model_copy(update={"profile": STUDY.profile.model_copy(update={"softening": 2})})
    study = profiled.model_copy(update={"tolerances": standard_tolerances(TABLE)})
    resolved = ResolvedModule(study, resolve_design(result.design).values)
    profiled_uncertainty = UncertaintyModel(resolved, OUTPUTS).at(resolved, 256, 8)
    assert profiled_uncertainty.left_out == ("response_time <=",)
    assert "response_time" not in profiled_uncertainty.intervals
    assert np.isfinite(profiled_uncertainty.together.share)


ARM = """
mode: shear
module: {transmission: unity, leg_model: ignored, spring_material: paper_wire}
require: {spring_stiffness: [">= 5.3 N.m/rad", "<= 6 N.m/rad"]}
"""


@pytest.mark.gate
def test_an_uncertainty_that_is_not_computed_is_a_warning(tvimdesign, tmp_path, monkeypatch):
    def no_start(*_: Any, **__: Any) -> None:
        raise TvimError("no start")

    (tmp_path / "arm.yaml").write_text(ARM)
    monkeypatch.setattr("tvimdesign.report.run.uncertainty_data.uncertainty_data", no_start)
    done = tvimdesign("run", "arm.yaml", "--no-cad", "--no-plots", "--out", "out", cwd=tmp_path, spread="on")
    assert done.returncode == 4, done.stderr
    text = " ".join(done.stdout.split())
    assert "Warning: the uncertainty of the design could not be computed: no start" in text
    assert "run the study again" in text
    assert "the uncertainty of the design could not be computed" in done.stderr
    assert "could not be computed" in (tmp_path / "out/summary.txt").read_text()
    assert "uncertainty" not in json.loads((tmp_path / "out/results.json").read_text())
    assert (tmp_path / "out/design.json").exists()


@pytest.mark.gate
def test_steps_left_out_are_on_the_screen_and_in_the_results(tvimdesign, tmp_path):
    (tmp_path / "arm.yaml").write_text(ARM)
    done = tvimdesign("run", "arm.yaml", "--no-cad", "--no-plots", "--out", "out", "--time-limit", "1 ms", cwd=tmp_path,
                      spread="on")  # fmt: skip
    assert done.returncode == 0, done.stderr
    text = " ".join(done.stdout.split())
    assert "Warning: the time limit of 0 s ended before these were done: yield and intervals" in text
    assert "Manufacturing" not in done.stdout
    assert "ended before these were done" in (tmp_path / "out/summary.txt").read_text()
    assert json.loads((tmp_path / "out/results.json").read_text())["left_out"] == ["yield and intervals"]
