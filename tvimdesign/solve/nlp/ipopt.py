"""IPOPT as every problem here wants it: its settings, and what warm starts take other ones."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.record import own_data
from tvimdesign.simulation.working_cycle.symbols import ca
from tvimdesign.study import SolverOptions

Array = NDArray[np.float64]
Beginning: TypeAlias = Literal["cold", "feasible", "near", "warm", "sharp"]
"""Where a run begins: anywhere; anywhere, to end where all limits are met; near another optimum, none of whose
multipliers hold; at an optimum, with them; at the optimum
itself, which is sought more exactly."""
_SETTINGS: dict[str, dict[str, Any]] = own_data(__file__, "ipopt.yaml")
_SHARP = 1e-11  # Tolerance that separates a limit which hardly presses from one which does not
_MOST_ITERATIONS = {"cold": 120, "near": 60, "warm": 25, "sharp": 60}
"""A warm start takes two to ten iterations or goes nowhere; who asks for one then starts from further back. A near one
takes 13 to 45, measured on six studies, or seldom comes to anything new."""


_MOST_POINTS = {"cold": 700, "warm": 75, "near": 95}
"""A start that leads somewhere evaluates up to 635 points cold, 71 warm and 89 near, measured on three studies and a
family of the atlas; any other searches along steps in vain."""

TIME_OVER = "Maximum_WallTime_Exceeded"  # Status of a run that a deadline ended, whatever its clock
ITERATIONS_OVER = "Maximum_Iterations_Exceeded"


class Programme(Protocol):
    """A nonlinear programme that a solver can be given."""

    @property
    def unknown_count(self) -> int:
        """Count of unknowns."""

    @property
    def row_count(self) -> int:
        """Count of constraints."""

    def at(self, x: Array) -> "Evaluated":
        """Evaluate the programme at a point."""


class Evaluated(Protocol):
    """A programme at a point."""

    @property
    def objective(self) -> float:
        """Return the value to minimise."""

    @property
    def gradient(self) -> Array:
        """Of the objective."""

    @property
    def rows(self) -> Array:
        """The constraints."""

    @property
    def jacobian(self) -> Array:
        """Of the constraints."""


class Solver:
    """IPOPT for one problem, ended between two iterations when the deadline of the run has passed."""

    def __init__(
        self, name: str, problem: Any, settings: Mapping[str, Any], sizes: tuple[int, int], plugin: str = "ipopt",
        most_points: float = math.inf,
    ) -> None:  # fmt: skip
        """Build it from what nlpsol takes; `sizes` are the counts of unknowns and rows."""
        self._stop = _Stop((*sizes, 0), most_points)
        self._nlp = ca.nlpsol(name, plugin, problem, {**settings, "iteration_callback": self._stop})
        self.unknown_count = sizes[0]

    def __call__(self, deadline: Deadline, **arguments: Any) -> dict[str, Any]:
        """Run it with nlpsol's arguments, until the deadline at most."""
        self._stop.deadline, self._stop.points, self._stop.status = deadline, 0, ""
        answer: dict[str, Any] = self._nlp(**arguments)
        return answer

    def stats(self) -> dict[str, Any]:
        """Return what nlpsol says of the last run."""
        statistics: dict[str, Any] = self._nlp.stats()
        status = self._stop.status
        return {**statistics, "return_status": status, "success": False} if status else statistics

    def count_point(self) -> None:
        """Count an evaluation of the problem at a point."""
        self._stop.points += 1


class ProgrammeSolver:
    """IPOPT, or another solver of CasADi's, for programmes of so many unknowns and rows, each given with its run."""

    def __init__(
        self, unknowns: int, rows: int, settings: Mapping[str, Any], plugin: str = "ipopt",
        most_points: float = math.inf,
    ) -> None:  # fmt: skip
        self._held = _Held()
        x, p = ca.MX.sym("x", unknowns), ca.MX.sym("p", 0)
        self._calls = [
            _Part(self._held, unknowns, size, sloped=sloped, part=part)
            for sloped in (False, True)
            for part, size in (("objective", 1), ("rows", rows))
        ]
        f, g, (same_f, gradient), (same_g, jacobian) = (call(x) for call in self._calls)
        derivatives = {
            "grad_f": ca.Function("grad_f", [x, p], [same_f, gradient], ["x", "p"], ["f", "grad_f_x"]),
            "jac_g": ca.Function("jac_g", [x, p], [same_g, jacobian], ["x", "p"], ["g", "jac_g_x"]),
            "no_nlp_grad": True, "calc_lam_p": False,
        }  # fmt: skip
        problem: Any = {"x": x, "p": p, "f": f, "g": g}
        self._solver = Solver("design", problem, {**settings, **derivatives}, (unknowns, rows), plugin, most_points)
        self._held.count_point = self._solver.count_point
        self.stats = self._solver.stats

    def __call__(self, programme: Programme, deadline: Deadline, **arguments: Any) -> dict[str, Any]:
        """Run it with nlpsol's arguments, until the deadline at most. Raises what the programme raises."""
        self._held.programme, self._held.at = programme, b""
        answer = self._solver(deadline, **arguments)
        if self._held.error is not None:
            error, self._held.error = self._held.error, None
            raise error
        return answer


class _Held:
    """The programme of the run."""

    programme: Programme
    at: bytes  # Unknowns of the last point, and the programme there: IPOPT takes it in four parts
    point: "Evaluated"
    error: BaseException | None = None
    count_point: Callable[[], None]


class _Part(ca.Callback):
    """Objective or constraints at a point, to CasADi; with their derivatives where `sloped`."""

    def __init__(self, held: _Held, unknowns: int, size: int, *, sloped: bool, part: str) -> None:
        super().__init__()
        self._held, self._unknowns, self._size, self._sloped, self._part = held, unknowns, size, sloped, part
        self.construct(f"{part}{int(sloped)}", {})

    def get_n_in(self) -> int:
        return 1

    def get_n_out(self) -> int:
        return 2 if self._sloped else 1

    def get_sparsity_in(self, _: int) -> Any:
        return ca.Sparsity.dense(self._unknowns)

    def get_sparsity_out(self, place: int) -> Any:
        return ca.Sparsity.dense(self._size, self._unknowns if place else 1)

    def has_eval_buffer(self) -> bool:
        return True  # a matrix of CasADi's takes ten times as long to make

    def eval_buffer(self, arguments: Sequence[memoryview], results: Sequence[memoryview | None]) -> int:
        """Write the results; anything but zero says that there are none."""
        held, at = self._held, arguments[0].tobytes()
        try:
            if at != held.at:
                held.point, held.at = held.programme.at(np.frombuffer(at)), at
        except BaseException as error:  # CasADi would swallow it
            held.error = error
            return 1
        point = held.point
        of_objective = self._part == "objective"
        computed: tuple[Any, Any] = (point.rows, point.jacobian)
        if of_objective:
            computed = (point.objective, point.gradient)
        elif not self._sloped:  # where a cycle never ends, IPOPT asks for no objective
            held.count_point()
        for result, values in zip(results, computed, strict=False):
            if result is not None:
                np.frombuffer(result)[:] = values.ravel(order="F") if isinstance(values, np.ndarray) else values
        return 0


class _Stop(ca.Callback):
    """Called by IPOPT before each iteration: anything but zero ends the run."""

    def __init__(self, sizes: tuple[int, int, int], most_points: float) -> None:
        super().__init__()
        unknowns, rows, parameters = sizes
        self._sizes = {"x": unknowns, "f": 1, "g": rows, "lam_x": unknowns, "lam_g": rows, "lam_p": parameters}
        self.deadline, self.points, self._most_points = NEVER, 0, most_points
        self.status = ""
        """Status of a run that was ended here."""
        self.construct("stop", {})

    def get_n_in(self) -> int:
        return int(ca.nlpsol_n_out())

    def get_n_out(self) -> int:
        return 1

    def get_name_in(self, place: int) -> str:
        return str(ca.nlpsol_out(place))

    def get_sparsity_in(self, place: int) -> Any:
        return ca.Sparsity.dense(self._sizes[ca.nlpsol_out(place)])

    def has_eval_buffer(self) -> bool:
        return True

    def eval_buffer(self, _: Any, results: Sequence[memoryview]) -> int:
        """Write whether to end."""
        if not self.status and self.deadline.passed:
            self.status = TIME_OVER
        elif not self.status and self.points > self._most_points:
            self.status = ITERATIONS_OVER
        np.frombuffer(results[0])[:] = bool(self.status)
        return 0


def solver_of(unknowns: int, rows: int, options: SolverOptions, beginning: Beginning = "cold") -> ProgrammeSolver:
    """IPOPT for programmes of so many unknowns and rows, set for where a run begins."""
    most = options.max_iterations
    ipopt: dict[str, Any] = {
        **_SETTINGS["every"],
        **_SETTINGS[beginning],
        "limited_memory_max_history": unknowns,  # of 34 unknowns, 12 take half as many iterations again
        "max_iter": min(most, _MOST_ITERATIONS.get(beginning, most)),
        "tol": min(options.tolerance, _SHARP) if beginning == "sharp" else options.tolerance,
    }
    settings: dict[str, Any] = {"ipopt": ipopt, "print_time": False, "show_eval_warnings": False}
    return ProgrammeSolver(unknowns, rows, settings, most_points=_MOST_POINTS.get(beginning, math.inf))
