"""The relaxation spectrum of a melt from any of its tests, with as few modes as the data bear, and its shift.

Modes (tau_i, G_i) are free in time and modulus. Each temperature but the reference shifts its rates by a factor a_T of
its own, and by Arrhenius' law where that describes them all; a ramp has rows at all temperatures, and goes by the law
from the start. How many modes: as long as one more betters Schwarz's criterion. Source: [BW] Baumgaertel and Winter,
Rheol. Acta 28 (1989) 511 (free times and moduli, as few modes as the data bear).
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.physics.polymers import polymer
from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS
from tvimdesign.simulation.measurement.fitting.fit import BestFit, simplest_fit
from tvimdesign.simulation.measurement.fitting.problem import Channel, Derived, Parameter, Problem, Values
from tvimdesign.simulation.measurement.measurement import Settings
from tvimdesign.simulation.measurement.reading.data_file import Array

_TOGETHER = 1.0  # Tests within so many kelvin are of one temperature
_A_PARAMETER = 2  # Values for each parameter, at least, of a spectrum of several modes: with fewer it follows the noise
BEYOND = 10.0  # Factor by which a relaxation time may lie outside the times that a test sees
_SOLID = 1e3  # Factor beyond that by which the time of a mode lies that stands for a solid
USUAL_ENERGY = 40e3  # J/mol, to start from: in the middle of what polymers' melts have


class MeltTest(NamedTuple):
    """One test: its temperature [K], or one for each row of a ramp, its curves, and where it sees the spectrum."""

    name: str
    temperature: float
    ramp: Array | None
    curves: Sequence[Channel]  # Values, each predicted from modes, shift factors and the parameters
    rates: Array  # Angular frequencies, or one over the times [1/s]
    sizes: Array  # Modulus at each of them [Pa], roughly
    note: str = ""  # Parts that were left out
    own: Sequence[Parameter] = ()  # Unknowns of this test alone
    blind: str = ""  # `inertia` or `rise` where first rows were left out for it: what relaxes faster is not seen


class Melt(NamedTuple):
    """Tests of a melt with what they are fitted by."""

    tests: Sequence[MeltTest]
    temperatures: Sequence[float]  # Of the tests that have one each [K], those within a kelvin as one
    reference: float
    energy: float | None = None
    """Start of the activation energy where the shift goes by Arrhenius' law; a factor each otherwise."""
    known_energy: float | None = None  # The activation energy, where it is known
    fast: bool = False  # True where what relaxes faster than the tests see is a viscosity
    solid: bool = False  # True where what relaxes slower than the tests see is the modulus of a solid

    @property
    def rates(self) -> Array:
        """Rates that the tests see, at the reference temperature, roughly [1/s]."""
        return np.concatenate([test.rates * guessed_shift(test.temperature, self.reference) for test in self.tests])

    @property
    def window(self) -> tuple[float, float]:
        """Shortest and longest relaxation time [s] that is looked for: `BEYOND` outside what the tests see."""
        return float(1.0 / (BEYOND * self.rates.max())), float(BEYOND / self.rates.min())

    def modes(self, values: Values, count: int) -> list[tuple[Any, Any]]:
        """Return the spectrum (time [s], modulus [Pa]), slowest first, with the modes of a solid and of a viscosity."""
        slow = [(_SOLID * self.window[1], values["solid_modulus"])] if self.solid else []
        fast = [(values["fast_time"], values["fast_viscosity"] / values["fast_time"])] if self.fast else []
        return [*slow, *modes_of(values, count), *fast]

    def factor(self, values: Values, test: MeltTest) -> Any:
        """Return the shift of the rates of a test: one, or one for each row of a ramp."""
        if self.energy is not None and (test.ramp is not None or self._near(test) != self.reference):
            at = self._near(test) if test.ramp is None else test.ramp
            return polymer.arrhenius_shift(at, self.reference, values.get("flow_activation_energy", self.energy))
        if np.isnan(self.reference) or self._near(test) == self.reference:
            return 1.0
        return values[shift_name(self._near(test))]

    def _near(self, test: MeltTest) -> float:
        return min(self.temperatures, key=lambda temperature: abs(temperature - test.temperature))

    @property
    def shifted(self) -> list[float]:
        """The temperatures whose tests are shifted."""
        return [at for at in self.temperatures if at != self.reference and not np.isnan(at)]


def melt_of(tests: Sequence[MeltTest], settings: Settings) -> Melt:
    """Return tests as one melt, by the reference temperature and the energy that are set."""
    if np.isnan(tests[0].temperature):
        return Melt(tests, [np.nan], np.nan)
    temperatures: list[float] = []
    for temperature in sorted(test.temperature for test in tests):
        if not temperatures or temperature - temperatures[-1] > _TOGETHER:
            temperatures.append(temperature)
    wanted = settings.get("reference_temperature", temperatures[len(temperatures) // 2])
    known = settings.get("flow_activation_energy")
    ramps = any(test.ramp is not None for test in tests)
    if known is None and not ramps:
        return Melt(tests, temperatures, min(temperatures, key=lambda temperature: abs(temperature - wanted)))
    return Melt(tests, temperatures, wanted, USUAL_ENERGY if known is None else known, known)


def fewest_modes(melt: Melt, most: int) -> tuple[int, BestFit]:
    """Return how many modes the data bear, from one to `most`, and the fit with them.

    Raises InputError where there are fewer values than one mode has parameters.
    """
    first, *others = (spectrum_problem(melt, count) for count in range(1, most + 1))
    chosen, best = simplest_fit(
        [first, *(each for each in others if each.count >= _A_PARAMETER * len(each.parameters))]
    )
    return chosen + 1, best


def spectrum_problem(melt: Melt, count: int) -> Problem:
    """Return the spectrum of `count` modes and shifts."""
    parameters = _modes(melt, count)
    parameters += [parameter for test in melt.tests for parameter in test.own]
    if melt.energy is None:
        parameters += [
            Parameter(shift_name(temperature), "1", "Shift of the rates to those of the reference",
                      float(guessed_shift(temperature, melt.reference)))
            for temperature in melt.shifted
        ]  # fmt: skip
    elif melt.known_energy is None:
        parameters.append(Parameter("flow_activation_energy", "kJ/mol", "Of the shift with temperature", melt.energy))

    if melt.solid:
        parameters.append(Parameter("solid_modulus", "Pa", "Modulus left at the longest times, as of a solid",
                                    float(min(np.min(test.sizes) for test in melt.tests))))  # fmt: skip
    if melt.fast:
        shortest = melt.window[0]
        largest = float(max(np.max(test.sizes) for test in melt.tests)) * shortest * BEYOND
        parameters += [
            Parameter("fast_time", "s", "Time of it", 0.1 * shortest, least=shortest / _SOLID, most=shortest,
                      nuisance=True),
            Parameter("fast_viscosity", "Pa*s", "Viscosity of all that relaxes faster than is seen", largest),
        ]  # fmt: skip

    def predicted(test: MeltTest, channel: Channel) -> Callable[[Values], Any]:
        by_spectrum: Callable[..., Any] = channel.predicted
        return lambda values: by_spectrum(melt.modes(values, count), melt.factor(values, test), values)

    channels = [replace(channel, predicted=predicted(test, channel)) for test in melt.tests for channel in test.curves]
    derived = [] if melt.solid else [
        Derived("zero_shear_viscosity", "Pa*s", "Viscosity of slow flow: sum of modulus times time",
                lambda values: sum(time * modulus for time, modulus in melt.modes(values, count)))
    ]  # fmt: skip
    if count:
        derived.append(
            Derived("plateau_modulus", "MPa", "Sum of the moduli: the modulus at the highest rates measured",
                    lambda values: sum(modulus for _, modulus in modes_of(values, count)))
        )  # fmt: skip
    return Problem(parameters, channels, derived)


def modes_of(values: Values, count: int) -> list[tuple[Any, Any]]:
    """Return the spectrum (time [s], modulus [Pa]), slowest mode first."""
    return [(values[f"time_{i}"], values[f"modulus_{i}"]) for i in range(1, count + 1)]


def _modes(melt: Melt, count: int) -> list[Parameter]:
    """Return starts: times evenly over the range of the rates, moduli from those nearest to one over each."""
    rates, size = melt.rates, np.concatenate([test.sizes for test in melt.tests])
    order = np.argsort(rates)
    logs = np.linspace(np.log(rates.min()), np.log(rates.max()), 2 * count + 1)[1::2]
    shortest, longest = melt.window
    parameters = []
    for i, log in enumerate(logs, start=1):
        modulus = float(np.exp(np.interp(log, np.log(rates[order]), np.log(size[order]))))
        parameters += [
            Parameter(f"time_{i}", "s", "Relaxation time of a mode", float(np.exp(-log)), profiled=False,
                      least=shortest, most=longest),
            Parameter(f"modulus_{i}", "Pa", "Modulus of that mode", modulus, profiled=False),
        ]  # fmt: skip
    return parameters


def temperature_known(names: Sequence[str], temperatures: Sequence[float]) -> bool:
    """Return whether the temperatures of tests are known. Raises InputError where those of some are."""
    unknown = np.isnan(temperatures)
    if np.any(unknown) and not np.all(unknown):
        name = names[int(np.argmax(unknown))]
        raise InputError(f"{name}: the file does not say its temperature, as others do; --set temperature=...")
    return not np.any(unknown)


def shift_name(temperature: float) -> str:
    """Return the name of a temperature's factor."""
    return f"shift_{temperature - ZERO_CELSIUS:.0f}".replace("-", "minus_")


def guessed_shift(temperature: Any, reference: float) -> Any:
    """Return the shift factor to start from."""
    return 1.0 if np.isnan(reference) else polymer.arrhenius_shift(temperature, reference, USUAL_ENERGY)
