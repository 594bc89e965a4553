"""CasADi, set up the way every solver here wants it, and symbols that numpy's functions act on.

They are scalars and one-dimensional arrays of CasADi's SX, written down quickly.
CasADi's own array of symbols tries every kind of matrix for each operation: 30 microseconds, ten times the operation.
Here what is elementwise goes straight to the function for SX; all else is left to CasADi's array. Without this file the
first optimum of a study of 13 sizes takes 28 % longer, 0.51 s of the processor in place of 0.40.
"""

from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np

# Equations are written with numpy's functions; this makes CasADi answer to them.
ca.GlobalOptions.setNumpyMode(1)
__all__ = ["Symbols", "ca", "symbols"]


_UNARY = {
    np.negative: ca.OP_NEG, np.sqrt: ca.OP_SQRT, np.exp: ca.OP_EXP, np.expm1: ca.OP_EXPM1, np.log: ca.OP_LOG,
    np.log1p: ca.OP_LOG1P, np.sin: ca.OP_SIN, np.cos: ca.OP_COS, np.tan: ca.OP_TAN, np.arcsin: ca.OP_ASIN,
    np.arccos: ca.OP_ACOS, np.arctan: ca.OP_ATAN, np.tanh: ca.OP_TANH, np.fabs: ca.OP_FABS, np.absolute: ca.OP_FABS,
}  # fmt: skip
_BINARY = {
    np.add: ca.OP_ADD, np.subtract: ca.OP_SUB, np.multiply: ca.OP_MUL, np.divide: ca.OP_DIV, np.power: ca.OP_POW,
    np.fmin: ca.OP_FMIN, np.fmax: ca.OP_FMAX, np.minimum: ca.OP_FMIN, np.maximum: ca.OP_FMAX,
    np.arctan2: ca.OP_ATAN2,
}  # fmt: skip


class Symbols(ca.ArrayInterfaceSX):
    """A scalar or a one-dimensional array of SX, which CasADi keeps as a quantity in `_v`."""

    _v: Any
    _ndim: int

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **kwargs: Any) -> Any:
        """Apply one of numpy's elementwise functions."""
        if method == "__call__" and not kwargs:
            if ufunc in _UNARY:
                return _of(ca.SX.unary(_UNARY[ufunc], self._v), self._ndim)
            if ufunc in _BINARY:
                return _binary(_BINARY[ufunc], *inputs)
        return _quick(super().__array_ufunc__(ufunc, method, *inputs, **kwargs))

    def __array_function__(self, *call: Any) -> Any:
        return _quick(super().__array_function__(*call))

    def __getitem__(self, place: Any) -> Any:
        """Return entries, by any index that numpy takes."""
        if self._ndim == 1 and isinstance(place, int):
            return _of(self._v[place], 0)
        return _quick(super().__getitem__(place))

    def __neg__(self) -> Any:
        return _of(ca.SX.unary(ca.OP_NEG, self._v), self._ndim)


def _operator(code: int, *, reflected: bool = False) -> Callable[[Any, Any], Any]:
    """Return the method of an operator between two operands."""
    if reflected:
        return lambda self, other: _binary(code, other, self)
    return lambda self, other: _binary(code, self, other)


for _name, _code in (
    ("add", ca.OP_ADD), ("sub", ca.OP_SUB), ("mul", ca.OP_MUL), ("truediv", ca.OP_DIV), ("pow", ca.OP_POW),
):  # fmt: skip
    setattr(Symbols, f"__{_name}__", _operator(_code))
    setattr(Symbols, f"__r{_name}__", _operator(_code, reflected=True))


def _binary(code: int, *operands: Any) -> Any:
    """Apply an elementwise operation to two operands, one of them symbols."""
    matrices, dimensions = [], 0
    for operand in operands:
        if isinstance(operand, float | int):
            matrices.append(operand)
            continue
        array: Any = operand if isinstance(operand, ca.ArrayInterface) else ca.ArrayInterface(operand)
        matrices.append(array._v)
        dimensions = max(dimensions, array._ndim)
    return _of(ca.SX.binary(code, *matrices), dimensions)


def _of(matrix: Any, dimensions: int) -> Symbols:
    """Return symbols of what CasADi computed: a quantity where there is a dimension."""
    made: Symbols = object.__new__(Symbols)
    made._v, made._ndim = matrix, dimensions
    return made


def _quick(result: Any) -> Any:
    """Convert CasADi's array to symbols where it can be."""
    if type(result) is not ca.ArrayInterfaceSX:
        return result
    array: Any = result
    return _of(array._v, array._ndim) if array._ndim < 2 else array


def symbols(column: Any) -> Symbols:
    """Return a column of SX as the one-dimensional array that the equations take; its entries are scalars."""
    return _of(column.T, 1)
