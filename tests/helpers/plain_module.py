"""A module's springs a second time, plainly: plane geometry by vectors, energy, numerical slopes.

numpy and nothing else: it shares no code with the package and reads plain numbers (SI) by name. A right-hand spring
stands at C = (r, 0), its coil runs counterclockwise into its leg, and the rotor's pin P is beyond the leg: the leg's
centre line is tangent to the coil's centre line (radius D/2), so the line through the pin's centre that is parallel to
it is tangent to the circle around C of the radius e = D/2 + d/2 + pin/2. Left-hand springs are the mirror image.
Springs: Shigley, 10th ed., 10-12.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

Numbers = Mapping[str, Any]
STEP = 2e-3  # rad, of the numerical derivatives; five points, so the error is of the order of its fourth power
NUMERICAL = 5e-4
"""Share of a limit by which it may be missed: between the angles that the product looks at, and by rounding."""
ANGLES = 41
"""Angles over the stroke at which the stiffness is looked at."""


def leg(module: Numbers, angle: float) -> tuple[float, float]:
    """Direction of a right-hand spring's leg [rad] and its length from the coil to the pin [m] at a rotor angle."""
    centre = np.array([module["placement_radius"], 0.0])
    radius = module["pin_radius_ratio"] * module["placement_radius"]
    pin = radius * np.array([np.cos(angle), np.sin(angle)])
    offset = 0.5 * (module["coil_diameter"] + module["wire_diameter"] + module["pin_diameter"])
    to_pin = pin - centre
    distance = np.hypot(*to_pin)
    # The radius to the tangent point stands to the right of the leg, which is perpendicular to it.
    towards = np.arctan2(to_pin[1], to_pin[0]) - np.arccos(offset / distance)
    tangent = centre + offset * np.array([np.cos(towards), np.sin(towards)])
    along = pin - tangent
    return float(np.arctan2(along[1], along[0]) % (2.0 * np.pi)), float(np.hypot(*along))


def winding(module: Numbers, angle: float) -> float:
    """How far a right-hand spring winds up from rest [rad]: its leg turns on counterclockwise.

    By the paper's ratio of one it winds as far as the rotor turns.
    """
    if module.get("transmission") == "unity":
        return angle
    turned = leg(module, angle)[0] - leg(module, 0.0)[0]
    return float((turned + np.pi) % (2.0 * np.pi) - np.pi)


def rate(module: Numbers) -> float:
    """Rate of one spring [N*m/rad], E d^4 / (64 D n_a) with n_a = n + leg / (3 pi D) where the rotor-side leg bends."""
    coils = module["coil_count"]
    if module["leg_model"] == "bending":
        coils += leg(module, 0.0)[1] / (3.0 * np.pi * module["coil_diameter"])
    wire = module["wire_diameter"]
    return float(module["spring_youngs_modulus"] * wire**4 / (64.0 * module["coil_diameter"] * coils))


def energy(module: Numbers, angle: float) -> float:
    """Elastic energy of all springs [J] with the rotor turned."""
    wound = [module["preload_angle"] + winding(module, sense * angle) for sense in (1.0, -1.0)]
    return float(module["spring_pairs"] * 0.5 * rate(module) * sum(angle**2 for angle in wound))


def torque(module: Numbers, angle: float) -> float:
    """Torque that holds the rotor there [N*m], the slope of the energy."""
    e = [energy(module, angle + i * STEP) for i in (-2, -1, 1, 2)]
    return (e[0] - 8.0 * e[1] + 8.0 * e[2] - e[3]) / (12.0 * STEP)


def stiffness(module: Numbers, angle: float) -> float:
    """Slope of torque over angle [N*m/rad], the second derivative of the energy."""
    e = [energy(module, angle + i * STEP) for i in (-2, -1, 0, 1, 2)]
    return (-e[0] + 16.0 * e[1] - 30.0 * e[2] + 16.0 * e[3] - e[4]) / (12.0 * STEP**2)


def statics(module: Numbers) -> dict[str, float]:
    """What the springs do over the stroke and bear, by the names of the product's outputs.

    Windings are the extremes over the stroke, stresses those at the inner fibre at full winding. `yield_strength`,
    `tensile_strength` [Pa] and `fatigue_ratio` are the wire's.
    """
    wire, coil, stroke = module["wire_diameter"], module["coil_diameter"], module["stroke"]
    over = np.linspace(-stroke, stroke, 2 * ANGLES - 1)
    wound = module["preload_angle"] + np.array([winding(module, angle) for angle in over])
    stiff = np.array([stiffness(module, angle) for angle in over[ANGLES - 1 :]])
    c = coil / wire
    factor = (4.0 * c**2 - c - 1.0) / (4.0 * c * (c - 1.0))
    per_angle = factor * 32.0 * rate(module) / (np.pi * wire**3)
    highest, lowest = per_angle * wound.max(), per_angle * max(wound.min(), 0.0)
    strength = module["tensile_strength"]
    fatigue = module["fatigue_ratio"] * strength
    endurance = 0.5 * fatigue / (1.0 - (0.5 * fatigue / strength) ** 2)  # Gerber, from S_r at R = 0
    mean, amplitude = 0.5 * (highest + lowest), 0.5 * (highest - lowest)
    # (n a / S_e) + (n m / S_ut)^2 = 1 for the safety n.
    a, b = (mean / strength) ** 2, amplitude / endurance
    reach = np.hypot(0.5 * coil, wire) + 0.5 * wire
    return {
        "spring_rate": rate(module),
        "spring_stiffness": stiff[0],
        "spring_stiffness_full_stroke": stiff[-1],
        "least_spring_stiffness": stiff.min(),
        "most_spring_stiffness": stiff.max(),
        "stiffness_over_stroke": stiff[-1] / stiff[0],
        "spring_torque_full_stroke": torque(module, stroke),
        "preload_margin": float(wound.min()),
        "spring_winding": float(wound.max()),
        "spring_stress": highest,
        "spring_static_safety": module["yield_strength"] / highest,
        "spring_fatigue_safety": float((-b + np.sqrt(b**2 + 4.0 * a)) / (2.0 * a)),
        "envelope_diameter": 2.0
        * (module["placement_radius"] + reach + module["radial_clearance"] + module["wall_thickness"]),
    }  # fmt: skip


def broken(module: Numbers, limits: Mapping[tuple[str, str], float]) -> list[str]:
    """Of limits by output and sense (SI) those that do not hold; on the stiffness, at any angle of the stroke."""
    found = statics(module)
    lost = []
    for (name, sense), limit in limits.items():
        ends = {"spring_stiffness": ("least_spring_stiffness", "most_spring_stiffness")}.get(name, (name, name))
        value = found[ends[0] if sense == ">=" else ends[1]]
        slack = NUMERICAL * max(abs(limit), 1e-2)
        if not (value >= limit - slack if sense == ">=" else value <= limit + slack):
            lost.append(f"{name} is {value:.6g}, asked {sense} {limit:.6g}")
    return lost


def layer_strain(module: Numbers) -> float:
    """Largest strain of a sheared layer at full stroke [1]: the way of its outer edge over its thickness."""
    return float(module["pcl_outer_radius"] * module["stroke"] / module["pcl_thickness"])


def block_strain(module: Numbers) -> float:
    """Largest strain of a squeezed block at full stroke [1]: the vane's way at the mean radius over the depth."""
    mean = 0.5 * (module["pcl_inner_radius"] + module["pcl_outer_radius"])
    return float(mean * module["stroke"] / module["block_depth"])


COMPARED = (
    "spring_rate", "spring_stiffness", "spring_stiffness_full_stroke", "spring_torque_full_stroke", "preload_margin",
    "spring_winding", "spring_stress", "spring_static_safety", "spring_fatigue_safety", "envelope_diameter",
)  # fmt: skip
"""The product's outputs that stand in `statics`, but those that follow from two others."""


def with_strength(module: Numbers, found: Numbers) -> dict[str, Any]:
    """A module's numbers with its wire's strength, A / d^m for music wire, by which the product's is held too."""
    strength = 2211e6 / (1e3 * module["wire_diameter"]) ** 0.145  # ASTM A228, Shigley, table 10-4
    assert abs(found["spring_tensile_strength"] / strength - 1.0) < 1e-9, "not music wire"
    return {**module, "tensile_strength": strength, "yield_strength": 0.78 * strength, "fatigue_ratio": 0.5}
