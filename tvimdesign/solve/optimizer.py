"""One study with its records chosen: the problem and its solvers, built once, run from any start."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.catalog import Catalog
from tvimdesign.device import Input, Path, Table
from tvimdesign.errors import InfeasibleError, SimulationError
from tvimdesign.solve.backend import ca
from tvimdesign.solve.drive import Drive, ramp_time
from tvimdesign.solve.goal import Goal
from tvimdesign.solve.limits import Limit, impossible, in_words, is_constant, limits_of, on_switch
from tvimdesign.solve.model import Model
from tvimdesign.solve.problem import Free, FreeCurrent, Problem
from tvimdesign.solve.simulate import Simulator, Switch, Trajectory
from tvimdesign.solve.solution import Start
from tvimdesign.solve.stage_model import StageModel
from tvimdesign.solve.transcription import guess
from tvimdesign.study import ProfileOptions, Range, Study, given

Array = NDArray[np.float64]
Progress = Callable[[str], None]

ALGEBRAIC_TOLERANCE = 1e-6
"""Share of its scale by which a limit on an algebraic row may be broken: IPOPT's own tolerance with a margin."""
RAMP_ELEMENT = 15.0  # s, the longest element of a ramp: as long as those of a switch of two minutes
SHORTEST = 0.1  # s; with a slow supply all of a stage may be its ramp, and the pieces after it next to nothing
MAX_DRAWS = 100
EXPAND_FROM = 4
"""Runs from which on it pays to expand the problem to scalar operations: slower to build, four times faster to run."""

_IPOPT = {
    "print_level": 0,
    "sb": "yes",
    "linear_solver": "mumps",
    # With MUMPS's usual 1e-6 the pivots of a freezing layer are too small: it miscounts negative eigenvalues, and IPOPT
    # answers with tiny steps.
    "mumps_pivtol": 1e-2,
    "mu_init": 1e-3,
    # The bounds of a study are exact: IPOPT's usual relaxation of 1e-8 stays, and the point is put back inside.
    "honor_original_bounds": "yes",
}
_WARM = {
    "warm_start_init_point": "yes",
    "mu_init": 1e-7,
    "warm_start_bound_push": 1e-6,
    "warm_start_mult_bound_push": 1e-6,
    "warm_start_slack_bound_push": 1e-6,
}


@dataclass
class Run:
    """What IPOPT left behind at one start."""

    start: Start
    inputs: Array
    drives: dict[str, Drive]
    """The free currents by stage."""
    ends: dict[str, float]
    """Time [s] each stage takes that the problem has."""
    unknowns: Array
    multipliers: Array
    bound_multipliers: Array
    parameter_multipliers: Array
    """What the objective falls with every parameter of the problem, per unit."""


@dataclass(frozen=True)
class Derivatives:
    """The problem where a run ended: its constraints' values, and exact first and second derivatives."""

    rows: Array
    jacobian: Any
    """DM, of the constraints by the unknowns."""
    hessian: Any
    """DM, of the Lagrangian, both triangles."""
    values: dict[str, float]
    """The minimised outputs, as collocation has them."""
    gradients: dict[str, Array]
    """Of the minimised outputs by the unknowns."""


class Optimizer:
    """One study with its records chosen: the problem and its solvers, built once."""

    def __init__(
        self,
        study: Study,
        catalog: Catalog,
        table: Table,
        runs: int,
        reference: dict[str, float] | None = None,
        progress: Progress = lambda _: None,
        simulator: Simulator | None = None,
    ) -> None:
        """Compile the device, simulate the study's start, and build the problem for about `runs` runs.

        `reference` are the values the minimised outputs are divided by: the study's start unless given. A `simulator`
        of the same device saves compiling it again. Raises InfeasibleError where a limit is broken that nothing free
        can mend, InputError from the table.
        """
        self.many = runs >= EXPAND_FROM
        self.study, self.catalog, self.table, self.progress = study, catalog, table, progress
        began = time.perf_counter()
        points = tuple(study.operating_points)
        self.simulator = simulator or Simulator(Model(table, given(study, catalog, table), points, study.solver.cells))
        self.model = self.simulator.model
        self.currents = tuple(self._current(stage, pieces) for stage, pieces in study.profile.pieces().items())
        rows = {current.row for current in self.currents}
        numbers = [name for name in study.vary if isinstance(table.row(name), Input) and name not in rows]
        self.free = tuple(self._free(name) for name in numbers)
        self.margins: dict[str, float] = {}
        """By limit, how far within it to stay [shares of its scale]: what is robust and no part of the problem."""
        self.problem = self._problem(limits_of(study, table))
        self.start_switch = self.simulator.run(self.model.start, stages=self.problem.stages)
        self.start_values = self.model.values(self.model.start, self.start_switch.values)
        self.reference = reference or {name: self._reference(name) for name in study.minimize}
        self._solvers: dict[bool, Any] = {}
        self.seconds = {"set_up": time.perf_counter() - began, "solve": 0.0}

    def with_constant_currents(self) -> Optimizer | None:
        """The same problem with currents that do not change over a stage; None where they do not anyway."""
        if not self.currents:
            return None
        study = self.study.model_copy(update={"profile": ProfileOptions()})
        runs = EXPAND_FROM if self.many else 1
        return Optimizer(study, self.catalog, self.table, runs, self.reference, self.progress, self.simulator)

    def _free(self, name: str) -> Free:
        vary = self.study.vary[name]
        reference = self.model.start[self.model.index[name]]
        if isinstance(vary, Range):
            lower, upper = vary.lower, vary.upper
        else:
            numbers = [float(value) for value in vary.values]
            lower, upper = min(numbers), max(numbers)
        return Free(name, lower, upper, reference if reference != 0.0 else upper)

    def _current(self, stage: str, pieces: int) -> FreeCurrent:
        row = self.table.stage(stage).drive
        vary = self.study.vary[row]
        assert isinstance(vary, Range)  # the reader sees to that
        slew = float(self.model.start[self.model.index["current_slew"]])
        ramp_elements = math.ceil(ramp_time(vary.upper, slew) / RAMP_ELEMENT)
        return FreeCurrent(stage, row, pieces, vary.lower, vary.upper, ramp_elements)

    def _problem(self, limits: list[Limit]) -> Problem:
        """The problem without the limits that nothing free can change; those are checked here and now."""
        free = [*(f.name for f in self.free), *(current.row for current in self.currents)]
        constant = [limit for limit in limits if is_constant(limit, self.table, free)]
        without_switch = dict.fromkeys(self.model.switch_names, np.inf)
        values = self.model.values(self.model.start, without_switch) if constant else {}
        for limit in constant:
            value = values[limit.output]
            if not limit.residual(value) <= ALGEBRAIC_TOLERANCE:
                raise InfeasibleError(
                    f"{in_words(limit, self.table)} does not hold, and nothing under `vary` can change it; "
                    f"vary one of: {', '.join(self._variables_behind(limit.output))}"
                )
        kept = [limit for limit in limits if limit not in constant]
        elements = self.study.solver.elements
        minimize = tuple(self.study.minimize)
        reserves = None
        if self.study.robust:
            from tvimdesign.solve.reserves import reserves_of

            reserves = reserves_of(self.model, self.study, kept)
        return Problem(self.model, self.free, kept, minimize, elements, self.currents, reserves)

    def _variables_behind(self, name: str) -> list[str]:
        above = self.table.ancestors(name)
        return [row.name for row in self.table.inputs if row.variable and row.name in above] or ["(nothing can)"]

    def _reference(self, name: str) -> float:
        value = self.start_values[name]
        if not np.isfinite(value):
            horizon = self.model.start[self.model.index["horizon"]]
            self.progress(f"{name} is not reached by the study's own start within {horizon:g} s")
            return float(horizon)
        return value if value != 0.0 else 1.0

    def _solver(self, warm: bool) -> Any:
        if warm not in self._solvers:
            ipopt: dict[str, Any] = {
                **_IPOPT,
                **(_WARM if warm else {}),
                "max_iter": self.study.solver.max_iterations,
                "tol": self.study.solver.tolerance,
            }
            options: dict[str, Any] = {
                "ipopt": ipopt,
                "print_time": False,
                "expand": self.many,
                "show_eval_warnings": False,
            }
            self._solvers[warm] = ca.nlpsol("design", "ipopt", self.problem.function, options)
        return self._solvers[warm]

    # --- starts ---

    def begin_points(self) -> Iterator[Array]:
        """Inputs to start from: the study's own, then random ones between the bounds, seeded.

        From a point whose switch never ends the solver mostly gets stuck there, so such points are drawn again; the
        study's own is replaced by the first random one.
        """
        random = np.random.default_rng(self.study.solver.seed)
        if self._trial(self.model.start) is not None:
            yield self.model.start
        else:
            self.progress("the switch of the study's own start never ends: starting elsewhere")
            yield self._ending_point(random)
        for _ in range(self.study.solver.starts - 1):
            yield self._ending_point(random)

    def _ending_point(self, random: np.random.Generator) -> Array:
        for _ in range(MAX_DRAWS):
            point = self.random_point(random)
            if self._trial(point) is not None:
                return point
        return self.model.start

    def random_point(self, random: np.random.Generator) -> Array:
        """Inputs with every free number drawn evenly between its bounds (of its logarithm, where it is positive).

        Drawn again where there is no such module, as with a leg that cannot reach its pin.
        """
        for _ in range(MAX_DRAWS):
            point = self.model.start.copy()
            for free in self.free:
                low, high = free.to_unknown(free.lower), free.to_unknown(free.upper)
                point[self.model.index[free.name]] = free.to_value(random.uniform(low, high))
            values = self.model.values(point, self.start_switch.values)
            numbers = [value for name, value in values.items() if not on_switch(self.table, name)]
            if all(np.isfinite(number) for number in numbers) and not impossible(values, self.table):
                return point
        return self.model.start

    def _trial(self, inputs: Array) -> Switch | None:
        """The switch at a point, None where it does not end."""
        try:
            known = inputs is self.model.start
            switch = self.start_switch if known else self.simulator.run(inputs, stages=self.problem.stages)
        except SimulationError:
            return None
        return switch if all(np.isfinite(switch.values[event]) for event in self.problem.events) else None

    def _guess(self, inputs: Array) -> Array:
        """Unknowns at a point: the free numbers, and the switch simulated there (as far as it goes where it stalls)."""
        switch = self._trial(inputs) or self.start_switch
        parts = [np.array([f.to_unknown(inputs[self.model.index[f.name]]) for f in self.free])]
        sizes = {c.stage: float(np.clip(inputs[self.model.index[c.row]], c.lower, c.upper)) for c in self.currents}
        slew = float(inputs[self.model.index["current_slew"]])
        ramps = {c.stage: (c.ramp_elements, ramp_time(sizes[c.stage], slew)) for c in self.currents}
        for block in self.problem.blocks:
            trajectory = switch.trajectories.get(block.stage.stage.name)
            if trajectory is None:  # a stage that does not begin: as it would stand after the first
                trajectory = self._standing(block.stage, switch)
            end = switch.values[block.event]
            end = end if np.isfinite(end) else trajectory.times[-1]
            name = block.stage.stage.name
            points = guess(trajectory, self.problem.elements(name), ramps.get(name, (0, 0.0))).ravel(order="F")
            parts += [points, np.array([np.log(max(end, 1e-3))])]
        parts += [np.full(current.nodes, sizes[current.stage] / current.upper) for current in self.currents]
        for balance in self.problem.balances:
            begin = switch.balances.get(balance.stage)
            last = switch.trajectories[balance.stage]
            parts.append(np.append(last.states[:, -1], last.currents[-1]) if begin is None else begin)
        for name in self.problem.peaks:
            row = self.table.row(name)
            assert isinstance(row, Path)
            value = switch.values[name]
            parts.append(np.array([(value if np.isfinite(value) else 1.0) / self.problem.peak_scale(row)]))
        return np.concatenate(parts)

    def _standing(self, stage: StageModel, switch: Switch) -> Trajectory:
        last = switch.trajectory
        state = np.asarray(stage.begin(last.states[:, -1], self.model.start)).ravel()
        return Trajectory(np.array([0.0, 60.0]), np.column_stack([state, state]), np.zeros(2))

    # --- solving ---

    def solve(
        self,
        fixed: Mapping[str, float] | None = None,
        warm: Run | None = None,
        begin: Array | None = None,
        goal: Goal | None = None,
    ) -> Run:
        """Run IPOPT once from `begin` (the study's start), or warm from an earlier run, with some numbers fixed.

        A `goal` stands in place of the study's weights and of some of its upper limits; nothing is built anew.
        """
        inputs = self.model.start if begin is None else begin
        clock = time.perf_counter()
        lower, upper = self.bounds(fixed or {})
        solver = self._solver(warm is not None)
        arguments: dict[str, Any] = {"x0": self._guess(inputs) if warm is None else warm.unknowns}
        if warm is not None:
            arguments |= {"lam_g0": warm.multipliers, "lam_x0": warm.bound_multipliers}
        goal = goal or Goal(self.study.minimize)
        equations = self.problem.equation_count
        rest = self.problem.slope_count + self.problem.peak_count
        answer = solver(
            **arguments, p=self._parameters(goal.weights), lbx=lower, ubx=upper,
            lbg=np.concatenate([np.zeros(equations), np.full(len(self.problem.limits) + rest, -np.inf)]),
            ubg=np.concatenate([np.zeros(equations), goal.room(self.problem.limits) - self._within(), np.zeros(rest)]),
        )  # fmt: skip
        stats = solver.stats()
        if stats["return_status"] == "User_Requested_Stop":  # an interrupt that reached IPOPT first
            raise KeyboardInterrupt
        unknowns = np.asarray(answer["x"]).ravel()
        seconds = time.perf_counter() - clock
        self.seconds["solve"] += seconds
        end = self._inputs_of(unknowns)
        start = Start(
            number=0, status=stats["return_status"], converged=bool(stats["success"]),
            iterations=int(stats["iter_count"]), objective=float(answer["f"]), seconds=seconds,
            begin=self.free_values(inputs), end=self.free_values(end),
        )  # fmt: skip
        drives = self._drives_of(unknowns)
        multipliers = (np.asarray(answer[name]).ravel() for name in ("lam_g", "lam_x", "lam_p"))
        times = self._times_of(unknowns)
        ends = {stage.name: times[stage.ends] for stage in self.table.stages if stage.ends in times}
        return Run(start, end, drives, ends, unknowns, *multipliers)

    def _within(self) -> Array:
        """How far within each limit to stay."""
        return np.array([self.margins.get(limit.name, 0.0) for limit in self.problem.limits])

    def _parameters(self, weights: Mapping[str, float]) -> Array:
        """The problem's parameters: the study's inputs, and weights over the references."""
        over = [weights.get(name, 0.0) / self.reference[name] for name in self.problem.minimize]
        return np.concatenate([self.model.start, over])

    def derivatives(self, run: Run) -> Derivatives:
        """The problem's values and derivatives where a run of the study's own goal ended.

        IPOPT's own functions are used again; a weight on one output alone makes the objective's gradient that output's.
        """
        solver = self._solver(warm=False)
        parameters = self._parameters(self.study.minimize)
        rows, jacobian = solver.get_function("nlp_jac_g")(run.unknowns, parameters)
        hessian = solver.get_function("nlp_hess_l")(run.unknowns, parameters, 1.0, run.multipliers)
        values, gradients = {}, {}
        for name in self.problem.minimize:
            alone = self._parameters({name: self.reference[name]})
            value, gradient = solver.get_function("nlp_grad_f")(run.unknowns, alone)
            values[name], gradients[name] = float(value), np.asarray(gradient).ravel()
        found = np.asarray(rows).ravel()
        # A limit that is to be kept by a margin is held where that is used up.
        found[self.problem.equation_count :][: len(self.problem.limits)] += self._within()
        return Derivatives(found, jacobian, ca.triu2symm(hessian), values, gradients)

    def bounds(self, fixed: Mapping[str, Any]) -> tuple[Array, Array]:
        """Least and largest unknowns, with some free numbers fixed."""
        lower = np.full(self.problem.unknown_count, -np.inf)
        upper = np.full(self.problem.unknown_count, np.inf)
        for i, free in enumerate(self.free):
            low, high = (fixed[free.name],) * 2 if free.name in fixed else (free.lower, free.upper)
            lower[i], upper[i] = free.to_unknown(low), free.to_unknown(high)
        for current, place in self.places_of_currents():
            lower[place], upper[place] = current.lower / current.upper, 1.0
        last = len(self.free)
        for block in self.problem.blocks:
            last += block.unknowns.numel()
            if block.stage.stage.name in self.study.profile.pieces():
                lower[last - 1] = np.log(SHORTEST)
        return lower, upper

    def places_of_currents(self) -> Iterator[tuple[FreeCurrent, slice]]:
        """Where the free currents stand among the unknowns."""
        first = len(self.free) + sum(block.unknowns.numel() for block in self.problem.blocks)
        for current in self.currents:
            yield current, slice(first, first + current.nodes)
            first += current.nodes

    def _times_of(self, unknowns: Array) -> dict[str, float]:
        """Time [s] to each event, after its stage's ramp."""
        first, times = len(self.free), {}
        for block in self.problem.blocks:
            first += block.unknowns.numel()
            times[block.event] = float(np.exp(unknowns[first - 1]))
        return times

    def _drives_of(self, unknowns: Array) -> dict[str, Drive]:
        """The free currents over the time their stage takes."""
        times = self._times_of(unknowns)
        sizes = {
            current.stage: np.clip(unknowns[place] * current.upper, current.lower, current.upper)
            for current, place in self.places_of_currents()
        }
        slew = float(self.model.start[self.model.index["current_slew"]])
        drives: dict[str, Drive] = {}
        for name, nodes in sizes.items():
            stage = self.table.stage(name)
            signed = [float(stage.sign * size) for size in nodes]
            drives[name] = Drive.in_pieces(ramp_time(float(nodes[0]), slew), times[stage.ends], signed)
        return drives

    def _inputs_of(self, unknowns: Array) -> Array:
        inputs = self.model.start.copy()
        for i, free in enumerate(self.free):
            inputs[self.model.index[free.name]] = min(max(free.to_value(unknowns[i]), free.lower), free.upper)
        for stage, drive in self._drives_of(unknowns).items():  # the row has one number: the mean
            inputs[self.model.index[self.table.stage(stage).drive]] = abs(drive.mean)
        return inputs

    def free_values(self, inputs: Array) -> dict[str, float]:
        """The free numbers among the inputs, by name."""
        return {free.name: float(inputs[self.model.index[free.name]]) for free in self.free}
