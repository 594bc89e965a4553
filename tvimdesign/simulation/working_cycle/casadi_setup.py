"""CasADi, loaded once and set up the way every solver here wants it."""

from __future__ import annotations

import os

# Two BLAS threads double the CPU time of systems this small and gain nothing; said before CasADi loads its libraries.
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

import casadi as ca  # noqa: E402  # the threads are set before it loads

# Equations are written with numpy's functions; this makes CasADi answer to them.
ca.GlobalOptions.setNumpyMode(1)

__all__ = ["ca"]
