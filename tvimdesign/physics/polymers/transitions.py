"""Freezing of a semicrystalline polymer below its melting window, and melting again: rate, solid fraction, temperature.

The state is psi [1], the extended variable of nucleation and growth; the solid fraction is X = 1 - exp(-psi^n). At a
constant temperature psi = K t, which is Avrami's law; at a changing one its integral is Nakamura's. The solid cannot be
more than its equilibrium fraction: what is above it melts within `melting_time`. Temperatures in kelvin, from 200 to
500 K; specific enthalpy in J/kg, zero at 0 degC in the solid. Every function is smooth, corners are rounded.
Sources: [A] Avrami, J. Chem. Phys. 8 (1940) 212; [N] Nakamura, Katayama and Amano, J. Appl. Polym. Sci. 17 (1973) 1031;
[H] Hoffman, Davis and Lauritzen, in Treatise on Solid State Chemistry 3 (1976) ch. 7 (growth rate, U, f, T_inf).

A polymer across its glass transition: one relaxation spectrum whose times shift with temperature, no latent heat.

Temperatures in kelvin. Sources: [F] Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 11 (time-temperature
superposition, Arrhenius below the transition); [WLF] Williams, Landel and Ferry, J. Am. Chem. Soc. 77 (1955) 3701.

A layer between two plates that shrinks in volume as it freezes, and the traction on its bond where it is held back.

Both plates are clamped at a hub; the layer begins a span away from it. Where it begins, the plates have not bent far
enough, and it pulls hardest. A strip of unit width, the layer as springs (Winkler) of the rate k [Pa/m], the plates'
flexural rigidities D in series, beta = (k/(4 D))^(1/4) and lambda = beta span. Sources: Timoshenko, Strength of
Materials, part II, ch. 1 (beam on an elastic foundation, semi-infinite); Timoshenko and Goodier, Theory of Elasticity,
sec. 6 (strain in one direction alone).
"""

from typing import Any, NamedTuple, Self

import numpy as np

from tvimdesign.physics.polymers import polymer
from tvimdesign.physics.polymers.polymer import Melting, Modes

BELOW_GLASS = 30.0  # K; molecules stop moving that far below the glass transition [H]
# Roundings, each small against what it rounds.
_UNDERCOOLING_ROUNDING = 0.5  # K
_WINDOW_ROUNDING = 0.5  # K
_PSI_ROUNDING = 1e-3
_LEAST_MELT = 1e-4  # psi ends where this share is left molten: at 2.1 for n = 3
_LEAST_NUCLEI = 1e-3  # below this -ln(1 - X), psi goes straight to zero, not with the root's infinite slope
_SLOWEST = (
    -200.0
)  # the logarithm of the rate goes no lower: K is then 1e-87 of its reference, and no half-time infinite


class Kinetics(NamedTuple):
    """Parameters of the freezing of one material."""

    avrami_exponent: Any  # n [1]
    reference_half_time: Any  # Time in which half of it freezes at the reference temperature [s]
    reference: Any  # [K]
    nucleation_constant: Any  # K_g [K^2]
    equilibrium_melting: Any  # T_m0, at which crystals of infinite thickness melt [K]: no freezing above it
    glass_transition: Any
    transport_energy: Any  # U [J/mol]
    melting_time: Any
    """Time constant with which solid above the equilibrium fraction melts [s]; the lag of melting behind heating."""


def _mobility_and_nucleation(temperature_kelvin: Any, kinetics: Kinetics) -> Any:
    """Return the logarithm of the growth rate but for a constant: -U/(R (T - T_inf)) - K_g/(T dT f), f = 2 T/(T + T_m0)
    [H]."""
    above_frozen = polymer.ramp(temperature_kelvin - (kinetics.glass_transition - BELOW_GLASS), _UNDERCOOLING_ROUNDING)
    undercooling = polymer.ramp(kinetics.equilibrium_melting - temperature_kelvin, _UNDERCOOLING_ROUNDING)
    correction = 2.0 * temperature_kelvin / (temperature_kelvin + kinetics.equilibrium_melting)
    transport = kinetics.transport_energy / (polymer.GAS_CONSTANT * above_frozen)
    return -transport - kinetics.nucleation_constant / (temperature_kelvin * undercooling * correction)


def _speed(temperature_kelvin: Any, kinetics: Kinetics) -> Any:
    """Return the rate of freezing over that at the reference temperature [1]."""
    reference = _mobility_and_nucleation(kinetics.reference, kinetics)
    logarithm = _mobility_and_nucleation(temperature_kelvin, kinetics) - reference
    return np.exp(_SLOWEST + polymer.ramp(logarithm - _SLOWEST, 0.1))


def rate_constant(temperature_kelvin: Any, kinetics: Kinetics) -> Any:
    """Return K = (ln 2)^(1/n)/t_half [1/s], with which psi rises at a temperature [N]."""
    at_reference = np.log(2.0) ** (1.0 / kinetics.avrami_exponent) / kinetics.reference_half_time
    return at_reference * _speed(temperature_kelvin, kinetics)


def solid_fraction(psi: Any, kinetics: Kinetics) -> Any:
    """Return the share that is frozen [1], X = 1 - exp(-psi^n) [A]; none for psi at and below zero."""
    return 1.0 - np.exp(-(polymer.ramp(psi, _PSI_ROUNDING) ** kinetics.avrami_exponent))


def extended(fraction: Any, kinetics: Kinetics) -> Any:
    """Return the psi of a solid fraction, (-ln(1 - X))^(1/n) [A]; X may be 0, 1 and a little beyond, as rounded curves
    give it.

    Near X = 0 the root is a straight line through zero, near X = 1 psi ends at what leaves a 10^-4 part molten.
    """
    molten = _LEAST_MELT + polymer.ramp(1.0 - fraction - _LEAST_MELT, _LEAST_MELT)
    extent = -np.log(molten)
    return extent * (extent**2 + _LEAST_NUCLEI**2) ** (0.5 / kinetics.avrami_exponent - 0.5)


def equilibrium_fraction(temperature_kelvin: Any, melting: Melting) -> Any:
    """Return the largest share that can be solid at a temperature [1]: 1 below, 0 above the melting window, straight
    within."""
    molten = polymer.ramp(temperature_kelvin - melting.start, _WINDOW_ROUNDING)
    molten = molten - polymer.ramp(temperature_kelvin - melting.end, _WINDOW_ROUNDING)
    return 1.0 - molten / (melting.end - melting.start)


def rate(temperature_kelvin: Any, psi: Any, kinetics: Kinetics, melting: Melting) -> Any:
    """Return the time derivative of psi [1/s]: freezing with K(T) [N], melting of what is above equilibrium.

    d psi/dt = K(T) - max(psi - psi_eq(T), 0)/tau. K does not depend on psi, so a melt without a crystal freezes too.
    Heated at a rate r, the solid fraction follows the equilibrium curve tau r behind.
    """
    largest = extended(equilibrium_fraction(temperature_kelvin, melting), kinetics)
    # The second ramp is the first at psi = 0: what is not there does not melt, not even in the rounded corner.
    excess = polymer.ramp(psi - largest, _PSI_ROUNDING) - polymer.ramp(-largest, _PSI_ROUNDING)
    return rate_constant(temperature_kelvin, kinetics) - excess / kinetics.melting_time


def enthalpy(temperature_kelvin: Any, fraction: Any, melting: Melting) -> Any:
    """Return the specific enthalpy [J/kg] of solid and melt at one temperature: X h_s(T) + (1 - X) h_m(T).

    h_s = c_s (T - T_0), h_m = h_2 + c_m (T - T_end), both lines drawn on beyond the window. So the heat of freezing,
    h_m - h_s, changes with temperature by c_m - c_s a kelvin: Kirchhoff's law follows.
    """
    solid = melting.specific_heat_solid * (temperature_kelvin - polymer.ZERO_CELSIUS)
    melt = melting.enthalpy_end + melting.specific_heat_melt * (temperature_kelvin - melting.end)
    return fraction * solid + (1.0 - fraction) * melt


def temperature(specific_enthalpy: Any, fraction: Any, melting: Melting) -> Any:
    """Return the temperature [K] of a specific enthalpy [J/kg] and a solid fraction: `enthalpy` solved for T, linear in
    it."""
    at_zero = enthalpy(polymer.ZERO_CELSIUS, fraction, melting)
    capacity = fraction * melting.specific_heat_solid + (1.0 - fraction) * melting.specific_heat_melt
    return polymer.ZERO_CELSIUS + (specific_enthalpy - at_zero) / capacity


_CORNER = 1.0  # K; over this the shift's kink at the glass transition is rounded


class GlassTransition(NamedTuple):
    """Parameters of the shift across a glass transition."""

    temperature: Any  # T_g [K]
    wlf_c1: Any  # [1]
    wlf_c2: Any  # [K]
    activation_energy: Any  # Of the relaxation below the transition [J/mol]


def shift(temperature_kelvin: Any, transition: GlassTransition) -> Any:
    """Return the time-temperature shift factor [1], above T_g a_T = 10^(-c1 (T - T_g)/(c2 + T - T_g)) [WLF], below
    Arrhenius [F].

    Both are 1 at T_g, where their slopes differ; that corner is rounded over one kelvin.
    """
    above = polymer.ramp(temperature_kelvin - transition.temperature, _CORNER)
    wlf = np.exp(-np.log(10.0) * transition.wlf_c1 * above / (transition.wlf_c2 + above))
    return wlf * polymer.arrhenius_shift(
        temperature_kelvin - above, transition.temperature, transition.activation_energy
    )


class Glass(NamedTuple):
    """Parameters of the spectrum of a glassy polymer."""

    shear_modulus: Any  # Storage modulus at the reference temperature and 1 Hz [Pa]
    reference_temperature: Any
    transition: GlassTransition
    modes: Modes
    """Relaxation spectrum at T_g: (time [s], modulus relative to the others [1]); the longest time is the rubber's."""

    @property
    def equilibrated(self) -> Self:
        """Return the glass itself: it has no memory."""
        return self

    def at(self, temperature_kelvin: Any) -> list[tuple[Any, Any]]:
        """Return the relaxation spectrum (time [s], modulus [Pa]) at a temperature: times shift, moduli are those of
        the reference."""
        before = shift(self.reference_temperature, self.transition)
        pinned, _ = polymer.maxwell_moduli(polymer.PINNED_FREQUENCY * before, self.modes)
        shifted = shift(temperature_kelvin, self.transition)
        return [(shifted * time, self.shear_modulus / pinned * share) for time, share in self.modes]


def volume_share(density_melt: Any, density_solid: Any) -> Any:
    """Return the share of the melt's volume that is lost on freezing [1]: 1 - rho_melt/rho_solid; densities
    [kg/m^3]."""
    return 1.0 - density_melt / density_solid


def linear_share(volume_share: Any) -> Any:
    """Return the share that a body with free sides loses of each length [1]: 1 - (1 - s)^(1/3) of its volume's share
    s."""
    return 1.0 - (1.0 - volume_share) ** (1.0 / 3.0)


def growth(density_melt: Any, density_solid: Any) -> Any:
    """Return the volume gained on melting over that of the solid [1]: rho_solid/rho_melt - 1; densities [kg/m^3]."""
    return density_solid / density_melt - 1.0


def confined_modulus(youngs_modulus: Any, poissons_ratio: Any) -> Any:
    """Return the modulus [Pa] of a body that can strain in one direction only, M = E (1 - nu)/((1 + nu)(1 - 2
    nu))."""
    return youngs_modulus * (1.0 - poissons_ratio) / ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio))


def flexural_rigidity(youngs_modulus: Any, poissons_ratio: Any, thickness: Any) -> Any:
    """Return the flexural rigidity of a plate [N*m], D = E h^3/(12 (1 - nu^2)); modulus [Pa], thickness [m]."""
    return youngs_modulus * thickness**3 / (12.0 * (1.0 - poissons_ratio**2))


def decay_rate(foundation: Any, rigidity: Any) -> Any:
    """Return the length over which plates bend after a layer [1/m], beta = (k/(4 D))^(1/4); k [Pa/m], D [N*m]."""
    return (foundation / (4.0 * rigidity)) ** 0.25


def shear_rigidity(shear_modulus: Any, thickness: Any) -> Any:
    """Return the force per width that shears a plate by a unit angle [N/m], 5/6 G h; modulus [Pa], thickness [m]."""
    return 5.0 / 6.0 * shear_modulus * thickness


def edge_traction(shortened: Any, foundation: Any, rigidity: Any, shear: Any, span: Any) -> Any:
    """Return the traction [Pa] where a layer begins that would be `shortened` [m] and whose plates are clamped a `span`
    [m] away.

    p = k delta (1 + lambda)/(1 + lambda (1 + k/(beta^2 S)) + lambda^2 + lambda^3/3): all of k delta without a span,
    none far from the hub. S [N/m] is the plates' rigidity in shear over the span, in series.
    """
    rate = decay_rate(foundation, rigidity)
    slack = rate * span
    given_way = 1.0 + slack * (1.0 + foundation / (rate**2 * shear)) + slack**2 + slack**3 / 3.0
    return foundation * shortened * (1.0 + slack) / given_way


def edge_traction_of_force(line_force: Any, foundation: Any, rigidity: Any, span: Any) -> Any:
    """Return the traction [Pa] where a layer begins whose plates a force [N/m] parts at the hub, where they may move
    but not turn.

    p = V beta (1 + lambda).
    """
    rate = decay_rate(foundation, rigidity)
    return line_force * rate * (1.0 + rate * span)
