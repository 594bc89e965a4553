"""The polymer as a rheometer holds it: one spectrum at each temperature, or several where its history decides.

Inside the melting range every number comes with the least and largest value over all solid fractions that history
allows; they are the columns `..._low` and `..._high` of a sheet, and `low` and `high` of a finding.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import astuple, dataclass, fields
from itertools import pairwise
from typing import Any

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.physics.polymers import polymer, viscoelasticity
from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS, Modes
from tvimdesign.physics.polymers.viscoelasticity import Body, KelvinVoigt, Maxwell, StandardLinearSolid
from tvimdesign.physics.solids.structure import shear_yield
from tvimdesign.simulation.trial import Array, Column, CurveTable, Finding, Panel, PlottedLine
from tvimdesign.simulation.working_cycle.curves import HISTORIES, fractions_at, melting_range
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule
from tvimdesign.study import STANDARD_POINTS

ROOM = 23.0 + ZERO_CELSIUS  # Temperature of a yield strength [K]
_NO_STRESS = 1e-30
PAPER = (303.15, 333.15, 373.15)  # The temperatures of the paper's rheometer tests [K]


@dataclass(frozen=True)
class State:
    """The polymer at one temperature and one solid fraction."""

    fraction: float
    modes: tuple[tuple[float, float], ...]  # Relaxation spectrum: (time [s], modulus [Pa])
    linear_strain: float  # Strain at which the storage modulus has fallen 5 % [1]

    activation_stress: float  # Stress that sets the yield of the frozen polymer [Pa]; see `yielding`

    def step_stress(self, time: Array, strain: float, rise: float) -> Array:
        """Return the stress [Pa] while and after a strain is reached at a constant rate within `rise` seconds.

        The frozen polymer yields, the melt has its damping function; between them both mix by their logarithms, as the
        moduli do.
        """
        logarithm = np.zeros(len(time))
        if self.fraction > 0.0:
            frozen = viscoelasticity.stress_of_a_ramp(time, strain, rise, self.modes, self.activation_stress)
            logarithm += self.fraction * np.log(np.maximum(frozen, _NO_STRESS))
        if self.fraction < 1.0:
            molten = viscoelasticity.ramped_stress(time, strain, rise, self.modes) * self.left(strain)
            logarithm += (1.0 - self.fraction) * np.log(np.maximum(molten, _NO_STRESS))
        stress: Array = np.exp(logarithm)
        return stress

    def left(self, strain: float | Array) -> float | Array:
        """Return the share of the linear modulus that is left at a strain."""
        share: float | Array = polymer.damping_function(strain, self.linear_strain)
        return share


@dataclass(frozen=True)
class Specimen:
    """The polymer at one temperature: the nominal state, and the others its history may have left it in."""

    temperature: float
    nominal: State
    others: tuple[State, ...]

    @property
    def states(self) -> tuple[State, ...]:
        """Every state, the nominal one first."""
        return (self.nominal, *self.others)

    @property
    def point(self) -> str:
        """The temperature as a part of a name."""
        return f"{_celsius(self.temperature)}_degC"

    @property
    def label(self) -> str:
        """The temperature for people."""
        return f"{_celsius(self.temperature)} °C"

    def columns(self, name: str, unit: str, of: Callable[[State], Array]) -> tuple[Column, ...]:
        """Return a quantity of the nominal state; where history decides, its least and largest values beside it."""
        nominal = Column(name, unit, of(self.nominal))
        if not self.others:
            return (nominal,)
        every = np.array([of(state) for state in self.states])
        return nominal, Column(f"{name}_low", unit, every.min(axis=0)), Column(f"{name}_high", unit, every.max(axis=0))

    def finding(self, name: str, unit: str, meaning: str, of: Callable[[State], float]) -> Finding:
        """Return a number read off; where history decides, with its least and largest value."""
        value = float(of(self.nominal))
        if not self.others:
            return Finding(f"{name}@{self.point}", value, unit, meaning)
        every = [float(of(state)) for state in self.states]
        return Finding(f"{name}@{self.point}", value, unit, meaning, min(every), max(every))

    def line(self, sheet: str, x: str, y: str, label: str | None = None, *, dashed: bool = False) -> PlottedLine:
        """Return a quantity of `columns` drawn over another, with its band where it has one."""
        band = (f"{y}_low", f"{y}_high") if self.others else None
        return PlottedLine(sheet, x, y, self.label if label is None else label, band, dashed)

    def bodies_panel(
        self, title: str, labels: tuple[str, str], sheet: str, x: str, y: str, *, log_x: bool = True, log_y: bool = True
    ) -> Panel:
        """Return a quantity of `columns` beside that of the simple bodies' `curves`, on axes with `labels`."""
        bodies = (PlottedLine(sheet, x, f"{y}_{kind}", name, dashed=True) for kind, name in TITLES.items())
        lines = (self.line(sheet, x, y, "full spectrum"), *bodies)
        return Panel(f"{title} at {self.label}", *labels, lines, log_x=log_x, log_y=log_y)


def at_fraction(resolved: ResolvedModule, temperature: float, fraction: float, *, cooled: bool = False) -> State:
    """Return polymer of a rig's module at a temperature [K] and a solid fraction. Raises InputError for no spectrum.

    One `cooled` from the melt has no memory of its crystals.
    """
    rheology = resolved.quantity("pcl_rheology")
    spectrum = polymer.spectrum(temperature, fraction, rheology.equilibrated if cooled else rheology)
    modes = tuple((float(time), float(modulus)) for time, modulus in spectrum)
    check_spectrum(modes, f"pcl_grade {resolved.values['pcl_grade'].name} at {_celsius(temperature)} °C")
    limit = float(polymer.linear_strain(fraction, resolved.quantity("pcl_linear_range")))
    return State(fraction, modes, limit, _activation_stress(resolved, temperature) if fraction > 0.0 else 0.0)


def _activation_stress(resolved: ResolvedModule, temperature: float) -> float:
    """Return the stress that sets the yield of the frozen polymer; its strength falls with its modulus, assumed."""
    rheology = resolved.quantity("pcl_rheology")
    here, room = (polymer.moduli(kelvin, 1.0, polymer.PINNED_FREQUENCY, rheology)[0] for kelvin in (temperature, ROOM))
    strength = float(shear_yield(resolved.values["pcl_tensile_yield"]) * here / room)
    return viscoelasticity.activation_stress(strength, polymer.spectrum(temperature, 1.0, rheology))


def specimen(resolved: ResolvedModule, temperature: float) -> Specimen:
    """Return the polymer of a rig's module at a temperature [K], in every state its history allows."""
    low, nominal, high = fractions_at(resolved, temperature)
    others = np.linspace(low, high, HISTORIES) if high > low else np.array([])
    return Specimen(
        temperature,
        at_fraction(resolved, temperature, nominal),
        tuple(at_fraction(resolved, temperature, float(x), cooled=bool(x < nominal)) for x in others),
    )


def specimens(resolved: ResolvedModule, temperatures: Sequence[float] | None = None) -> list[Specimen]:
    """Return the polymer at rising temperatures [K]; at those of the study's operating points where none are given.

    A study that has only the standard points, at their temperatures, gets the paper's three.
    """
    if temperatures is None:
        own = {point["temperature"] for point in resolved.study.operating_points.values()}
        standard = {point["temperature"] for point in STANDARD_POINTS.values()}
        temperatures = PAPER if own == standard else sorted(own)
    check_rising([at - ZERO_CELSIUS for at in temperatures], "the temperatures of the test", "°C")
    return [specimen(resolved, temperature) for temperature in temperatures]


def history_note(resolved: ResolvedModule) -> str:
    """Return a sentence on what the bands mean."""
    first, last = (_celsius(at) for at in melting_range(resolved))
    return (
        f"Between {first} and {last} °C the answer depends on history: the line is the equilibrium curve on heating; "
        "the band reaches from still liquid, cooled from the melt, to melting as late as the record allows."
    )


def _celsius(temperature: float) -> str:
    return f"{temperature - ZERO_CELSIUS:.6g}"


def check_spectrum(modes: Modes, place: str) -> None:
    """Raise InputError, naming the value and its place, where a spectrum is none."""
    if not modes:
        raise InputError(f"{place}: the spectrum has no modes; expected at least one (relaxation time, modulus)")
    for number, mode in enumerate(modes, start=1):
        for name, unit, value in zip(("relaxation time", "modulus"), ("s", "Pa"), mode, strict=True):
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(
                    f"{place}: mode {number} has the {name} {value:g} {unit}; expected a number greater than zero"
                )


def check_rising(values: Iterable[float], place: str, unit: str) -> None:
    """Raise InputError, naming the value and its place, where numbers do not rise one after the other."""
    for number, (before, after) in enumerate(pairwise(values), start=2):
        if not after > before:
            raise InputError(
                f"{place}: value {number} is {after:g} {unit} and follows {before:g} {unit}; expected rising values"
            )


BODIES: dict[str, type[Any]] = {
    "kelvin_voigt": KelvinVoigt,
    "maxwell": Maxwell,
    "standard_linear_solid": StandardLinearSolid,
}
TITLES = {"kelvin_voigt": "Kelvin-Voigt", "maxwell": "Maxwell", "standard_linear_solid": "standard linear solid"}
_FLOOR = 1e-6  # Share of the largest value below which two curves count as the same: both are nothing that is measured
_REACH = 60.0  # How far parameters may go from the first guess, in units of their logarithm
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
    fits: dict[str, tuple[ModelFit, ...]]  # By kind; the nominal state's first

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
