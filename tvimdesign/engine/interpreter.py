"""Run a tape of operations: values alone, or values with tangents along directions.

A tape is what `tape.Tape` makes of a CasADi function: operations in groups of one kind, which do not need one
another. Registers `w` hold its arguments, then constants, then results. So the program below is compiled once,
whatever the function is, and takes about two nanoseconds for an operation.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from llvmlite import binding
from numba import cfunc, njit, types
from numba.np.numpy_support import carray
from numpy.typing import NDArray

from tvimdesign.engine.vectors import BLOCK, add_tangents, scale_tangents

Array = NDArray[np.float64]
Indices = NDArray[np.uint32]

(ADD, SUB, MUL, DIV, NEG, EXP, LOG, POW, CONSTPOW, SQRT, SQ, TWICE, SIN, COS, TAN, ASIN, ACOS, ATAN) = range(1, 19)
LT, LE, EQ, NE, NOT, AND, OR, FLOOR, CEIL = range(19, 28)
FABS, SIGN, COPYSIGN, IF_ELSE_ZERO, ERF, FMIN, FMAX, INV = range(29, 37)
SINH, COSH, TANH, ASINH, ACOSH, ATANH, ATAN2 = range(37, 44)
LOG1P, EXPM1, HYPOT = 93, 94, 95
"""CasADi's numbers of its operations (`casadi.OP_ADD`, ...); `tape` checks that they are still these."""


class Code(NamedTuple):
    """The operations of a tape, as the compiled program takes them."""

    first: Indices  # Register of each operation's first operand
    second: Indices  # Register of its second operand; the first again where there is none
    to: Indices  # Register of its result
    groups: NDArray[np.int64]
    """Operation of each group, and where the group starts: a row each; the last row ends the last group."""


_OPERANDS = types.CPointer(types.uint32)
_CODE = (_OPERANDS, _OPERANDS, _OPERANDS, types.CPointer(types.int64), types.intp)
_REGISTERS = (types.CPointer(types.float64), types.intp)
ON_VALUES, ON_TANGENTS = types.void(*_CODE, *_REGISTERS), types.void(*_CODE, *_REGISTERS, *_REGISTERS)
"""Arguments of a program by address: operands, results, groups and their number; registers and their number, tangents
and the number of directions.
"""
_PROGRAMS: dict[str, Any] = {}


def by_address(name: str, arguments: Any) -> Callable[[Callable[..., None]], Any]:
    """Compile a program once, to be called by its address: numba compiles a callee again into each of its callers."""

    def compiled(program: Callable[..., None]) -> Any:
        _PROGRAMS[name] = cfunc(arguments, cache=True, error_model="numpy")(program)
        binding.add_symbol(name, _PROGRAMS[name].address)
        return types.ExternalFunction(name, arguments)

    return compiled


@njit(cache=True, error_model="numpy")
def slopes_of(op: int, x: float, y: float) -> tuple[float, float, float]:
    """Return the value of an operation and its slopes by both operands."""
    if op == ADD:
        return x + y, 1.0, 1.0
    if op == SUB:
        return x - y, 1.0, -1.0
    if op == MUL:
        return x * y, y, x
    if op == DIV:
        quotient = x / y
        return quotient, 1.0 / y, -quotient / y
    if op == NEG:
        return -x, -1.0, 0.0
    if op == EXP:
        power = math.exp(x)
        return power, power, 0.0
    if op == LOG:
        return math.log(x), 1.0 / x, 0.0
    if op == POW:
        power = x**y
        return power, y * x ** (y - 1.0), (power * math.log(x) if x > 0.0 else 0.0)
    if op == CONSTPOW:
        return x**y, y * x ** (y - 1.0), 0.0
    if op == SQRT:
        root = math.sqrt(x)
        return root, 0.5 / root, 0.0
    if op == SQ:
        return x * x, 2.0 * x, 0.0
    if op == TWICE:
        return 2.0 * x, 2.0, 0.0
    if op == INV:
        inverse = 1.0 / x
        return inverse, -inverse * inverse, 0.0
    if op == FABS:
        return abs(x), (1.0 if x > 0.0 else -1.0 if x < 0.0 else 0.0), 0.0
    if op == FMIN:
        return (x, 1.0, 0.0) if x <= y or math.isnan(y) else (y, 0.0, 1.0)
    if op == FMAX:
        return (x, 1.0, 0.0) if x >= y or math.isnan(y) else (y, 0.0, 1.0)
    if op == IF_ELSE_ZERO:
        return (y, 0.0, 1.0) if x != 0.0 else (0.0, 0.0, 0.0)
    if op <= ATAN and op >= SIN:
        return _circular(op, x)
    if op >= SINH and op <= ATAN2:
        return _hyperbolic(op, x, y)
    if op == LOG1P:
        return math.log1p(x), 1.0 / (1.0 + x), 0.0
    if op == EXPM1:
        return math.expm1(x), math.exp(x), 0.0
    if op == HYPOT:
        length = math.hypot(x, y)
        return length, x / length, y / length
    if op == ERF:
        return math.erf(x), 2.0 / math.sqrt(math.pi) * math.exp(-x * x), 0.0
    if op == COPYSIGN:
        return math.copysign(x, y), math.copysign(1.0, x) * math.copysign(1.0, y), 0.0
    return _stepped(op, x, y), 0.0, 0.0


@njit(cache=True, error_model="numpy")
def _circular(op: int, x: float) -> tuple[float, float, float]:
    if op == SIN:
        return math.sin(x), math.cos(x), 0.0
    if op == COS:
        return math.cos(x), -math.sin(x), 0.0
    if op == TAN:
        tangent = math.tan(x)
        return tangent, 1.0 + tangent * tangent, 0.0
    if op == ASIN:
        return (math.asin(x), 1.0 / math.sqrt(1.0 - x * x), 0.0) if abs(x) <= 1.0 else (math.nan, math.nan, 0.0)
    if op == ACOS:
        return (math.acos(x), -1.0 / math.sqrt(1.0 - x * x), 0.0) if abs(x) <= 1.0 else (math.nan, math.nan, 0.0)
    return math.atan(x), 1.0 / (1.0 + x * x), 0.0


@njit(cache=True, error_model="numpy")
def _hyperbolic(op: int, x: float, y: float) -> tuple[float, float, float]:
    if op == SINH:
        return math.sinh(x), math.cosh(x), 0.0
    if op == COSH:
        return math.cosh(x), math.sinh(x), 0.0
    if op == TANH:
        tangent = math.tanh(x)
        return tangent, 1.0 - tangent * tangent, 0.0
    if op == ASINH:
        return math.asinh(x), 1.0 / math.sqrt(x * x + 1.0), 0.0
    if op == ACOSH:
        return (math.acosh(x), 1.0 / math.sqrt(x * x - 1.0), 0.0) if x >= 1.0 else (math.nan, math.nan, 0.0)
    if op == ATANH:
        return (math.atanh(x), 1.0 / (1.0 - x * x), 0.0) if abs(x) <= 1.0 else (math.nan, math.nan, 0.0)
    square = x * x + y * y
    return math.atan2(x, y), y / square, -x / square


@njit(cache=True, error_model="numpy")
def _stepped(op: int, x: float, y: float) -> float:
    """Return the value of an operation whose slopes are zero. Operations that are none of these give NaN."""
    if op == LT:
        return 1.0 if x < y else 0.0
    if op == LE:
        return 1.0 if x <= y else 0.0
    if op == EQ:
        return 1.0 if x == y else 0.0
    if op == NE:
        return 1.0 if x != y else 0.0
    if op == NOT:
        return 1.0 if x == 0.0 else 0.0
    if op == AND:
        return 1.0 if x != 0.0 and y != 0.0 else 0.0
    if op == OR:
        return 1.0 if x != 0.0 or y != 0.0 else 0.0
    if op == FLOOR:
        return float(np.floor(x))
    if op == CEIL:
        return float(np.ceil(x))
    if op == SIGN:
        return 1.0 if x > 0.0 else -1.0 if x < 0.0 else x
    return math.nan


@njit(cache=True, error_model="numpy")
def run(code: Code, w: Array) -> None:
    """Fill the registers of the results from those of the arguments and constants."""
    first, second, to, groups = code.first.ctypes, code.second.ctypes, code.to.ctypes, code.groups.ctypes
    _run(first, second, to, groups, code.groups.shape[0] - 1, w.ctypes, w.shape[0])


@by_address("tvimdesign_values", ON_VALUES)
def _run(first: Any, second: Any, to: Any, groups_at: Any, count: int, w: Any, _size: int) -> None:
    groups = carray(groups_at, (count + 1, 2))
    for g in range(count):
        op, start, end = groups[g, 0], groups[g, 1], groups[g + 1, 1]
        if op == MUL:
            for k in range(start, end):
                w[to[k]] = w[first[k]] * w[second[k]]
        elif op == ADD:
            for k in range(start, end):
                w[to[k]] = w[first[k]] + w[second[k]]
        elif op == SUB:
            for k in range(start, end):
                w[to[k]] = w[first[k]] - w[second[k]]
        elif op == DIV:
            for k in range(start, end):
                w[to[k]] = w[first[k]] / w[second[k]]
        elif op == SQ:
            for k in range(start, end):
                w[to[k]] = w[first[k]] * w[first[k]]
        elif op == NEG:
            for k in range(start, end):
                w[to[k]] = -w[first[k]]
        elif op == SQRT:
            for k in range(start, end):
                w[to[k]] = math.sqrt(w[first[k]])
        elif op == EXP:
            for k in range(start, end):
                w[to[k]] = math.exp(w[first[k]])
        elif op == LOG:
            for k in range(start, end):
                w[to[k]] = math.log(w[first[k]])
        else:
            for k in range(start, end):
                w[to[k]] = slopes_of(op, w[first[k]], w[second[k]])[0]


@njit(cache=True, error_model="numpy")
def push(code: Code, w: Array, d: Array) -> None:
    """Fill the registers, and their tangents `d` along the directions, in blocks of columns (`tangent_registers`)."""
    first, second, to, groups = code.first.ctypes, code.second.ctypes, code.to.ctypes, code.groups.ctypes
    _push(first, second, to, groups, code.groups.shape[0] - 1, w.ctypes, w.shape[0], d.ctypes, d.shape[1])


@by_address("tvimdesign_tangents", ON_TANGENTS)
def _push(
    first: Any, second: Any, to: Any, groups_at: Any, count: int, w: Any, size: int, tangents: Any, columns: int
) -> None:
    groups, d, blocks = carray(groups_at, (count + 1, 2)), carray(tangents, (size, columns)), columns // BLOCK
    for g in range(count):
        op, start, end = groups[g, 0], groups[g, 1], groups[g + 1, 1]
        for k in range(start, end):
            left, right, at = first[k], second[k], to[k]
            x, y = w[left], w[right]
            if op == MUL:
                value, by_x, by_y = x * y, y, x
            elif op == ADD:
                value, by_x, by_y = x + y, 1.0, 1.0
            elif op == SUB:
                value, by_x, by_y = x - y, 1.0, -1.0
            else:
                value, by_x, by_y = slopes_of(op, x, y)
            w[at] = value
            for j in range(blocks):
                if by_y == 0.0:
                    scale_tangents(d, at * blocks + j, left * blocks + j, by_x)
                else:
                    add_tangents(d, at * blocks + j, left * blocks + j, by_x, right * blocks + j, by_y)
