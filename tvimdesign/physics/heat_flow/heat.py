"""Transient heat through the stack: air or sink | Peltier cold side | hot side | polymer | plate | air.

One dimension through the stack, finite volumes; what the plate is part of takes up heat sideways, as a chain of lumps.
The polymer's states are enthalpies, not temperatures with an apparent heat capacity, so the latent heat is never
stepped over (Voller and Prakash, Int. J. Heat Mass Transfer 30 (1987) 1709). Between polymer cells flows the difference
of their conduction potentials (`conduction`); other faces carry the two half-cell resistances in series (Patankar,
Numerical Heat Transfer and Fluid Flow, 1980, sec. 4.2). Surfaces lose heat
by convection and grey radiation to surroundings at ambient temperature (Incropera, ch. 1).

What is frozen follows the equilibrium melting curve, which is right for melting; with `Stack.freezing` each cell
carries its own history instead, and freezes late and supercooled.

A state is a one-dimensional array: cold side, hot side, polymer cells from the hot side on, plate cells, the lumps
beside the plate, the sink if there is one, and with kinetics one extended fraction for each polymer cell. Temperatures
stand in it as (T - 273.15 K)/100 K and enthalpies as H/(1e5 J/kg), so that all are of the order of one.
"""

from __future__ import annotations

import itertools
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.heat_flow import conduction, peltier
from tvimdesign.physics.polymers import crystallization, polymer
from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS

TEMPERATURE_SCALE = 100.0  # K
ENTHALPY_SCALE = 1e5  # J/kg
STEFAN_BOLTZMANN = 5.670374419e-8  # W/(m^2 K^4), CODATA


class Surface(NamedTuple):
    """A surface that loses heat to ambient."""

    area: Any
    """[m^2]"""
    coefficient: Any
    """Convection [W/m^2 K]."""
    emissivity: Any = 0.0


NOWHERE = Surface(0.0, 0.0)


def surface_coefficient(surface: Surface, temperature: Any, ambient: Any) -> Any:
    """Convection and radiation together [W/m^2 K]: h + e s (T^2 + T_a^2)(T + T_a)."""
    radiation = surface.emissivity * STEFAN_BOLTZMANN * (temperature**2 + ambient**2) * (temperature + ambient)
    return surface.coefficient + radiation


def surface_heat(surface: Surface, temperature: Any, ambient: Any) -> Any:
    """Heat lost by a surface [W]."""
    return surface.area * surface_coefficient(surface, temperature, ambient) * (temperature - ambient)


class Lump(NamedTuple):
    """A body at one temperature."""

    conductance: Any
    """To the plate, to the lump before it in the chain, or of a sink to the cold side [W/K]."""
    capacity: Any
    """[J/K]"""
    surface: Surface


class Stack(NamedTuple):
    """Everything the heat equation needs to know of the stack."""

    area: Any
    """Area the heat passes [m^2], the same for all layers."""
    thickness: Any
    """Thickness of the polymer [m]."""
    density: Any
    conductivity_solid: Any
    conductivity_melt: Any
    melting: polymer.Melting
    peltier: peltier.PeltierModule
    cold_capacity: Any
    """Heat capacity of the cold side [J/K]."""
    hot_capacity: Any
    cold_surface: Surface
    """What the cold side has towards the air; not used where there is a sink."""
    hot_contact: Any
    """Contact conductance of hot side and polymer [W/m^2 K]."""
    plate_contact: Any
    plate_thickness: Any
    plate_conductivity: Any
    plate_heat_capacity: Any
    """Per volume [J/m^3 K]."""
    plate_surface: Surface
    """The plate's outer face; its area is the stack's."""
    ambient: Any
    """[K]"""
    plate_cells: int
    beside: tuple[Lump, ...] = ()
    """What the plate belongs to: the first takes heat from all the plate's cells, each next from the one before."""
    sink: Lump | None = None
    """A body between the cold side and the air."""
    freezing: crystallization.Kinetics | None = None
    """Kinetics of freezing; without them the equilibrium melting curve holds."""


class Profile(NamedTuple):
    """Temperatures [K] through the stack at one instant, and the solid fraction of each polymer cell."""

    cold: Any
    hot: Any
    near: Any
    """Polymer's face towards the Peltier element."""
    cells: Any
    far: Any
    """Polymer's face towards the plate."""
    plate_face: Any
    """Plate's face towards the polymer."""
    plate: Any
    beside: Any
    """Lumps beside the plate."""
    sink: Any
    """The sink, if there is one."""
    fractions: Any
    through_layer: Any
    """Heat [W] into the first polymer cell, between the cells, and out of the last."""
    through_plate: Any
    """Heat [W] into the first plate cell, between the cells, and out to the air."""


class _Parts(NamedTuple):
    """A state taken apart; scaled as it stands there."""

    cold: Any
    hot: Any
    layer: Any
    plate: Any
    beside: Any
    sink: Any
    extended: Any


def _others(stack: Stack) -> int:
    """Count of entries after the polymer's."""
    return stack.plate_cells + len(stack.beside) + int(stack.sink is not None)


def _parts(state: Any, stack: Stack) -> _Parts:
    cells = len(state) - 2 - _others(stack)
    cells = cells // 2 if stack.freezing else cells
    lengths = (2, cells, stack.plate_cells, len(stack.beside), int(stack.sink is not None))
    ends = list(itertools.accumulate(lengths))
    layer, plate, beside, sink = (state[a:b] for a, b in itertools.pairwise(ends))
    return _Parts(state[0], state[1], layer, plate, beside, sink, state[ends[-1] :])


def initial_state(stack: Stack, cells: int, temperature: Any) -> Any:
    """State of a stack that is everywhere at one temperature [K], on the equilibrium melting curve."""
    scaled = (temperature - ZERO_CELSIUS) / TEMPERATURE_SCALE
    enthalpy = polymer.enthalpy(temperature, stack.melting) / ENTHALPY_SCALE
    layer = np.append(scaled * np.ones(2), enthalpy * np.ones(cells))
    state = np.append(layer, scaled * np.ones(_others(stack)))
    return with_history(state, stack) if stack.freezing else state


def with_history(state: Any, stack: Stack) -> Any:
    """A state of the equilibrium curve, as the stack with freezing kinetics goes on from it; no heat is lost."""
    assert stack.freezing is not None
    layer = _parts(state, stack._replace(freezing=None)).layer
    fractions = polymer.solid_fraction(ENTHALPY_SCALE * layer, stack.melting)
    return np.append(state, crystallization.extended(fractions, stack.freezing))


def _kelvin(scaled: Any) -> Any:
    return ZERO_CELSIUS + TEMPERATURE_SCALE * scaled


def _layer(parts: _Parts, stack: Stack) -> tuple[Any, Any]:
    """Temperature [K] and solid fraction of each polymer cell."""
    enthalpies = ENTHALPY_SCALE * parts.layer
    if stack.freezing is None:
        return polymer.temperature(enthalpies, stack.melting), polymer.solid_fraction(enthalpies, stack.melting)
    fractions = crystallization.solid_fraction(parts.extended, stack.freezing)
    return crystallization.temperature(enthalpies, fractions, stack.melting), fractions


def profile(state: Any, stack: Stack) -> Profile:
    """Temperatures, solid fractions and heat flows that a state stands for."""
    parts = _parts(state, stack)
    cells, fractions = _layer(parts, stack)
    plate = _kelvin(parts.plate)
    hot = _kelvin(parts.hot)
    near_half, far_half = _wall_halves(stack, cells, fractions, hot, plate[0])
    plate_half = 0.5 * stack.plate_thickness / stack.plate_cells / (stack.plate_conductivity * stack.area)

    inflow = (hot - cells[0]) / (1.0 / (stack.hot_contact * stack.area) + near_half)
    inside = _between_cells(stack, cells, fractions)
    across = (cells[-1] - plate[0]) / (far_half + 1.0 / (stack.plate_contact * stack.area) + plate_half)
    within = -np.diff(plate) / (2.0 * plate_half)
    # Radiation at the temperature of the outermost cell: in a thin plate that is nearly the surface's.
    outside = surface_coefficient(stack.plate_surface, plate[-1], stack.ambient) * stack.area
    outflow = (plate[-1] - stack.ambient) / (plate_half + 1.0 / outside)
    return Profile(
        cold=_kelvin(parts.cold),
        hot=hot,
        near=cells[0] + inflow * near_half,
        cells=cells,
        far=cells[-1] - across * far_half,
        plate_face=plate[0] + across * plate_half,
        plate=plate,
        beside=_kelvin(parts.beside),
        sink=_kelvin(parts.sink),
        fractions=fractions,
        through_layer=np.append(np.append(inflow, inside), across),
        through_plate=np.append(np.append(across, within), outflow),
    )


def _conductivities(stack: Stack) -> conduction.Conductivities:
    return conduction.Conductivities(stack.conductivity_solid, stack.conductivity_melt)


def _between_cells(stack: Stack, cells: Any, fractions: Any) -> Any:
    """Heat [W] between the polymer cells.

    On the equilibrium curve from the conduction potential; a layer with a history has none, as what is frozen does not
    follow from its temperature: there two half cells are in series, each as much as it is frozen.
    """
    depth = stack.thickness / len(cells)
    if stack.freezing is None:
        return stack.area * conduction.between(cells, _conductivities(stack), stack.melting, depth)
    half = 0.5 * depth / (_conductivities(stack).mixed(fractions) * stack.area)
    return -np.diff(cells) / (half[:-1] + half[1:])


def _wall_halves(stack: Stack, cells: Any, fractions: Any, hot: Any, plate: Any) -> tuple[Any, Any]:
    """Thermal resistance [K/W] of the halves of the outermost cells towards the pads and towards the plate."""
    both = _conductivities(stack)
    near, far = both.mixed(fractions[0]), both.mixed(fractions[-1])
    if stack.freezing is None:
        near = conduction.mean_conductivity(cells[0], near, hot, both, stack.melting)
        far = conduction.mean_conductivity(cells[-1], far, plate, both, stack.melting)
    half = 0.5 * stack.thickness / len(cells) / stack.area
    return half / near, half / far


def rates(state: Any, stack: Stack, current: Any) -> Any:
    """Time derivative of the state [1/s] at a current [A], positive where it heats the polymer."""
    now = profile(state, stack)
    hot_heat = peltier.hot_side_heat(stack.peltier, current, now.hot, now.cold)
    cold_heat = peltier.cold_side_heat(stack.peltier, current, now.hot, now.cold)
    from_cold, sink = _cold_end(now, stack)
    sides = np.append(
        -(cold_heat + from_cold) / stack.cold_capacity, (hot_heat - now.through_layer[0]) / stack.hot_capacity
    )
    layer = -np.diff(now.through_layer) / _cell_mass(stack, len(now.cells))
    sideways, beside = _beside(now, stack)
    plate = (-np.diff(now.through_plate) - sideways) / _plate_cell_capacity(stack)
    bodies = np.append(np.append(plate, beside), sink) / TEMPERATURE_SCALE
    heated = np.append(np.append(sides / TEMPERATURE_SCALE, layer / ENTHALPY_SCALE), bodies)
    if stack.freezing is None:
        return heated
    extended = _parts(state, stack).extended
    return np.append(heated, crystallization.rate(now.cells, extended, stack.freezing, stack.melting))


def _cell_mass(stack: Stack, count: int) -> Any:
    """Mass of one polymer cell [kg]."""
    return stack.density * stack.area * stack.thickness / count


def _plate_cell_capacity(stack: Stack) -> Any:
    """Heat capacity of one plate cell [J/K]."""
    return stack.plate_heat_capacity * stack.area * stack.plate_thickness / stack.plate_cells


def _cold_end(now: Profile, stack: Stack) -> tuple[Any, Any]:
    """Heat [W] that leaves the cold side, and the heating [K/s] of the sink it goes to, if there is one."""
    if stack.sink is None:
        return surface_heat(stack.cold_surface, now.cold, stack.ambient), now.sink
    flow = stack.sink.conductance * (now.cold - now.sink[0])
    rest = flow - surface_heat(stack.sink.surface, now.sink[0], stack.ambient)
    return flow, rest / stack.sink.capacity


def _beside(now: Profile, stack: Stack) -> tuple[Any, Any]:
    """Heat [W] each plate cell gives sideways, and the heating [K/s] of the lumps beside the plate."""
    if not stack.beside:
        return 0.0, now.beside
    sideways = stack.beside[0].conductance / stack.plate_cells * (now.plate - now.beside[0])
    inflow, heating = np.sum(sideways), now.beside[:0]
    for i, lump in enumerate(stack.beside):
        onward = 0.0
        if i + 1 < len(stack.beside):
            onward = stack.beside[i + 1].conductance * (now.beside[i] - now.beside[i + 1])
        lost = surface_heat(lump.surface, now.beside[i], stack.ambient)
        heating = np.append(heating, (inflow - onward - lost) / lump.capacity)
        inflow = onward
    return sideways, heating


def electrical_power(now: Profile, stack: Stack, current: Any) -> Any:
    """Power at the terminals [W], voltage times current; negative where the module generates."""
    return current * peltier.voltage(stack.peltier, current, now.hot, now.cold)


def stored_energy(state: Any, stack: Stack) -> Any:
    """Heat stored in the stack [J], zero with everything at 0 degC and the polymer frozen."""
    parts = _parts(state, stack)
    bodies = (*stack.beside, stack.sink) if stack.sink else stack.beside
    lumps = zip(bodies, [*parts.beside, *parts.sink], strict=True)
    heated = sum(lump.capacity * scaled for lump, scaled in lumps)
    heated += stack.cold_capacity * parts.cold + stack.hot_capacity * parts.hot
    heated += _plate_cell_capacity(stack) * np.sum(parts.plate)
    layer = _cell_mass(stack, len(parts.layer)) * np.sum(parts.layer)
    return TEMPERATURE_SCALE * heated + ENTHALPY_SCALE * layer
