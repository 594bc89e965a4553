"""Parts of the structure by their closed forms: shafts, rings, beams, vanes, warm and creeping plastics, bodies."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from tvimdesign.catalog import Catalog
from tvimdesign.physics.polymers import plastics, transitions
from tvimdesign.physics.solids import shapes, structure, vane

Values = Mapping[str, Any]
_SOFTENING = ("modulus_slope", "softening_temperature", "softening_width", "softened_share", "loss_factor",
              "softening_loss_factor")  # fmt: skip


def torsion(inputs: Values) -> Values:
    """Return a round bored shaft [N*m/rad], its torque at yield [N*m], and a flat ring turned in its plane."""
    shear = structure.shear_modulus(inputs["youngs_modulus"], inputs["poissons_ratio"])
    radius, length = inputs["radius"], inputs["length"]
    ring = inputs["ring"]
    return {
        "shear_modulus": shear,
        "shaft": structure.shaft_stiffness(shear, radius, length),
        "yield_torque": structure.shaft_torque(structure.shear_yield(inputs["tensile_yield"]), radius),
        "ring": structure.ring_stiffness(shear, ring["thickness"], ring["inner"], ring["outer"]),
    }


def foot(inputs: Values) -> Values:
    """Sideways stiffness [N/m] of a bored foot built in at both ends, over its height [m]."""
    youngs = inputs["youngs_modulus"]
    shear = structure.shear_modulus(youngs, inputs["poissons_ratio"])
    return {
        "stiffness": [
            structure.foot_stiffness(youngs, shear, inputs["radius"], inputs["bore"], height)
            for height in inputs["height"]
        ]
    }


def pressed_cantilever(inputs: Values) -> Values:
    """Force on the face over its mean deflection [N/m] of a vane on a rigid root, over the length free of the block."""
    youngs = inputs["youngs_modulus"]
    shear = structure.shear_modulus(youngs, inputs["poissons_ratio"])
    return {
        "stiffness": [
            vane.stiffness(youngs, shear, inputs["width"], inputs["thickness"], inputs["height"], free)
            for free in inputs["free"]
        ]
    }


def elastic_constants(inputs: Values) -> Values:
    """Confined modulus and flexural rigidity from Young's modulus and Poisson's ratio."""
    youngs, poisson = inputs["youngs_modulus"], inputs["poissons_ratio"]
    return {
        "shear_modulus": structure.shear_modulus(youngs, poisson),
        "confined_modulus": transitions.confined_modulus(youngs, poisson),
        "flexural_rigidity": transitions.flexural_rigidity(youngs, poisson, inputs["thickness"]),
    }


def warm_moduli(inputs: Values) -> Values:
    """Modulus [MPa] of materials at temperatures [degC], rows of material, temperature and modulus at 23 degC."""
    results = []
    for material, celsius, at_23 in inputs["rows"]:
        results.append(at_23 * float(plastics.modulus_share(celsius + 273.15, _law(material))))
    return {"modulus": results}


def modulus_over_that_at(inputs: Values) -> Values:
    """Modulus of a material over that at a reference temperature [degC], over the temperature."""
    law = _law(inputs["material"])
    share = plastics.modulus_share(np.array(inputs["celsius"], float) + 273.15, law)
    return {"share": share / plastics.modulus_share(inputs["reference"] + 273.15, law)}


def _law(material: str) -> plastics.Softening:
    record = Catalog().record("structure_materials", material)
    return plastics.Softening(*(record.value(name) for name in _SOFTENING))


def creep_moduli(inputs: Values) -> Values:
    """Creep modulus [MPa] of a material over hours at 23 degC, and how much an hour at a temperature ages it."""
    record = Catalog().record("structure_materials", inputs["material"])
    law = plastics.Creep(*(record.value(name) for name in ("creep_share", "creep_exponent", "creep_energy")))
    hours = np.array(inputs["hours"], float)
    return {"modulus": inputs["tensile_modulus"] / (1.0 + plastics.growth(3600.0 * hours, law))}


def ages(inputs: Values) -> Values:
    """Hours at 23 degC that age as one at a temperature [degC], of an activation energy [J/mol]."""
    law = plastics.Creep(0.1, 0.1, inputs["energy"])
    return {"hours": [plastics.aged(1.0, celsius + 273.15, law) for celsius in inputs["celsius"]]}


def flat_shapes(inputs: Values) -> Values:
    """Area [m^2] and polar moment [m^4] of sectors, discs, rectangles, slots, notches and strips about an axis."""
    results = {
        "sector": shapes.sector(*inputs["sector"]),
        "disc": shapes.disc_at(*inputs["disc"]),
        "rectangle": shapes.rectangle_at(*inputs["rectangle"]),
        "slot": shapes.slot(*inputs["slot"]),
        "notch": shapes.notch(*inputs["notch"]),
    }
    return {
        "area": [section.area for section in results.values()],
        "polar": [section.polar for section in results.values()],
        "lens": shapes.lens(*inputs["lens"]),
        "strip": shapes.radial_strip(*inputs["strip"]),
    }
