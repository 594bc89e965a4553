"""Code that the benchmarks wrote by hand for numba, as plain Python: compiling it takes longer than all else."""

from unittest import mock

import numba

import tvimdesign.engine.integrator  # what the product has written for numba stays compiled

with mock.patch.object(numba.config, "DISABLE_JIT", True):
    import by_hand
    import hand_module

__all__ = ["by_hand", "hand_module", "tvimdesign"]
