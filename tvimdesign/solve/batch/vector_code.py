"""A CasADi function of scalars written in LLVM's language, eight designs side by side, and compiled.

Exponentials and logarithms are written out so that they run in vectors too; the rarer trigonometric functions are the C
library's, one design at a time.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable
from functools import cache
from typing import Any

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.machine_code import Lines, MachineCode, hexadecimal
from tvimdesign.simulation.working_cycle.casadi_setup import ca

LANES = 8
_V = f"<{LANES} x double>"
_I = f"<{LANES} x i64>"
_B = f"<{LANES} x i1>"


def constant(value: float) -> str:
    """A number in every lane."""
    return f"<{', '.join([f'double {hexadecimal(value)}'] * LANES)}>"


def whole(value: int) -> str:
    """A whole number in every lane."""
    return f"<{', '.join([f'i64 {value}'] * LANES)}>"


class VectorLines(Lines):
    """The body of a function of vectors while it is written."""

    def __init__(self) -> None:
        """Nothing is written yet."""
        super().__init__(_V, f"v{LANES}f64")

    def own(self, name: str, *arguments: str) -> str:
        """A function of this module."""
        return self.new(f"call {_V} @{name}({', '.join(f'{_V} {a}' for a in arguments)})")

    def choose(self, comparison: str, a: str, b: str, yes: str, no: str) -> str:
        """`yes` where the comparison of a and b holds, else `no`."""
        truth = self.new(f"fcmp {comparison} {_V} {a}, {b}")
        return self.new(f"select {_B} {truth}, {_V} {yes}, {_V} {no}")

    def address(self, array: str, row: int) -> str:
        """Place of a row's entry for the first of the designs at hand."""
        at = self.new(f"add i64 {self.new(f'mul i64 %{array}_stride, {row}')}, %i")
        return self.new(f"getelementptr double, ptr %{array}, i64 {at}")

    def polynomial(self, x: str, coefficients: list[float]) -> str:
        """Horner's scheme, the highest power first."""
        found = constant(coefficients[0])
        for coefficient in coefficients[1:]:
            found = self.two("fadd", self.two("fmul", found, x), constant(coefficient))
        return found

    def each(self, name: str, *arguments: str) -> str:
        """A function of the C library, lane by lane."""
        found = "undef"
        for lane in range(LANES):
            parts = [self.new(f"extractelement {_V} {a}, i32 {lane}") for a in arguments]
            one = self.new(f"call double @{name}({', '.join(f'double {p}' for p in parts)})")
            found = self.new(f"insertelement {_V} {found}, double {one}, i32 {lane}")
        return found


_ONE, _ZERO, _TWO = constant(1.0), constant(0.0), constant(2.0)
_LIBRARY = {"sin": 1, "cos": 1, "tan": 1, "asin": 1, "acos": 1, "atan": 1, "atan2": 2, "sinh": 1, "cosh": 1,
            "tanh": 1, "erf": 1}  # fmt: skip
"""Functions of the C library that are called lane by lane, with the count of their arguments."""


def _both(operation: str) -> Callable[[VectorLines, str, str], str]:
    return lambda w, a, b: w.two(operation, a, b)


def _known(name: str) -> Callable[..., str]:
    return lambda w, *a: w.intrinsic(name, *a)


def _own(name: str) -> Callable[..., str]:
    return lambda w, *a: w.own(name, *a)


def _each(name: str) -> Callable[..., str]:
    return lambda w, *a: w.each(name, *a)


def _test(comparison: str) -> Callable[[VectorLines, str, str], str]:
    return lambda w, a, b: w.choose(comparison, a, b, _ONE, _ZERO)


_WRITTEN: dict[str, Callable[..., str]] = {
    "ASSIGN": lambda w, a: w.two("fadd", a, constant(-0.0)),
    "ADD": _both("fadd"),
    "SUB": _both("fsub"),
    "MUL": _both("fmul"),
    "DIV": _both("fdiv"),
    "NEG": lambda w, a: w.new(f"fneg {_V} {a}"),
    "INV": lambda w, a: w.two("fdiv", _ONE, a),
    "SQ": lambda w, a: w.two("fmul", a, a),
    "TWICE": lambda w, a: w.two("fadd", a, a),
    "SQRT": _known("sqrt"),
    "FABS": _known("fabs"),
    "FMIN": _known("minnum"),
    "FMAX": _known("maxnum"),
    "FLOOR": _known("floor"),
    "CEIL": _known("ceil"),
    "COPYSIGN": _known("copysign"),
    "SIGN": lambda w, a: w.choose("oeq", a, _ZERO, a, w.intrinsic("copysign", _ONE, a)),
    "EXP": _own("vexp"),
    "LOG": _own("vlog"),
    "LOG1P": _own("vlog1p"),
    "POW": lambda w, a, b: w.own("vexp", w.two("fmul", b, w.own("vlog", a))),
    "CONSTPOW": lambda w, a, b: w.own("vexp", w.two("fmul", b, w.own("vlog", a))),
    "LT": _test("olt"),
    "LE": _test("ole"),
    "EQ": _test("oeq"),
    "NE": _test("une"),
    "NOT": lambda w, a: w.choose("oeq", a, _ZERO, _ONE, _ZERO),
    "AND": lambda w, a, b: w.two("fmul", _test("une")(w, a, _ZERO), _test("une")(w, b, _ZERO)),
    "OR": lambda w, a, b: w.intrinsic("maxnum", _test("une")(w, a, _ZERO), _test("une")(w, b, _ZERO)),
    "IF_ELSE_ZERO": lambda w, a, b: w.choose("une", a, _ZERO, b, _ZERO),
    **{name.upper(): _each(name) for name in _LIBRARY},
}
"""How each of CasADi's operations is written. Powers are those of positive numbers."""


@cache
def _names() -> dict[int, str]:
    """CasADi's operations by number."""
    return {getattr(ca, name): name.removeprefix("OP_") for name in dir(ca) if name.startswith("OP_")}


def _offsets(function: Any, way: str) -> list[int]:
    """Row at which each argument or result begins."""
    count = getattr(function, f"n_{way}")()
    sizes = [getattr(function, f"numel_{way}")(i) for i in range(count)]
    if any(sizes[i] != getattr(function, f"nnz_{way}")(i) for i in range(count)):
        raise NotImplementedError("a function with sparse arguments or results has no vector form; densify it")
    return [sum(sizes[:i]) for i in range(count)]


def _body(function: Any) -> VectorLines:
    lines = VectorLines()
    slots: dict[int, str] = {}
    rows_in, rows_out = _offsets(function, "in"), _offsets(function, "out")
    for k in range(function.n_instructions()):
        name = _names()[function.instruction_id(k)]
        into, of = function.instruction_output(k), function.instruction_input(k)
        if name == "CONST":
            slots[into[0]] = constant(function.instruction_constant(k))
        elif name == "INPUT":
            place = lines.address("in", rows_in[of[0]] + of[1])
            slots[into[0]] = lines.new(f"load {_V}, ptr {place}, align 8")
        elif name == "OUTPUT":
            place = lines.address("out", rows_out[into[0]] + into[1])
            lines.text.append(f"  store {_V} {slots[of[0]]}, ptr {place}, align 8")
        elif name in _WRITTEN:
            slots[into[0]] = _WRITTEN[name](lines, *(slots[i] for i in of))
        else:
            raise NotImplementedError(f"the operation {name} of a CasADi function has no vector form; add it")
    return lines


def module_text(function: Any) -> str:
    """A module with `kernel(in, out, in stride, out stride, begin, end)`, which takes LANES columns at a time.

    `function` is an expanded CasADi function. Raises NotImplementedError naming an operation that cannot be written.
    """
    double = {1: "double", 2: "double, double"}
    declared = [f"declare double @{name}({double[count]})" for name, count in _LIBRARY.items()]
    return "\n".join([
        *_own_functions(), *declared,
        "define void @kernel(ptr noalias %in, ptr noalias %out, i64 %in_stride, i64 %out_stride, "
        "i64 %begin, i64 %end) {",
        "start:", "  %any = icmp slt i64 %begin, %end", "  br i1 %any, label %loop, label %done",
        "loop:", "  %i = phi i64 [ %begin, %start ], [ %next, %loop ]",
        *_body(function).text,
        f"  %next = add i64 %i, {LANES}", "  %more = icmp slt i64 %next, %end",
        "  br i1 %more, label %loop, label %done", "done:", "  ret void", "}",
    ])  # fmt: skip


_LN2_HIGH, _LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
"""ln 2 in two parts: the first has so few digits that its multiples are exact (fdlibm, e_exp.c)."""
_INFINITE = constant(math.inf)


def _own_functions() -> list[str]:
    """Exponential and logarithm in vectors, within two units of the last place."""
    text: list[str] = []
    for name, write in (("vexp", _write_exp), ("vlog", _write_log), ("vlog1p", _write_log1p)):
        lines = VectorLines()
        found = write(lines)
        # Not written into their callers: that runs no faster, and takes five times as long to compile.
        text += [f"define internal {_V} @{name}({_V} %x) noinline {{", *lines.text, f"  ret {_V} {found}", "}"]
    return text


def _write_exp(w: VectorLines) -> str:
    """exp x = 2^n exp r with |r| <= ln(2)/2, whose Taylor series ends at r^13/13!."""
    x = w.intrinsic("minnum", w.intrinsic("maxnum", "%x", constant(-1000.0)), constant(1000.0))
    n = w.intrinsic("rint", w.two("fmul", x, constant(1.0 / math.log(2.0))))
    r = w.two("fsub", x, w.two("fmul", n, constant(_LN2_HIGH)))
    r = w.two("fsub", r, w.two("fmul", n, constant(_LN2_LOW)))
    found = w.polynomial(r, [1.0 / math.factorial(k) for k in range(13, -1, -1)])
    power = w.new(f"fptosi {_V} {n} to {_I}")
    half = w.new(f"ashr {_I} {power}, {whole(1)}")
    rest = w.new(f"sub {_I} {power}, {half}")
    for part in (half, rest):  # in two steps, as 2^n alone may be no number
        shifted = w.new(f"shl {_I} {w.new(f'add {_I} {part}, {whole(1023)}')}, {whole(52)}")
        found = w.two("fmul", found, w.new(f"bitcast {_I} {shifted} to {_V}"))
    return w.choose("uno", "%x", "%x", "%x", found)


def _write_log(w: VectorLines) -> str:
    """log x = e ln 2 + 2 artanh s, s = (m - 1)/(m + 1), with x = 2^e m and m between sqrt(1/2) and sqrt 2."""
    tiny = constant(2.2250738585072014e-308)
    x = w.choose("olt", "%x", tiny, w.two("fmul", "%x", constant(2.0**54)), "%x")
    lifted = w.choose("olt", "%x", tiny, constant(54.0), _ZERO)
    bits = w.new(f"bitcast {_V} {x} to {_I}")
    power = w.new(f"sub {_I} {w.new(f'lshr {_I} {bits}, {whole(52)}')}, {whole(1023)}")
    mantissa = w.new(f"or {_I} {w.new(f'and {_I} {bits}, {whole(2**52 - 1)}')}, {whole(1023 << 52)}")
    m = w.new(f"bitcast {_I} {mantissa} to {_V}")
    root = constant(math.sqrt(2.0))
    e = w.two("fsub", w.new(f"sitofp {_I} {power} to {_V}"), lifted)
    e = w.choose("ogt", m, root, w.two("fadd", e, _ONE), e)
    m = w.choose("ogt", m, root, w.two("fmul", m, constant(0.5)), m)
    f = w.two("fsub", m, _ONE)
    s = w.two("fdiv", f, w.two("fadd", f, _TWO))
    series = w.polynomial(w.two("fmul", s, s), [2.0 / k for k in range(23, 0, -2)])
    small = w.two("fadd", w.two("fmul", s, series), w.two("fmul", e, constant(_LN2_LOW)))
    found = w.two("fadd", w.two("fmul", e, constant(_LN2_HIGH)), small)
    found = w.choose("oeq", "%x", _INFINITE, "%x", found)
    found = w.choose("oeq", "%x", _ZERO, constant(-math.inf), found)
    return w.choose("ult", "%x", _ZERO, constant(math.nan), found)


def _write_log1p(w: VectorLines) -> str:
    """log(1 + x) = x log(u)/(u - 1), u = 1 + x as it is rounded (Kahan)."""
    u = w.two("fadd", "%x", _ONE)
    d = w.two("fsub", u, _ONE)
    found = w.two("fmul", w.own("vlog", u), w.two("fdiv", "%x", d))
    found = w.choose("oeq", "%x", _INFINITE, "%x", found)
    return w.choose("oeq", d, _ZERO, "%x", found)


class Code:
    """A compiled module; its machine code lives as long as this object."""

    def __init__(self, text: str, often: bool = False, deadline: Deadline = NEVER) -> None:
        """Compile for the processor this runs on, what runs `often` as well as can be. Raises TimeOverError."""
        self._code = MachineCode(text, often, deadline)
        pointer, number = ctypes.c_void_p, ctypes.c_int64
        self._call = self._code.function("kernel", (pointer, pointer, number, number, number, number))

    def __call__(self, given: int, found: int, in_stride: int, out_stride: int, begin: int, end: int) -> None:
        """Run columns `begin` to `end`, a multiple of LANES of them; the arrays are given by address."""
        self._call(given, found, in_stride, out_stride, begin, end)
