"""CasADi, loaded once and set up the way every solver here wants it; its threads are set where the room begins."""

from collections.abc import Mapping, Sequence
from typing import Any

import casadi as ca

# Equations are written with numpy's functions; this makes CasADi answer to them.
ca.GlobalOptions.setNumpyMode(1)


def lean_function(name: str, arguments: Sequence[Any], value: Any, options: Mapping[str, Any] | None = None) -> Any:
    """Return a function of SX in which repeated expressions are computed once.

    Rows of the table write out what they need, so that a third to two thirds of the operations are repeats, and of the
    second derivatives half. CasADi's option for it would go through every derivative again, which takes longer.
    """
    return ca.Function(name, arguments, [ca.cse(value)], dict(options or {}))


__all__ = ["ca", "lean_function"]
