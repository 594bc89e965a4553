"""A function of an instant in two parts: what is the same all through a phase, and what is not."""

from collections.abc import Callable
from functools import cache
from typing import Any

from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions


@cache
def per_phase(phase: PhaseFunctions, function: Callable[..., Any]) -> tuple[Any, Any]:
    """The functions inputs -> constants, and (state, current, constants) -> the function's value."""
    state, profile, inputs = phase._state, phase._drive, phase._inputs
    value, constants, changing = phase._parted(function(state, profile, inputs))
    return (
        ca.Function("constants", [inputs], [constants]),
        ca.Function("varying", [state, profile, changing], [value], {"enable_forward": False}),
    )
