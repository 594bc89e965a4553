"""CasADi, loaded once and set up the way every solver here wants it; its threads are set where the room begins."""

from __future__ import annotations

import casadi as ca

# Equations are written with numpy's functions; this makes CasADi answer to them.
ca.GlobalOptions.setNumpyMode(1)

__all__ = ["ca"]
