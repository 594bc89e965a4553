"""Derivatives of a function whose results depend on many arguments through a few terms they share.

Where every cell of a layer feels the layer's mean temperature, each result depends on each argument, and derivatives by
directions need a direction for each. With a symbol for each such term, m = D(w, m before it), the value V(w, m) is as
sparse as the equations are. With S = dm/dw, the multipliers mu of V and nu of D,

    dV/dw = V_w + V_m S,    d2(mu'V)/dw2 = [I; S]' (mu'V + nu'D)_(w,m)(w,m) [I; S],    nu = V_m' mu + D_m' nu.

Source: Griewank and Walther, Evaluating Derivatives, 2nd ed. (2008), chapters 3 and 10.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from tvimdesign.simulation.working_cycle.casadi_setup import ca

MANY = 12
"""Entries of the state from which on a sum of them gets a symbol: more than a plate's 8, less than a layer's 24."""
_SUMS = {ca.OP_ADD, ca.OP_SUB, ca.OP_NEG, ca.OP_TWICE}
_PRODUCTS = {ca.OP_MUL: (0, 1), ca.OP_DIV: (0,)}
"""Operations that are linear in one operand where the other does not move, with the operands that may move."""


@dataclass(frozen=True)
class Opened:
    """A function's value with symbols for the terms that its results share."""

    moving: Any
    """SX or MX, column w of the arguments that move."""
    value: Any
    """Column V(w, m)."""
    terms: Any
    """Column m."""
    definitions: Any
    """Column D(w, m), each of w and the terms before it."""

    @property
    def whole(self) -> Any:
        """The value without the terms' symbols."""
        return self._closed(self.value)

    def jacobian(self) -> Any:
        """Derivatives of the value by what moves."""
        found = ca.jacobian(self.value, self.moving)
        if not self.terms.numel():
            return found
        return self._closed(found + ca.mtimes(ca.jacobian(self.value, self.terms), self._along))

    def hessian(self, multipliers: Any) -> Any:
        """Second derivatives of the value times multipliers by what moves."""
        lagrangian = ca.dot(multipliers, ca.vec(self.value))
        if not self.terms.numel():
            return ca.hessian(lagrangian, self.moving)[0]
        nu = ca.SX.sym("nu", self.terms.numel())
        both = ca.vertcat(self.moving, self.terms)
        bent = ca.hessian(lagrangian + ca.dot(nu, self.definitions), both)[0]
        along = ca.vertcat(ca.SX.eye(self.moving.numel()), self._along)
        found = ca.triu(ca.mtimes(along.T, ca.mtimes(bent, along)))
        back = self._back(ca.gradient(lagrangian, self.terms))
        return ca.triu2symm(self._closed(found, list(zip(ca.vertsplit(nu), back, strict=True))))

    @cached_property
    def _by_terms(self) -> Any:
        """Derivatives of the definitions by the terms."""
        return ca.jacobian(self.definitions, self.terms)

    @cached_property
    def _along(self) -> Any:
        """S = dm/dw, a row a term."""
        by_moving = ca.jacobian(self.definitions, self.moving)
        rows = [by_moving[:1, :]]
        for i in range(1, self.terms.numel()):
            rows.append(by_moving[i, :] + ca.mtimes(self._by_terms[i, :i], ca.vertcat(*rows)))
        return ca.vertcat(*rows)

    def _back(self, of_value: Any) -> list[Any]:
        """The multipliers nu of the definitions, from those that the value gives the terms."""
        found = ca.vertsplit(of_value)
        for i in reversed(range(len(found))):
            for j in range(i):
                if self._by_terms.sparsity().has_nz(i, j):
                    found[j] += self._by_terms[i, j] * found[i]
        return found

    def _closed(self, expression: Any, more: Sequence[tuple[Any, Any]] = ()) -> Any:
        """An expression without the terms' symbols, and without `more` symbols with the values they stand for."""
        if not self.terms.numel():
            return expression
        known = [*zip(ca.vertsplit(self.terms), ca.vertsplit(self.definitions), strict=True), *more]
        return ca.substitute_inplace([symbol for symbol, _ in known], [value for _, value in known], [expression])[1][0]


def opened(function: Any, arguments: Sequence[Sequence[Any]], moving: Sequence[Sequence[int]]) -> Opened:
    """A function with one result at some `arguments`, entry by entry, of which the rows `moving` move.

    The first argument is the state, whose entries are alike: sums of many of them get symbols. A function of which no
    result hangs on many entries of it is left as it is, and so is one of MX.
    """
    columns = list(zip(arguments, moving, strict=True))
    moved = ca.vertcat(*(column[row] for column, rows in columns for row in rows))
    if not (function.is_a("SXFunction") and _many_of(function, moving[0])):
        value = function.call([ca.vertcat(*column) for column in arguments], True, False)[0]
        return Opened(moved, value, type(value)(0, 1), type(value)(0, 1))
    operations = _Operations(function, moving)
    shared = operations.shared()
    terms, definitions = [], []
    values: list[Any] = [None] * function.sz_w()
    results = [ca.SX(0)] * function.nnz_out(0)
    for step, (operation, before, after) in enumerate(operations.steps):
        if operation == ca.OP_OUTPUT:
            results[after[1]] = values[before[0]]
            continue
        if operation == ca.OP_INPUT:
            found = arguments[before[0]][before[1]]
        elif operation == ca.OP_CONST:
            found = ca.SX(function.instruction_constant(step))
        elif len(before) == 1:
            found = ca.SX.unary(operation, values[before[0]])
        else:
            found = ca.SX.binary(operation, values[before[0]], values[before[1]])
        if step in shared:
            definitions.append(found)
            found = ca.SX.sym("term")
            terms.append(found)
        values[after[0]] = found
    value = ca.SX(function.sparsity_out(0), ca.vertcat(*results))
    return Opened(moved, value, ca.vertcat(*terms), ca.vertcat(*definitions))


def _many_of(function: Any, moving: Sequence[int]) -> bool:
    """Whether a result depends on many of the first argument's entries that move."""
    if len(moving) < 2 * MANY:
        return False
    pattern = function.jac_sparsity(0, 0)
    entries = np.isin(pattern.get_triplet()[1], moving)
    return bool(np.bincount(np.array(pattern.row(), dtype=np.int64)[entries]).max(initial=0) >= MANY)


class _Operations:
    """The operations of a function of SX, and which of its arguments each of them depends on."""

    def __init__(self, function: Any, moving: Sequence[Sequence[int]]) -> None:
        self.steps: list[tuple[int, list[int], list[int]]] = [
            (function.instruction_id(k), function.instruction_input(k), function.instruction_output(k))
            for k in range(function.n_instructions())
        ]
        """Operation, operands and result, as CasADi numbers them."""
        places = [(of, row) for of, rows in enumerate(moving) for row in rows]
        self._bits = {place: 1 << i for i, place in enumerate(places)}
        self._state = (1 << len(moving[0])) - 1
        self._sources = self._traced()

    def shared(self) -> set[int]:
        """The steps at which a sum of many entries is whole: what uses it is no sum, or more than one does."""
        linear = self._linear()
        ends = self._ends(linear)
        found: set[int] = set()
        bits: list[int] = []
        for step in range(len(self.steps)):
            own = self._depends(step, bits)
            if linear[step] and ends[step] and (own & self._state).bit_count() >= MANY:
                own = 1 << (len(self._bits) + len(found))
                found.add(step)
            bits.append(own)
        return found

    def _traced(self) -> list[tuple[int, ...]]:
        """Of each step the steps that made its operands."""
        made: dict[int, int] = {}
        found = []
        for step, (operation, before, after) in enumerate(self.steps):
            plain = operation in (ca.OP_INPUT, ca.OP_CONST)
            found.append(() if plain else tuple(made[place] for place in before))
            if operation != ca.OP_OUTPUT:
                made[after[0]] = step
        return found

    def _depends(self, step: int, before: Sequence[int]) -> int:
        """What a step depends on, a bit for each argument and each term, from those of the steps `before` it."""
        operation, operands, _ = self.steps[step]
        if operation == ca.OP_INPUT:
            return self._bits.get((operands[0], operands[1]), 0)
        own = 0
        for source in self._sources[step]:
            own |= before[source]
        return own

    def _linear(self) -> list[bool]:
        """Whether each step is linear in what moves of its operands."""
        moves: list[int] = []
        found = []
        for step, sources in enumerate(self._sources):
            operation = self.steps[step][0]
            moving = [i for i, source in enumerate(sources) if moves[source]]
            found.append(operation in _SUMS or (len(moving) == 1 and moving[0] in _PRODUCTS.get(operation, ())))
            moves.append(int(self._depends(step, moves) != 0))
        return found

    def _ends(self, linear: Sequence[bool]) -> list[bool]:
        """Whether each step's result is used by several steps, or by one that is not linear."""
        uses = [0] * len(self.steps)
        bent = [False] * len(self.steps)
        for step, sources in enumerate(self._sources):
            for source in set(sources):
                uses[source] += 1
                bent[source] |= not linear[step] and self.steps[step][0] != ca.OP_OUTPUT
        return [use > 1 or bend for use, bend in zip(uses, bent, strict=True)]
