"""In words: which parameters the data cannot tell apart, and what else a reader of the fit has to know."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tvimdesign.simulation.measurement.fitting.intervals import Spread, moved_by
from tvimdesign.simulation.measurement.fitting.problem import Array, Parameter, Problem

CLOSE = 0.95
"""Correlation from which on two parameters are named together."""
_FOLLOW = 0.5
_CHANCE = 0.05
"""Correlation from which on it is named, and the probability that it is none up to which it is sure."""
_SAME = 0.05
"""Share to which parameters must change alike for their ratios to be what is known."""


def in_words(problem: Problem, known: Spread, inner: Array) -> list[str]:
    """Sentences about free directions, close correlations, and residuals that follow one another.

    `inner` are the solver's numbers of the best fit.
    """
    undetermined: set[int] = set()
    said = []
    for direction in known.free_directions:
        moved = moved_by(direction)
        undetermined.update(moved)
        named = [i for i in moved if not problem.parameters[i].nuisance]
        said += [_free(problem.parameters, direction, named, inner)] if named else []
    said += _correlated(problem.parameters, correlation(known.covariance), undetermined)
    return said + _following(problem, known)


def _following(problem: Problem, known: Spread) -> list[str]:
    """Whether residuals follow one another, or are so few that nobody can tell."""
    most = max(range(len(known.follows)), key=lambda i: known.follows[i].rho)
    rho, name = known.follows[most].rho, problem.channels[most].name
    wider = np.sqrt((1.0 + rho) / (1.0 - rho))
    if rho <= _FOLLOW:
        return []
    if known.follows[most].by_chance > _CHANCE:
        return [
            f"The residuals of {name} are too few to tell whether they follow one another (correlation {rho:.2f}, if "
            f"they do): what they say counts as {wider:.1f} times less sure. Give more rows."
        ]
    return [
        f"Residuals follow one another, most those of {name} (correlation {rho:.2f}): the equations leave something "
        f"out, or the instrument smooths. What these data say counts as {wider:.1f} times less sure."
    ]


def correlation(covariance: Array) -> Array:
    """Correlation of the parameters; zero where one has no spread."""
    deviation = np.sqrt(np.diag(covariance))
    deviation[deviation == 0.0] = np.inf
    return np.asarray(covariance / np.outer(deviation, deviation))


def _free(parameters: Sequence[Parameter], direction: Array, moved: Sequence[int], inner: Array) -> str:
    names = [parameters[i].name for i in moved]
    if len(moved) == 1:
        return f"The data say nothing of {names[0]}: no prediction depends on it. Its value is the start of the fit."
    together = "rise together" if len({np.sign(direction[i]) for i in moved}) == 1 else "make up for one another"
    shares = np.array([direction[i] if parameters[i].positive else direction[i] / (inner[i] or np.inf) for i in moved])
    ratio = " Only their ratios are known." if np.ptp(shares) < _SAME * np.max(np.abs(shares)) else ""
    return (
        f"The data cannot tell {_listed(names)} apart: they {together} without changing any prediction.{ratio} "
        "Measure one of them otherwise and give it with --set."
    )


def _correlated(parameters: Sequence[Parameter], rho: Array, left_out: set[int]) -> list[str]:
    said = []
    for i, one in enumerate(parameters):
        for j in range(i + 1, len(parameters)):
            if abs(rho[i, j]) < CLOSE or {i, j} & left_out or one.nuisance or parameters[j].nuisance:
                continue
            how = "rises with" if rho[i, j] > 0.0 else "falls as"
            end = "" if rho[i, j] > 0.0 else " rises"
            said.append(
                f"The data hardly tell {one.name} and {parameters[j].name} apart (correlation {rho[i, j]:.3f}): "
                f"{one.name} {how} {parameters[j].name}{end}, and each alone is less sure than both together."
            )
    return said


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names[:-1]) + f" and {names[-1]}"
