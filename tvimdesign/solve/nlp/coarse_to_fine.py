"""The unknowns of a problem from a solution of the same one with fewer elements of time."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tvimdesign.solve.nlp.problem import Problem
from tvimdesign.solve.nlp.solver_run import Array
from tvimdesign.solve.nlp.transcription import ORDER, radau


def on_finer_grid(unknowns: Array, coarse: Problem, fine: Problem, inputs: Array) -> Array:
    """The unknowns of `fine` where those of `coarse` are `unknowns`, at the inputs that they stand for.

    States are what the collocation's polynomials are at the finer points. Where a current is free, both problems have
    the same elements.
    """
    parts = [unknowns[: len(coarse.free)]]
    left = iter(np.split(unknowns, np.cumsum([len(coarse.free), *(one.unknowns.numel() for one in coarse.blocks)])))
    next(left)
    ends: dict[str, Array] = {}
    for block, other in zip(coarse.blocks, fine.blocks, strict=True):
        own = next(left)
        states = own[:-1].reshape(block.states.shape, order="F")
        after, phase = block.phase.phase.after, block.phase
        begin = phase.initial(inputs) if after is None else phase.begin(ends[after], inputs)
        ends[phase.phase.name] = states[:, -1]
        every = np.column_stack([np.asarray(begin).ravel(), states])
        finer = at_points(every, other.states.shape[1] // fine.order, coarse.order, fine.order)
        parts += [finer.ravel(order="F"), own[-1:]]
    return np.concatenate([*parts, next(left)])


def at_points(every: Array, elements: int, order: int = ORDER, finer: int = ORDER) -> Array:
    """States at the points of so many equal elements of the order `finer`, from those at the start and at the points of
    fewer, of another `order`."""
    return np.column_stack([_at(place, every, order) for place in _points(elements, finer)])


def _points(elements: int, order: int) -> Iterator[float]:
    """The collocation points over a whole time of one."""
    for element in range(elements):
        yield from (element + radau(order)[0]) / elements


def _at(place: float, every: Array, order: int) -> Array:
    """The states at a share of the time, by the polynomial of the element that it lies in."""
    count = (every.shape[1] - 1) // order
    element = min(int(place * count), count - 1)
    nodes = np.append(0.0, radau(order)[0])
    shape = np.array([
        np.prod([(place * count - element - other) / (node - other) for other in nodes if other != node])
        for node in nodes
    ])  # fmt: skip
    first = element * order
    value: Array = every[:, first : first + order + 1] @ shape
    return value
