"""Stacks cut down to problems that have closed solutions, and their integration in time by scipy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from comparisons.numbers import Array
from tvimdesign.physics.heat_flow import heat, lumps, peltier
from tvimdesign.physics.polymers import polymer
from tvimdesign.simulation.working_cycle.symbols import ca

NO_MELTING = polymer.Melting(1900.0, 1900.0, 1.0, 5000.0, 5001.0, 1e-3)
COLD = 295.15
FIXED = 1e12
"""Heat capacity [J/K] of what keeps its temperature."""


@dataclass(frozen=True)
class History:
    """A stack over time."""

    stack: heat.Stack
    times: Array
    states: Array
    """One column a time."""

    def profiles(self) -> list[heat.Profile]:
        """Temperatures and flows at each time."""
        return [heat.profile(column, self.stack) for column in self.states.T]


def bare_stack(**changes: Any) -> heat.Stack:
    """Return a layer of 1 mm on 1000 mm^2 without melting, losses and heating, with the given changes."""
    stack = heat.Stack(
        area=1e-3, thickness=1e-3, density=1145.0, conductivity_solid=0.2, conductivity_melt=0.2,
        melting=NO_MELTING, peltier=peltier.PeltierModule(0.0, 1.0, 0.0), cold_capacity=1e9, hot_capacity=1e-7,
        cold_surface=lumps.NOWHERE, hot_contact=1e12, plate_contact=1e-12, plate_thickness=1e-3,
        plate_conductivity=0.2, plate_heat_capacity=1e6, plate_surface=lumps.Surface(1e-3, 1e-12), ambient=COLD,
        plate_cells=1,
    )  # fmt: skip
    return stack._replace(**changes)


def integrate(
    stack: heat.Stack, begin: Array, times: Sequence[float], tolerance: float = 1e-9, current: float = 0.0
) -> History:
    """Integrate a stack to each of the given times from a state; neighbours alone couple, so the Jacobian is banded."""
    # Compiled: a stack takes thousands of steps, and numpy needs ten times as long for each.
    symbols = ca.SX.sym("state", len(begin))
    written = heat.rates(np.reshape(symbols, (len(begin),)), stack, current)
    rates = ca.Function("rates", [symbols], [ca.vertcat(*written)])
    results = solve_ivp(
        lambda _, y: np.asarray(rates(y)).ravel(), (0.0, times[-1]), begin, method="LSODA", t_eval=times,
        lband=1, uband=1, rtol=tolerance, atol=tolerance * 1e-3,
    )  # fmt: skip
    if not results.success:
        raise ValueError(f"the stack could not be integrated: {results.message}")
    return History(stack, np.asarray(times), results.y)
