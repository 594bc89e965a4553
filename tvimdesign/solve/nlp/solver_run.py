"""End of a solver run at one start, and the part from which another run can start.

IPOPT's ways to end, in plain words, each with what to do next: data, read wherever a person sees how a run ended.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

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
    """Result of IPOPT at one start."""

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
NO_DESIGN = "Infeasible_Problem_Detected"  # IPOPT's word for a point from which no step brings the limits nearer

FEASIBLE = "Feasible_Point_Found"  # Status of a run with a feasible design but no optimum
NO_MODULE = "Invalid_Number_Detected"
"""IPOPT's word for a point at which there is no module: an output is no number there."""


INFEASIBLE = "Infeasible_Problem_Detected"
"""IPOPT's word for a point from which no small change brings the violated limits closer to being met."""


class Meaning(NamedTuple):
    """Meaning of a status and the next step, which is empty if there is nothing to do."""

    words: str
    step: str


_BETTER_START = "set `module` to a design that nearly works, or try more `solver.starts`"
_MORE_TIME = f"raise `solver.time_limit` (or --time-limit), or {_BETTER_START}"
_REPORT = "this is a fault of the program or its libraries: report it with the study file"

MEANINGS = {
    "Solve_Succeeded": Meaning("converged", ""),
    "Solved_To_Acceptable_Level": Meaning(
        "converged, though less exactly than asked",
        "look at what the check outside the solver says, or ease `solver.tolerance`",
    ),
    FEASIBLE: Meaning("a feasible design was found, not the best one", _BETTER_START),
    INFEASIBLE: Meaning(
        "ended where no small change brings the violated limits closer to being met",
        "ease one of the limits it names, or widen a range that stands in the way",
    ),
    "Search_Direction_Becomes_Too_Small": Meaning("stalled: the next step is smaller than rounding", _BETTER_START),
    "Diverging_Iterates": Meaning(
        "ran off without end: something that is minimised has no least value here",
        "give the variables it names ranges, or limit what is minimised under `require`",
    ),
    "User_Requested_Stop": Meaning("was interrupted", "run it again"),
    "Maximum_Iterations_Exceeded": Meaning(
        "ran out of iterations", "raise `solver.max_iterations`, or try more `solver.starts`"
    ),
    "Maximum_CpuTime_Exceeded": Meaning("ran out of processor time", _MORE_TIME),
    "Maximum_WallTime_Exceeded": Meaning("ran out of time", _MORE_TIME),
    "Restoration_Failed": Meaning("lost its way back to the equations of the switch", _BETTER_START),
    "Error_In_Step_Computation": Meaning(
        "could not compute a step: the equations are close to singular there", _BETTER_START
    ),
    "Invalid_Number_Detected": Meaning(
        "met a point where an output is no number, such as a leg that cannot reach its pin",
        "narrow the ranges under `vary` to modules that can exist",
    ),
    "Not_Enough_Degrees_Of_Freedom": Meaning(
        "has fewer variables than equations left", "free another variable under `vary`"
    ),
    "Invalid_Problem_Definition": Meaning("was given a problem that makes no sense", _REPORT),
    "Invalid_Option": Meaning("was given an option it does not know", _REPORT),
    "Unrecoverable_Exception": Meaning("failed inside", _REPORT),
    "NonIpopt_Exception_Thrown": Meaning("failed inside one of its libraries", _REPORT),
    "Insufficient_Memory": Meaning("ran out of memory", "ask for fewer `solver.cells` or a lower `solver.fineness`"),
    "Internal_Error": Meaning("failed inside", _REPORT),
}


def meaning(status: str) -> Meaning:
    """Return the meaning of a status; one of a later IPOPT is shown as it is."""
    return MEANINGS.get(status, Meaning(f"ended with {status.replace('_', ' ').lower()}", _REPORT))
