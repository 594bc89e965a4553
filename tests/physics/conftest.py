"""Stacks cut down to problems that have textbook solutions, and their integration in time by scipy."""

from collections.abc import Callable

import pytest
from comparisons.bare_stack import History
from comparisons.bare_stack import bare_stack as make_bare_stack
from comparisons.bare_stack import integrate as integrate_stack
from hypothesis import settings

from tvimdesign.physics.heat_flow import heat

# A slow machine is no mistake in the equations.
settings.register_profile("no deadline", deadline=None)
settings.load_profile("no deadline")


@pytest.fixture(scope="session")
def bare_stack() -> Callable[..., heat.Stack]:
    """Return the builder of a layer without melting, losses and heating (validation/comparisons)."""
    return make_bare_stack


@pytest.fixture(scope="session")
def integrate() -> Callable[..., History]:
    """Integrate a stack to each of the given times from a state."""
    return integrate_stack
