"""The walk of rays through a tree of boxes, written in LLVM's language and compiled.

One ray after the other goes down the tree; what it meets behind the nearest triangle so far is left out. Boxes are met
by slabs (Kay and Kajiya 1986), triangles by Moeller and Trumbore (1997).

Machine code from LLVM's language, compiled for the processor that it runs on.
"""

from __future__ import annotations

import ctypes
import struct
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import llvmlite
import llvmlite.binding as llvm

from tvimdesign.base.user_cache import find_code, keep_code


def hexadecimal(value: float) -> str:
    """Write a number to its last bit."""
    return f"0x{struct.unpack('<Q', struct.pack('<d', value))[0]:016X}"


class Lines:
    """The body of a function while it is written: every line defines one new name."""

    def __init__(self, kind: str = "double", suffix: str = "f64") -> None:
        """Start an empty body for numbers of a `kind`, which LLVM's own functions have as a suffix."""
        self.text: list[str] = []
        self._kind, self._suffix = kind, suffix

    def new(self, expression: str) -> str:
        """Write a line, return the name it defines."""
        name = f"%v{len(self.text)}"
        self.text.append(f"  {name} = {expression}")
        return name

    def two(self, operation: str, a: str, b: str) -> str:
        """Write an operation on two numbers."""
        return self.new(f"{operation} {self._kind} {a}, {b}")

    def intrinsic(self, name: str, *arguments: str) -> str:
        """Write a call of one of LLVM's functions."""
        given = ", ".join(f"{self._kind} {argument}" for argument in arguments)
        return self.new(f"call {self._kind} @llvm.{name}.{self._suffix}({given})")


class MachineCode:
    """A compiled module; its machine code lives as long as this object."""

    def __init__(self, text: str) -> None:
        """Compile the text of a module, or take what an earlier run has kept of it."""
        machine = _machine()
        compiler = (f"llvmlite {llvmlite.__version__}", _processor())
        code = find_code(text, *compiler)
        if code is None:
            code = _compiled(text, machine)
            keep_code(code, text, *compiler)
        self._engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), machine)
        self._engine.add_object_file(llvm.ObjectFileRef.from_data(code))
        self._engine.finalize_object()

    def function(self, name: str, arguments: Sequence[type]) -> Callable[..., None]:
        """Return one of its functions without a result, for ctypes to call."""
        signature = ctypes.CFUNCTYPE(None, *arguments)
        return signature(self._engine.get_function_address(name))


def _compiled(text: str, machine: Any) -> bytes:
    module = llvm.parse_assembly(text)
    module.verify()
    passes = llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options(speed_level=1))
    passes.getModulePassManager().run(module, passes)
    return bytes(machine.emit_object(module))


def _machine() -> Any:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    target = llvm.Target.from_default_triple()
    return target.create_target_machine(
        cpu=llvm.get_host_cpu_name(), features=llvm.get_host_cpu_features().flatten(), opt=1, jit=True
    )


def _processor() -> str:
    """Return the triple, the processor and its features."""
    return " ".join((llvm.get_process_triple(), llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()))


LEAF = 4
"""Triangles in a box that is not divided further."""
ROOM = 1e-7
"""What boxes and triangles are larger than they are [mm], so that no ray slips through between two."""
_BEHIND = 1e-3
"""How far behind the nearest triangle so far a box must begin to be left out [mm]."""
_DEEPEST = 64
"""Boxes that wait at once, at most: one for each level of the tree, and one."""
_FLAT = 1e-12
"""A ray and a triangle whose determinant is not above this are parallel."""
_BOX, _TRIANGLE = 6, 9
"""Numbers of a box: lower, then upper corner; of a triangle: a corner, then the ways to the two others."""
Three = tuple[str, str, str]


class _Lines(Lines):
    """The body of the function while it is written."""

    def add(self, line: str) -> None:
        """Write a line that names nothing."""
        self.text.append(line)

    def three(self, array: str, entry: str, first: int, width: int) -> Three:
        """Return three numbers of an entry that has `width` of them, from the `first` on."""
        start = self.new(f"mul i64 {entry}, {width}")
        found = []
        for place in range(first, first + 3):
            at = self.new(f"getelementptr double, ptr {array}, i64 {self.new(f'add i64 {start}, {place}')}")
            found.append(self.new(f"load double, ptr {at}"))
        return found[0], found[1], found[2]

    def dot(self, a: Three, b: Three) -> str:
        """Return scalar product."""
        x, y, z = (self.two("fmul", one, other) for one, other in zip(a, b, strict=True))
        return self.two("fadd", self.two("fadd", x, y), z)

    def cross(self, a: Three, b: Three) -> Three:
        """Return vector product."""
        parts = []
        for i, j in ((1, 2), (2, 0), (0, 1)):
            parts.append(self.two("fsub", self.two("fmul", a[i], b[j]), self.two("fmul", a[j], b[i])))
        return parts[0], parts[1], parts[2]

    def less(self, a: Three, b: Three) -> Three:
        """Return difference."""
        x, y, z = (self.two("fsub", one, other) for one, other in zip(a, b, strict=True))
        return x, y, z

    def all_of(self, truths: Sequence[str]) -> str:
        """Return whether all hold."""
        found = truths[0]
        for truth in truths[1:]:
            found = self.new(f"and i1 {found}, {truth}")
        return found


def _text() -> str:
    w = _Lines()
    w.add("each:\n  %ray = load i64, ptr %ray.at")
    w.add(f"  br i1 {w.new('icmp slt i64 %ray, %count')}, label %begin, label %end\nbegin:")
    origin, direction = w.three("%origins", "%ray", 0, 3), w.three("%directions", "%ray", 0, 3)
    one = hexadecimal(1.0)
    inverse = (w.two("fdiv", one, direction[0]), w.two("fdiv", one, direction[1]), w.two("fdiv", one, direction[2]))
    w.add(f"  store double {hexadecimal(float('inf'))}, ptr %best.at\n  store i64 -1, ptr %found.at")
    w.add("  store i64 0, ptr %stack\n  store i64 1, ptr %waiting.at\n  br label %next")
    w.add("next:\n  %waiting = load i64, ptr %waiting.at")
    w.add(f"  br i1 {w.new('icmp sgt i64 %waiting, 0')}, label %take, label %keep\ntake:")
    w.add("  %top = sub i64 %waiting, 1\n  store i64 %top, ptr %waiting.at")
    w.add("  %top.at = getelementptr i64, ptr %stack, i64 %top\n  %node = load i64, ptr %top.at")
    w.add(f"  br i1 {_meets_box(w, origin, inverse)}, label %inside, label %next\ninside:")
    w.add(f"  br i1 {w.new('icmp slt i64 %node, %leaf')}, label %divided, label %undivided\ndivided:")
    _wait_for_halves(w)
    w.add("  br label %next\nundivided:")
    first = w.new(f"mul i64 {w.new('sub i64 %node, %leaf')}, {LEAF}")
    for place in range(LEAF):
        _try_triangle(w, w.new(f"add i64 {first}, {place}"), origin, direction)
    w.add("  br label %next\nkeep:")
    for array, kind, kept in (("%distance", "double", "%best.at"), ("%triangle", "i64", "%found.at")):
        at = w.new(f"getelementptr {kind}, ptr {array}, i64 %ray")
        w.add(f"  store {kind} {w.new(f'load {kind}, ptr {kept}')}, ptr {at}")
    w.add(f"  store i64 {w.new('add i64 %ray, 1')}, ptr %ray.at\n  br label %each\nend:\n  ret void\n}}")
    head = (
        "declare double @llvm.minnum.f64(double, double)\ndeclare double @llvm.maxnum.f64(double, double)\n"
        "declare double @llvm.fabs.f64(double)\n"
        "define void @first_hits(ptr noalias %boxes, ptr noalias %triangles, i64 %leaf, ptr noalias %origins, "
        "ptr noalias %directions, i64 %count, double %beyond, ptr noalias %distance, ptr noalias %triangle) {\n"
        f"  %stack = alloca [{_DEEPEST} x i64]\n  %waiting.at = alloca i64\n  %ray.at = alloca i64\n"
        "  %best.at = alloca double\n  %found.at = alloca i64\n  store i64 0, ptr %ray.at\n  br label %each"
    )
    return "\n".join([head, *w.text])


def _meets_box(w: _Lines, origin: Three, inverse: Three) -> str:
    """Return whether the ray meets the box of %node at or after its start, and not behind the nearest triangle.

    0 x inf, where a ray lies in the plane of a side, is not a number and is left out: taken as inside.
    """
    lower, upper = w.three("%boxes", "%node", 0, _BOX), w.three("%boxes", "%node", 3, _BOX)
    nears, fars = [], []
    for axis in range(3):
        one = w.two("fmul", w.two("fsub", lower[axis], origin[axis]), inverse[axis])
        other = w.two("fmul", w.two("fsub", upper[axis], origin[axis]), inverse[axis])
        nears.append(w.intrinsic("minnum", one, other))
        fars.append(w.intrinsic("maxnum", one, other))
    near = w.intrinsic("maxnum", w.intrinsic("maxnum", nears[0], nears[1]), nears[2])
    far = w.intrinsic("minnum", w.intrinsic("minnum", fars[0], fars[1]), fars[2])
    met = w.new(f"fcmp oge double {far}, {w.intrinsic('maxnum', near, hexadecimal(0.0))}")
    best = w.two("fadd", w.new("load double, ptr %best.at"), hexadecimal(_BEHIND))
    return w.all_of([met, w.new(f"fcmp ole double {near}, {best}")])


def _wait_for_halves(w: _Lines) -> None:
    """Put the halves of %node on the stack, the first on top."""
    twice = w.new("mul i64 %node, 2")
    for place, half in enumerate((w.new(f"add i64 {twice}, 2"), w.new(f"add i64 {twice}, 1"))):
        at = w.new(f"getelementptr i64, ptr %stack, i64 {w.new(f'add i64 %top, {place}')}")
        w.add(f"  store i64 {half}, ptr {at}")
    w.add(f"  store i64 {w.new('add i64 %top, 2')}, ptr %waiting.at")


def _try_triangle(w: _Lines, slot: str, origin: Three, direction: Three) -> None:
    """Keep a triangle where the ray meets it no further than what is the nearest."""
    first, along_one, along_other = (w.three("%triangles", slot, 3 * place, _TRIANGLE) for place in range(3))
    across = w.cross(direction, along_other)
    volume = w.dot(along_one, across)
    to_origin = w.less(origin, first)
    u = w.two("fdiv", w.dot(to_origin, across), volume)
    over = w.cross(to_origin, along_one)
    v = w.two("fdiv", w.dot(direction, over), volume)
    far = w.two("fdiv", w.dot(along_other, over), volume)
    best, found = w.new("load double, ptr %best.at"), w.new("load i64, ptr %found.at")
    nearer = w.all_of([
        w.new(f"fcmp oge double {u}, {hexadecimal(-ROOM)}"),
        w.new(f"fcmp oge double {v}, {hexadecimal(-ROOM)}"),
        w.new(f"fcmp ole double {w.two('fadd', u, v)}, {hexadecimal(1.0 + ROOM)}"),
        w.new(f"fcmp ogt double {w.intrinsic('fabs', volume)}, {hexadecimal(_FLAT)}"),
        w.new(f"fcmp ogt double {far}, %beyond"),
        w.new(f"fcmp ole double {far}, {best}"),
        w.new(f"fcmp olt double {far}, {hexadecimal(float('inf'))}"),
    ])  # fmt: skip
    w.add(f"  store double {w.new(f'select i1 {nearer}, double {far}, double {best}')}, ptr %best.at")
    w.add(f"  store i64 {w.new(f'select i1 {nearer}, i64 {slot}, i64 {found}')}, ptr %found.at")


@cache
def first_hits() -> Callable[..., None]:
    """Return compiled walk: of boxes, triangles, the first leaf's number, origins, directions, their count, `beyond`.

    Then follow where distances and places of the triangles that are met go. Arrays are given by address.
    """
    pointer, whole = ctypes.c_void_p, ctypes.c_int64
    arguments = (pointer, pointer, whole, pointer, pointer, whole, ctypes.c_double, pointer, pointer)
    return _code().function("first_hits", arguments)


@cache
def _code() -> MachineCode:
    return MachineCode(_text())
