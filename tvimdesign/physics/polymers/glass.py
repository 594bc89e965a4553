"""A polymer across its glass transition: one relaxation spectrum whose times shift with temperature, no latent heat.

Temperatures in kelvin. Sources: [F] Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 11 (time-temperature
superposition, Arrhenius below the transition); [WLF] Williams, Landel and Ferry, J. Am. Chem. Soc. 77 (1955) 3701.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.polymers.polymer import PINNED_FREQUENCY, Modes, arrhenius_shift, maxwell_moduli, ramp

_CORNER = 1.0  # K; over this the shift's kink at the glass transition is rounded


class GlassTransition(NamedTuple):
    """Parameters of the shift across a glass transition."""

    temperature: Any
    """T_g [K]."""
    wlf_c1: Any
    """[1]"""
    wlf_c2: Any
    """[K]"""
    activation_energy: Any
    """Of the relaxation below the transition [J/mol]."""


def shift(temperature_kelvin: Any, transition: GlassTransition) -> Any:
    """Return the time-temperature shift factor [1], above T_g a_T = 10^(-c1 (T - T_g)/(c2 + T - T_g)) [WLF], below
    Arrhenius [F].

    Both are 1 at T_g, where their slopes differ; that corner is rounded over one kelvin.
    """
    above = ramp(temperature_kelvin - transition.temperature, _CORNER)
    wlf = np.exp(-np.log(10.0) * transition.wlf_c1 * above / (transition.wlf_c2 + above))
    return wlf * arrhenius_shift(temperature_kelvin - above, transition.temperature, transition.activation_energy)


class Glass(NamedTuple):
    """Parameters of the spectrum of a glassy polymer."""

    shear_modulus: Any
    """Storage modulus at the reference temperature and 1 Hz [Pa]."""
    reference_temperature: Any
    transition: GlassTransition
    modes: Modes
    """Relaxation spectrum at T_g: (time [s], modulus relative to the others [1]); the longest time is the rubber's."""

    def at(self, temperature_kelvin: Any) -> list[tuple[Any, Any]]:
        """Return the relaxation spectrum (time [s], modulus [Pa]) at a temperature: times shift, moduli are those of
        the reference."""
        before = shift(self.reference_temperature, self.transition)
        pinned, _ = maxwell_moduli(PINNED_FREQUENCY * before, self.modes)
        shifted = shift(temperature_kelvin, self.transition)
        return [(shifted * time, self.shear_modulus / pinned * share) for time, share in self.modes]
