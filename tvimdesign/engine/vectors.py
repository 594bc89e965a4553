"""Operations on the lanes of registers: one row of an array is a register, its columns are designs side by side.

Each is one instruction of LLVM on a vector, so that nothing is left to decide for the compiler. Exponential and
logarithm are written out: range reduction and a polynomial, within two units of the last place.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numpy.typing import NDArray

Array = NDArray[np.float64]

LANES = 16  # Designs side by side: 128 bytes a register
_NUMBERS = ir.VectorType(ir.DoubleType(), LANES)
_WHOLE = ir.VectorType(ir.IntType(64), LANES)
_LN2_HIGH, _LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
"""ln 2 in two parts: the first has so few digits that its multiples are exact (fdlibm, e_exp.c)."""
_ALIGNED = 64
BLOCK = 8  # Tangents in one instruction
_TANGENTS = ir.VectorType(ir.DoubleType(), BLOCK)


def registers(rows: int, columns: int = LANES) -> Array:
    """Return registers of zeros that begin where a line of the cache does: across two all takes twice as long."""
    room = np.zeros(rows * columns + _ALIGNED // 8)
    first = -room.ctypes.data // 8 % (_ALIGNED // 8)
    return room[first : first + rows * columns].reshape(rows, columns)


def tangent_registers(rows: int, directions: int) -> Array:
    """Return registers for the tangents along some directions: whole blocks; those beyond stay zero."""
    return registers(rows, max(math.ceil(directions / BLOCK), 1) * BLOCK)


def _lanewise(operands: int, write: Callable[..., Any]) -> Any:
    """Return a compiled function (registers, place of the result, places of the operands)."""

    def typed(*kinds: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, given: Sequence[Any]) -> Any:
            room = cgutils.create_struct_proxy(signature.args[0])(context, builder, given[0])

            def at(i: int) -> Any:
                place = context.cast(builder, given[i], signature.args[i], types.intp)
                first = builder.gep(room.data, [builder.mul(place, ir.Constant(place.type, LANES))])
                return builder.bitcast(first, _NUMBERS.as_pointer())

            values = [builder.load(at(2 + i), align=_ALIGNED) for i in range(operands)]
            builder.store(write(builder, *values), at(1), align=_ALIGNED)
            return context.get_dummy_value()

        return types.void(*kinds), generate

    if operands == 1:
        return intrinsic(lambda _, w, to, x: typed(w, to, x))
    if operands == 2:
        return intrinsic(lambda _, w, to, x, y: typed(w, to, x, y))
    return intrinsic(lambda _, w, to, x, y, z: typed(w, to, x, y, z))


def _all(value: float) -> Any:
    return ir.Constant(_NUMBERS, [value] * LANES)


def _known(b: Any, name: str, *values: Any) -> Any:
    """Return a function of LLVM's own."""
    kind = ir.FunctionType(_NUMBERS, [_NUMBERS] * len(values))
    return b.call(cgutils.get_or_insert_function(b.module, kind, f"llvm.{name}.v{LANES}f64"), values)


def _where(b: Any, test: str, x: Any, y: Any, yes: Any, no: Any) -> Any:
    """Choose by an ordered comparison, which nothing passes that is no number."""
    return b.select(b.fcmp_ordered(test, x, y), yes, no)


def _horner(b: Any, x: Any, coefficients: Sequence[float]) -> Any:
    total = _all(coefficients[0])
    for coefficient in coefficients[1:]:
        total = _known(b, "fmuladd", total, x, _all(coefficient))
    return total


def _exp(b: Any, given: Any) -> Any:
    """exp x = 2^n exp r with |r| <= ln(2)/2, whose Taylor series ends at r^13/13!."""
    x = _known(b, "minnum", _known(b, "maxnum", given, _all(-1000.0)), _all(1000.0))
    n = _known(b, "rint", b.fmul(x, _all(1.0 / math.log(2.0))))
    r = b.fsub(b.fsub(x, b.fmul(n, _all(_LN2_HIGH))), b.fmul(n, _all(_LN2_LOW)))
    value = _horner(b, r, [1.0 / math.factorial(k) for k in range(13, -1, -1)])
    power = b.fptosi(n, _WHOLE)
    half = b.ashr(power, _bits(1))
    for part in (half, b.sub(power, half)):  # in two steps, as 2^n alone may be no number
        value = b.fmul(value, b.bitcast(b.shl(b.add(part, _bits(1023)), _bits(52)), _NUMBERS))
    return b.select(b.fcmp_unordered("uno", given, given), given, value)


def _bits(value: int) -> Any:
    return ir.Constant(_WHOLE, [value] * LANES)


def _log(b: Any, given: Any) -> Any:
    """log x = e ln 2 + 2 artanh s, s = (m - 1)/(m + 1), with x = 2^e m and m between sqrt(1/2) and sqrt 2."""
    tiny, root = _all(2.2250738585072014e-308), _all(math.sqrt(2.0))
    x = _where(b, "<", given, tiny, b.fmul(given, _all(2.0**54)), given)
    bits = b.bitcast(x, _WHOLE)
    power = b.sub(b.lshr(bits, _bits(52)), _bits(1023))
    m = b.bitcast(b.or_(b.and_(bits, _bits(2**52 - 1)), _bits(1023 << 52)), _NUMBERS)
    e = b.fsub(b.sitofp(power, _NUMBERS), _where(b, "<", given, tiny, _all(54.0), _all(0.0)))
    e = _where(b, ">", m, root, b.fadd(e, _all(1.0)), e)
    m = _where(b, ">", m, root, b.fmul(m, _all(0.5)), m)
    f = b.fsub(m, _all(1.0))
    s = b.fdiv(f, b.fadd(f, _all(2.0)))
    series = _horner(b, b.fmul(s, s), [2.0 / k for k in range(23, 0, -2)])
    small = b.fadd(b.fmul(s, series), b.fmul(e, _all(_LN2_LOW)))
    value = b.fadd(b.fmul(e, _all(_LN2_HIGH)), small)
    value = _where(b, "==", given, _all(math.inf), given, value)
    value = _where(b, "==", given, _all(0.0), _all(-math.inf), value)
    return _where(b, ">=", given, _all(0.0), value, _all(math.nan))


def _log1p(b: Any, x: Any) -> Any:
    """log(1 + x) = x log(u)/(u - 1), u = 1 + x as it is rounded (Kahan)."""
    u = b.fadd(x, _all(1.0))
    d = b.fsub(u, _all(1.0))
    value = b.fmul(_log(b, u), b.fdiv(x, d))
    value = _where(b, "==", x, _all(math.inf), x, value)
    return _where(b, "==", d, _all(0.0), x, value)


add = _lanewise(2, lambda b, x, y: b.fadd(x, y))
sub = _lanewise(2, lambda b, x, y: b.fsub(x, y))
mul = _lanewise(2, lambda b, x, y: b.fmul(x, y))
div = _lanewise(2, lambda b, x, y: b.fdiv(x, y))
neg = _lanewise(1, lambda b, x: b.fneg(x))
square = _lanewise(1, lambda b, x: b.fmul(x, x))
twice = _lanewise(1, lambda b, x: b.fadd(x, x))
inverse = _lanewise(1, lambda b, x: b.fdiv(_all(1.0), x))
sqrt = _lanewise(1, lambda b, x: _known(b, "sqrt", x))
fabs = _lanewise(1, lambda b, x: _known(b, "fabs", x))
exp = _lanewise(1, _exp)
log = _lanewise(1, _log)
log1p = _lanewise(1, _log1p)
sin, cos, asin, acos, atan, tanh = (
    _lanewise(1, lambda b, x, name=name: _known(b, name, x)) for name in ("sin", "cos", "asin", "acos", "atan", "tanh")
)
"""The C library's, one design at a time."""
power = _lanewise(2, lambda b, x, y: _exp(b, b.fmul(y, _log(b, x))))
"""Of positive numbers; its error grows with the size of its logarithm."""
less = _lanewise(2, lambda b, x, y: _where(b, "<", x, y, _all(1.0), _all(0.0)))
at_most = _lanewise(2, lambda b, x, y: _where(b, "<=", x, y, _all(1.0), _all(0.0)))
lesser = _lanewise(2, lambda b, x, y: _known(b, "minnum", x, y))
larger = _lanewise(2, lambda b, x, y: _known(b, "maxnum", x, y))
if_else_zero = _lanewise(2, lambda b, x, y: b.select(b.fcmp_unordered("!=", x, _all(0.0)), y, _all(0.0)))
copy = _lanewise(1, lambda _, x: x)
add_product = _lanewise(3, lambda b, x, y, z: b.fadd(x, b.fmul(y, z)))
"""x + y z, each rounded, as in a register that holds x."""
sub_product = _lanewise(3, lambda b, x, y, z: b.fsub(x, b.fmul(y, z)))


def _along(operands: int) -> Any:
    """Return a compiled function (tangents, place of the result, place and factor of each operand).

    It fills a block of tangents with the sum of factors times those of the operands; places count blocks.
    """

    def typed(*kinds: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, given: Sequence[Any]) -> Any:
            room = cgutils.create_struct_proxy(signature.args[0])(context, builder, given[0])

            def at(i: int) -> Any:
                place = context.cast(builder, given[i], signature.args[i], types.intp)
                first = builder.gep(room.data, [builder.mul(place, ir.Constant(place.type, BLOCK))])
                return builder.bitcast(first, _TANGENTS.as_pointer())

            empty = ir.Constant(_TANGENTS, ir.Undefined)
            every_first = ir.Constant(ir.VectorType(ir.IntType(32), BLOCK), [0] * BLOCK)
            total: Any = None
            for i in range(2, 2 + 2 * operands, 2):
                factor = context.cast(builder, given[i + 1], signature.args[i + 1], types.float64)
                first = builder.insert_element(empty, factor, ir.Constant(ir.IntType(32), 0))
                factors = builder.shuffle_vector(first, empty, every_first)
                value = builder.load(at(i), align=8)
                total = builder.fmul(factors, value) if total is None else _fma(builder, factors, value, total)
            builder.store(total, at(1), align=8)
            return context.get_dummy_value()

        return types.void(*kinds), generate

    if operands == 1:
        return intrinsic(lambda _, d, to, x, by_x: typed(d, to, x, by_x))
    return intrinsic(lambda _, d, to, x, by_x, y, by_y: typed(d, to, x, by_x, y, by_y))


def _fma(b: Any, x: Any, y: Any, z: Any) -> Any:
    kind = ir.FunctionType(_TANGENTS, [_TANGENTS] * 3)
    return b.call(cgutils.get_or_insert_function(b.module, kind, f"llvm.fmuladd.v{BLOCK}f64"), [x, y, z])


scale_tangents, add_tangents = _along(1), _along(2)  # by_x x, and by_x x + by_y y
