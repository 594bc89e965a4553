"""End of a solver run at one start, and the part from which another run can start."""

from __future__ import annotations

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
Ends = tuple[float, float]
"""Least and largest value of a number, SI; twice the same fixes it."""


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
    current_profiles: dict[str, CurrentProfile]
    """The free currents by phase."""
    ends: dict[str, float]
    """Time [s] each phase takes that the problem has."""
    unknowns: Array
    multipliers: Array
    bound_multipliers: Array
    times: Mapping[str, float] = field(default_factory=dict)
    """Time [s] of each event the problem needs."""
    within: Mapping[str, Ends] = field(default_factory=dict)
    """Ends of their own that some numbers were kept within."""
    grids: dict[str, Grid] = field(default_factory=dict)
    """The steps of each phase at which it was run."""

    @property
    def trace(self) -> Trace:
        """Return the state from which another run can start."""
        return Trace(self.unknowns, self.multipliers, self.bound_multipliers)


@dataclass(frozen=True)
class Derivatives:
    """The problem where a run ended: its constraints' values, and exact first and second derivatives."""

    rows: Array
    jacobian: Array
    """Of the constraints by the unknowns."""
    hessian: Array
    """Of the Lagrangian."""
    values: dict[str, float]
    """The minimised outputs."""
    gradients: dict[str, Array]
    """Of the minimised outputs by the unknowns."""
