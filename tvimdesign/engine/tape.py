"""A CasADi function of scalars as data for the interpreter."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from tvimdesign.engine import interpreter
from tvimdesign.engine.interpreter import Array, Code, push, run
from tvimdesign.engine.vectors import tangent_registers

Integers = NDArray[np.int64]
_NAMES = [name for name in vars(interpreter) if name.isupper() and hasattr(ca, f"OP_{name}")]
_KNOWN = frozenset(getattr(interpreter, name) for name in _NAMES)
if any(getattr(ca, f"OP_{name}") != getattr(interpreter, name) for name in _NAMES):
    raise ImportError(
        f"CasADi {vars(ca)['__version__']} numbers its operations otherwise than tvimdesign.engine.interpreter"
    )
_COMMUTE = frozenset((interpreter.ADD, interpreter.MUL))
_wrapped: Any = vars(ca)["_casadi"]
_operation, _given, _to = (getattr(_wrapped, f"Function_instruction_{part}") for part in ("id", "input", "output"))
"""CasADi's methods without their wrappers, which take half of the time."""


@dataclass(frozen=True, eq=False)
class Tape:
    """The operations of a function. Registers hold its arguments, one below the other, then constants, then results."""

    code: Code
    registers: Array  # Registers with the constants in place; the compiled program works in a copy
    arguments: Integers  # Register at which each argument starts, and where the last ends
    results: tuple[Integers, ...]  # Register of each nonzero of each result
    _rooms: dict[int, Array] = field(default_factory=dict, repr=False)
    """Registers of tangents, by the count of directions."""

    @classmethod
    def of(cls, arguments: Sequence[Any], results: Sequence[Any], *, inverses: bool = False) -> Tape:
        """Record expressions (SX) of symbols."""
        return cls.of_function(_function(arguments, results), inverses)

    @classmethod
    def of_function(cls, function: Any, inverses: bool = False) -> Tape:
        """Record a function of SX. Raises ValueError for an operation that the interpreter does not know.

        With `inverses`, what several quotients are divided by is inverted once, which may change their last bits.
        """
        return cls._of_record(_recorded(function, inverses))

    @classmethod
    def parted(cls, arguments: Sequence[Any], results: Sequence[Any], *, inverses: bool = True) -> tuple[Tape, Tape]:
        """Record expressions in two: constants that follow from the last argument alone; then the results, of the other
        arguments and these constants.
        """
        constants, values = _parted(_recorded(_function(arguments, results), inverses=inverses))
        return cls._of_record(constants), cls._of_record(values)

    def arrays(self) -> list[NDArray[Any]]:
        """Return what `of_arrays` makes the tape from."""
        return [*self.code, self.registers, self.arguments, np.array(len(self.results)), *self.results]

    @classmethod
    def of_arrays(cls, arrays: Iterator[NDArray[Any]]) -> Tape:
        """Return the tape of the next of some arrays."""
        code = Code(*(next(arrays) for _ in Code._fields))
        return cls(code, next(arrays), next(arrays), tuple(next(arrays) for _ in range(int(next(arrays)))))

    @classmethod
    def _of_record(cls, record: _Record) -> Tape:
        operations, base = record.operations, int(record.starts[-1]) + len(record.constants)
        table = np.column_stack([_levels(operations), np.array(operations, dtype=np.int64).reshape(-1, 3)])
        order = np.lexsort((table[:, 1], table[:, 0]))
        changes = np.flatnonzero(np.any(np.diff(table[order, :2], axis=0) != 0, axis=1)) + 1
        starting = np.concatenate([[0], changes, [len(table)]]) if len(table) else np.zeros(1, np.int64)
        register, size = _allocated(table, order, starting, [at for *_, at in record.written], base)

        def resolved(places: Integers) -> Integers:
            constants = np.where(places >= _CONSTANT, places - _CONSTANT + record.starts[-1], places)
            return np.where(places < 0, register[np.maximum(-1 - places, 0)] if len(register) else 0, constants)

        kinds = np.append(table[order[starting[:-1]], 1], 0)
        first, second = (resolved(table[order, side]).astype(np.uint32) for side in (2, 3))
        groups = np.column_stack([kinds, starting]).astype(np.int64)
        code = Code(first, second, register[order].astype(np.uint32), groups)
        registers = np.zeros(size)
        registers[int(record.starts[-1]) : base] = record.constants
        results = tuple(np.zeros(length, np.int64) for length in record.lengths)
        for (result, entry, _), at in zip(record.written, resolved(_places(record.written)), strict=True):
            results[result][entry] = at
        return cls(code, registers, record.starts, results)

    @cached_property
    def _work(self) -> Array:
        return self.registers.copy()

    def values(self, *arguments: Array) -> list[Array]:
        """Return the nonzeros of each result."""
        w = self._work
        np.concatenate(arguments, out=w[: self.arguments[-1]])
        run(self.code, w)
        return [w[places] for places in self.results]

    def tangents(self, arguments: Sequence[Array], moved: Sequence[Array]) -> list[tuple[Array, Array]]:
        """Return the nonzeros of each result, and their tangents along what the arguments move by, a column each."""
        w, count = self._work, self.arguments[-1]
        directions = moved[0].shape[1]
        if directions not in self._rooms:
            self._rooms[directions] = tangent_registers(self.registers.size, directions)
        d = self._rooms[directions]
        np.concatenate(arguments, out=w[:count])
        np.concatenate(moved, out=d[:count, :directions])
        push(self.code, w, d)
        return [(w[places], d[places, :directions]) for places in self.results]


def _function(arguments: Sequence[Any], results: Sequence[Any]) -> Any:
    return ca.Function("tape", list(arguments), [ca.SX(result) for result in results], {"live_variables": False})


_CONSTANT = 1 << 40  # Place of the first constant


class _Record(NamedTuple):
    """Operations on places: an entry of an argument (>= 0), the value of an operation (-1 - its number), a constant."""

    starts: Integers  # Entry at which each argument starts, and where the last ends
    constants: list[float]
    operations: list[tuple[int, int, int]]  # Operation and operands, in CasADi's order
    written: list[tuple[int, int, int]]  # Result, its nonzero, and the place of that
    lengths: list[int]  # Count of each result's nonzeros


def _recorded(function: Any, inverses: bool) -> _Record:
    starts = np.concatenate([[0], np.cumsum([function.nnz_in(i) for i in range(function.n_in())])]).astype(np.int64)
    place: dict[int, int] = {}  # By CasADi's work register
    constants: dict[float, int] = {}
    operations: dict[tuple[int, int, int], int] = {}  # With their numbers; what is written twice is computed once
    written: list[tuple[int, int, int]] = []
    for k in range(function.n_instructions()):
        op, given, to = _operation(function, k), _given(function, k), _to(function, k)
        if op == ca.OP_INPUT:
            place[to[0]] = int(starts[given[0]]) + given[1]
        elif op == ca.OP_CONST:
            place[to[0]] = _CONSTANT + constants.setdefault(function.instruction_constant(k), len(constants))
        elif op == ca.OP_OUTPUT:
            written.append((to[0], to[1], place[given[0]]))
        elif op in _KNOWN:
            operands = place[given[0]], place[given[-1]]
            if op in _COMMUTE:
                operands = max(operands), min(operands)
            place[to[0]] = -1 - operations.setdefault((op, *operands), len(operations))
        else:
            raise ValueError(f"CasADi's operation {op} is not known to tvimdesign.engine.interpreter")
    listed = list(operations)
    if inverses:
        listed, moved = _with_inverses(listed)
        written = [(result, entry, moved[-1 - at] if at < 0 else at) for result, entry, at in written]
    return _Record(starts, list(constants), listed, written, [function.nnz_out(i) for i in range(function.n_out())])


def _parted(whole: _Record) -> tuple[_Record, _Record]:
    """Part a record into what follows from its last argument alone, and the rest, whose last argument that is."""
    first, end = (int(place) for place in whole.starts[-2:])
    alone: list[bool] = []
    for _, *operands in whole.operations:
        alone.append(all(alone[-1 - place] if place < 0 else place >= first for place in operands))
    handed: dict[int, int] = {}  # Places that the rest takes, and their numbers
    parts: tuple[list[tuple[int, int, int]], list[tuple[int, int, int]]] = ([], [])
    numbers: list[int] = []

    def before(place: int) -> int:
        return numbers[-1 - place] if place < 0 else place if place >= _CONSTANT else place - first

    def behind(place: int) -> int:
        if first <= place < end or (place < 0 and alone[-1 - place]):
            return first + handed.setdefault(place, len(handed))
        return numbers[-1 - place] if place < 0 else place

    for (op, first_of, other), is_alone in zip(whole.operations, alone, strict=True):
        moved, part = (before, parts[0]) if is_alone else (behind, parts[1])
        part.append((op, moved(first_of), moved(other)))
        numbers.append(-len(part))
    written = [(result, entry, behind(place)) for result, entry, place in whole.written]
    given = [(0, i, before(place)) for place, i in handed.items()]
    return (
        _Record(np.array([0, end - first]), whole.constants, parts[0], given, [len(given)]),
        _Record(np.append(whole.starts[:-1], first + len(given)), whole.constants, parts[1], written, whole.lengths),
    )


def _places(written: Sequence[tuple[int, int, int]]) -> Integers:
    return np.array([place for *_, place in written], dtype=np.int64)


def _with_inverses(operations: list[tuple[int, int, int]]) -> tuple[list[tuple[int, int, int]], list[int]]:
    """Return operations in which products with an inverse replace quotients that share a divisor.

    Then the place of the value of each that was given.
    """
    uses = Counter(other for op, _, other in operations if op == interpreter.DIV)
    replaced: list[tuple[int, int, int]] = []
    at: list[int] = []
    inverse: dict[int, int] = {}
    for op, *operands in operations:
        first, other = (at[-1 - operand] if operand < 0 else operand for operand in operands)
        if op == interpreter.DIV and uses[operands[1]] > 1:
            if other not in inverse:
                replaced.append((interpreter.INV, other, other))
                inverse[other] = -len(replaced)
            replaced.append((interpreter.MUL, first, inverse[other]))
        else:
            replaced.append((op, first, other))
        at.append(-len(replaced))
    return replaced, at


def _levels(operations: list[tuple[int, int, int]]) -> Integers:
    """Return how many operations come one after the other up to each."""
    level: list[int] = []
    for _, first, other in operations:
        level.append(1 + max(level[-1 - first] if first < 0 else 0, level[-1 - other] if other < 0 else 0))
    return np.array(level, dtype=np.int64)


def _allocated(
    table: Integers, order: Integers, starting: Integers, wanted: Sequence[int], base: int
) -> tuple[Integers, int]:
    """Return the register of each operation, and how many registers there are.

    A register is used again once the last group is done that reads it, so that they stay in the processor's cache.
    """
    group = np.empty(len(table), np.int64)
    for g in range(len(starting) - 1):
        group[order[starting[g] : starting[g + 1]]] = g
    last = group.copy()
    for side in (2, 3):
        reads = table[:, side] < 0
        np.maximum.at(last, -1 - table[reads, side], group[reads])
    ends: list[list[int]] = [[] for _ in starting]
    lasting = {-1 - at for at in wanted if at < 0}
    for k in order:
        if k not in lasting:
            ends[last[k]].append(int(k))
    register, free, size = np.empty(len(table), np.int64), list[int](), base
    for g in range(len(starting) - 1):
        for k in order[starting[g] : starting[g + 1]]:
            if free:
                register[k] = free.pop()
            else:
                register[k], size = size, size + 1
        free += [int(register[k]) for k in reversed(ends[g])]
    return register, size
