"""The problem compiled: residuals and their exact derivatives by the solver's numbers, from CasADi."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from tvimdesign.simulation.measurement.fitting.problem import Array, Problem, Values
from tvimdesign.simulation.working_cycle.casadi_setup import ca

_FARTHEST, _STEEPEST = 1e6, 1e30  # beyond these a trial of the solver is merely bad


class Residuals:
    """Measured less predicted, channel after channel, as functions of the solver's numbers."""

    def __init__(self, problem: Problem) -> None:
        """Build the functions."""
        self.problem = problem
        inner = ca.MX.sym("x", len(problem.parameters))
        values: Values = {one.name: one.outer(inner[i]) for i, one in enumerate(problem.parameters)}
        predicted = [ca.vec(ca.MX(channel.predicted(values))) for channel in problem.channels]
        compared = [ca.log(one) if c.relative else one for one, c in zip(predicted, problem.channels, strict=True)]
        self._values = ca.Function("values", [inner], [ca.vertcat(*compared)])
        self._jacobian = ca.Function("jacobian", [inner], [ca.jacobian(ca.vertcat(*compared), inner)])
        following = [ca.log(ca.MX(one.formula(values))) for one in problem.derived]
        out = ca.vertcat(*following) if following else ca.MX(0, 1)
        self._derived = ca.Function("derived", [inner], [out, ca.jacobian(out, inner)])
        measured = [np.log(c.measured) if c.relative else c.measured for c in problem.channels]
        self._measured = np.concatenate(measured)
        self._most = _FARTHEST * (1.0 + float(np.max(np.abs(self._measured))))
        ends = np.cumsum([0, *(len(c.measured) for c in problem.channels)])
        self.parts = [slice(int(a), int(b)) for a, b in pairwise(ends)]
        """Where each channel stands in the whole."""
        words = [channel.noise_of or f"channel {i}" for i, channel in enumerate(problem.channels)]
        self.alike = [[j for j, word in enumerate(words) if word == mine] for mine in words]
        """Of each channel those that err as it does, itself among them."""
        self.groups = [alike for i, alike in enumerate(self.alike) if alike[0] == i]
        """Channels that err alike, each group once."""

    def at(self, inner: Array) -> Array:
        """Residuals, in the units of the channels, or as a share of the value.

        No larger than `_FARTHEST` times the largest value measured, where the equations give less or no number.
        """
        found: Array = self._measured - np.asarray(self._values(inner)).ravel()
        numbers = np.nan_to_num(found, nan=self._most, posinf=self._most, neginf=-self._most)
        clipped: Array = np.clip(numbers, -self._most, self._most)
        return clipped

    def jacobian(self, inner: Array) -> Array:
        """Their derivatives by the solver's numbers."""
        slopes = np.nan_to_num(np.asarray(self._jacobian(inner).full()), posinf=0.0, neginf=0.0)
        clipped: Array = np.clip(-slopes, -_STEEPEST, _STEEPEST)
        return clipped

    def derived(self, inner: Array) -> tuple[Array, Array]:
        """Logarithms of what follows, and their derivatives."""
        values, slopes = self._derived(inner)
        return np.asarray(values).ravel(), np.asarray(slopes.full())

    def predicted(self, inner: Array) -> list[Array]:
        """What each channel should be [SI]."""
        values = np.asarray(self._values(inner)).ravel()
        return [
            np.exp(values[part]) if channel.relative else values[part]
            for part, channel in zip(self.parts, self.problem.channels, strict=True)
        ]
