"""Torsion and wave springs: rate, stress, strength, tolerances, and the springs of the paper's module."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from comparisons.numbers import array, si
from tvimdesign.catalog import Catalog
from tvimdesign.physics import spring

Values = Mapping[str, Any]
TURN = 2.0 * np.pi


def rate_per_turn(inputs: Values) -> Values:
    """Torque for a turn [N*m] of one spring by a rate model, and its active coils."""
    coil, legs = si(inputs["coil_diameter"]), si(inputs.get("leg_length", 0.0))
    coils = spring.active_coils(inputs["coils"], coil, legs)
    rate = spring.rate(si(inputs["youngs_modulus"]), si(inputs["wire_diameter"]), coil, coils, inputs["model"])
    return {"rate_per_turn": rate * TURN, "rate": rate, "active_coils": coils}


def handbook_example(inputs: Values) -> Values:
    """Return all figures of a worked example: active coils, rate, curvature, wound coil, torque at strength."""
    wire, coil, body = si(inputs["wire_diameter"]), si(inputs["coil_diameter"]), inputs["coils"]
    modulus, turned = si(inputs["youngs_modulus"]), si(inputs["wound"])
    results = dict(rate_per_turn(inputs))
    factor = spring.inner_fibre_factor(spring.spring_index(wire, coil))
    body_rate = spring.rate(modulus, wire, coil, body, inputs["model"])
    results["inner_fibre_factor"] = factor
    results["wound_coil_diameter"] = spring.loaded_coil_diameter(coil, body, turned)
    results["stress"] = spring.bending_stress(turned * body_rate, wire, factor)
    return results


def catalogue_torque(inputs: Values) -> Values:
    """Torque [N*m] at a deflection of springs of a maker's table, rows of wire, outer diameter, coils; SMI's rate.

    The modulus is the wire's by its diameter, of the record `wire`.
    """
    steps = Catalog().record("spring_materials", inputs["wire"]).table("youngs_modulus_steps")
    results = []
    for diameter, outer, coils in inputs["springs"]:
        wire = si(f"{diameter} {inputs['length_unit']}")
        coil = si(f"{outer} {inputs['length_unit']}") - wire
        modulus = next(
            row["youngs_modulus"] for row in steps if row["wire_diameter_from"] <= wire < row["wire_diameter_to"]
        )
        results.append(spring.rate(modulus, wire, coil, coils, "smi") * si(inputs["deflection"]))
    return {"torque": results}


def stress_factors(inputs: Values) -> Values:
    """Stress factors at the inner fibre over the spring index."""
    index = array(inputs["index"])
    return {"smi": spring.inner_fibre_factor(index), "en": spring.inner_fibre_factor_en(index)}


def wire_strength(inputs: Values) -> Values:
    """Tensile strength [Pa] of wires of the catalogue, rows of record and diameter."""
    results = []
    for record, diameter in inputs["wires"]:
        rows = Catalog().record("spring_materials", record).table("strength")
        results.append(spring.tensile_strength(si(diameter), [(row["coefficient"], row["exponent"]) for row in rows]))
    return {"tensile_strength": results}


def din_tolerances(inputs: Values) -> Values:
    """Tolerances of coil diameter [m] and free angle [rad] by DIN 2194 over the grades' factors."""
    wire, coil = si(inputs["wire_diameter"]), si(inputs["coil_diameter"])
    return {
        "coil_diameter": [spring.diameter_tolerance(wire, coil, factor) for factor in inputs["grade_factor"]],
        "free_angle": [
            spring.free_angle_tolerance(inputs["coils"], coil / wire, factor) for factor in inputs["grade_factor"]
        ],
    }


def endurance(inputs: Values) -> Values:
    """Endurance limit [Pa] and safety of a spring between two stresses, by Gerber."""
    tensile, ratio = si(inputs["tensile_strength"]), inputs["strength_ratio"]
    limit = spring.endurance_strength(tensile, ratio)
    safety = [spring.gerber_safety(si(a), si(m), limit, tensile) for a, m in inputs["stresses"]]
    return {"endurance_limit": limit, "safety": safety}


def wave(inputs: Values) -> Values:
    """Rate [N/m] and stress [Pa] of a wave spring, and the deflection factor."""
    size = [si(inputs[name]) for name in ("inner_diameter", "outer_diameter", "thickness")]
    rate = spring.wave_spring_rate(si(inputs["youngs_modulus"]), *size, inputs["waves"])
    return {
        "rate": rate,
        "stress": spring.wave_spring_stress(si(inputs["force"]), *size, inputs["waves"]),
        "factor": spring.WAVE_FACTOR,
    }


def output_stiffness(inputs: Values) -> Values:
    """Stiffness about the rotor [N*m/rad] of springs on pins over the angle from rest; by the drawn geometry."""
    rate = spring.rate(*(si(inputs[name]) for name in ("youngs_modulus", "wire_diameter", "coil_diameter")),
                       inputs["coils"])  # fmt: skip
    place, preload = si(inputs["placement_radius"]), si(inputs["preload"])
    pin = 0.5 * place
    offset = 0.5 * sum(si(inputs[name]) for name in ("coil_diameter", "wire_diameter", "pin_diameter"))
    unity = spring.output_stiffness(inputs["springs"], rate, 0.0, 1.0, 0.0)
    pairs = inputs["springs"] // 2
    drawn = [pairs * rate * spring.pair_turned(si(angle), preload, pin, place, offset)[1] for angle in inputs["angle"]]
    return {"by_the_papers_ratio": unity, "as_drawn": drawn}


def leg_on_its_pin(inputs: Values) -> Values:
    """Return a leg's angle [rad] over the rotor's angle, and its derivatives."""
    pin, place, offset = (si(inputs[name]) for name in ("pin_radius", "placement_radius", "offset"))
    angle = array(inputs["angle"])
    return {
        "turned": spring.leg_turned(pin, place, angle, offset),
        "ratio": spring.leg_ratio(pin, place, angle, offset),
        "curvature": spring.leg_curvature(pin, place, angle, offset),
    }
