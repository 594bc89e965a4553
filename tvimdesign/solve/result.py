"""A study answered: evaluated or optimised, as a `Design` with what the report draws from."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign import __version__
from tvimdesign.device import Input, Table
from tvimdesign.device.core.softening import CONTROL, DUTY
from tvimdesign.simulation.joint_tests.release import contact_seen
from tvimdesign.simulation.working_cycle.curves import Curves, impedance_sweep, intervals, phase_history
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions, ResolvedModule, given_profiles
from tvimdesign.solve.duty import HOUR, ControlResult, DutyResult, control_of, duty_of
from tvimdesign.solve.nlp import constraints
from tvimdesign.solve.nlp.constraints import Constraint
from tvimdesign.solve.nlp.solution import Solution, YieldReached
from tvimdesign.solve.nlp.solver_run import ABOVE_RATING, BELOW_YIELD, OPTIMAL, SIMULATED_MISSED, Progress
from tvimdesign.solve.optimizer.verify_optimum import CYCLE_TOLERANCE, exceeded, happened, is_met, sorted_by_acceptance
from tvimdesign.solve.search import Keep, Search, SearchInterrupted, optimize
from tvimdesign.solve.variants import Cooling, Idealization, cooling, idealizations
from tvimdesign.study import CONTROLLED, Design, Requirement, Study, given
from tvimdesign.study.written_studies import started_at

ROUNDS = 2  # Searches with tighter limits, at most, where a limit on what is simulated of the design is violated
Designed = Callable[[Design, Solution | None], None]  # Receiver of a design as soon as it exists


@dataclass(frozen=True)
class ConstraintCheck:
    """Limit and the design's value."""

    text: str
    output: str
    value: float
    margin: float  # Room left, as a share of `scale`; negative where it is broken
    scale: float  # The limit's size, SI; or what stands for it where the limit is zero or a temperature
    absolute: bool  # True if the margin is to be read in the row's unit, not as a share
    met: bool
    worst: float  # The least margin over what history leaves open; the margin itself where there is one value
    origin: str  # `require`, or the reason the machine has the limit
    part_of: str = ""  # The output of the requirement that is put on several at once


@dataclass(frozen=True)
class StudyResult:
    """Result of a study."""

    design: Design
    checks: tuple[ConstraintCheck, ...]  # Requirements and rules
    warnings: tuple[ConstraintCheck, ...]
    """Ratings that the design is beyond and the study does not accept, then advice that it does not follow."""
    accepted: tuple[ConstraintCheck, ...]  # Ratings that the design is beyond, as the study accepts
    idealizations: tuple[Idealization, ...]
    """What the study leaves out of the drawn module, and what comes out without that; the first that gave a value
    marks it."""
    histories: dict[str, Curves]  # By phase
    sweep: Curves
    solution: Solution | None
    intervals: dict[str, tuple[float, float]]
    """Least and largest value (SI) of the outputs for which a point inside the melting range has no one answer."""
    constant_current: dict[str, float]
    """What the same module does where currents that follow a profile stay at their default; empty where none does."""
    cooling: Cooling  # Benefit of cooling by current on the way back
    duty: DutyResult | None
    control: ControlResult | None

    @property
    def has_design(self) -> bool:
        """Existence of a design: evaluated, optimal, beyond a rating that is not accepted, or below a yield."""
        return _has_design(self.design, self.solution)

    @property
    def yield_reached(self) -> YieldReached | None:
        """The account of a yield that the study asks for; None without a design or without one asked for."""
        return self.solution.yield_reached if self.solution and self.has_design else None

    @property
    def accepted_in_vain(self) -> tuple[str, ...]:
        """The ratings that the study accepts to be exceeded and its design keeps."""
        exceeded = {check.output for check in self.accepted}
        return tuple(name for name in self.design.study.get("accept", ()) if name not in exceeded)

    @property
    def seconds(self) -> dict[str, float]:
        """Return the time of set-up and solving; empty if nothing was optimised."""
        return self.solution.seconds if self.solution else {}

    @property
    def undecided(self) -> tuple[ConstraintCheck, ...]:
        """The requirements and rules that are met as nominally heated, and broken with another history."""
        return tuple(check for check in self.checks if check.met and check.worst < -CYCLE_TOLERANCE)

    @property
    def feasible(self) -> bool:
        """Feasibility: every requirement and rule is satisfied."""
        return all(check.met for check in self.checks)


def _has_design(design: Design, solution: Solution | None) -> bool:
    return solution is None or design.status in {OPTIMAL, ABOVE_RATING, BELOW_YIELD}


def answer(
    study: Study,
    progress: Progress = lambda _: None,
    reference: dict[str, float] | None = None,
    keep: Keep = lambda *_: None,
    objectives: Sequence[str] = (),
    search: Search = optimize,
    designed: Designed = lambda *_: None,
) -> StudyResult:
    """Evaluate or optimise a study, its outputs over a `reference` (its start). Raises InputError, InfeasibleError.

    What found the optimum is handed to `keep`, able to trade some outputs afterwards. A `search` may stand in place of
    the usual one. `designed` receives a design and its solution as soon as they exist, before the whole account. An
    interrupt of the search, or once it has found a design, is SearchInterrupted.
    """
    constraints.refuse_impossible(study)
    if study.task != "optimize":
        progress("simulating one working cycle")
        return _result(study, None, designed)
    solution = search(study, progress, reference, keep, objectives)
    try:
        result = _result(study, solution, designed)
        for _ in range(ROUNDS):
            closer = _tightened(study, result)
            if closer is None:
                break
            progress("searching again: a limit on what is simulated of the design is violated")
            solution = search(closer, progress, reference, keep, objectives)
            again = _result(study, solution, designed)
            if again.design.status != SIMULATED_MISSED and not again.has_design:
                break
            result = again
        return result
    except KeyboardInterrupt as interrupt:
        if solution.status not in {OPTIMAL, BELOW_YIELD}:
            raise
        inputs = dict(zip(solution.model.names, solution.inputs.tolist(), strict=True))
        raise SearchInterrupted(started_at(study, inputs, _choices(solution.model, study.table))) from interrupt


def _tightened(study: Study, result: StudyResult) -> Study | None:
    """Return the study with limits that what is simulated would keep, if both differ as they do now; None if it does.

    An output is limited in the switch from ambient by as much more as it is beyond that in a duty, or under control.
    """
    if result.design.status != SIMULATED_MISSED:
        return None
    values, limits = result.design.values, []
    for limit in study.simulated:
        base = limit.output.partition("@")[0]
        if base not in values:
            return None
        least = limit.limit - (values[limit.output] - values[base])
        if not np.isfinite(least) or limit.limit > 0.0 >= least:
            return None
        limits.append(Requirement(output=base, sense=limit.sense, limit=least, text=limit.text))
    return study.model_copy(update={"require": (*study.require, *limits)})


def _simulated(
    study: Study, duty: DutyResult | None, control: ControlResult | None, values: Mapping[str, float]
) -> dict[str, float]:
    """Return the limited outputs in a duty and under the controller; NaN where there is no such cycle."""
    of_state: dict[str, dict[str, float]] = {DUTY: {}, CONTROL: {}}
    if duty:
        of_state[DUTY] = duty.quantities | {"highest_switch_rate": duty.most / HOUR}
    if control:
        slower = control.settling_of_nominal * values["response_time"]
        of_state[CONTROL] = {
            **dict(zip(CONTROLLED, (slower, control.hottest_pads), strict=True)),
            "overshoot": control.overshoot, "slowdown": control.settling, "controlled_share": control.controlled.share,
        }  # fmt: skip
    parted = ((limit.output, *limit.output.split("@")) for limit in study.simulated)
    return {name: of_state[state].get(base, np.nan) for name, base, state in parted}


def _result(study: Study, solution: Solution | None, designed: Designed) -> StudyResult:
    """Return the result of a study, with a search's solution or as evaluated."""
    table = study.table
    if solution is not None:
        model, inputs, cycle, values = solution.model, solution.inputs, solution.cycle, solution.values
        status, current_profiles = solution.status, solution.current_profiles
    else:
        model = DeviceFunctions(table, given(study), tuple(study.operating_points), study.solver.cells)
        inputs = model.start
        status, current_profiles = "evaluated", given_profiles(study)
        cycle = Simulator(model).run(inputs, current_profiles)
        values = model.values(inputs, cycle.values)
    numbers = {name: float(inputs[i]) for name, i in model.index.items()}
    resolved = ResolvedModule(study, {**given(study), **model.words, **numbers}, current_profiles)
    open_values = intervals(resolved, model, inputs, cycle.values, current_profiles)
    seen = _seen(resolved, exists=solution is None or status in {OPTIMAL, BELOW_YIELD})
    open_values |= {name: (low, high) for name, (_, low, high) in seen.items() if low < high}
    values = values | {name: nominal for name, (nominal, _, _) in seen.items()}
    exists = solution is None or status in {OPTIMAL, BELOW_YIELD}
    duty = duty_of(study, model, inputs, current_profiles) if exists else None
    control = control_of(resolved) if exists else None
    values |= _simulated(study, duty, control, values) if exists else {}
    simulated = tuple(
        _check(constraints.make_constraint(table, limit.output, limit.sense, limit.limit, "require"), values, table, {})
        for limit in (study.simulated if exists else ())
    )
    if solution is not None and not all(check.met for check in simulated):
        status = SIMULATED_MISSED
    ratings = {limit.output: _check(limit, values, table, open_values) for limit in exceeded(values, table)}
    above, accepting = sorted_by_acceptance(ratings, study.accept)
    design = Design(
        tvimdesign=__version__,
        name=study.name,
        mode=study.mode,
        status=ABOVE_RATING if above and status in {OPTIMAL, BELOW_YIELD} else status,
        above_rating=above,
        accepting=accepting,
        choices=_choices(model, table),
        values={**numbers, **values},
        intervals=open_values,
        study=study.model_dump(mode="json"),
        current_profiles={phase: profile.plain() for phase, profile in current_profiles.items()},
        solution=_plain(solution),
    )
    if _has_design(design, solution):
        designed(design, solution)
    required = constraints.constraints_of(study, table, resolved.values)
    checks = (*(_check(limit, values, table, open_values) for limit in required), *simulated)
    advice = [
        limit
        for limit in constraints.advice_of(table)
        if table.output(limit.output).exists(design.choices) and happened(limit.output, values, table)
    ]
    ignored = [check for limit in advice if not (check := _check(limit, values, table, open_values)).met]
    return StudyResult(
        design=design, checks=checks, warnings=(*(ratings[name] for name in above), *ignored),
        accepted=tuple(ratings[name] for name in accepting),
        idealizations=idealizations(resolved, inputs, values, current_profiles),
        histories={phase: phase_history(model, inputs, line, phase) for phase, line in cycle.trajectories.items()},
        sweep=impedance_sweep(resolved), solution=solution,
        intervals=open_values,
        constant_current=_at_constant_current(model, inputs, set(current_profiles)),
        cooling=cooling(model, inputs, values, current_profiles),
        duty=duty,
        control=control,
    )  # fmt: skip


def _seen(resolved: ResolvedModule, *, exists: bool) -> dict[str, tuple[float, float, float]]:
    """Return the impedances of a released link; nothing is known where a solver ended without a design."""
    if exists:
        return contact_seen(resolved)
    names = [f"{row.name}@{point}" for row in resolved.table.first_oscillations for point in resolved.points]
    return dict.fromkeys(names, (np.nan, np.nan, np.nan))


_COMPARED = {
    "softening": ("response_time", "softening_time", "switch_energy", "peak_power", "peak_voltage",
                  "peak_heater_temperature"),
    "stiffening": ("stiffening_time", "frozen_time", "stiffening_energy", "peak_cold_side_temperature"),
}  # fmt: skip


def _at_constant_current(model: DeviceFunctions, inputs: NDArray[np.float64], phases: set[str]) -> dict[str, float]:
    if not phases:
        return {}
    changed = inputs.copy()
    for phase in phases:
        row = model.table.quantity(model.table.phase(phase).current_input)
        assert isinstance(row, Input)
        changed[model.index[row.name]] = row.default
    values = Simulator(model).run(changed).values
    return {name: values[name] for phase in _COMPARED if phase in phases for name in _COMPARED[phase]}


def _choices(model: DeviceFunctions, table: Table) -> dict[str, str]:
    return {row.name: getattr(model.words[row.name], "name", model.words[row.name]) for row in table.choices}


def _check(
    limit: Constraint, values: dict[str, float], table: Table, open_values: Mapping[str, tuple[float, float]]
) -> ConstraintCheck:
    value = values[limit.output]
    ends = open_values.get(limit.output, (value, value))
    residual = limit.residual(value)
    return ConstraintCheck(
        text=constraints.in_words(limit, table), output=limit.output, value=value, margin=-float(residual),
        scale=limit.scale, absolute=limit.absolute, met=is_met(limit, value, table),
        worst=-max(float(limit.residual(end)) for end in ends), origin=limit.origin,
        part_of=limit.part_of,
    )  # fmt: skip


def _plain(solution: Solution | None) -> dict[str, Any]:
    """Return the account as plain data, SI, without the parts that differ from run to run."""
    if solution is None:
        return {}
    return {
        "objective": solution.objective,
        "reference": solution.reference,
        "distinct_optima": [start.number for start in solution.distinct_optima()],
        "starts": [{k: v for k, v in asdict(start).items() if k != "seconds"} for start in solution.starts],
        "active_constraints": [asdict(held) for held in solution.held],
    }
