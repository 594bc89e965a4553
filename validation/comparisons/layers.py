"""The polymer between two faces: sheared layers, squeezed blocks, laps, gaps of melt, shrinkage."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from comparisons.numbers import si
from tvimdesign.catalog import Catalog
from tvimdesign.physics.layers import block, lasting_load, layer, shear_lag
from tvimdesign.physics.motions import motion
from tvimdesign.physics.polymers import melt, plastics, transitions
from tvimdesign.physics.solids import structure

Values = Mapping[str, Any]


def sheared_ring(inputs: Values) -> Values:
    """Stiffness [N*m/rad] of a sheared annular layer, and its torque [N*m] at a traction."""
    outer, inner, thickness = (si(inputs[name]) for name in ("outer_radius", "inner_radius", "thickness"))
    polar = 0.5 * np.pi * (outer**4 - inner**4)
    ((_, stiffness),) = motion.layer_modes([(1.0, si(inputs["shear_modulus"]))], polar, thickness)
    return {
        "stiffness": stiffness,
        "torque": layer.torque_at_traction(si(inputs["traction"]), polar, outer),
        "strain": layer.shear_strain(outer, inputs["angle"], thickness),
    }


def bonded_pads(inputs: Values) -> Values:
    """Force [N] that round pads of a frozen layer bear, as the layer of a lock: by its bond or its shear yield."""
    record = Catalog().record("polymers", inputs["polymer"])
    traction = min(record.value("bond_strength"), structure.shear_yield(record.value("tensile_yield")))
    return {"force": traction * inputs["count"] * 0.25 * np.pi * si(inputs["diameter"]) ** 2}


def layers_in_series(inputs: Values) -> Values:
    """Modulus of slices in series, and stiffness of a lossy layer behind a lossy support."""
    moduli = np.array(inputs["slices"], float)
    storage, loss = layer.series_modulus(moduli[:, 0], moduli[:, 1])
    joint = layer.series_stiffness(*inputs["layer"], *inputs["support"])
    return {"slices": [storage, loss], "joint": list(joint)}


def apparent_moduli(inputs: Values) -> Values:
    """Compression modulus of bonded blocks over Young's modulus, rows of width, height and depth."""
    poisson, results = inputs["poissons_ratio"], []
    shear, bulk = structure.shear_modulus(1.0, poisson), block.bulk_modulus(1.0, poisson)
    for width, height, depth in inputs["blocks"]:
        shape = block.shape_factor(width, height, depth)
        stiff = 3.0 * shear * block.shape_stiffening(shape)
        results.append(1.0 / (1.0 / stiff + 1.0 / block.volumetric_modulus(bulk, shape)))
    return {"modulus": results}


def rubber_blocks(inputs: Values) -> Values:
    """Compression modulus [Pa] of blocks of rubber over their shape factor."""
    youngs, bulk = si(inputs["youngs_modulus"]), si(inputs["bulk_modulus"])
    return {
        "modulus": [
            1.0 / (1.0 / (youngs * block.shape_stiffening(s)) + 1.0 / block.volumetric_modulus(bulk, s))
            for s in inputs["shape_factor"]
        ]
    }


def lap_edges(inputs: Values) -> Values:
    """Traction at the edge of a lap over its mean, and what a layer bears over a window, over the reach."""
    stiffness, width = inputs["layer"], inputs["width"]
    first, second = inputs["sheets"]
    scale = [reach**2 / (stiffness * (first + second) * width**2) for reach in inputs["reach"]]
    return {
        "edge": [shear_lag.edge_rise(stiffness * factor, first, second, width) for factor in scale],
        "window": [
            shear_lag.borne_over_window(stiffness, reach**2 / (stiffness * width**2), width)
            for reach in inputs["reach"]
        ],
    }


def melt_in_gaps(inputs: Values) -> Values:
    """Mean speed in a gap [m/s], time to squeeze a strip [s], height a wetting liquid rises between plates [m]."""
    gap, viscosity = si(inputs["gap"]), inputs["viscosity"]
    length, width, thin, thick = (si(inputs[name]) for name in ("length", "width", "thin", "thick"))
    held = melt.meniscus_pressure(inputs["surface_tension"], gap)
    return {
        "speed": melt.gap_speed(inputs["gradient"], gap, viscosity),
        "squeeze_time": melt.squeeze_time(inputs["force"], viscosity, length, width, thin, thick),
        "rise": held / (inputs["liquid_density"] * 9.80665),
    }


def held_link(inputs: Values) -> Values:
    """Angle [rad] of a link under a lasting torque over time, and the angle at which its polymer is free of stress."""
    modes = [tuple(map(float, mode)) for mode in inputs["modes"]]
    results = [
        lasting_load.held(inputs["torque"], float(time), inputs["springs"], inputs["structure"], modes)
        for time in inputs["time"]
    ]
    return {"angle": [each.angle for each in results], "set_angle": [each.set_angle for each in results]}


def plates_on_a_layer(inputs: Values) -> Values:
    """Traction [Pa] where a layer that shrinks begins, over the span to the hub [m]."""
    return {
        "traction": [
            transitions.edge_traction(
                inputs["shortened"], inputs["foundation"], inputs["rigidity"], inputs["shear"], span
            )
            for span in inputs["span"]
        ]
    }


def gives_of_pegs(inputs: Values) -> Values:
    """Way per force of pegs [m/N] and turn per moment of holes [rad/(N*m)] in one plastic."""
    modulus, poisson = inputs["modulus"], inputs["poissons_ratio"]
    shear = structure.shear_modulus(modulus, poisson)
    return {
        "pins": [plastics.peg_give(modulus, poisson, pin["diameter"], pin["height"]) for pin in inputs["pins"]],
        "holes": [plastics.twisted_hole_give(shear, hole["diameter"], hole["length"]) for hole in inputs["holes"]],
    }
