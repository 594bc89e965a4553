"""Transient heat through the stack: air or sink | Peltier cold side | hot side | polymer | plate | air.

One dimension through the stack, finite volumes. What the plate is part of takes up heat sideways, as a chain of lumps;
so does what the pads are set in, from the edges of pads and layer. Gaps of air join the two chains (`lumps`).
The polymer's states are enthalpies, not temperatures with an apparent heat capacity, so the latent heat is never
stepped over (Voller and Prakash, Int. J. Heat Mass Transfer 30 (1987) 1709). Between polymer cells flows the difference
of their conduction potentials (`conduction`); other faces carry the two half-cell resistances in series (Patankar,
Numerical Heat Transfer and Fluid Flow, 1980, sec. 4.2).

What is frozen follows the equilibrium melting curve, which is right for melting; with `Stack.freezing` each cell
carries its own history instead, and freezes late and supercooled.

A state is a one-dimensional array: cold side, hot side, polymer cells from the hot side on, plate cells, the lumps
beside the plate, the sink if there is one, the lumps around the pads, the middle of the pads' legs where these have a
heat capacity, spreader and liner if there are any, and with kinetics one extended fraction for each polymer cell.
Temperatures stand in it as (T - 273.15 K)/100 K and enthalpies as H/(1e5 J/kg), so that all are of the order of one.
"""

import itertools
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.heat_flow import conduction, lumps, peltier
from tvimdesign.physics.heat_flow.layer_end import warm_lip
from tvimdesign.physics.heat_flow.stack import LINER_CELLS, Profile, Stack, liner_flows, liner_heating
from tvimdesign.physics.polymers import polymer, transitions
from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS

__all__ = [
    "Profile", "Stack", "electrical_power", "initial_state", "profile", "rates", "stored_energy", "voltage",
    "with_history",
]  # fmt: skip

TEMPERATURE_SCALE = 100.0  # K
ENTHALPY_SCALE = 1e5  # J/kg


class _Parts(NamedTuple):
    """A state taken apart; scaled as it stands there."""

    cold: Any
    hot: Any
    layer: Any
    plate: Any
    beside: Any
    sink: Any
    around: Any
    legs: Any
    spreader: Any
    liner: Any
    extended: Any


def _lengths(stack: Stack) -> tuple[int, ...]:
    """Return the counts of entries after the polymer's, in the order of a state."""
    bodies = (len(stack.beside), int(stack.sink is not None), len(stack.around))
    thin = int(stack.legs_capacity is not None), int(stack.spreader is not None)
    return stack.plate_cells, *bodies, *thin, LINER_CELLS * int(stack.liner is not None)


def _parts(state: Any, stack: Stack) -> _Parts:
    cells = len(state) - 2 - sum(_lengths(stack))
    cells = cells // 2 if stack.freezing else cells
    ends = list(itertools.accumulate((2, cells, *_lengths(stack))))
    bodies = (state[a:b] for a, b in itertools.pairwise(ends))
    return _Parts._make((state[0], state[1], *bodies, state[ends[-1] :]))


def initial_state(stack: Stack, cells: int, temperature: Any) -> Any:
    """Return the state of a stack that is everywhere at one temperature [K], on the equilibrium melting curve."""
    scaled = (temperature - ZERO_CELSIUS) / TEMPERATURE_SCALE
    enthalpy = polymer.enthalpy(temperature, stack.melting) / ENTHALPY_SCALE
    layer = np.append(scaled * np.ones(2), enthalpy * np.ones(cells))
    state = np.append(layer, scaled * np.ones(sum(_lengths(stack))))
    return with_history(state, stack) if stack.freezing else state


def with_history(state: Any, stack: Stack) -> Any:
    """Return a state of the equilibrium curve, as the stack with freezing kinetics goes on from it; no heat is lost."""
    assert stack.freezing is not None
    layer = _parts(state, stack._replace(freezing=None)).layer
    fractions = polymer.solid_fraction(ENTHALPY_SCALE * layer, stack.melting)
    return np.append(state, transitions.extended(fractions, stack.freezing))


def _kelvin(scaled: Any) -> Any:
    return ZERO_CELSIUS + TEMPERATURE_SCALE * scaled


def _layer(parts: _Parts, stack: Stack) -> tuple[Any, Any]:
    """Return the temperature [K] and solid fraction of each polymer cell."""
    enthalpies = ENTHALPY_SCALE * parts.layer
    if stack.freezing is None:
        return polymer.temperature(enthalpies, stack.melting), polymer.solid_fraction(enthalpies, stack.melting)
    fractions = transitions.solid_fraction(parts.extended, stack.freezing)
    return transitions.temperature(enthalpies, fractions, stack.melting), fractions


def profile(state: Any, stack: Stack) -> Profile:
    """Return the temperatures, solid fractions and heat flows that a state stands for."""
    parts = _parts(state, stack)
    cells, fractions = _layer(parts, stack)
    plate = _kelvin(parts.plate)
    hot = _kelvin(parts.hot)
    spreader = hot if stack.spreader is None else _kelvin(parts.spreader[0])
    sheet = _kelvin(parts.liner)
    near_half, far_half = _wall_halves(stack, cells, fractions, spreader, plate[0] if stack.liner is None else sheet[0])
    plate_half = 0.5 * stack.plate_thickness / stack.plate_cells / (stack.plate_conductivity * stack.area)

    inflow = (spreader - cells[0]) / (1.0 / (stack.hot_contact * stack.area) + near_half)
    inside = _between_cells(stack, cells, fractions)
    to_face = far_half + 1.0 / (stack.plate_contact * stack.area)
    if stack.liner is None:
        across = onward = (cells[-1] - plate[0]) / (to_face + plate_half)
        through = sheet
    else:
        through = liner_flows(stack.liner, (cells[-1], plate[0]), (to_face, plate_half), sheet)
        across, onward = through[0], through[-1]
    within = -np.diff(plate) / (2.0 * plate_half)
    # Radiation at the temperature of the outermost cell: in a thin plate that is nearly the surface's.
    outside = lumps.surface_coefficient(stack.plate_surface, plate[-1], stack.ambient) * stack.area
    outflow = outside * (plate[-1] - stack.ambient) / (1.0 + outside * plate_half)
    now = Profile(
        cold=_kelvin(parts.cold),
        hot=hot,
        spreader=spreader,
        near=cells[0] + inflow * near_half,
        cells=cells,
        far=cells[-1] - across * far_half,
        plate_face=plate[0] + onward * plate_half,
        plate=plate,
        beside=_kelvin(parts.beside),
        sink=_kelvin(parts.sink),
        around=_kelvin(parts.around),
        legs=_kelvin(parts.legs),
        liner=sheet,
        through_liner=through,
        fractions=fractions,
        through_layer=np.append(np.append(inflow, inside), across),
        through_plate=np.append(np.append(onward, within), outflow),
    )
    if stack.lip is None:
        return now
    conducting = partial(_over_mean, stack, now)
    return now._replace(lip=warm_lip(stack.lip, cells, now.at, conducting, stack.lip_temperatures))


def _over_mean(stack: Stack, now: Profile, wall: Any) -> tuple[Any, Any]:
    """Return the conductivity of the polymer between each cell and a temperature, and between the pads and it, over the
    mean of both phases [1]; with a history that of what is there."""
    both, mean = _conductivities(stack), 0.5 * (stack.conductivity_solid + stack.conductivity_melt)
    cells, pads = both.mixed(now.fractions), both.mixed(now.fractions[0])
    if stack.freezing is None:
        cells = conduction.mean_conductivity(now.cells, cells, wall, both, stack.melting)
        pads = conduction.mean_conductivity(now.spreader, pads, wall, both, stack.melting)
    return cells / mean, pads / mean


def _conductivities(stack: Stack) -> conduction.Conductivities:
    return conduction.Conductivities(stack.conductivity_solid, stack.conductivity_melt)


def _between_cells(stack: Stack, cells: Any, fractions: Any) -> Any:
    """Return the heat [W] between the polymer cells.

    On the equilibrium curve from the conduction potential; a layer with a history has none, as what is frozen does not
    follow from its temperature: there two half cells are in series, each as much as it is frozen.
    """
    depth = stack.thickness / len(cells)
    if stack.freezing is None:
        return stack.area * conduction.between(cells, _conductivities(stack), stack.melting, depth)
    half = 0.5 * depth / (_conductivities(stack).mixed(fractions) * stack.area)
    return -np.diff(cells) / (half[:-1] + half[1:])


def _wall_halves(stack: Stack, cells: Any, fractions: Any, hot: Any, plate: Any) -> tuple[Any, Any]:
    """Return the thermal resistance [K/W] of the halves of the outermost cells towards the pads and towards the
    plate."""
    both = _conductivities(stack)
    near, far = both.mixed(fractions[0]), both.mixed(fractions[-1])
    if stack.freezing is None:
        near = conduction.mean_conductivity(cells[0], near, hot, both, stack.melting)
        far = conduction.mean_conductivity(cells[-1], far, plate, both, stack.melting)
    half = 0.5 * stack.thickness / len(cells) / stack.area
    return half / near, half / far


def rates(state: Any, stack: Stack, current: Any) -> Any:
    """Return the time derivative of the state [1/s] at a current [A], positive where it heats the polymer."""
    now = profile(state, stack)
    from_cold, sink = _cold_end(now, stack)
    linked = _linked(now, stack, current)
    cold, hot, legs = _pads(now, stack, current, linked)
    of_legs = 0.0 if stack.legs_capacity is None else peltier.OF_SIDE * stack.legs_capacity
    cold_side, hot_side = stack.cold_capacity + of_legs, stack.hot_capacity + of_legs
    onward, spreader = _from_pads(now, stack, linked)
    sides = np.append((cold - from_cold) / cold_side, (hot - onward) / hot_side)
    made = stack.motion_heat + current**2 * stack.layer_resistance / len(now.cells)
    layer = made - np.diff(now.through_layer) + linked["layer"][0]
    sideways = _sideways(now, stack)
    plate = (linked["plate"][0] - np.diff(now.through_plate) - sideways) / _plate_cell_capacity(stack)
    beside, around = _bodies(now, stack, np.sum(sideways), linked)
    sheet = now.liner if stack.liner is None else liner_heating(stack.liner, now.through_liner, linked["liner"][0])
    thin = np.append(np.append(legs, spreader), sheet)
    bodies = np.append(np.append(np.append(np.append(plate, beside), sink), around), thin)
    bodies = bodies / TEMPERATURE_SCALE
    heated = np.append(sides / TEMPERATURE_SCALE, layer / _cell_mass(stack, len(now.cells)) / ENTHALPY_SCALE)
    heated = np.append(heated, bodies)
    if stack.freezing is None:
        return heated
    extended = _parts(state, stack).extended
    return np.append(heated, transitions.rate(now.cells, extended, stack.freezing, stack.melting))


def _pads(now: Profile, stack: Stack, current: Any, linked: Mapping[str, Sequence[Any]]) -> tuple[Any, Any, Any]:
    """Return the heat [W] that comes to the pads' cold and hot side, what they give onwards aside, and heating [K/s] of
    the legs' middle, where they have one.

    What comes to the legs by links is even over their length, or over a half of it.
    """
    pads, of_legs = stack.peltier, linked.get("legs", [0.0, 0.0, 0.0])
    along, tilt = of_legs[0] + of_legs[1] + of_legs[2], peltier.OF_HALF * (of_legs[1] - of_legs[2])
    if stack.legs_capacity is None:
        cold = linked["cold"][0] - peltier.cold_side_heat(pads, current, now.hot, now.cold)
        hot = linked["hot"][0] + peltier.hot_side_heat(pads, current, now.hot, now.cold)
        return cold + 0.5 * along - tilt, hot + 0.5 * along + tilt, now.legs
    legs = peltier.legs_heat(pads, current, now.hot, now.legs[0], now.cold)
    carried, of_side = pads.seebeck * current, peltier.OF_SIDE * along
    cold = linked["cold"][0] + legs.cold - carried * now.cold + of_side - tilt
    hot = linked["hot"][0] + legs.hot + carried * now.hot + of_side + tilt
    return cold, hot, (legs.middle / peltier.OF_MIDDLE + along) / stack.legs_capacity


def _from_pads(now: Profile, stack: Stack, linked: Mapping[str, Sequence[Any]]) -> tuple[Any, Any]:
    """Return the heat [W] from the pads' hot side to what lies on it, and the heating [K/s] of a spreader there."""
    if stack.spreader is None:
        return now.through_layer[0] - linked["spreader"][0], now.liner[:0]
    flow = stack.spreader.conductance * (now.hot - now.spreader)
    return flow, (flow - now.through_layer[0] + linked["spreader"][0]) / stack.spreader.capacity


def _cell_mass(stack: Stack, count: int) -> Any:
    """Return the mass of one polymer cell [kg]."""
    return stack.density * stack.area * stack.thickness / count


def _plate_cell_capacity(stack: Stack) -> Any:
    """Return the heat capacity of one plate cell [J/K]."""
    return stack.plate_heat_capacity * stack.area * stack.plate_thickness / stack.plate_cells


def _cold_end(now: Profile, stack: Stack) -> tuple[Any, Any]:
    """Return the heat [W] that leaves the cold side, and the heating [K/s] of the sink it goes to, if there is one."""
    if stack.sink is None:
        return lumps.surface_heat(stack.cold_surface, now.cold, stack.ambient), now.sink
    flow = stack.sink.conductance * (now.cold - now.sink[0])
    stored = flow - lumps.surface_heat(stack.sink.surface, now.sink[0], stack.ambient)
    return flow, stored / stack.sink.capacity


def _linked(now: Profile, stack: Stack, current: Any) -> dict[str, list[Any]]:
    """Return the heat [W] that links bring to each place of the column and each body; to each cell of layer and
    plate."""
    places = {
        "ambient": [stack.ambient],
        "spreader": [now.spreader],
        "cold": [now.cold],
        "hot": [now.hot],
        "beside": now.beside,
        "around": now.around,
    }
    if any("legs" in (link.first[0], link.second[0]) for link in stack.links):
        settled = stack.legs_capacity is None
        middle = peltier.settled_middle(stack.peltier, current, now.hot, now.cold) if settled else now.legs[0]
        places["legs"] = list(peltier.legs_temperatures(now.hot, middle, now.cold))
    divided = {"layer": now.cells, "plate": now.plate} | ({} if stack.liner is None else {"liner": now.liner})
    linked = lumps.linked(stack.links, places, divided)
    if now.lip is not None:
        _take(linked, now)
    return linked


def _take(linked: dict[str, list[Any]], now: Profile) -> None:
    """Take what a lip takes from the heat that places get."""
    assert now.lip is not None
    linked["layer"][0] = linked["layer"][0] - now.lip.from_layer
    for (group, i), heat in now.lip.from_places.items():
        if group in ("face", "plate"):
            shares = lumps.of_first(len(now.plate)) if group == "face" else 1.0 / len(now.plate)
            linked["plate"][0] = linked["plate"][0] - heat * shares
        else:
            linked[group][i] = linked[group][i] - heat


def _sideways(now: Profile, stack: Stack) -> Any:
    """Return the heat [W] each plate cell gives to the first lump beside the plate."""
    if not stack.beside:
        return 0.0
    sideways = stack.beside[0].conductance
    if stack.uneven_conductance is None:
        return sideways / stack.plate_cells * (now.plate - now.beside[0])
    mean = np.mean(now.plate)
    even = sideways * (mean - now.beside[0])
    return (even + stack.uneven_conductance * (now.plate - mean)) / stack.plate_cells


def _bodies(now: Profile, stack: Stack, to_beside: Any, linked: Mapping[str, Sequence[Any]]) -> tuple[Any, Any]:
    """Return the heating [K/s] of the bodies beside the plate and around the pads, from what the plate and links bring
    [W]."""
    chain = lumps.chain_heat(stack.beside, now.beside, to_beside, stack.ambient)
    upper = [own + more for own, more in zip(chain, linked["beside"], strict=True)]
    lower = [
        more - lumps.surface_heat(body.surface, now.around[i], stack.ambient)
        for i, (body, more) in enumerate(zip(stack.around, linked["around"], strict=True))
    ]
    empty = now.around[:0]
    return lumps.heating(stack.beside, upper, empty), lumps.heating(stack.around, lower, empty)


def electrical_power(now: Profile, stack: Stack, current: Any) -> Any:
    """Return the power at the terminals [W], voltage times current; negative where the module generates."""
    return current * voltage(now, stack, current)


def voltage(now: Profile, stack: Stack, current: Any) -> Any:
    """Return the voltage over the pads and, where the current passes it, the polymer [V]."""
    return peltier.voltage(stack.peltier, current, now.hot, now.cold) + current * stack.layer_resistance


def stored_energy(state: Any, stack: Stack) -> Any:
    """Return the heat stored in the stack [J], zero with everything at 0 degC and the polymer frozen."""
    parts = _parts(state, stack)
    bodies = (*stack.beside, *((stack.sink,) if stack.sink else ()), *stack.around)
    temperatures = [*parts.beside, *parts.sink, *parts.around]
    heated = sum(lump.capacity * scaled for lump, scaled in zip(bodies, temperatures, strict=True))
    heated += stack.cold_capacity * parts.cold + stack.hot_capacity * parts.hot
    if stack.legs_capacity is not None:
        heated += stack.legs_capacity * peltier.legs_temperature(parts.hot, parts.legs[0], parts.cold)
    heated += _plate_cell_capacity(stack) * np.sum(parts.plate)
    if stack.spreader is not None:
        heated += stack.spreader.capacity * parts.spreader[0]
    if stack.liner is not None:
        heated += stack.liner.capacity * np.mean(parts.liner)
    layer = _cell_mass(stack, len(parts.layer)) * np.sum(parts.layer)
    return TEMPERATURE_SCALE * heated + ENTHALPY_SCALE * layer
