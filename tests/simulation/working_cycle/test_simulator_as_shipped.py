"""The simulator people get is looser than the one other tests difference: it must still find the same cycle."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from support import ROOT, fine

from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.trajectory import Cycle
from tvimdesign.study import drawn, given, read_study


@pytest.mark.parametrize("design", ["as it is", "thin", "thick", "aluminium"])
def test_the_shipped_tolerance_finds_the_values_of_the_tight_one(
    design: str, build: Callable[..., DeviceFunctions], switch_of: Callable[[str], Cycle]
) -> None:
    model, tight = build(design), switch_of(design)
    shipped = Simulator(model).run(model.start)
    for name, value in tight.values.items():
        assert shipped.values[name] == pytest.approx(value, rel=2e-4), name


def test_an_event_that_a_second_look_just_misses_is_found_where_it_is() -> None:
    """At this start the sample after the event has it, and the same moment integrated once more not quite."""
    study = read_study(ROOT / "studies" / "fast_switch.yaml")
    table = study.table
    model = DeviceFunctions(table, given(study), tuple(study.operating_points), study.solver.cells)
    shown, tight = Simulator(model).run_to_show(model.start), fine(model).run(model.start)
    for name in ("softening_time", "stiffening_time", "equilibrium_stiffening_time"):
        assert shown.values[name] == pytest.approx(tight.values[name], rel=2e-5), name


@pytest.mark.parametrize("name", ["paper_shear", "wrist_compression"])
def test_the_first_look_of_a_cycle_that_is_shown_seeks_ends_alone_and_finds_the_same_ones(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Events and steady states beside them are a third to a half of its work, and move no end by a bit."""
    study = drawn(read_study(ROOT / "studies" / f"{name}.yaml"))
    model = DeviceFunctions(study.table, given(study), tuple(study.operating_points), study.solver.cells)
    simulator, looks = Simulator(model), list[Cycle]()
    run = simulator.run

    def seen(*what: Any, **how: Any) -> Cycle:
        looks.append(run(*what, **how))
        return looks[-1]

    monkeypatch.setattr(simulator, "run", seen)
    simulator.run_to_show(model.start)
    first, shown = (look.values for look in looks)
    ends = {phase.phase.ends for phase in model.phases.values()}
    assert sum(map(np.isfinite, first.values())) < sum(map(np.isfinite, shown.values()))
    whole = run(model.start).values
    assert {end: first[end] for end in ends} == {end: whole[end] for end in ends}


def test_a_phase_that_is_over_at_once_is_not_sampled_as_finely_for_ever() -> None:
    """What else happens in it may take hours: stretches of 10 ms up to then were a hang, of gigabytes."""
    study = read_study(ROOT / "studies" / "paper_shear.yaml")
    model = DeviceFunctions(study.table, given(study), tuple(study.operating_points), study.solver.cells)
    simulator = Simulator(model)
    usual = simulator.run(model.start, phases=["softening"])
    fine_sampled = simulator.run(model.start, phases=["softening"], stretches={"softening": 0.01})
    assert len(fine_sampled.trajectories["softening"].times) < 5_000
    assert fine_sampled.values["softening_time"] == pytest.approx(usual.values["softening_time"], rel=2e-4)
