"""A study answered: evaluated or optimised, as a `Design` with what the report draws from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign import __version__
from tvimdesign.catalog import Catalog
from tvimdesign.device import Input, Path, Table
from tvimdesign.simulation.curves import Curves, impedance_sweep, stage_history
from tvimdesign.simulation.cycle import Simulator, Switch
from tvimdesign.simulation.device_functions import Model
from tvimdesign.simulation.melt_history import intervals
from tvimdesign.simulation.resolved_module import Rig
from tvimdesign.solve.nlp.constraints import Limit, advice_of, in_words, limits_of, on_switch, refuse_impossible
from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.nlp.solver_run import Progress
from tvimdesign.solve.optimizer.optimizer import ALGEBRAIC_TOLERANCE
from tvimdesign.solve.optimizer.verify_optimum import SWITCH_TOLERANCE
from tvimdesign.solve.search import Keep, optimize
from tvimdesign.study import Study, given
from tvimdesign.study.design import Design
from tvimdesign.virtual_tests.joint_tests.release import contact_seen


@dataclass(frozen=True)
class Check:
    """One limit held against the design."""

    text: str
    output: str
    value: float
    margin: float
    """What is left, as a share of `scale`; negative where it is broken."""
    scale: float
    """The limit's size, SI; or what stands for it where the limit is zero or a temperature."""
    absolute: bool
    """Whether the margin is to be read in the row's unit, not as a share."""
    kept: bool
    worst: float
    """The least margin over what history leaves open; the margin itself where there is one value."""
    origin: str
    """`require`, or the reason the machine has the limit."""


@dataclass(frozen=True)
class Answer:
    """What a study came to."""

    design: Design
    checks: tuple[Check, ...]
    """Requirements and rules."""
    warnings: tuple[Check, ...]
    """Advice that the design does not follow."""
    histories: dict[str, Curves]
    """By stage."""
    sweep: Curves
    solution: Solution | None
    intervals: dict[str, tuple[float, float]]
    """Least and largest value (SI) of the outputs for which a point inside the melting range has no one answer."""
    constant_current: dict[str, float]
    """What the same module does where currents that follow a profile stay at their default; empty where none does."""

    @property
    def found(self) -> bool:
        """Whether there is a design: evaluated, or optimal."""
        return self.solution is None or self.design.status == "optimal"

    @property
    def seconds(self) -> dict[str, float]:
        """What setting up and solving took; empty where nothing was optimised."""
        return self.solution.seconds if self.solution else {}

    @property
    def undecided(self) -> tuple[Check, ...]:
        """The requirements and rules that are kept as nominally heated, and broken with another history."""
        return tuple(check for check in self.checks if check.kept and check.worst < -SWITCH_TOLERANCE)

    @property
    def feasible(self) -> bool:
        """Whether every requirement and rule is kept."""
        return all(check.kept for check in self.checks)


def answer(
    study: Study,
    catalog: Catalog,
    table: Table,
    progress: Progress = lambda _: None,
    reference: dict[str, float] | None = None,
    keep: Keep = lambda *_: None,
    traded: Sequence[str] = (),
) -> Answer:
    """Evaluate or optimise a study, its outputs over a `reference` (its start). Raises InputError, InfeasibleError.

    What found the optimum is handed to `keep`, able to trade some outputs afterwards.
    """
    solution = None
    refuse_impossible(study, catalog, table)
    if study.task == "optimize":
        solution = optimize(study, catalog, table, progress, reference, keep, traded)
        model, inputs, switch, values = solution.model, solution.inputs, solution.switch, solution.values
        status, drives = solution.status, solution.drives
    else:
        progress("simulating one working cycle")
        model = Model(table, given(study, catalog, table), tuple(study.operating_points), study.solver.cells)
        inputs = model.start
        switch = Simulator(model).run_to_show(inputs)
        values = model.values(inputs, switch.values)
        status, drives = "evaluated", {}
    numbers = {name: float(inputs[i]) for name, i in model.index.items()}
    rig = Rig(study, catalog, table, {**given(study, catalog, table), **model.words, **numbers})
    open_values = intervals(rig, model, inputs, switch.values, drives)
    seen = _seen(rig, exists=solution is None or status == "optimal")
    open_values |= {name: (low, high) for name, (_, low, high) in seen.items() if low < high}
    values = values | {name: nominal for name, (nominal, _, _) in seen.items()}
    design = Design(
        tvimdesign=__version__, name=study.name, mode=study.mode, status=status,
        choices=_choices(model, table), values={**numbers, **values},
        intervals=open_values, study=study.model_dump(mode="json"),
        drives={stage: drive.plain() for stage, drive in drives.items()}, solution=_plain(solution),
    )  # fmt: skip
    checks = tuple(_check(limit, values, table, open_values) for limit in limits_of(study, table, rig.values))
    happened = (limit for limit in advice_of(table) if _happened(limit.output, values, table))
    advice = (_check(limit, values, table, open_values) for limit in happened)
    warnings = tuple(check for check in advice if not check.kept)
    return Answer(
        design=design, checks=checks, warnings=warnings, histories=_histories(model, inputs, switch),
        sweep=impedance_sweep(rig), solution=solution,
        intervals=open_values,
        constant_current=_at_constant_current(model, inputs, set(drives)),
    )  # fmt: skip


def _seen(rig: Rig, *, exists: bool) -> dict[str, tuple[float, float, float]]:
    """What a released link shows; nothing is known of where a solver ended that found no design."""
    if exists:
        return contact_seen(rig)
    names = [f"{row.name}@{point}" for row in rig.table.swings for point in rig.points]
    return dict.fromkeys(names, (np.nan, np.nan, np.nan))


_COMPARED = {
    "softening": ("response_time", "softening_time", "switch_energy", "peak_power", "peak_voltage",
                  "peak_peltier_temperature"),
    "stiffening": ("stiffening_time", "frozen_time", "stiffening_energy", "peak_cold_side_temperature"),
}  # fmt: skip


def _at_constant_current(model: Model, inputs: NDArray[np.float64], stages: set[str]) -> dict[str, float]:
    if not stages:
        return {}
    changed = inputs.copy()
    for stage in stages:
        row = model.table.row(model.table.stage(stage).drive)
        assert isinstance(row, Input)
        changed[model.index[row.name]] = row.default
    values = Simulator(model).run(changed).values
    return {name: values[name] for stage in _COMPARED if stage in stages for name in _COMPARED[stage]}


def _histories(model: Model, inputs: NDArray[np.float64], switch: Switch) -> dict[str, Curves]:
    return {stage: stage_history(model, inputs, line, stage) for stage, line in switch.trajectories.items()}


def _choices(model: Model, table: Table) -> dict[str, str]:
    return {row.name: getattr(model.words[row.name], "name", model.words[row.name]) for row in table.choices}


def _check(
    limit: Limit, values: dict[str, float], table: Table, open_values: Mapping[str, tuple[float, float]]
) -> Check:
    value = values[limit.output]
    ends = open_values.get(limit.output, (value, value))
    residual = limit.residual(value)
    tolerance = SWITCH_TOLERANCE if on_switch(table, limit.output) else ALGEBRAIC_TOLERANCE
    return Check(
        text=in_words(limit, table), output=limit.output, value=value, margin=-float(residual),
        scale=limit.scale, absolute=limit.absolute, kept=bool(residual <= tolerance),
        worst=-max(float(limit.residual(end)) for end in ends), origin=limit.origin,
    )  # fmt: skip


def _happened(name: str, values: dict[str, float], table: Table) -> bool:
    """Whether there is anything to say of an output: the peak of a stage that never began is none."""
    peaks = (need for need in table.output(name).needs if isinstance(table.row(need), Path))
    return not np.isnan(values[name]) and all(np.isfinite(values[peak]) for peak in peaks)


def _plain(solution: Solution | None) -> dict[str, Any]:
    """The account as plain data, SI, without what differs from run to run."""
    if solution is None:
        return {}
    return {
        "objective": solution.objective,
        "reference": solution.reference,
        "distinct_optima": [start.number for start in solution.distinct_optima()],
        "starts": [{k: v for k, v in asdict(start).items() if k != "seconds"} for start in solution.starts],
        "held": [asdict(held) for held in solution.held],
    }
