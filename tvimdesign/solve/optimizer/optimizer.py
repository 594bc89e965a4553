"""One study with its records chosen: the problem and its solvers, built once, run from any start."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.errors import InfeasibleError
from tvimdesign.base.interrupts import raise_pending
from tvimdesign.device import Input
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.current_profile import ramp_time
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.nlp.constraints import ALGEBRAIC_TOLERANCE, Constraint, constraints_of, on_cycle, unchangeable
from tvimdesign.solve.nlp.decision_vector import DecisionVector
from tvimdesign.solve.nlp.derivatives import Known
from tvimdesign.solve.nlp.ipopt import NLP, TIME_OVER, Beginning, Solver, solver_of
from tvimdesign.solve.nlp.mixture import MixedDevice, Mixture
from tvimdesign.solve.nlp.objective import Objective
from tvimdesign.solve.nlp.problem import Free, FreeCurrent, Problem
from tvimdesign.solve.nlp.solution import Start
from tvimdesign.solve.nlp.solver_run import Array, Derivatives, Ends, Progress, Run, Trace
from tvimdesign.solve.nlp.transcription import ORDER
from tvimdesign.solve.optimizer.multistart import Multistart
from tvimdesign.study import ProfileOptions, Range, Study, given

RAMP_ELEMENT = 15.0  # s, the longest element of a ramp, in which the current changes fastest


class Optimizer:
    """One study with its records chosen: the problem and its solvers, built once."""

    def __init__(
        self,
        study: Study,
        reference: dict[str, float] | None = None,
        progress: Progress = lambda _: None,
        simulator: Simulator | None = None,
        objectives: Sequence[str] = (),
        *,
        without_cycle: bool = False,
        deadline: Deadline | None = None,
        mixtures: Sequence[Mixture] = (),
    ) -> None:
        """Compile the device, simulate the study's start, and build the problem.

        `reference` are the values the minimised outputs are divided by: the study's start unless given. A `simulator`
        of the same device saves compiling it again. Outputs among the `objectives` can be weighed and bounded by an
        `Objective` whether the study minimises them or not. `without_cycle` leaves out the limits that depend on a
        working cycle, so that none is simulated. Runs end at the `deadline`, the study's time limit from now on unless
        given. Records in `mixtures` are free, too, by their shares. Raises InfeasibleError where a limit is broken that
        nothing free can mend, InputError from the table.
        """
        self.study, self.table, self.progress = study, study.table, progress
        self.deadline = deadline or Deadline(study.solver.time_limit)
        began = time.perf_counter()
        self.mixtures = tuple(mixtures)
        self.simulator = simulator or Simulator(self._device())
        self.model = self.simulator.model
        self.currents = tuple(self._current(phase, pieces) for phase, pieces in study.profile.pieces().items())
        rows = {current.row for current in self.currents}
        numbers = [name for name in study.vary if isinstance(self.table.quantity(name), Input) and name not in rows]
        self.free = tuple(self._free(name) for name in numbers)
        self.free += tuple(Free(name, 0.0, 1.0, 1.0) for mixture in self.mixtures for name in mixture.shares)
        self.margins: dict[str, float] = {}
        """By limit, how far within it to stay [shares of its scale]: what is robust and no part of the problem."""
        limits = constraints_of(study, self.table, self.model.words)
        if without_cycle:
            limits = [limit for limit in limits if not on_cycle(self.table, limit.output)]
        self.problem = self._problem(self.kept_constraints(limits), objectives, study.solver.elements)
        self._begin()
        self.reference = {name: self._reference(name) for name in self.problem.minimize} | (reference or {})
        self._solvers: dict[Beginning, Solver] = {}
        self.points: Known = {}
        """What is known of the derivatives of the functions that problems of this device call."""
        self._grids: dict[tuple[int, int], Optimizer] = {}
        """This problem with other counts and orders of elements, once they are built."""
        self.seconds = {"set_up": time.perf_counter() - began, "solve": 0.0}

    def _device(self) -> DeviceFunctions:
        study = self.study
        known = (self.table, given(study), tuple(study.operating_points), study.solver.cells)
        return MixedDevice(*known, self.mixtures) if self.mixtures else DeviceFunctions(*known)

    def with_constant_currents(self) -> Optimizer | None:
        """The same problem with currents that do not change over a phase; None where they do not anyway."""
        if not self.currents:
            return None
        study = self.study.model_copy(update={"profile": ProfileOptions()})
        return Optimizer(
            study, self.reference, self.progress, self.simulator, deadline=self.deadline, mixtures=self.mixtures
        )

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
        ramp_elements = math.ceil(ramp_time(vary.upper, slew) / RAMP_ELEMENT)
        return FreeCurrent(phase, row, pieces, vary.lower, vary.upper, ramp_elements)

    def with_records(self, study: Study) -> Optimizer | None:
        """The same problem for a study that differs in its records alone, where their numbers are all that counts.

        Nothing is built: such numbers are parameters. None where a row reads a table of a record that differs, or an
        option. Raises InfeasibleError as a new one does.
        """
        numbers = given(study)
        read = {need for row in self.table.outputs for need in row.needs}
        model = copy(self.model)
        model.words = {name: numbers[name] for name in self.model.words}
        if any(model.words[name] != word for name, word in self.model.words.items() if name in read):
            return None
        model.start = np.array([float(numbers[name]) for name in model.names])
        other = copy(self)
        other.study, other.model = study, model
        other.seconds = {"set_up": 0.0, "solve": 0.0}
        other.kept_constraints(constraints_of(study, self.table, model.words))
        other._begin()
        return other

    def on_grid(self, elements: int, order: int) -> Optimizer:
        """The same problem with so many elements of time of an order, built once for all that differ in their records
        alone."""
        if (elements, order) not in self._grids:
            first = copy(self)
            first.__dict__.pop("_compiled", None)
            first.problem = self._problem(list(self.problem.limits), self.problem.objectives, elements, order)
            first._solvers = {}
            self._grids[elements, order] = first
        other = copy(self._grids[elements, order])
        other.study, other.model, other.multistart = self.study, self.model, self.multistart
        other.seconds, other.start_values, other.margins = self.seconds, self.start_values, self.margins
        other.vector = DecisionVector(other.problem, self.model)
        return other

    def _problem(self, kept: list[Constraint], objectives: Sequence[str], elements: int, order: int = ORDER) -> Problem:
        back_offs = None
        if self.study.robust and self.study.robust.sigma is not None:
            from tvimdesign.solve.nlp.back_off import back_offs_of

            back_offs = back_offs_of(self.model, self.study, kept)
        return Problem(
            self.model, self.free, kept, tuple(self.study.minimize), elements, self.currents, objectives, back_offs,
            self.mixtures, order,
        )  # fmt: skip

    def kept_constraints(self, limits: list[Constraint]) -> list[Constraint]:
        """The limits without those that nothing free can change, which are checked here and now."""
        constant = self._constant(limits)
        without_switch = dict.fromkeys(self.model.switch_names, np.inf)
        values = self.model.some_values([limit.output for limit in constant], self.model.start, without_switch)
        broken = [one for one in constant if not one.residual(values[one.output]) <= ALGEBRAIC_TOLERANCE]
        if broken:
            told = [unchangeable(limit, self.table, values[limit.output], self.study) for limit in broken]
            raise InfeasibleError("\n  ".join(told))
        return [limit for limit in limits if limit not in constant]

    def _constant(self, limits: list[Constraint]) -> list[Constraint]:
        """The limits that nothing free can change: by the table, or with these records and options."""
        free = [*(f.name for f in self.free), *(current.row for current in self.currents)]
        outputs = list(dict.fromkeys(limit.output for limit in limits if not on_cycle(self.table, limit.output)))
        rows, columns = self.model.outputs(outputs).jac_sparsity(0, 0).get_triplet()
        places = {self.model.index[name] for name in free}
        moved = {outputs[row] for row, column in zip(rows, columns, strict=True) if column in places}
        return [limit for limit in limits if limit.output in outputs and limit.output not in moved]

    def _begin(self) -> None:
        """What knows the numbers of the records: where to begin, and how the vector of unknowns is read."""
        asked = self.study.solver
        self.multistart = Multistart(
            self.problem, self.model, self.simulator, asked, self.progress, self.deadline
        )  # fmt: skip
        self.vector = DecisionVector(self.problem, self.model)
        cycle = self.multistart.cycle.values
        self.start_values = self.model.some_values(self.problem.minimize, self.model.start, cycle)
        """What is minimised, at the study's start."""

    def guess(self, inputs: Array) -> Array:
        """The unknowns at a point, with the switch simulated there; with the start's where that does not end.

        Nothing is simulated where a body takes no heat: CVODES needs seconds to give that up. A link that corrects
        another one may be below zero and counts as such a body, so that most modules with a structure begin with the
        start's switch. Simulated there, three of 21 studies ended in worse optima (`ankle` 1.4 %) and none in a better.
        """
        return (self.simulated_guess if self.multistart.heats(inputs) else self.first_guess)(inputs)

    def simulated_guess(self, inputs: Array) -> Array:
        """The same, simulated whatever there takes heat."""
        return self.vector.at(inputs, self.multistart.trial(inputs) or self.multistart.cycle)

    def first_guess(self, inputs: Array) -> Array:
        """The unknowns at a point, with the switch simulated at the study's start."""
        return self.vector.at(inputs, self.multistart.cycle)

    def _reference(self, name: str) -> float:
        value = self.start_values[name]
        if not np.isfinite(value):
            horizon = self.model.start[self.model.index["horizon"]]
            self.progress(f"{name} is not reached by the study's own start within {horizon:g} s")
            return float(horizon)
        return value if value != 0.0 else 1.0

    @cached_property
    def _compiled(self) -> Any:
        """The problem as one function."""
        written = self.problem.function
        return ca.Function("problem", [written["x"], written["p"]], [written["f"], written["g"]], *NLP)

    def _solver(self, beginning: Beginning) -> Solver:
        """The solver, built when it is first needed."""
        if beginning not in self._solvers:
            known, asked = self._solvers.values(), self.study.solver
            self._solvers[beginning] = solver_of(
                self._compiled, asked, known, beginning, points=self.points, of_parameters=not self.mixtures
            )
        return self._solvers[beginning]

    def solve(
        self,
        within: Mapping[str, Ends] | None = None,
        warm: Run | Trace | None = None,
        begin: Array | None = None,
        objective: Objective | None = None,
        unknowns: Array | None = None,
        *,
        beginning: Beginning | None = None,
    ) -> Run:
        """Run IPOPT once from `begin` (the study's start), or warm from an earlier run, with some numbers kept `within`
        ends of their own.

        `unknowns` stand in place of the switch simulated at `begin`; `beginning` says what is neither cold nor warm.
        An `objective` stands in place of the study's weights and bounds what is traded; nothing is built anew. Raises
        KeyboardInterrupt where an interrupt came, also one that CasADi has swallowed. The run ends at the deadline; one
        that refines a coarse optimum, which would be lost otherwise, at that of the whole command.
        """
        raise_pending()
        inputs = self.model.start if begin is None else begin
        clock = time.perf_counter()
        deadline = self.deadline.whole if beginning == "refined" else self.deadline
        if warm is not None:
            unknowns = warm.unknowns
        beginning = beginning or ("cold" if warm is None else "warm")
        takes = 0.0 if self._solvers else self.seconds["set_up"]  # building a solver takes about as long
        if deadline.remaining <= takes:
            self.deadline.met = True
            return self._not_begun(inputs, unknowns, within or {})
        solver = self._solver(beginning)
        arguments: dict[str, Any] = {"x0": self.guess(inputs) if unknowns is None else unknowns}
        if warm is not None:
            arguments |= {"lam_g0": warm.multipliers, "lam_x0": warm.bound_multipliers}
        objective = objective or Objective(self.study.minimize)
        answer = solver(deadline, **arguments, p=self.parameters(objective), **self.ends(within or {}, objective))
        seconds = time.perf_counter() - clock
        self.seconds["solve"] += seconds
        run = self.record(answer, solver.stats(), inputs, seconds)
        return replace(run, within=within or {})

    def _not_begun(self, inputs: Array, unknowns: Array | None, within: Mapping[str, Ends]) -> Run:
        """Return a run that ended where it was to start, as the time was over: nothing is simulated or built."""
        x = self.first_guess(inputs) if unknowns is None else unknowns
        p = self.parameters(Objective(self.study.minimize))
        value, rows = self._compiled(x, p)
        answer = {"x": x, "f": value} | {
            name: np.zeros(len(like)) for name, like in (("lam_g", np.asarray(rows)), ("lam_x", x), ("lam_p", p))
        }
        stats = {"return_status": TIME_OVER, "success": False, "iter_count": 0}
        return replace(self.record(answer, stats, inputs, 0.0), within=within)

    def ends(self, within: Mapping[str, Ends], objective: Objective) -> dict[str, Array]:
        """Ends of the unknowns and of the rows for one run, as nlpsol names them."""
        lower, upper = self.vector.bounds(within)
        equations = np.zeros(self.problem.equation_count)
        room, rest = (
            objective.room(self.problem.objectives),
            np.zeros(self.problem.slope_count + self.problem.peak_count),
        )
        most = np.concatenate([self._limits_less_margins(), room, rest])
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

    def record(self, answer: Mapping[str, Any], stats: Mapping[str, Any], inputs: Array, seconds: float) -> Run:
        """What a solver left behind that was run from some inputs; raises KeyboardInterrupt where one reached it.

        CasADi takes an interrupt that comes while it evaluates a function for a failure of that.
        """
        raise_pending()
        if stats["return_status"] == "User_Requested_Stop":
            raise KeyboardInterrupt
        unknowns = np.asarray(answer["x"]).ravel()
        end = self.vector.inputs(unknowns)
        start = Start(
            number=0, status=stats["return_status"], converged=bool(stats["success"]),
            iterations=int(stats["iter_count"]), objective=float(answer["f"]), seconds=seconds,
            begin=self.vector.free_values(inputs), end=self.vector.free_values(end),
        )  # fmt: skip
        current_profiles = self.vector.current_profiles(unknowns)
        multipliers, of_bounds, of_parameters = (
            np.asarray(answer[name]).ravel() for name in ("lam_g", "lam_x", "lam_p")
        )
        times = self.vector.times(unknowns)
        ends = {phase.name: times[phase.ends] for phase in self.table.phases if phase.ends in times}
        return Run(start, end, current_profiles, ends, unknowns, multipliers, of_bounds, of_parameters)

    def _limits_less_margins(self) -> Array:
        """What the limits' residuals may come to: zero, or so far within as their margins say."""
        return -np.array([self.margins.get(limit.name, 0.0) for limit in self.problem.limits])

    def parameters(self, objective: Objective) -> Array:
        """The problem's parameters: the study's inputs, weights over the references, factors of what is traded."""
        over = [objective.weights.get(name, 0.0) / self.reference[name] for name in self.problem.minimize]
        return np.concatenate([self.model.start, over, objective.factors(self.problem.objectives).ravel(order="F")])

    def derivatives(self, run: Run) -> Derivatives:
        """The problem's values and derivatives where a run of the study's own objective ended.

        IPOPT's own functions are used again; a weight on one output alone makes the objective's gradient that output's.
        """
        solver = self._solver("cold")
        parameters = self.parameters(Objective(self.study.minimize))
        rows, jacobian = solver.get_function("nlp_jac_g")(run.unknowns, parameters)
        hessian = solver.get_function("nlp_hess_l")(run.unknowns, parameters, 1.0, run.multipliers)
        values, gradients = {}, {}
        for name in self.study.minimize:
            alone = self.parameters(Objective({name: self.reference[name]}))
            value, gradient = solver.get_function("nlp_grad_f")(run.unknowns, alone)
            values[name], gradients[name] = float(value), np.asarray(gradient).ravel()
        found = np.asarray(rows).ravel()
        # A limit that is to be kept by a margin is held where that is used up.
        found[self.problem.equation_count :][: len(self.problem.limits)] -= self._limits_less_margins()
        return Derivatives(found, jacobian, ca.triu2symm(hessian), values, gradients)
