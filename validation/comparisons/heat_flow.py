"""The heat equation of the stack in cases that have closed solutions, at the cells a study has or those said."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from comparisons.bare_stack import COLD, FIXED, bare_stack, integrate
from comparisons.numbers import Array, si
from tvimdesign.physics.heat_flow import heat, held_plate, lumps, peltier, shape_factors
from tvimdesign.physics.polymers import polymer

Values = Mapping[str, Any]
LAYER, CONDUCTIVITY, CAPACITY = 1e-3, 0.2, 1145.0 * 1900.0
FOURIER_TIME = LAYER**2 * CAPACITY / CONDUCTIVITY  # s in which the Fourier number of the bare layer grows by one
FLUX = 2000.0  # W/m^2: at 2 A half of I^2 R goes to the hot side of the bare stack


def _fourier(inputs: Values) -> list[float]:
    return [number * FOURIER_TIME for number in inputs["fourier"]]


def slab_under_flux(inputs: Values) -> Values:
    """Rise k theta/(q L) of front and back over the Fourier number."""
    stack = bare_stack()
    seen = integrate(stack, heat.initial_state(stack, inputs["cells"], COLD), _fourier(inputs), current=2.0).profiles()
    scale = FLUX * LAYER / CONDUCTIVITY
    return {"front": [(p.near - COLD) / scale for p in seen], "back": [(p.far - COLD) / scale for p in seen]}


def stepped_slab(inputs: Values) -> Values:
    """Share of the step that is left at the insulated face; the mid-plane of a slab twice as thick."""
    stack = bare_stack(hot_capacity=FIXED)
    begin = heat.initial_state(stack, inputs["cells"], COLD)
    begin[1] += 0.5
    return {"left": [1.0 - (p.far - COLD) / 50.0 for p in integrate(stack, begin, _fourier(inputs)).profiles()]}


def slab_in_a_stream(inputs: Values) -> Values:
    """Share of the difference that is left at the insulated face and at the one behind a film of a Biot number."""
    stack = bare_stack(hot_capacity=FIXED, hot_contact=inputs["biot"] * CONDUCTIVITY / LAYER)
    begin = heat.initial_state(stack, inputs["cells"], COLD)
    begin[1] += 0.5
    seen = integrate(stack, begin, _fourier(inputs)).profiles()
    return {
        "insulated": [1.0 - (p.far - COLD) / 50.0 for p in seen],
        "wetted": [1.0 - (p.near - COLD) / 50.0 for p in seen],
    }


def deep_layer_under_flux(inputs: Values) -> Values:
    """Rise of the surface of a layer that is deep for the heat [K] over time."""
    stack = bare_stack(thickness=8e-3)
    begin = heat.initial_state(stack, inputs["cells"], COLD)
    seen = integrate(stack, begin, inputs["time"], current=2.0).profiles()
    return {"surface": [p.near - COLD for p in seen]}


def order_of_the_cells(inputs: Values) -> Values:
    """Power by which the error of front and back under flux falls with the size of the cells."""
    exact = inputs["exact"]
    errors = []
    for cells in inputs["cells"]:
        results = slab_under_flux({"cells": cells, "fourier": [inputs["fourier"]]})
        errors.append([abs(results["front"][0] - exact[0]), abs(results["back"][0] - exact[1])])
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    return {"front": orders[:, 0], "back": orders[:, 1]}


def touching_bodies(inputs: Values) -> Values:
    """Temperature [degC] at which a layer and a plate of another temperature meet, over time."""
    metal = inputs["plate"]
    stack = bare_stack(
        thickness=2e-3, conductivity_solid=inputs["layer_conductivity"], conductivity_melt=inputs["layer_conductivity"],
        hot_contact=1e-12, plate_contact=1e12, plate_thickness=60e-3, plate_conductivity=metal["conductivity"],
        plate_heat_capacity=metal["density"] * metal["specific_heat"], plate_cells=200,
    )  # fmt: skip
    begin = heat.initial_state(stack, inputs["cells"], COLD)
    begin[-200:] = 1.0
    return {"face": [p.far - 273.15 for p in integrate(stack, begin, inputs["time"], tolerance=1e-7).profiles()]}


def wall_at_rest(inputs: Values) -> Values:
    """Drops of temperature [K] from the heater to the air, half a plate's cell at its ends, under a steady flux."""
    stack = bare_stack(
        hot_contact=inputs["hot_contact"], plate_contact=inputs["plate_contact"], plate_conductivity=0.8,
        plate_thickness=3e-3, plate_cells=3, plate_surface=lumps.Surface(1e-3, inputs["film"]),
    )  # fmt: skip
    p = integrate(stack, heat.initial_state(stack, 5, COLD), [8000.0], current=2.0).profiles()[-1]
    return {"drop": -np.diff([p.hot, p.near, p.far, p.plate_face, *p.plate, COLD])}


def energy_of_a_switch(inputs: Values) -> Values:
    """Heat stored by the layer and heat that came into it, over the second, of a layer that melts and loses heat."""
    melting = polymer.Melting(1850.0, 2100.0, 76.75e3, 323.15, 338.15, 500.0)
    stack = bare_stack(
        melting=melting, conductivity_melt=0.18, plate_contact=500.0, plate_surface=lumps.Surface(1e-3, 10.0, 0.9)
    )
    begin = heat.initial_state(stack, inputs["cells"], COLD)
    times = np.linspace(0.0, inputs["seconds"], 4001)
    history = integrate(stack, begin, list(times), tolerance=1e-10, current=2.0)
    lost = [p.through_plate[-1] for p in history.profiles()]
    away = FLUX * stack.area * times[-1]
    stored = [heat.stored_energy(history.states[:, i], stack) for i in (0, -1)]
    # The other half of I^2 R goes to the cold side, whose capacity stores it.
    return {"balance": (stored[1] - stored[0] + np.trapezoid(lost, times)) / (2.0 * away)}


def parallel_plates(inputs: Values) -> Values:
    """Heat [W] between grey plates by radiation alone, and a surface's loss by convection and radiation."""
    area, hot, cold = inputs["area"], inputs["hot"], inputs["cold"]
    gap = lumps.air_gap(area, 1.0, 0.0, inputs["emissivity"], ("hot", 0), ("plate", 0))
    surface = lumps.Surface(area, inputs["film"], inputs["emissivity"])
    return {"radiation": lumps.link_heat(gap, hot, cold), "loss": lumps.surface_heat(surface, hot, cold)}


def spread_plate(inputs: Values) -> Values:
    """Resistance [m^2 K/W] that a plate beside its modules adds, over the width beside them [m]."""
    fed, thickness, k = inputs["fed"], inputs["thickness"], inputs["conductivity"]
    return {
        "resistance": [
            peltier.spreading_resistance(fed + beside, fed, 1.0, k, thickness) + thickness / k
            for beside in inputs["beside"]
        ]
    }


def plate_behind_polymer(inputs: Values) -> Values:
    """Steady temperatures [K] in a plate behind a polymer that is kept warm, with a body beside it."""
    side = lumps.Lump(inputs["sideways"], 1.0, lumps.Surface(inputs["side_area"], inputs["side_film"]))
    behind = held_plate.BehindPolymer(
        area=inputs["area"], plate_thickness=inputs["thickness"], plate_conductivity=inputs["conductivity"],
        plate_surface=lumps.Surface(inputs["area"], inputs["film"]), ambient=COLD, beside=(side,),
    )  # fmt: skip
    results = held_plate.held_plate(behind, inputs["polymer"])
    return {"plate": results.plate, "beside": results.beside}


def _layer_state(stack: heat.Stack, cells: int, far: float, face: float) -> Array:
    """Return a layer at one temperature [K] whose heated face has another from the start."""
    begin = heat.initial_state(stack, cells, far)
    begin[1] = (face - 273.15) / heat.TEMPERATURE_SCALE
    return begin


_MELTING_POINT, _SPECIFIC_HEAT = 330.0, 2000.0


def phase_front(inputs: Values) -> Values:
    """Depth of a melting or freezing front over 2 sqrt(a t) of the phase that grows, over cases of phases and faces.

    Rows of conductivity of solid and melt, far and face temperature [K]; the mean while it goes through a millimetre.
    """
    latent, cells = si(inputs["latent_heat"]), inputs["cells"]
    melting = polymer.Melting(_SPECIFIC_HEAT, _SPECIFIC_HEAT, latent, _MELTING_POINT, _MELTING_POINT + 0.02, 5.0)
    results = []
    for (solid, melt, far, face), speed in zip(inputs["cases"], inputs["about"], strict=True):
        melts = face > _MELTING_POINT
        deep = 1e-3 if abs(far - _MELTING_POINT) < 0.1 else 4e-3
        stack = bare_stack(
            hot_capacity=FIXED, melting=melting, conductivity_solid=solid, conductivity_melt=melt, thickness=deep
        )
        begin = _layer_state(stack, round(cells * deep / 1e-3), far, face)
        scale = 4.0 * (melt if melts else solid) / (1145.0 * _SPECIFIC_HEAT)
        times = np.linspace(0.3e-3, 0.9e-3, 121) ** 2 / (scale * speed**2)
        seen = integrate(stack, begin, list(times), tolerance=1e-7).profiles()
        frozen = np.array([float(np.mean(p.fractions)) for p in seen])
        grown = deep * (1.0 - frozen if melts else frozen)
        results.append(float(np.mean(grown / np.sqrt(scale * times))))
    return {"front": results}


def layer_that_heats_itself(inputs: Values) -> Values:
    """Rise [K] of the insulated face of a layer its own current heats, the other face kept, over the Fourier number."""
    stack = bare_stack(hot_capacity=FIXED, layer_resistance=inputs["resistance"])
    begin = heat.initial_state(stack, inputs["cells"], COLD)
    history = integrate(stack, begin, _fourier(inputs), current=inputs["current"])
    power = heat.electrical_power(history.profiles()[-1], stack, inputs["current"])
    return {"insulated": [p.far - COLD for p in history.profiles()], "power": power}


def layer_over_a_comb(inputs: Values) -> Values:
    """Resistance [ohm] of a layer between the fingers of a comb, over rows of gap and width in depths."""
    depth, area, r = 1e-3, 1e-3, inputs["resistivity"]
    return {
        "resistance": [shape_factors.comb_resistance(r, depth, area, g * depth, w * depth) for g, w in inputs["combs"]]
    }
