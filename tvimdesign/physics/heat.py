"""Transient heat through the stack: air | Peltier cold side | Peltier hot side | polymer, melting | plate | air.

One dimension through the stack, finite volumes; what the plate is part of takes up heat sideways, as a chain of lumps.
The polymer's states are enthalpies, not temperatures with an apparent heat capacity, so the latent heat is never
stepped over (Voller and Prakash, Int. J. Heat Mass Transfer 30 (1987) 1709). Faces between cells carry the two
half-cell resistances in series (Patankar, Numerical Heat Transfer and Fluid Flow, 1980, sec. 4.2).

A state is a list of scalars: cold side, hot side, polymer cells from the hot side on, plate cells, and the lumps beside
the plate. Temperatures stand in it as (T - 273.15 K)/100 K and enthalpies as H/(1e5 J/kg), so that all are of the order
of one.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from tvimdesign.physics import peltier, polymer
from tvimdesign.physics.polymer import ZERO_CELSIUS

TEMPERATURE_SCALE = 100.0  # K
ENTHALPY_SCALE = 1e5  # J/kg
FIRST_CELL = 2  # the cold side and the hot side come first


class Lump(NamedTuple):
    """A body beside the plate, at one temperature."""

    conductance: Any
    """To the plate, or to the lump before it in the chain [W/K]."""
    capacity: Any
    """[J/K]"""
    loss: Any
    """To ambient [W/K]."""


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
    peltier: peltier.Module
    current: Any
    cold_capacity: Any
    """Heat capacity of the cold side with what is fixed to it [J/K]."""
    hot_capacity: Any
    cold_conductance: Any
    """Cold side to ambient [W/K]."""
    hot_contact: Any
    """Contact conductance of hot side and polymer [W/m^2 K]."""
    plate_contact: Any
    plate_thickness: Any
    plate_conductivity: Any
    plate_heat_capacity: Any
    """Per volume [J/m^3 K]."""
    plate_coefficient: Any
    """Convection and radiation from the plate's outer face [W/m^2 K]."""
    ambient: Any
    """[K]"""
    plate_cells: int
    beside: tuple[Lump, ...] = ()
    """What the plate belongs to: the first takes heat from all the plate's cells, each next from the one before."""


class Profile(NamedTuple):
    """Temperatures [K] through the stack at one instant, and the solid fraction of each polymer cell."""

    cold: Any
    hot: Any
    near: Any
    """Polymer's face towards the Peltier element."""
    cells: list[Any]
    far: Any
    """Polymer's face towards the plate."""
    plate_face: Any
    """Plate's face towards the polymer."""
    plate: list[Any]
    beside: list[Any]
    """Lumps beside the plate."""
    fractions: list[Any]
    flows: list[Any]
    """Heat [W] into the first polymer cell, between the cells, into the plate, within it, and out to the air."""


def initial_state(stack: Stack, cells: int, temperature: Any) -> list[Any]:
    """State of a stack that is everywhere at one temperature [K]."""
    scaled = (temperature - ZERO_CELSIUS) / TEMPERATURE_SCALE
    enthalpy = polymer.enthalpy(temperature, stack.melting) / ENTHALPY_SCALE
    return [scaled, scaled, *[enthalpy] * cells, *[scaled] * (stack.plate_cells + len(stack.beside))]


def _first_plate_cell(state: Sequence[Any], stack: Stack) -> int:
    return len(state) - stack.plate_cells - len(stack.beside)


def _kelvin(scaled: Any) -> Any:
    return ZERO_CELSIUS + TEMPERATURE_SCALE * scaled


def profile(state: Sequence[Any], stack: Stack) -> Profile:
    """Temperatures, solid fractions and heat flows that a state stands for."""
    last = _first_plate_cell(state, stack)
    enthalpies = [ENTHALPY_SCALE * state[i] for i in range(FIRST_CELL, last)]
    cells = [polymer.temperature(h, stack.melting) for h in enthalpies]
    fractions = [polymer.solid_fraction(h, stack.melting) for h in enthalpies]
    plate = [_kelvin(state[i]) for i in range(last, last + stack.plate_cells)]
    hot = _kelvin(state[1])
    layer_half = [_half_cell(stack, fraction, len(cells)) for fraction in fractions]
    plate_half = 0.5 * stack.plate_thickness / stack.plate_cells / (stack.plate_conductivity * stack.area)

    inflow = (hot - cells[0]) / (1.0 / (stack.hot_contact * stack.area) + layer_half[0])
    inside = [(cells[i] - cells[i + 1]) / (layer_half[i] + layer_half[i + 1]) for i in range(len(cells) - 1)]
    across = (cells[-1] - plate[0]) / (layer_half[-1] + 1.0 / (stack.plate_contact * stack.area) + plate_half)
    within = [(plate[i] - plate[i + 1]) / (2.0 * plate_half) for i in range(len(plate) - 1)]
    outflow = (plate[-1] - stack.ambient) / (plate_half + 1.0 / (stack.plate_coefficient * stack.area))
    return Profile(
        cold=_kelvin(state[0]),
        hot=hot,
        near=cells[0] + inflow * layer_half[0],
        cells=cells,
        far=cells[-1] - across * layer_half[-1],
        plate_face=plate[0] + across * plate_half,
        plate=plate,
        beside=[_kelvin(state[i]) for i in range(last + stack.plate_cells, len(state))],
        fractions=fractions,
        flows=[inflow, *inside, across, *within, outflow],
    )


def _half_cell(stack: Stack, fraction: Any, count: int) -> Any:
    """Thermal resistance of half a polymer cell [K/W]."""
    conductivity = stack.conductivity_melt + fraction * (stack.conductivity_solid - stack.conductivity_melt)
    return 0.5 * stack.thickness / count / (conductivity * stack.area)


def rates(state: Sequence[Any], stack: Stack) -> list[Any]:
    """Time derivative of the state [1/s]."""
    now = profile(state, stack)
    count = len(now.cells)
    hot_heat = peltier.hot_side_heat(stack.peltier, stack.current, now.hot, now.cold)
    cold_heat = peltier.cold_side_heat(stack.peltier, stack.current, now.hot, now.cold)
    cold = (stack.cold_conductance * (stack.ambient - now.cold) - cold_heat) / stack.cold_capacity
    hot = (hot_heat - now.flows[0]) / stack.hot_capacity
    cell_mass = stack.density * stack.area * stack.thickness / count
    cell_capacity = stack.plate_heat_capacity * stack.area * stack.plate_thickness / stack.plate_cells
    layer = [(now.flows[i] - now.flows[i + 1]) / (cell_mass * ENTHALPY_SCALE) for i in range(count)]
    sideways, beside = _beside(now, stack)
    plate = [
        (now.flows[count + i] - now.flows[count + i + 1] - sideways[i]) / (cell_capacity * TEMPERATURE_SCALE)
        for i in range(stack.plate_cells)
    ]
    return [cold / TEMPERATURE_SCALE, hot / TEMPERATURE_SCALE, *layer, *plate, *beside]


def _beside(now: Profile, stack: Stack) -> tuple[list[Any], list[Any]]:
    """Heat [W] each plate cell gives sideways, and the rates of the lumps beside the plate."""
    if not stack.beside:
        return [0.0] * stack.plate_cells, []
    share = stack.beside[0].conductance / stack.plate_cells
    sideways = [share * (temperature - now.beside[0]) for temperature in now.plate]
    flows = [sum(sideways)]
    flows += [stack.beside[i].conductance * (now.beside[i - 1] - now.beside[i]) for i in range(1, len(stack.beside))]
    flows.append(0.0)
    rates_beside = [
        (flows[i] - flows[i + 1] - lump.loss * (now.beside[i] - stack.ambient)) / (lump.capacity * TEMPERATURE_SCALE)
        for i, lump in enumerate(stack.beside)
    ]
    return sideways, rates_beside


def electrical_power(now: Profile, stack: Stack) -> Any:
    """Power the supply gives [W]: terminal voltage times current."""
    return stack.current * peltier.voltage(stack.peltier, stack.current, now.hot, now.cold)


def stored_energy(state: Sequence[Any], stack: Stack) -> Any:
    """Heat stored in the stack [J], zero with everything at 0 degC and the polymer frozen."""
    last = _first_plate_cell(state, stack)
    cell_mass = stack.density * stack.area * stack.thickness / (last - FIRST_CELL)
    cell_capacity = stack.plate_heat_capacity * stack.area * stack.plate_thickness / stack.plate_cells
    ends = TEMPERATURE_SCALE * (stack.cold_capacity * state[0] + stack.hot_capacity * state[1])
    layer = cell_mass * ENTHALPY_SCALE * sum(state[i] for i in range(FIRST_CELL, last))
    end = last + stack.plate_cells
    plate = cell_capacity * TEMPERATURE_SCALE * sum(state[i] for i in range(last, end))
    beside = TEMPERATURE_SCALE * sum(lump.capacity * state[end + i] for i, lump in enumerate(stack.beside))
    return ends + layer + plate + beside
