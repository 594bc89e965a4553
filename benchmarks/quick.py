"""Calls a CasADi function through its buffers, without the copies and conversions of an ordinary call."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Quick:
    """A CasADi function of one result; the object keeps alive the memory it reads from and writes to."""

    def __init__(self, function: Any) -> None:
        """Hand the function its memory."""
        self._function = function
        self._buffer, self._call = function.buffer()
        self._arguments = [np.zeros(function.numel_in(i)) for i in range(function.n_in())]
        self._result = np.zeros(function.numel_out(0))
        self._shape = function.size_out(0) if function.size2_out(0) > 1 else (function.numel_out(0),)
        for i, argument in enumerate(self._arguments):
            self._buffer.set_arg(i, memoryview(argument))
        self._buffer.set_res(0, memoryview(self._result))

    def __call__(self, *arguments: Any) -> Array:
        """Evaluate."""
        for memory, argument in zip(self._arguments, arguments, strict=True):
            memory[:] = argument
        self._call()
        return self._result.reshape(self._shape, order="F").copy()
