"""Numba is off in tests of the benchmarks: compiling takes longer than all else."""

from importlib import import_module
from unittest.mock import patch

from numba import config

with patch.object(config, "DISABLE_JIT", new=True):
    import_module("by_hand")
