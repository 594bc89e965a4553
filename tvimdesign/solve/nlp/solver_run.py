"""End of a solver run at one start, its meaning, and the part from which another run can start."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.record import own_data
from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.phase_instants import Grid
from tvimdesign.solve.nlp.solution import Start

Array = NDArray[np.float64]
Progress = Callable[[str], None]
Ends = tuple[float, float]  # Least and largest value of a number, SI; twice the same fixes it


class Trace(NamedTuple):
    """State of a run for another one to start from, warm."""

    unknowns: Array
    multipliers: Array
    bound_multipliers: Array


@dataclass
class Run:
    """Result of the solver at one start."""

    start: Start
    inputs: Array
    current_profiles: dict[str, CurrentProfile]  # The free currents by phase
    ends: dict[str, float]  # Time [s] each phase takes that the problem has
    unknowns: Array
    multipliers: Array
    bound_multipliers: Array
    times: Mapping[str, float] = field(default_factory=dict)  # Time [s] of each event the problem needs
    within: Mapping[str, Ends] = field(default_factory=dict)  # Ends of their own that some numbers were kept within
    grids: dict[str, Grid] = field(default_factory=dict)  # The steps of each phase at which it was run

    @property
    def trace(self) -> Trace:
        """Return the state from which another run can start."""
        return Trace(self.unknowns, self.multipliers, self.bound_multipliers)


@dataclass(frozen=True)
class Derivatives:
    """The problem where a run ended: its constraints' values, and exact first and second derivatives."""

    rows: Array
    jacobian: Array  # Of the constraints by the unknowns
    hessian: Array  # Of the Lagrangian
    values: dict[str, float]  # The minimised outputs
    gradients: dict[str, Array]  # Of the minimised outputs by the unknowns


OPTIMAL = "optimal"
"""Status of a design that a search found: converged, every limit kept by a check outside the solver, and within what
its materials and bought parts are rated for, or beyond that as the study accepts."""
ABOVE_RATING = "above_rating"  # Status of such a design beyond a rating that the study does not accept
BELOW_YIELD = "below_yield"
"""Status of a design within its limits that fewer modules keep than the study asks, as far as the search came."""
ALTERNATIVES = "the alternatives to the best combination"
BETWEEN = "the best design between the listed sizes"
MARGINS = "the margins against spread"  # Steps, as they are named where the time limit left them out
NO_COMBINATION = "infeasible: nothing that is listed goes together"
"""Status where lists are searched and no combination of what they hold has a design."""
SIMULATED_MISSED = "infeasible: a limit on what is simulated of the design is violated"
"""Status of a search whose design violates a limit on a duty or on the controller, tightened as often as is tried."""
FLAT_GOAL = "no optimum: nothing under `vary` moves the goal"
"""Status of a search whose objective has no derivative at any start: all designs within the limits are as good."""
# Statuses of runs, in IPOPT's words:
SOLVED = "Solve_Succeeded"
NO_DESIGN = "Infeasible_Problem_Detected"  # At a point from which no step brings the limits nearer
FEASIBLE = "Feasible_Point_Found"  # With a feasible design but no optimum
NO_MODULE = "Invalid_Number_Detected"  # At a point where there is no module: an output is no number there
NO_STEP = "Error_In_Step_Computation"
TIME_OVER = "Maximum_WallTime_Exceeded"
ITERATIONS_OVER = "Maximum_Iterations_Exceeded"


class Meaning(NamedTuple):
    """Meaning of a status and the next step, which is empty if there is nothing to do."""

    words: str
    step: str


_REPORT = "this is a fault of the program or its libraries: report it with the study file"
MEANINGS = {status: Meaning(**listed) for status, listed in own_data(__file__, "statuses.yaml").items()}


def meaning(status: str) -> Meaning:
    """Return the meaning of a status; an unknown one is shown as it is."""
    return MEANINGS.get(status, Meaning(f"ended with {status.replace('_', ' ').lower()}", _REPORT))
