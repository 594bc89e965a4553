"""The ways to the optimum that `optimum.py` sets side by side: tvimdesign, and what people would write instead.

Each takes the reference problem and a start, and gives the design it ends with. Those that call numbers are handed
tvimdesign's compiled equations; the one by hand has only the problem's numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, MutableMapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any
from unittest.mock import patch

import numpy as np
from by_hand import ByHand, by_hand
from numpy.typing import NDArray
from reference_problem import LONGEST, Heat, Reference, study
from scipy.integrate import solve_ivp
from scipy.optimize import Bounds, NonlinearConstraint, minimize

from tvimdesign.simulation.working_cycle import device_functions, phase_functions
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.symbols import ca
from tvimdesign.solve.optimizer.optimizer import Optimizer

Array = NDArray[np.float64]


@dataclass
class End:
    """Result of a contender."""

    design: Array
    evaluations: int
    """Switches simulated, or iterations where the switch is part of the problem."""


@dataclass(frozen=True)
class Contender:
    """One way to the optimum, from a start."""

    name: str
    solve: Callable[[Reference, Array], End]
    starts: int
    """How many of the random starts it is given: fewer where one takes minutes."""
    prepare: Callable[[Reference], object] = lambda _: None
    """What is built or compiled before the clock starts."""


# --- tvimdesign ---


def by_tvimdesign(_: Reference, begin: Array) -> End:
    """Build and solve, as `tvimdesign run` does for one start."""
    sought = study()
    device_functions.STRUCTURES.forget()
    optimizer = Optimizer(sought)
    inputs = optimizer.model.start.copy()
    places = [optimizer.model.index[free.name] for free in optimizer.free]
    inputs[places] = begin
    run = optimizer.solve(begin=inputs)
    return End(run.inputs[places], run.start.iterations)


class Built:
    """Contender with everything built, as for the second start and every one after it."""

    def __init__(self) -> None:
        """Start with nothing built."""
        self._optimizer: Optimizer | None = None

    def build(self, reference: Reference) -> None:
        """Build, and solve once, which is when CasADi builds the solver."""
        sought = study()
        self._optimizer = Optimizer(sought)
        self.solve(reference, reference.begin)

    def solve(self, reference: Reference, begin: Array) -> End:
        """From a start."""
        assert self._optimizer is not None
        run = self._optimizer.solve(begin=reference.inputs(begin))
        return End(run.inputs[reference.places], run.start.iterations)


BUILT = Built()


# --- numba ---


def hand_written(reference: Reference, begin: Array) -> End:
    """Equations written out for numba, with slopes, and SLSQP."""
    return End(*by_hand(begin, reference.lower, reference.upper))


# --- scipy ---


class Event:
    """Event of the switch, as scipy takes it: it ends the integration where it passes zero."""

    terminal = True

    def __init__(self, heat: Heat) -> None:
        """Of one design's switch."""
        self._gap = heat.gap

    def __call__(self, now: float, state: Array) -> float:
        """Below zero before the event, above it after."""
        return self._gap(now, state)


def lsoda(tolerance: float) -> Callable[[Reference, Array], float]:
    """Simulate the switch by LSODA with the exact Jacobian, stopped at the event."""

    def cycle(reference: Reference, design: Array) -> float:
        heat = reference.heat(design)
        solved = solve_ivp(heat.rates, (0.0, LONGEST), heat.start, method="LSODA", jac=heat.jacobian, rtol=tolerance,
                          atol=1e-2 * tolerance, events=Event(heat))  # fmt: skip
        return float(solved.t_events[0][0]) if len(solved.t_events[0]) else LONGEST

    return cycle


def bdf(reference: Reference, design: Array) -> float:
    """Simulate the switch as most would write it: solve_ivp's BDF at 1e-6, no Jacobian."""
    heat = reference.heat(design)
    solved = solve_ivp(heat.rates, (0.0, LONGEST), heat.start, method="BDF", rtol=1e-6, atol=1e-8, events=Event(heat))
    return float(solved.t_events[0][0]) if len(solved.t_events[0]) else LONGEST


class Once:
    """Objective and residuals in the logarithms of the variables; a design asked for again is not simulated again."""

    def __init__(self, reference: Reference, cycle: Callable[[Reference, Array], float]) -> None:
        """Start with nothing simulated."""
        self.reference, self.cycle = reference, cycle
        self.evaluations = 0
        self._last: tuple[bytes, Array] | None = None

    def rows(self, unknowns: Array) -> Array:
        """Objective and residuals."""
        key = np.asarray(unknowns).tobytes()
        if self._last is None or self._last[0] != key:
            design = np.exp(unknowns)
            self.evaluations += 1
            self._last = key, self.reference.rows(design, self.cycle(self.reference, design))
        return self._last[1]

    def objective(self, unknowns: Array) -> float:
        """Return the objective."""
        return float(self.rows(unknowns)[0])

    def room(self, unknowns: Array) -> Array:
        """Return what is left of every limit, as SLSQP wants it: not below zero."""
        return -self.rows(unknowns)[1:]

    def bounds(self) -> Bounds:
        """Ends of the unknowns."""
        return Bounds(np.log(self.reference.lower), np.log(self.reference.upper), keep_feasible=True)


def slsqp(cycle: Callable[[Reference, Array], float], step: float) -> Callable[[Reference, Array], End]:
    """scipy's SLSQP with its finite differences at a step."""

    def solve(reference: Reference, begin: Array) -> End:
        once = Once(reference, cycle)
        optimum = minimize(
            once.objective, np.log(begin), method="SLSQP", bounds=once.bounds(),
            constraints={"type": "ineq", "fun": once.room}, options={"maxiter": 300, "ftol": 1e-9, "eps": step},
        )  # fmt: skip
        return End(np.exp(optimum.x), once.evaluations)

    return solve


def trust_constr(reference: Reference, begin: Array) -> End:
    """scipy's trust-constr with finite differences and BFGS."""
    once = Once(reference, lsoda(1e-8))
    optimum = minimize(
        once.objective, np.log(begin), method="trust-constr", bounds=once.bounds(),
        constraints=NonlinearConstraint(once.room, 0.0, np.inf), options={"maxiter": 500, "gtol": 1e-7, "xtol": 1e-9},
    )  # fmt: skip
    return End(np.exp(optimum.x), once.evaluations)


# --- OpenMDAO ---


def openmdao(reference: Reference, begin: Array) -> End:
    """OpenMDAO: the switch and the algebra as components with finite differences, SLSQP as driver."""
    import openmdao.api as om

    count = {"switches": 0}
    switch_time = lsoda(1e-8)

    class Cycle(om.ExplicitComponent):
        def setup(self) -> None:
            self.add_input("unknowns", np.log(begin))
            self.add_output("time", 100.0)
            self.declare_partials("*", "*", method="fd", step=1e-6)

        def compute(self, inputs: Mapping[str, Array], outputs: MutableMapping[str, Any]) -> None:
            count["switches"] += 1
            outputs["time"] = switch_time(reference, np.exp(inputs["unknowns"]))

    class Algebra(om.ExplicitComponent):
        def setup(self) -> None:
            self.add_input("unknowns", np.log(begin))
            self.add_input("time", 100.0)
            self.add_output("objective", 1.0)
            self.add_output("residuals", np.zeros(len(reference.limits)))
            self.declare_partials("*", "*", method="fd", step=1e-6)

        def compute(self, inputs: Mapping[str, Array], outputs: MutableMapping[str, Any]) -> None:
            rows = reference.rows(np.exp(inputs["unknowns"]), float(inputs["time"][0]))
            outputs["objective"], outputs["residuals"] = rows[0], rows[1:]

    problem = om.Problem(reports=False)
    problem.model.add_subsystem("switch", Cycle(), promotes=["*"])
    problem.model.add_subsystem("algebra", Algebra(), promotes=["*"])
    problem.driver = om.ScipyOptimizeDriver(optimizer="SLSQP", tol=1e-9, maxiter=300, disp=False)
    problem.model.add_design_var("unknowns", np.log(reference.lower), np.log(reference.upper))
    problem.model.add_objective("objective")
    problem.model.add_constraint("residuals", upper=0.0)
    problem.setup()
    problem.set_val("unknowns", np.log(begin))
    problem.run_driver()
    return End(np.exp(problem.get_val("unknowns")), count["switches"])


# --- AeroSandbox ---


@contextmanager
def arrays_of_casadi() -> Iterator[None]:
    """Equations that are written meanwhile are written with CasADi's own arrays, not with tvimdesign's quicker ones."""

    def array(column: Any) -> Any:
        return np.reshape(column, (column.numel(),))

    with patch.object(device_functions, "symbols", array), patch.object(phase_functions, "symbols", array):
        yield


def along_time(function: Any, arguments: Sequence[Any]) -> Any:
    """Write a function's arithmetic on Opti's own variables, every number of it a row over the points in time.

    So AeroSandbox's users write; as a compiled function, mapped over the points, it takes Opti a fifth longer.
    """
    entries = [ca.vertsplit(argument) for argument in arguments]
    count = max(argument.size2() for argument in arguments)
    held: dict[int, Any] = {}
    rows = [ca.MX(1, count)] * function.size1_out(0)
    for k in range(function.n_instructions()):
        code, given, to = function.instruction_id(k), function.instruction_input(k), function.instruction_output(k)
        if code == ca.OP_OUTPUT:
            row = held[given[0]]
            rows[to[1]] = row if row.size2() == count else ca.repmat(row, 1, count)
        elif code == ca.OP_INPUT:
            held[to[0]] = entries[given[0]][given[1]]
        elif code == ca.OP_CONST:
            held[to[0]] = ca.MX(function.instruction_constant(k))
        elif len(given) == 1:
            held[to[0]] = ca.MX.unary(code, held[given[0]])
        else:
            held[to[0]] = ca.MX.binary(code, *(held[operand] for operand in given))
    return ca.vertcat(*rows)


def radau(order: int = 5) -> tuple[Array, Array]:
    """Collocation points on (0, 1], and the matrix from values at the start and at them to derivatives at them."""
    points = ca.collocation_points(order, "radau")
    return np.array(points), np.asarray(ca.collocation_coeff(points)[1])


def aerosandbox(reference: Reference, begin: Array) -> End:
    """AeroSandbox's Opti with Radau collocation written by its user, from a simulated trajectory.

    Its user writes the equations as symbols too, of the kind that CasADi has for numpy's functions; which limits hang
    on nothing free, and numbers of records, are known.
    """
    import aerosandbox as asb

    with arrays_of_casadi():
        written = reference.written_again()
        phase, algebra = written.phases["softening"], reference.algebra(written)
        rates, gap, initial = phase.rates, phase.watch([reference.event]), phase.initial
    ca.GlobalOptions.setNumpyMode(0)  # AeroSandbox does not know the symbols of the other mode
    opti = asb.Opti()
    elements, (points, derivative) = 3, radau()
    ends = zip(*(np.log(values).tolist() for values in (begin, reference.lower, reference.upper)), strict=True)
    logs = ca.vertcat(*(opti.variable(guess, lower_bound=low, upper_bound=high) for guess, low, high in ends))
    log_time = opti.variable(init_guess=np.log(200.0))
    entries = ca.vertsplit(ca.MX(reference.model.start))
    for i, place in enumerate(reference.places):
        entries[place] = ca.exp(logs[i])
    inputs = ca.vertcat(*entries)
    start, profile = along_time(initial, [inputs]), inputs[reference.current]
    warm = _heated(reference, begin, elements * len(points))
    states = ca.reshape(opti.variable(init_guess=warm.ravel(order="F")), *warm.shape)
    slopes_there = along_time(rates, [states, profile, inputs])
    for element in range(elements):
        columns = slice(element * len(points), (element + 1) * len(points))
        before = start if element == 0 else states[:, element * len(points) - 1]
        slopes = ca.mtimes(ca.horzcat(before, states[:, columns]), derivative)
        opti.subject_to(ca.vec(slopes - ca.exp(log_time) / elements * slopes_there[:, columns]) == 0)
    opti.subject_to(along_time(gap, [states[:, -1], profile, inputs]) == 0)
    rows = along_time(algebra, [inputs, ca.exp(log_time)])
    opti.subject_to(rows[1:] <= 0)
    opti.minimize(rows[0])
    solution = opti.solve(verbose=False, max_iter=500)
    ca.GlobalOptions.setNumpyMode(1)
    return End(np.exp(np.asarray(solution(logs)).ravel()), solution.stats()["iter_count"])


def _heated(reference: Reference, begin: Array, columns: int) -> Array:
    """Return a simulated trajectory to start the collocation from, which its user needs as much as we do."""
    inputs = reference.inputs(begin)
    trajectory = Simulator(reference.model).run(inputs, phases=["softening"]).trajectories["softening"]
    return trajectory.at(np.linspace(0.0, 1.0, columns + 1)[1:])


CONTENDERS = (
    Contender("tvimdesign, build included", by_tvimdesign, 20),
    Contender("tvimdesign, built before", BUILT.solve, 20, BUILT.build),
    Contender("SLSQP on equations written by hand for numba, compiled before", hand_written, 20, lambda _: ByHand()),
    Contender("AeroSandbox Opti, Radau written by its user, build included", aerosandbox, 20),
    Contender("SLSQP, finite differences, LSODA with exact Jacobian", slsqp(lsoda(1e-8), 1e-6), 10),
    Contender("trust-constr, finite differences, the same LSODA", trust_constr, 2),
    Contender("OpenMDAO, SLSQP, finite differences, the same LSODA", openmdao, 10),
    Contender("SLSQP, `solve_ivp` BDF at 1e-6, as most would write it", slsqp(bdf, 1.5e-8), 5),
)
