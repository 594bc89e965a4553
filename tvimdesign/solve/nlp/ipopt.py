"""IPOPT as every problem here wants it: its settings, and what warm starts take other ones."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Literal, TypeAlias

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.solve.nlp.derivatives import Known, derivatives_of
from tvimdesign.study import SolverOptions

_USUAL = {
    "print_level": 0,
    "sb": "yes",
    "linear_solver": "mumps",
    # With MUMPS's usual 1e-6 the pivots of a freezing layer are too small: it miscounts negative eigenvalues, and IPOPT
    # answers with tiny steps.
    "mumps_pivtol": 1e-2,
    # METIS. Where blocks have rows an iteration takes 0.42 to 0.49 of what it takes by minimum degree, with
    # a free current 0.74, of a layer in shear 0.87 to 1 (seven studies).
    "mumps_pivot_order": 5,
    "mu_init": 1e-3,
    # The bounds of a study are exact: IPOPT's usual relaxation of 1e-8 stays, and the point is put back inside.
    "honor_original_bounds": "yes",
}
_WARM = {
    "warm_start_init_point": "yes",
    # Below what the tolerance asks of the barrier, so that no iteration goes to lowering it.
    "mu_init": 1e-9,
    "warm_start_bound_push": 1e-6,
    "warm_start_mult_bound_push": 1e-6,
    "warm_start_slack_bound_push": 1e-6,
}
_REFINED = {
    # Close by, with next to nothing to learn of what presses: 8 to 13 iterations in four studies, and 13 to 16 where
    # IPOPT begins as it does anywhere.
    "mu_init": 1e-6,
    "bound_push": 1e-3,
    "bound_frac": 1e-3,
    "slack_bound_push": 1e-3,
    "slack_bound_frac": 1e-3,
}
_ANYWHERE = {
    # Most boxes of a search over lists hold no design. Where the multipliers of broken limits pass 1e5, IPOPT leaves
    # the objective and looks for the least breach. Otherwise it takes hundreds of iterations, of ever harder
    # factorizations: `wrist_compression` takes a quarter of the time, `rigid_modules_compression` a sixth.
    "expect_infeasible_problem": "yes",
    "expect_infeasible_problem_ytol": 1e5,
}
_FEASIBLE = {
    **_ANYWHERE,
    # The first point that keeps all limits is as good as any.
    "acceptable_iter": 1,
    "acceptable_tol": 1e6,
    "acceptable_compl_inf_tol": 1e6,
    "acceptable_constr_viol_tol": 1e-8,
}
Beginning: TypeAlias = Literal["cold", "feasible", "near", "refined", "warm", "sharp"]
"""Where a run begins: anywhere; anywhere, to end where all limits are kept; near another optimum, none of whose
multipliers hold; at an optimum of the same problem with fewer elements; at an optimum, with them; at the optimum
itself, which is sought more exactly."""
_SETTINGS: dict[Beginning, dict[str, Any]] = {
    "cold": _ANYWHERE, "feasible": _FEASIBLE, "refined": _REFINED, "warm": _WARM, "sharp": _WARM,
}  # fmt: skip
_SHARP = 1e-11
"""Tolerance at which a limit that hardly presses is told from one that does not."""
_MOST_ITERATIONS = {"near": 60, "refined": 60, "warm": 30, "sharp": 30}
"""A warm start takes two to ten iterations or goes nowhere; who asks for one then starts from further back. A near one
takes 13 to 45, measured on six studies, or seldom comes to anything new."""
NLP = (["x", "p"], ["f", "g"])
"""The names nlpsol knows the parts of a problem by."""
_DERIVATIVES = {"grad_f": "nlp_grad_f", "jac_g": "nlp_jac_g", "hess_lag": "nlp_hess_l"}
"""Derivatives a solver has built, by the option under which another one takes them."""


TIME_OVER = "Maximum_WallTime_Exceeded"
"""Status of a run that a deadline ended, whatever its clock."""


class Solver:
    """IPOPT for one problem, ended between two iterations when the deadline of the run has passed."""

    def __init__(self, name: str, problem: Any, settings: Mapping[str, Any], sizes: tuple[int, int, int]) -> None:
        """Build it from what nlpsol takes; `sizes` are the counts of unknowns, rows and parameters."""
        self._stop = _Stop(sizes)
        self._nlp = ca.nlpsol(name, "ipopt", problem, {**settings, "iteration_callback": self._stop})

    def __call__(self, deadline: Deadline, **arguments: Any) -> dict[str, Any]:
        """Run it with nlpsol's arguments, until the deadline at most."""
        self._stop.deadline, self._stop.stopped = deadline, False
        answer: dict[str, Any] = self._nlp(**arguments)
        return answer

    def stats(self) -> dict[str, Any]:
        """Return what nlpsol says of the last run."""
        found: dict[str, Any] = self._nlp.stats()
        return {**found, "return_status": TIME_OVER, "success": False} if self._stop.stopped else found

    def get_function(self, name: str) -> Any:
        """Return one of the functions that nlpsol built."""
        return self._nlp.get_function(name)

    def size1_in(self, name: str) -> int:
        """Return the rows of one of nlpsol's arguments."""
        return int(self._nlp.size1_in(name))


class _Stop(ca.Callback):
    """Called by IPOPT before each iteration: anything but zero ends the run."""

    def __init__(self, sizes: tuple[int, int, int]) -> None:
        super().__init__()
        unknowns, rows, parameters = sizes
        self._sizes = {"x": unknowns, "f": 1, "g": rows, "lam_x": unknowns, "lam_g": rows, "lam_p": parameters}
        self.deadline, self.stopped = NEVER, False
        self.construct("stop", {})

    def get_n_in(self) -> int:
        return int(ca.nlpsol_n_out())

    def get_n_out(self) -> int:
        return 1

    def get_name_in(self, place: int) -> str:
        return str(ca.nlpsol_out(place))

    def get_sparsity_in(self, place: int) -> Any:
        return ca.Sparsity.dense(self._sizes[ca.nlpsol_out(place)])

    def eval(self, _: Any) -> list[int]:
        self.stopped = self.stopped or self.deadline.passed
        return [int(self.stopped)]


def solver_of(
    function: Any,
    asked: SolverOptions,
    known: Iterable[Solver] = (),
    beginning: Beginning = "cold",
    *,
    points: Known | None = None,
    of_parameters: bool = True,
) -> Solver:
    """IPOPT for a problem, a function of `NLP`'s names; solvers of the same problem that are `known` lend their
    derivatives, which are most of the work of building one, and those of a problem with the same functions what is
    known of their derivatives at `points`. The multipliers `of_parameters` can be left out: where a
    run ends at no geometry CasADi cannot compute them, and warns.
    """
    most = asked.max_iterations
    ipopt: dict[str, Any] = {
        **_USUAL,
        **_SETTINGS.get(beginning, {}),
        "max_iter": min(most, _MOST_ITERATIONS.get(beginning, most)),
        "tol": min(asked.tolerance, _SHARP) if beginning == "sharp" else asked.tolerance,
    }
    lent = {option: other.get_function(name) for other in known for option, name in _DERIVATIVES.items()}
    own = {} if lent else derivatives_of(function, points)
    settings: dict[str, Any] = {"ipopt": ipopt, "print_time": False, "show_eval_warnings": False, **lent, **own}
    settings |= {} if of_parameters else {"calc_lam_p": False}
    return Solver("design", function, settings, (function.size1_in(0), function.size1_out(1), function.size1_in(1)))
