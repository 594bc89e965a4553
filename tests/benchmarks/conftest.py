"""What the benchmarks have written for numba is tested as plain Python: compiling it takes longer than all else."""

from importlib import import_module
from unittest.mock import patch

from numba import config

with patch.object(config, "DISABLE_JIT", new=True):
    import_module("by_hand")
