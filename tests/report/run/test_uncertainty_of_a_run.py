"""The yield and the assumptions of a first screen, and a run whose uncertainty is not computed."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from comparable import COARSE
from support import Command

from tvimdesign.base.errors import TvimError
from tvimdesign.base.units import parse_quantity
from tvimdesign.device import table_for
from tvimdesign.report.output.numbers import label
from tvimdesign.report.run.uncertainty_data import Uncertainty
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_design
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.solve.uncertainty.design_uncertainty import DesignUncertainty, UncertaintyModel
from tvimdesign.solve.uncertainty.tolerance import Tolerancing
from tvimdesign.solve.uncertainty.uncertain_inputs import unmeasured_inputs
from tvimdesign.study import read_study_text, standard_tolerances

TABLE = table_for("shear")
TEXT = COARSE.replace("require:\n", 'require:\n  response_time: "<= 120 s"\n  impedance_range: ">= 3"\n')
STUDY = read_study_text(TEXT, "a test")
SAMPLES = 1024
ASKED = [requirement.output for requirement in STUDY.require]


@pytest.fixture(scope="module")
def found() -> StudyResult:
    return answer(STUDY)


@pytest.fixture(scope="module")
def module(found: StudyResult) -> ResolvedModule:
    resolved = resolve_design(found.design)
    return replace(resolved, study=resolved.study.model_copy(update={"tolerances": standard_tolerances(TABLE)}))


@pytest.fixture(scope="module")
def model(module: ResolvedModule) -> UncertaintyModel:
    return UncertaintyModel(module, ASKED)


@pytest.fixture(scope="module")
def spread(model: UncertaintyModel, module: ResolvedModule) -> DesignUncertainty:
    """The design with few samples, for what does not depend on them."""
    return model.at(module, 4, 8)


@pytest.mark.slow
def test_the_yield_is_what_tolerate_says(found: StudyResult, module: ResolvedModule, model: UncertaintyModel) -> None:
    said = Uncertainty(STUDY).data(found.design, SAMPLES)
    expected = Tolerancing(module, lambda _: None).analyse(SAMPLES, STUDY.solver.seed)
    assert 0.02 < expected.together.share < 0.98
    assert said["parts_yield"]["share"] == expected.together.share
    assert (said["limits"], said["tolerances"]) == (len(expected.kept), "standard")
    alone = model.at(module, SAMPLES)  # by the design's own kernel
    assert said["parts_yield"]["share"] == alone.together.share


@pytest.mark.gate
@pytest.mark.parametrize("output", ["holding_torque", "impedance_range"])
def test_the_assumed_input_shown_moves_its_output_most(
    module: ResolvedModule, spread: DesignUncertainty, output: str
) -> None:
    def at(name: str, value: float) -> float:
        return float(TABLE.evaluate({**module.values, name: value}, [output])[output])

    every = {one.name: abs(at(one.name, one.high) - at(one.name, one.low)) for one in unmeasured_inputs(module)}
    swing = spread.intervals[output].swings[0]
    assert swing.moved.name == max(every, key=lambda name: every[name])
    assert swing.moved.name in TABLE.ancestors(output)
    assert swing.at_low == pytest.approx(at(swing.moved.name, swing.moved.low), rel=1e-9)
    assert swing.at_high == pytest.approx(at(swing.moved.name, swing.moved.high), rel=1e-9)


@pytest.mark.gate
def test_the_limit_most_in_doubt_is_met_up_to_the_value_named(
    found: StudyResult, module: ResolvedModule, model: UncertaintyModel
) -> None:
    data = Uncertainty(STUDY).data(found.design, 0)
    limit = next(limit for limit in model.limits if limit.name == next(iter(data["held"])))
    main = next(iter(data["intervals"][limit.output]["shares"]))
    sense, number = data["needs"].removeprefix(f"{label(main)} ").split(" ", 1)

    def met(factor: float) -> bool:
        value = factor * parse_quantity(number, TABLE.unit(main))
        reached = TABLE.evaluate({**module.values, main: value}, [limit.output])[limit.output]
        return bool(limit.residual(float(reached)) <= 0.0)

    assert met(0.97) is (sense == "<=")
    assert met(1.03) is (sense == ">=")


def test_limits_on_what_follows_a_profile_are_left_out_and_named(found: StudyResult) -> None:
    profiled = STUDY.model_copy(update={"profile": STUDY.profile.model_copy(update={"softening": 2})})
    study = profiled.model_copy(update={"tolerances": standard_tolerances(TABLE)})
    resolved = ResolvedModule(study, resolve_design(found.design).values)
    profiled_uncertainty = UncertaintyModel(resolved, ASKED).at(resolved, 256, 8)
    assert profiled_uncertainty.left_out == ("response_time <=",)
    assert "response_time" not in profiled_uncertainty.intervals
    assert np.isfinite(profiled_uncertainty.together.share)


ARM = """
mode: shear
module: {transmission: unity, leg_model: ignored, spring_material: paper_wire}
require: {spring_stiffness: [">= 5.3 N.m/rad", "<= 6 N.m/rad"]}
"""


@pytest.mark.gate
def test_an_uncertainty_that_is_not_computed_is_a_warning(
    tvimdesign: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_start(*_: Any, **__: Any) -> None:
        raise TvimError("no start")

    (tmp_path / "arm.yaml").write_text(ARM)
    monkeypatch.setattr(Uncertainty, "data", no_start)
    done = tvimdesign("run", "arm.yaml", "--no-cad", "--no-plots", "--out", "out", cwd=tmp_path, spread="on")
    assert done.returncode == 4, done.stderr
    said = " ".join(done.stdout.split())
    assert "Warning: the uncertainty of the design could not be computed: no start" in said
    assert "run the study again" in said
    assert "the uncertainty of the design could not be computed" in done.stderr
    assert "could not be computed" in (tmp_path / "out/summary.txt").read_text()
    assert "uncertainty" not in json.loads((tmp_path / "out/results.json").read_text())
    assert (tmp_path / "out/design.json").exists()


def test_steps_left_out_are_on_the_screen_and_in_the_results(tvimdesign: Command, tmp_path: Path) -> None:
    (tmp_path / "arm.yaml").write_text(ARM)
    done = tvimdesign("run", "arm.yaml", "--no-cad", "--no-plots", "--out", "out", "--time-limit", "1 ms", cwd=tmp_path,
                      spread="on")  # fmt: skip
    assert done.returncode == 0, done.stderr
    said = " ".join(done.stdout.split())
    assert "Warning: the time limit of 0 s ended before these were done: yield and intervals" in said
    assert "Manufacturing" not in done.stdout
    assert "ended before these were done" in (tmp_path / "out/summary.txt").read_text()
    assert json.loads((tmp_path / "out/results.json").read_text())["left_out"] == ["yield and intervals"]
