"""One study with its records chosen: the problem and its solvers, built once, run from any start."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.errors import InfeasibleError
from tvimdesign.base.interrupts import raise_pending
from tvimdesign.device import Input
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.nlp.constraints import ALGEBRAIC_TOLERANCE, Constraint, constraints_of, on_cycle, unchangeable
from tvimdesign.solve.nlp.decision_vector import DecisionVector, ExtendedProblem
from tvimdesign.solve.nlp.mixture import MixedDevice, Mixture
from tvimdesign.solve.nlp.problem import Problem
from tvimdesign.solve.nlp.problem_parts import Free, FreeCurrent, Objective, Parameters
from tvimdesign.solve.nlp.solution import EasedRequirement, Start
from tvimdesign.solve.nlp.solver_run import NO_DESIGN, SOLVED, TIME_OVER, Array, Derivatives, Ends, Progress, Run, Trace
from tvimdesign.solve.nlp.sqp import MOST_ITERATIONS, SqpSolver
from tvimdesign.solve.nlp.trust_region import TrustRegion
from tvimdesign.solve.optimizer.multistart import Multistart
from tvimdesign.study import ProfileOptions, Range, Study, given

SETTLED = 1e-6
"""Change of the objective or of an active row below which an optimum stays where steps are placed anew."""
_ACTIVE = 1e-4  # Distance from its limit below which a row counts as active there
MOST_GRIDS = 4  # Times the steps are placed anew for one run
_BESIDE, _TRIALS = (0.1, 0.3, 1.0), 10
"""How far beside a module whose switch never ends others are tried, as a share of the ranges, and how many each."""
_WORTH = 10.0
"""Worth of the whole of a step of the margins, in what is minimised over its reference; no design is dearer."""
_APART = 1e-4  # Step of an unknown in the differences that second derivatives come from


class Optimizer:
    """One study with its records chosen: the problem and its solvers, built once."""

    def __init__(
        self,
        study: Study,
        reference: dict[str, float] | None = None,
        progress: Progress = lambda _: None,
        objectives: Sequence[str] = (),
        *,
        without_cycle: bool = False,
        deadline: Deadline | None = None,
        mixtures: Sequence[Mixture] = (),
    ) -> None:
        """Compile the device, simulate the study's start, and build the problem.

        `reference` are the values the minimised outputs are divided by: the study's start unless given. Outputs among
        the `objectives` can be weighed and bounded by an `Objective` whether the study minimises them or not.
        `without_cycle` leaves out the limits that depend on a working cycle, so that none is simulated. Runs end at the
        `deadline`, the study's time limit from now on unless given. Records in `mixtures` are free, too, by their
        shares. Raises InfeasibleError where a limit is violated that nothing free can cure, InputError from the table.
        """
        self.study, self.table, self.progress = study, study.table, progress
        self.deadline = deadline or Deadline(study.solver.time_limit)
        began = time.perf_counter()
        self.mixtures = tuple(mixtures)
        self.simulator = Simulator(self._device())
        self.model = self.simulator.model
        self.currents = tuple(self._current(phase, pieces) for phase, pieces in study.profile.pieces().items())
        rows = {current.row for current in self.currents}
        numbers = [name for name in study.vary if isinstance(self.table.quantity(name), Input) and name not in rows]
        self.free = tuple(self._free(name) for name in numbers)
        self.free += tuple(Free(name, 0.0, 1.0, 1.0) for mixture in self.mixtures for name in mixture.shares)
        self.margins: dict[str, float] = {}
        """By limit, how far within it to stay [shares of its scale]: what is robust and no part of the problem."""
        self.floors: dict[str, float] = {}
        """By limit, the margin below which the search for a yield gives none back."""
        self.eased: EasedRequirement | None = None  # What keeps the design from a yield, once that is known
        limits = constraints_of(study, self.table, self.model.words)
        if without_cycle:
            limits = [limit for limit in limits if not on_cycle(self.table, limit.output)]
        self.problem = self._problem(self.kept_constraints(limits), objectives)
        self._begin()
        self.reference = {name: self._reference(name) for name in self.problem.minimize} | (reference or {})
        self._solvers: dict[tuple[bool, int], SqpSolver] = {}
        self.seconds = {"set_up": time.perf_counter() - began, "solve": 0.0}

    def _device(self) -> DeviceFunctions:
        study = self.study
        known = (self.table, given(study), tuple(study.operating_points), study.solver.cells)
        return MixedDevice(*known, self.mixtures) if self.mixtures else DeviceFunctions(*known)

    def with_constant_currents(self) -> Optimizer | None:
        """Return the problem with currents constant over a phase; None if they already are."""
        if not self.currents:
            return None
        study = self.study.model_copy(update={"profile": ProfileOptions()})
        return Optimizer(study, self.reference, self.progress, deadline=self.deadline, mixtures=self.mixtures)

    def _free(self, name: str) -> Free:
        vary = self.study.vary[name]
        reference = self.model.start[self.model.index[name]]
        if isinstance(vary, Range):
            lower, upper = vary.lower, vary.upper
        else:
            numbers = [float(value) for value in vary.values]
            lower, upper = min(numbers), max(numbers)
        return Free(name, lower, upper, reference if reference != 0.0 else upper)

    def _current(self, phase: str, pieces: int) -> FreeCurrent:
        row = self.table.phase(phase).current_input
        vary = self.study.vary[row]
        assert isinstance(vary, Range)  # the reader sees to that
        slew = float(self.model.start[self.model.index["current_slew"]])
        return FreeCurrent(phase, row, pieces, vary.lower, vary.upper, slew)

    def _problem(self, limits: list[Constraint], objectives: Sequence[str]) -> Problem:
        return Problem(
            self.model, self.free, limits, tuple(self.study.minimize), self.currents, objectives, self.mixtures,
            self.study.solver.fineness,
        )  # fmt: skip

    def kept_constraints(self, limits: list[Constraint]) -> list[Constraint]:
        """Return the limits without those that no free number changes; check those now."""
        constant = self._constant(limits)
        without_switch = dict.fromkeys(self.model.switch_names, np.inf)
        values = self.model.some_values([limit.output for limit in constant], self.model.start, without_switch)
        broken = [limit for limit in constant if not limit.residual(values[limit.output]) <= ALGEBRAIC_TOLERANCE]
        if broken:
            messages = [unchangeable(limit, self.table, values[limit.output], self.study) for limit in broken]
            raise InfeasibleError("\n  ".join(messages))
        return [limit for limit in limits if limit not in constant]

    def _constant(self, limits: list[Constraint]) -> list[Constraint]:
        """Return the limits that no free number changes, by the table or with these records and options."""
        free = {*(f.name for f in self.free), *(current.row for current in self.currents)}
        outputs = list(dict.fromkeys(limit.output for limit in limits if not on_cycle(self.table, limit.output)))
        moved = {output for output, name in self.model.dependence(outputs) if name in free}
        return [limit for limit in limits if limit.output in outputs and limit.output not in moved]

    def _begin(self) -> None:
        """Build the parts that know the records' numbers: where to start, and how to read the vector of unknowns."""
        options = self.study.solver
        self.multistart = Multistart(self.problem, self.model, options, self.progress, self.deadline)
        self.vector = DecisionVector(self.problem, self.model)
        cycle = self.multistart.cycle
        self.start_values = self.model.some_values(self.problem.minimize, self.model.start, cycle)
        """What is minimised, at the study's start."""

    def guess(self, inputs: Array) -> Array:
        """Return the unknowns at a design; with the start's times if its switch does not end."""
        cycle = self.multistart.trial(inputs) if self.currents else None
        return self.vector.at(inputs, cycle or self.multistart.cycle)

    def _reference(self, name: str) -> float:
        value = self.start_values[name]
        if not np.isfinite(value):
            horizon = self.model.start[self.model.index["horizon"]]
            self.progress(f"{name} is not reached by the study's own start within {horizon:g} s")
            return float(horizon)
        return value if value != 0.0 else 1.0

    def solver(self, unknowns: int, *, feasible: bool = False) -> SqpSolver:
        """Return the solver for programmes of so many unknowns and the problem's rows; see `SqpSolver`."""
        key = (feasible, unknowns)
        if key not in self._solvers:
            options, sizes = self.study.solver, (self.problem.row_count, self.problem.equation_count)
            most = min(options.max_iterations, MOST_ITERATIONS)
            self._solvers[key] = SqpSolver(unknowns, *sizes, options.tolerance, most, feasible=feasible)
        return self._solvers[key]

    def solve(
        self,
        within: Mapping[str, Ends] | None = None,
        warm: Run | Trace | None = None,
        begin: Array | None = None,
        objective: Objective | None = None,
        unknowns: Array | None = None,
        *,
        near: bool = False,
        feasible: bool = False,
        moves: Mapping[str, float] | None = None,
    ) -> Run:
        """Search from `begin` (the study's start), from `unknowns`, or warm from where an earlier run ended, with some
        numbers kept `within` ends of their own.

        A warm run, or one `near` an optimum, may fail soon; a `feasible` one ends where all limits are met. An
        `objective` stands in place of the study's weights and bounds what is traded. As large a share of `moves` as a
        design bears, all of them if possible, is added to the margins. Steps in time are placed where the run begins,
        and anew where it ends, until that moves the optimum no more. Raises KeyboardInterrupt where an interrupt came,
        also one that CasADi has swallowed. The run ends at the deadline.
        """
        raise_pending()
        inputs = self.model.start if begin is None else begin
        clock = time.perf_counter()
        if warm is not None:
            unknowns, near = warm.unknowns, True
        x = self.guess(inputs) if unknowns is None else unknowns
        objective = objective or Objective(self.study.minimize)
        parameters = self.parameters(objective)
        if self.deadline.remaining <= 0.0:
            self.deadline.met = True
            return replace(self._not_started(x, inputs, parameters), within=within or {})
        ends, count = self.ends(within or {}, objective), len(x)
        if not len(x):
            answer, stats = self._checked(x, parameters, ends["ubg"])
            return self.record(answer, stats, inputs, time.perf_counter() - clock, parameters)
        x = self._where_it_ends(x, parameters, ends)
        programme = ExtendedProblem(self.problem, parameters)
        if moves is not None:
            steps = np.array([[moves.get(limit.name, 0.0)] for limit in self.problem.limits])
            programme = ExtendedProblem(self.problem, parameters, steps, np.array([-_WORTH]))
            ends |= {"lbx": np.append(ends["lbx"], 0.0), "ubx": np.append(ends["ubx"], 1.0)}
            x = np.append(x, 0.0)
        iterations, solver = 0, self.solver(programme.unknown_count, feasible=feasible)
        region = None if self.currents else TrustRegion(programme, solver, self.deadline, ends)
        for _ in range(MOST_GRIDS):
            grids = self.problem.grids
            modelled = region.solve(x, near=near) if region else None
            if modelled is None:  # there are no models, or they lead nowhere
                x, iterations = (region.reached, iterations + region.iterations) if region else (x, iterations)
                modelled = solver(programme, self.deadline, x0=x, **ends), solver.stats()
            answer, stats = modelled
            iterations += int(stats["iter_count"])
            x, near = answer["x"], True
            if not stats["success"] or not self.problem.events or self._settled(programme, x, ends["ubg"]):
                break
        seconds = time.perf_counter() - clock
        self.seconds["solve"] += seconds
        self.problem.grids = grids
        if moves is not None:
            names = {**self.margins, **moves}
            self.margins = {name: self.margins.get(name, 0.0) + x[-1] * moves.get(name, 0.0) for name in names}
            own = self.problem.at(x[:count], parameters).objective
            answer = {**answer, "x": x[:count], "lam_x": answer["lam_x"][:count], "f": own}
        run = self.record(answer, {**stats, "iter_count": iterations}, inputs, seconds, parameters)
        return replace(run, within=within or {})

    def _where_it_ends(self, x: Array, parameters: Parameters, ends: Mapping[str, Array]) -> Array:
        """Return the unknowns with steps placed there; where a switch never ends, those of a module beside whose does.

        An event that never comes has no derivatives for a search to begin with.
        """
        self.problem.place_grids(x, parameters)
        if self.mixtures or not self._never_ends(x, parameters):
            return x
        count, random = len(self.free), np.random.default_rng(self.study.solver.seed)
        lower, upper = ends["lbx"][:count], ends["ubx"][:count]
        for share in np.repeat(_BESIDE, _TRIALS):
            moved = x.copy()
            moved[:count] += share * (lower + random.random(count) * (upper - lower) - x[:count])
            if self.multistart.trial(self.vector.inputs(moved)) is not None:
                self.problem.place_grids(moved, parameters)
                return moved
        return x

    def _never_ends(self, x: Array, parameters: Parameters) -> bool:
        """Return whether the module exists and its switch never ends."""
        point = self.problem.at(x, parameters)
        values = (value for name, value in point.values.items() if not on_cycle(self.table, name))
        return any(np.isinf(time) for time in point.times.values()) and bool(np.all(np.isfinite(list(values))))

    def _settled(self, programme: ExtendedProblem, x: Array, most: Array) -> bool:
        """Return whether new steps at an optimum leave it and its active rows, which are at `most`, where they are."""
        before = programme.at(x)
        self.problem.place_grids(x[: self.problem.unknown_count], programme.parameters)
        after = programme.at(x)
        moved = np.abs(after.rows - before.rows)[np.fmax(before.rows, after.rows) > most - _ACTIVE]
        return bool(np.max(np.append(moved, abs(after.objective / (before.objective or 1.0) - 1.0))) < SETTLED)

    def _checked(self, x: Array, parameters: Parameters, most: Array) -> tuple[dict[str, Any], dict[str, Any]]:
        """Return the answer of a solver if nothing is free: whether the rows are within their bounds."""
        self.problem.place_grids(x, parameters)
        point = self.problem.at(x, parameters)
        good = bool(np.all(point.rows <= most + self.study.solver.tolerance))
        answer = {"x": x, "f": point.objective, "lam_g": np.zeros(len(point.rows)), "lam_x": np.zeros(0)}
        return answer, {"return_status": SOLVED if good else NO_DESIGN, "success": good, "iter_count": 0}

    def _not_started(self, x: Array, inputs: Array, parameters: Parameters) -> Run:
        """Return a run that ended where it was to start, as the time was over."""
        point = self.problem.at(x, parameters)
        answer = {"x": x, "f": point.objective, "lam_g": np.zeros(len(point.rows)), "lam_x": np.zeros(len(x))}
        stats = {"return_status": TIME_OVER, "success": False, "iter_count": 0}
        return self.record(answer, stats, inputs, 0.0, parameters)

    def ends(self, within: Mapping[str, Ends], objective: Objective) -> dict[str, Array]:
        """Ends of the unknowns and of the rows for one run, as nlpsol names them."""
        lower, upper = self.vector.bounds(within)
        equations = np.zeros(self.problem.equation_count)
        room, own = objective.room(self.problem.objectives), np.zeros(self.problem.own_count)
        most = np.concatenate([self.limits_less_margins(), room, own])
        least, largest = self.with_room_where_decided(equations, within)
        return {
            "lbx": lower, "ubx": upper,
            "lbg": np.concatenate([least, np.full(len(most), -np.inf)]), "ubg": np.concatenate([largest, most]),
        }  # fmt: skip

    def with_room_where_decided(self, equations: Array, within: Mapping[str, Ends]) -> tuple[Array, Array]:
        """Ends of the equations: the sum of shares that are all fixed adds up to one, and needs no equation."""
        least, largest = equations.copy(), equations.copy()
        for place, mixture in enumerate(self.mixtures, start=len(equations) - len(self.mixtures)):
            ends = [within.get(name, (0.0, 1.0)) for name in mixture.shares]
            if all(low == high for low, high in ends):
                least[place], largest[place] = -1.0, 1.0
        return least, largest

    def record(
        self, answer: Mapping[str, Any], stats: Mapping[str, Any], inputs: Array, seconds: float, parameters: Parameters
    ) -> Run:
        """Return the solver's result from some inputs. Raise KeyboardInterrupt if one arrived.

        CasADi takes an interrupt that comes while it evaluates a function for a failure of that.
        """
        raise_pending()
        unknowns = np.asarray(answer["x"]).ravel()
        end = self.vector.inputs(unknowns)
        start = Start(
            number=0, status=stats["return_status"], converged=bool(stats["success"]),
            iterations=int(stats["iter_count"]), objective=float(answer["f"]), seconds=seconds,
            begin=self.vector.free_values(inputs), end=self.vector.free_values(end),
        )  # fmt: skip
        current_profiles = self.vector.current_profiles(unknowns)
        multipliers, of_bounds = (np.asarray(answer[name]).ravel() for name in ("lam_g", "lam_x"))
        times = self.problem.at(unknowns, parameters).times
        ends = {phase.name: times[phase.ends] for phase in self.table.phases if phase.ends in times}
        grids = self.problem.grids
        return Run(start, end, current_profiles, ends, unknowns, multipliers, of_bounds, times, grids=grids)

    def limits_less_margins(self) -> Array:
        """Return the bounds on the limits' residuals: zero, or less by their margins."""
        return -np.array([self.margins.get(limit.name, 0.0) for limit in self.problem.limits])

    def parameters(self, objective: Objective) -> Parameters:
        """Return the problem's parameters: the study's inputs, weights over references, factors of a trade-off."""
        over = [objective.weights.get(name, 0.0) / self.reference[name] for name in self.problem.minimize]
        return Parameters(self.model.start, np.array(over), objective.factors(self.problem.objectives))

    def derivatives(self, run: Run) -> Derivatives:
        """Return the problem's values and derivatives at the end of a run of the study's own objective.

        Second derivatives of the Lagrangian are differences of its gradients.
        """
        parameters, x = self.parameters(Objective(self.study.minimize)), run.unknowns
        self.problem.grids = run.grids  # multipliers are those of an optimum with these steps
        here = self.problem.at(x, parameters)
        lower, upper = self.vector.bounds(run.within)

        def gradient(place: int, step: float) -> Array:
            there = x.copy()
            there[place] += step
            point = self.problem.at(there, parameters)
            return np.asarray(point.gradient + run.multipliers @ point.jacobian)

        hessian = np.zeros((len(x), len(x)))
        for i in np.flatnonzero(lower < upper).tolist():
            hessian[i] = (gradient(i, _APART) - gradient(i, -_APART)) / (2.0 * _APART)
        rows = here.rows.copy()
        # A limit that is to be met with a margin is active where that is used up.
        rows[self.problem.equation_count :][: len(self.problem.limits)] -= self.limits_less_margins()
        names = self.study.minimize
        values, gradients = {name: here.values[name] for name in names}, {name: here.gradients[name] for name in names}
        return Derivatives(rows, here.jacobian, 0.5 * (hessian + hessian.T), values, gradients)
