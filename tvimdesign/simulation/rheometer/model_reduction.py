"""Kelvin-Voigt, Maxwell and standard linear solid fitted to the full spectrum in one test, and how far off they are."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import astuple, dataclass, fields
from typing import Any

import numpy as np

from tvimdesign.physics.polymers.viscoelasticity import Body, KelvinVoigt, Maxwell, StandardLinearSolid
from tvimdesign.simulation.rheometer.specimen import Specimen, State
from tvimdesign.simulation.trial import Array, Column, CurveTable, Finding

BODIES: dict[str, type[Any]] = {
    "kelvin_voigt": KelvinVoigt,
    "maxwell": Maxwell,
    "standard_linear_solid": StandardLinearSolid,
}
TITLES = {"kelvin_voigt": "Kelvin-Voigt", "maxwell": "Maxwell", "standard_linear_solid": "standard linear solid"}
_FLOOR = 1e-6
"""Share of the largest value below which two curves count as the same: both are nothing that is measured."""
_REACH = 60.0
"""How far parameters may go from the first guess, in units of their logarithm."""
_STARTS = (-4.0, 0.0, 4.0)

StudyResult = Callable[[Body], Array]


@dataclass(frozen=True)
class ModelFit:
    """A body that comes as near as it can; `residual` is the root mean square of ln(body/full) over the test."""

    body: Any
    residual: float


def fit(kind: str, full: Array, answer: StudyResult, modulus: float, time: float) -> ModelFit:
    """Fit a body's parameters to the logarithms of what the full spectrum shows.

    `modulus` [Pa] and `time` [s] are of the size of what the test sees. Several starts: a dashpot far outside the
    test's window has no influence, and the search would stay there.
    """
    from scipy.optimize import least_squares

    body = BODIES[kind]
    sizes = [modulus * time if field.name == "viscosity" else modulus for field in fields(body)]
    target = _logarithms(full, full)

    def gap(logarithms: Array) -> Array:
        return _logarithms(answer(body(*np.exp(logarithms))), full) - target

    best: Any = None
    for start in _STARTS:
        begin = np.log(sizes) + start * np.array([field.name == "viscosity" for field in fields(body)])
        solution = least_squares(gap, begin, bounds=(begin - _REACH, begin + _REACH), x_scale=1.0)
        if best is None or solution.cost < best.cost:
            best = solution
    return ModelFit(body(*(float(value) for value in np.exp(best.x))), float(np.sqrt(np.mean(best.fun**2))))


def _logarithms(values: Array, full: Array) -> Array:
    return np.log(np.maximum(values, _FLOOR * np.max(full)))


@dataclass(frozen=True)
class Comparison:
    """Every body fitted to every state of a specimen."""

    specimen: Specimen
    fits: dict[str, tuple[ModelFit, ...]]
    """By kind; the nominal state's first."""

    def curves(self, name: str, unit: str, answer: StudyResult) -> tuple[Column, ...]:
        """Return the response of the nominal state's bodies, a column each."""
        return tuple(Column(f"{name}_{kind}", unit, answer(fits[0].body)) for kind, fits in self.fits.items())

    def findings(self) -> tuple[Finding, ...]:
        """Return the residual of every body."""
        compared = []
        for kind, fits in self.fits.items():
            residuals = dict(zip(self.specimen.states, (fit.residual for fit in fits), strict=True))
            meaning = f"root mean square of ln({TITLES[kind]} body / full spectrum) over the test"
            compared.append(self.specimen.finding(f"{kind}_residual", "1", meaning, residuals.__getitem__))
        return tuple(compared)


def compare(
    specimen: Specimen, full: Callable[[State], Array], answer: StudyResult, times: tuple[float, float]
) -> Comparison:
    """Fit every body to every state; `full` is what a state shows in the test, `times` [s] the test's window."""
    time = float(np.sqrt(times[0] * times[1]))

    def fits(kind: str) -> tuple[ModelFit, ...]:
        return tuple(fit(kind, full(state), answer, _size(state, time), time) for state in specimen.states)

    return Comparison(specimen, {kind: fits(kind) for kind in BODIES})


def _size(state: State, time: float) -> float:
    """Return the modulus [Pa] of the size a test of that length sees."""
    return sum(modulus * tau / (tau + time) for tau, modulus in state.modes)


def parameters(comparisons: Sequence[Comparison]) -> CurveTable:
    """Return every fitted body's parameters and residual, one row for each temperature and solid fraction."""
    rows = []
    for compared in comparisons:
        for index, state in enumerate(compared.specimen.states):
            chosen = [fits[index] for fits in compared.fits.values()]
            numbers = [number for fit in chosen for number in (*astuple(fit.body), fit.residual)]
            rows.append([compared.specimen.temperature, state.fraction, *numbers])
    heads = [("temperature", "degC"), ("solid_fraction", "1")]
    for kind, body in BODIES.items():
        heads += [(f"{kind}_{field.name}", "Pa*s" if field.name == "viscosity" else "Pa") for field in fields(body)]
        heads.append((f"{kind}_residual", "1"))
    table = np.array(rows)
    return CurveTable("simple_bodies", tuple(Column(name, unit, table[:, i]) for i, (name, unit) in enumerate(heads)))
