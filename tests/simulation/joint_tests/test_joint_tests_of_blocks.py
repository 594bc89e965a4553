"""The link's tests on a compression module: contact lost and made, its backlash on the loop, and the linear limits."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from stiff_when_warm import LOSSLESS
from support import study_path

from tvimdesign.report.output.tables import results
from tvimdesign.simulation.joint_tests import release as release_test
from tvimdesign.simulation.joint_tests.case import Case, cases
from tvimdesign.simulation.joint_tests.release import contact_seen
from tvimdesign.simulation.link_motion import link
from tvimdesign.simulation.trial import CurveTable, Trial
from tvimdesign.simulation.virtual_tests import TESTS, find_test
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule, resolve_study
from tvimdesign.solve.result import answer
from tvimdesign.study import read_study

POINTS = ("cold", "melting", "hot")


@pytest.fixture(scope="module")
def resolved() -> ResolvedModule:
    study = read_study(study_path("paper_compression"))
    # Without its cover the core is shorter, and thicker it is stiffer; without friction, as the textbook has it, and
    # without the structure's loss (what that does is in test_loss_in_motion.py).
    other = {"cover": "none", "core_radius": 9e-3, "pin_friction": 0.0, **LOSSLESS}
    study = study.model_copy(update={"module": {**study.module, **other}})
    return resolve_study(study)


@pytest.fixture(scope="module")
def trial(resolved: ResolvedModule) -> Callable[[str], Trial]:
    @cache
    def run(test: str) -> Trial:
        return find_test(test)(resolved)

    return run


def with_rows(resolved: ResolvedModule, **values: float) -> ResolvedModule:
    """Return the rig with some quantities fixed."""
    return replace(resolved, values={**resolved.values, **values})


def value(trial: Trial, name: str) -> float:
    return next(finding.value for finding in trial.findings if finding.name == name)


def sheet(trial: Trial, name: str) -> CurveTable:
    return next(table for table in trial.sheets if table.name == name)


def case_of(resolved: ResolvedModule, name: str) -> Case:
    return next(case for case in cases(resolved) if case.name == name)


@pytest.mark.gate
@pytest.mark.parametrize("test", TESTS)
def test_every_test_runs_on_a_compression_module(test, trial):
    outcome = trial(test)
    assert outcome.findings
    sheets = {table.name: table for table in outcome.sheets}
    assert len(sheets) == len(outcome.sheets)
    for table in outcome.sheets:
        assert len({len(column.values) for column in table.columns}) == 1, table.name
        assert all(np.all(np.isfinite(column.values)) for column in table.columns), table.name
    for line in (line for panel in outcome.panels for line in panel.lines):
        sheets[line.sheet].column(line.x)
        sheets[line.sheet].column(line.y)
    # Only where the link moves does it matter that blocks push.
    assert any(note.startswith("Blocks push and never pull") for note in outcome.notes) == (test in {"release", "sine"})


@pytest.mark.gate
def test_energy_never_rises_and_a_lasting_rattle_is_reported(trial, resolved):
    release = trial("release")
    for table in release.sheets:
        if not table.name.endswith("_events"):
            energy = table.column("stored_energy").values
            assert np.max(np.diff(energy)) <= 1e-9 * energy[0], table.name
    for point in POINTS:
        gain = next(finding for finding in release.findings if finding.name == f"energy_gain@{point}")
        assert max(gain.value, gain.high or 0.0) <= 1e-9
    # A hot link has nothing but lossless springs over most of its way, and a frozen one hardly any damping.
    assert not np.isfinite(value(trial("release"), "settling_time@hot"))
    assert any(
        note.startswith("At cold and hot") and "the link still swings" in note for note in trial("release").notes
    )
    assert not any(
        "still swings" in note for note in release_test.release(with_rows(resolved, parting_share=0.0)).notes
    )


def test_hot_blocks_leave_the_link_to_its_springs(resolved, trial):
    release, springs = trial("release"), resolved.quantity("spring_stiffness")
    assert value(release, "backlash@hot") == pytest.approx(0.1, rel=1e-6)
    for name in ("release_hot", "release_melting_nominal", "release_melting_high"):
        course = sheet(release, name)
        angle, torque = course.column("angle").values, course.column("torque").values
        free = course.column("ahead_touches").values + course.column("behind_touches").values == 0.0
        assert np.any(free)
        assert torque[free] == pytest.approx(-springs * angle[free], rel=1e-9, abs=1e-12), name
        assert np.max(np.abs(torque[~free])) > springs * np.max(np.abs(angle[~free])), name


@pytest.mark.parametrize("name", ["cold", "melting_nominal", "melting_high"])
def test_first_flat_of_the_loop_is_as_wide_as_the_backlash(name, resolved, trial):
    # Unless a block recovers while it is crossed, which takes a millisecond: less than a tenth here.
    course = sheet(trial("release"), f"release_{name}")
    free = course.column("ahead_touches").values + course.column("behind_touches").values == 0.0
    first = int(np.argmax(free))
    last = first + int(np.argmin(free[first:]))
    way = course.column("angle").values[first] - course.column("angle").values[last]
    case = case_of(resolved, name)
    gap = case.plant.gap(link.held(case.plant, 0.1, 10.0))
    assert 0.9 * gap < way <= gap * (1.0 + 1e-9)


def test_the_loop_and_contact_lost_are_those_of_the_first_swing(trial):
    release = trial("release")
    loops = [panel for panel in release.panels if panel.x_label.startswith("Angle")]
    assert len(loops) == 3
    assert all(line.sheet.endswith("_first_swing") for panel in loops for line in panel.lines)
    whole = sheet(release, "release_melting_nominal").column("time").values
    swing = sheet(release, "release_melting_nominal_first_swing").column("time").values
    assert np.array_equal(swing, whole[: len(swing)])
    assert swing[-1] == pytest.approx(1.0 / value(release, "ringing_frequency@melting"), rel=1e-9)
    # By the events of the sheet: left at the first, met at the second, and once more on the way back.
    events = sheet(trial("release"), "release_melting_nominal_events")
    times, swing = events.column("time").values, 1.0 / value(trial("release"), "ringing_frequency@melting")
    lost = (times[1] - times[0]) + (times[3] - times[2])
    assert times[3] < swing < times[4] + swing
    assert value(trial("release"), "contact_lost@melting") == pytest.approx(lost / swing, rel=1e-9)


def test_events_are_where_the_columns_change(trial):
    release = trial("release")
    course, events = sheet(release, "release_cold"), sheet(release, "release_cold_events")
    times = course.column("time").values
    for ahead, column in ((1.0, "ahead_touches"), (0.0, "behind_touches")):
        chosen = events.column("block_ahead").values == ahead
        moments, touches = events.column("time").values[chosen], events.column("touches_from_here").values[chosen]
        changes = np.flatnonzero(np.diff(course.column(column).values)) + 1
        assert times[changes] == pytest.approx(moments, abs=1e-12)
        assert np.array_equal(course.column(column).values[changes], touches)


def test_rows_say_what_the_release_says(resolved, trial):
    seen = contact_seen(resolved)
    for point in POINTS:
        loss = next(finding for finding in trial("release").findings if finding.name == f"contact_lost@{point}")
        nominal, low, high = seen[f"contact_lost@{point}"]
        assert nominal == pytest.approx(loss.value, rel=1e-6)
        assert (low, high) == pytest.approx((loss.low or nominal, loss.high or nominal), rel=1e-6)
    assert 0.0 < seen["contact_lost@cold"][0] < 0.01
    assert 0.7 < seen["contact_lost@hot"][0] < 1.0


@pytest.mark.slow
def test_answer_of_a_study_holds_what_the_swing_shows(resolved):
    result = answer(resolved.study)
    seen, reported = contact_seen(resolved), results(result)["values"]
    for name, (nominal, low, high) in seen.items():
        assert result.design.values[name] == nominal
        assert reported[name]["value"] == nominal
        if low < high:
            assert result.intervals[name] == (low, high)
            assert (reported[name]["low"], reported[name]["high"]) == (low, high)
    assert result.intervals.keys() & seen.keys() == {"contact_lost@melting"}
    assert result.intervals["backlash@melting"][1] > 100.0 * result.intervals["backlash@melting"][0] > 0.0


def test_bonded_layer_loses_no_contact_and_has_no_backlash():
    study = read_study(study_path("paper_reconstructed"))
    shear = resolve_study(study)
    assert all(ends == (0.0, 0.0, 0.0) for ends in contact_seen(shear).values())
    release = release_test.release(shear)
    for point in POINTS:
        assert value(release, f"backlash@{point}") == 0.0
        assert value(release, f"contact_lost@{point}") == 0.0
    assert not any(table.name.endswith("_events") for table in release.sheets)


def test_sine_pushes_molten_blocks_aside_and_keeps_frozen_ones(resolved, trial):
    sine, springs = trial("sine"), resolved.quantity("spring_stiffness")
    assert value(sine, "stiffness@hot") == pytest.approx(springs, rel=1e-4)
    assert value(sine, "contact_lost@hot") > 0.95
    assert value(sine, "stiffness@cold") == pytest.approx(resolved.quantity("joint_stiffness@cold"), rel=2e-3)
    assert value(sine, "contact_lost@cold") < 1e-3
    loop = sheet(sine, "sine_hot_loop").column("time").values
    assert loop[-1] - loop[0] == pytest.approx(1.0, rel=1e-6)
