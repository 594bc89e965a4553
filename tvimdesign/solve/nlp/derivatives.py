"""First and second derivatives of a problem by the chain rule, put together from those of the functions it calls.

A problem is a large graph that does little itself: almost all of its arithmetic is in a few compiled functions, most
of them applied to every collocation point. Each call's result becomes a symbol of its own, y = F(w(x, y before)); its
function is differentiated for one point, and what is left as a graph without calls. With z = (x, y), Z = dz/dx, the
multipliers mu of the results and nu = (dF/dw)' mu of the arguments,

    J = g_z Z,    H = Z' [(lambda f + lambda' g + nu' w)_zz + w_z' (mu' F)_ww w_z] Z

CasADi alone would go through all of it once for each direction: twice to five times the work, to build and to run.
Source: Griewank and Walther, Evaluating Derivatives, 2nd ed. (2008), chapters 3, 5 and 10.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate, chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.solve.nlp.shared_terms import Opened, opened

Places = NDArray[np.int64]


def derivatives_of(function: Any, known: Known | None = None) -> dict[str, Any]:
    """The Jacobian of g and the Hessian of the Lagrangian of a function (x, p) -> (f, g), by the options of nlpsol.

    Problems that apply the same functions to more or fewer points share what is `known` of these.
    """
    x, p = (ca.MX.sym(name, function.size1_in(i)) for i, name in enumerate("xp"))
    (f, g), calls = _opened(function.call([x, p], True, False), x, p, {} if known is None else known)
    z, along = _follow(calls, x)
    slopes = ca.jacobian(g, z)
    results = [(call.result, call.value) for call in calls]
    jacobian = _inserted([g, ca.mtimes(slopes, along)], results)

    lam_f, lam_g = ca.MX.sym("lam_f"), ca.MX.sym("lam_g", g.numel())
    inner, outer, nus = _go_back(calls, ca.mtimes(slopes.T, lam_g) + lam_f * ca.gradient(f, z))
    between = ca.hessian(lam_f * f + ca.dot(lam_g, g) + outer, z)[0]
    bent = sum(inner, _turned(between, along))
    hessian = _inserted([ca.triu(bent)], [*results, *nus])
    return {
        "jac_g": ca.Function("jac_g", [x, p], jacobian),
        "hess_lag": ca.Function("hess_lag", [x, p, lam_f, lam_g], hessian),
    }


class AtPoint:
    """A function of one point and its derivatives by the rows of its arguments that move."""

    def __init__(self, function: Any, sizes: Sequence[int], moving: Sequence[Sequence[int]]) -> None:
        """`sizes` are the arguments' rows. Nothing is differentiated before it is needed."""
        self._function, self._sizes, self._moving = function, sizes, moving

    @cached_property
    def _opened(self) -> tuple[list[Any], Opened]:
        """The arguments, and the function there."""
        kind: Any = ca.SX if self._function.is_a("SXFunction") else ca.MX
        entries = [kind.sym("entry", 1, 1, rows) for rows in self._sizes]
        return [ca.vertcat(*column) for column in entries], opened(self._function, entries, self._moving)

    @cached_property
    def first(self) -> tuple[Any, Any]:
        """The pattern of the Jacobian; the function of the value and the Jacobian's entries."""
        symbols, point = self._opened
        by_moving = point.jacobian()
        return by_moving.sparsity(), ca.Function("first", symbols, [point.whole, by_moving.nz[:]])

    @cached_property
    def second(self) -> tuple[Any, Any]:
        """The pattern of the second derivatives times multipliers; the function of their entries."""
        symbols, point = self._opened
        mu = type(point.value).sym("mu", point.value.numel())
        bent = point.hessian(mu)
        return bent.sparsity(), ca.Function("second", [*symbols, mu], [bent.nz[:]])


Known = dict[tuple[str, tuple[tuple[int, ...], ...]], AtPoint]
"""By function, written out, and the rows of its arguments that move."""


@dataclass
class _Call:
    """One function applied to columns of arguments; those that are the same for all columns are given once."""

    function: Any
    count: int
    arguments: list[Any]
    result: Any
    known: Known
    before: Any = None
    """What its arguments may hang on: the unknowns, and the results of the calls before it."""
    moving_before: Collection[int] = ()
    """Which entries of that move when the unknowns do."""
    along: Any = None
    """Derivatives of what moves of its arguments by the unknowns."""

    @cached_property
    def _moving(self) -> list[list[int]]:
        """Of every argument the rows that move in any column."""
        found = []
        for one in self.arguments:
            rows, hang = one.size1(), ca.jacobian_sparsity(ca.vec(one), self.before)
            pairs = zip(*hang.get_triplet(), strict=True)
            found.append(sorted({entry % rows for entry, by in pairs if by in self.moving_before}))
        return found

    @cached_property
    def moved(self) -> Any:
        """What moves of the arguments, one vector: argument by argument, column by column."""
        pairs = zip(self.arguments, self._moving, strict=True)
        return ca.vertcat(*(ca.vec(one[rows, :]) for one, rows in pairs))

    @cached_property
    def by_before(self) -> Any:
        """Derivatives of what moves by what it hangs on."""
        return ca.jacobian(self.moved, self.before)

    @cached_property
    def _places(self) -> Places:
        """Where in `moved` a point's moving arguments stand: a row for each of them, a column a point."""
        found, first = [], 0
        for one, rows in zip(self.arguments, self._moving, strict=True):
            own = first + np.arange(len(rows) * one.size2()).reshape(one.size2(), len(rows)).T
            found.append(np.tile(own, self.count // one.size2()))
            first += own.size
        return np.concatenate(found)

    @cached_property
    def _point(self) -> AtPoint:
        """The function at one point."""
        key = (self.function.serialize(), tuple(tuple(rows) for rows in self._moving))
        sizes = [one.size1() for one in self.arguments]
        return self.known.setdefault(key, AtPoint(self.function, sizes, self._moving))

    @property
    def _columns(self) -> list[Any]:
        """The arguments, a column for each point."""
        return [ca.repmat(one, 1, self.count // one.size2()) for one in self.arguments]

    @cached_property
    def _first(self) -> tuple[Any, list[Any]]:
        """The pattern of one point's derivatives; value and derivatives at all points."""
        pattern, function = self._point.first
        return pattern, function.map(self.count)(*self._columns)

    @property
    def value(self) -> Any:
        """The call itself."""
        return self._first[1][0]

    @cached_property
    def slopes(self) -> Any:
        """Derivatives of the result by what moves of the arguments."""
        pattern, (_, entries) = self._first
        rows, columns = (np.array(one, dtype=np.int64) for one in pattern.get_triplet())
        every = np.add.outer(rows, pattern.size1() * np.arange(self.count))
        return _matrix(every, self._places[columns], entries, (self.result.numel(), self.moved.numel()))

    def curvature(self, multipliers: Any) -> Any:
        """Second derivatives of the result, times multipliers, by what moves of the arguments."""
        pattern, function = self._point.second
        entries = function.map(self.count)(*self._columns, ca.reshape(multipliers, -1, self.count))
        rows, columns = (self._places[list(one)] for one in pattern.get_triplet())
        return _matrix(rows, columns, entries, (self.moved.numel(), self.moved.numel()))


def _opened(expressions: Sequence[Any], x: Any, p: Any, known: Known) -> tuple[list[Any], list[_Call]]:
    """Expressions with a symbol in place of every call's results, and the calls in the order they are made."""
    graph = ca.Function("graph", [x, p], expressions)
    steps = range(graph.n_instructions())
    nodes = [graph.instruction_MX(k) for k in steps if graph.instruction_id(k) == ca.OP_CALL]
    outputs = [[node.get_output(i) for i in range(node.which_function().n_out())] for node in nodes]
    results = [ca.MX.sym("result", sum(one.size1() for one in own), own[0].size2()) for own in outputs]
    parts = [ca.vertsplit(result, _ends(own)) for result, own in zip(results, outputs, strict=True)]
    arguments = [[_once(node.dep(i)) for i in range(node.n_dep())] for node in nodes]
    whole = [*expressions, *(one for each in arguments for one in each)]
    opened = ca.graph_substitute(whole, [*chain(*outputs)], [*chain(*parts)])
    left = iter(opened[len(expressions) :])
    calls = []
    for node, result, own in zip(nodes, results, arguments, strict=True):
        function = node.which_function()
        mapped = function.is_a("Map")
        point = _with_one_result(function.get_function("f") if mapped else function)
        calls.append(_Call(point, result.size2() if mapped else 1, [next(left) for _ in own], result, known))
    return opened[: len(expressions)], calls


def _ends(outputs: Sequence[Any]) -> list[int]:
    """Where results begin that stand one below the other, and where the last one ends."""
    return [0, *accumulate(one.size1() for one in outputs)]


def _with_one_result(function: Any) -> Any:
    """A function whose results stand one below the other."""
    if function.n_out() == 1:
        return function
    kind: Any = ca.SX if function.is_a("SXFunction") else ca.MX
    arguments = [kind.sym("argument", function.sparsity_in(i)) for i in range(function.n_in())]
    return ca.Function(function.name(), arguments, [ca.vertcat(*function.call(arguments, True, False))])


def _once(argument: Any) -> Any:
    """An argument that is the same for all points, without its repetition."""
    return argument.dep(0) if argument.op() == ca.OP_HORZREPMAT else argument


def _follow(calls: Sequence[_Call], x: Any) -> tuple[Any, Any]:
    """All that is known once the calls are made, unknowns first, and its derivatives by them."""
    known, along = [x], ca.MX.eye(x.numel())
    for call in calls:
        call.before, call.moving_before = ca.vertcat(*known), set(along.sparsity().row())
        call.along = ca.mtimes(call.by_before, along)
        along = ca.vertcat(along, ca.mtimes(call.slopes, call.along))
        known.append(ca.vec(call.result))
    return ca.vertcat(*known), along


def _go_back(calls: Sequence[_Call], multipliers: Any) -> tuple[list[Any], Any, list[tuple[Any, Any]]]:
    """From the multipliers of z: the calls' own second derivatives by x, the arguments times theirs, and these."""
    inner, outer, nus = [], ca.MX(0), []
    for call in reversed(calls):
        count = call.before.numel()
        if not call.moved.numel():  # it stays as it is, whatever the unknowns are
            multipliers = multipliers[:count]
            continue
        mu = multipliers[count:]
        nu = ca.MX.sym("nu", call.moved.numel())
        nus.append((nu, ca.mtimes(call.slopes.T, mu)))
        multipliers = multipliers[:count] + ca.mtimes(call.by_before.T, nus[-1][1])
        outer += ca.dot(nu, call.moved)
        inner.append(_turned(call.curvature(mu), call.along))
    return inner, outer, nus


def _turned(bent: Any, along: Any) -> Any:
    """Second derivatives by the unknowns, from those by something, and its derivatives by the unknowns."""
    return ca.mtimes(along.T, ca.mtimes(bent, along))


def _inserted(expressions: list[Any], known: Sequence[tuple[Any, Any]]) -> list[Any]:
    """Expressions with what symbols stand for in their places, each of which may need those before it."""
    symbols, values = [symbol for symbol, _ in known], [value for _, value in known]
    found: list[Any] = ca.substitute_inplace(symbols, values, expressions)[1]
    return found


def _matrix(rows: Places, columns: Places, entries: Any, shape: tuple[int, int]) -> Any:
    """The sparse matrix with entries at certain places; those at one place are added up."""
    where = (columns * shape[0] + rows).ravel(order="F")
    places, which = np.unique(where, return_inverse=True)
    pattern = ca.Sparsity.triplet(*shape, (places % shape[0]).tolist(), (places // shape[0]).tolist())
    adding = ca.DM(ca.Sparsity.triplet(len(places), len(where), which.tolist(), list(range(len(where)))), 1.0)
    return ca.MX(pattern, ca.mtimes(adding, ca.vec(entries)))
