"""A module's springs a second time, plainly: plane geometry by vectors, energy, numerical slopes.

numpy and nothing else: it shares no code with the package and reads plain numbers (SI) by name. A right-hand spring
stands at C = (r, 0), its coil runs counterclockwise into its leg, and the rotor's pin P is beyond the leg: the leg's
centre line is tangent to the coil's centre line (radius D/2), so the line through the pin's centre that is parallel to
it is tangent to the circle around C of the radius e = D/2 + d/2 + pin/2. Left-hand springs are the mirror image.
Springs: Shigley, 10th ed., 10-12; Castigliano's theorem, summed up along the wire.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Numbers = Mapping[str, Any]
FloatArray = NDArray[np.float64]
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
    """Return how far a right-hand spring winds up from rest [rad]: its leg turns on counterclockwise.

    By the paper's ratio of one it winds as far as the rotor turns.
    """
    if module.get("transmission") == "unity":
        return angle
    turned = leg(module, angle)[0] - leg(module, 0.0)[0]
    return float((turned + np.pi) % (2.0 * np.pi) - np.pi)


_ROOTS, _WEIGHTS = np.polynomial.legendre.leggauss(240)
NODES, WEIGHTS = 0.5 * (_ROOTS + 1.0), 0.5 * _WEIGHTS
"""Gauss-Legendre on 0 to 1: exact to rounding on any piece of wire, as a coil's moment is a few dozen waves at most."""
BEND_ACROSS = 1.1  # calibrated, validation/fe_spring
DOWN, ACROSS = np.array([0.0, 0.0, -1.0]), np.array([0.0, 1.0, 0.0])


DRAWN = ("coil_pitch", "coil_end_level", "rotor_top_level", "tang_length", "pin_foot_diameter", "adjuster_radius")
"""Lengths of the drawn module that are read beside its inputs."""


class Wire(NamedTuple):
    """A spring's wire in its own axes, its coil around z, with the pin that pushes on the leg's end along `ACROSS`."""

    radius: float
    wound: float
    climb: float
    """Descent of the coil per radian, back from the leg [m]."""
    bend: float
    """Radius of the wire's centre in the bend down to the tang [m]."""
    pin: FloatArray

    def coil(self, shares: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Moment of a unit force [m] and direction of the wire at shares of the coil, the slope left out."""
        back = self.wound * shares
        points = [-self.radius * np.sin(back), self.radius * np.cos(back), -self.climb * back]
        moments = np.cross(self.pin - np.stack(points, axis=1), ACROSS)
        return moments, np.stack([-np.cos(back), -np.sin(back), 0.0 * back], axis=1)

    def bent(self, shares: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the same at shares of the quarter bend, from the coil's end down."""
        (last,), (begin,) = self.coil(np.array([1.0]))
        turn = 0.5 * np.pi * shares[:, None]
        way = self.bend * (np.sin(turn) * begin + (1.0 - np.cos(turn)) * DOWN)
        return last - np.cross(way, ACROSS), np.cos(turn) * begin + np.sin(turn) * DOWN


def bend_radius(module: Numbers) -> float:
    """Radius of the wire's centre in the bend down to the tang [m]."""
    return float((module["tang_bend_ratio"] + 0.5) * module["wire_diameter"])


def tang_lever(module: Numbers) -> float:
    """Distance of the free spring's tang from its axis [m]."""
    return float(np.hypot(0.5 * module["coil_diameter"], bend_radius(module)))


def wire_of(module: Numbers) -> Wire:
    """Return the wire wound up by its preload, which narrows the coil; the straight leg rises on as the coil does."""
    free = 2.0 * np.pi * module["coil_count"]
    wound = free + module["preload_angle"]
    radius = 0.5 * module["coil_diameter"] * free / wound
    arm, climb = leg(module, 0.0)[1], module["coil_pitch"] / (2.0 * np.pi)
    return Wire(radius, wound, climb, bend_radius(module), np.array([arm, radius, climb * arm / radius]))


def wire_length(module: Numbers) -> float:
    """Straight wire [m] that bends as far under the force's moment about the coil: Castigliano, summed up.

    At every point the moment is split into torsion and bending. The leg counts as level; the bend is a quarter circle
    from the coil's end down, level at first.
    """
    wire, poisson = wire_of(module), module["spring_poissons_ratio"]
    arm = wire.pin[0]
    moments, along = wire.coil(NODES)
    on_leg = np.stack([0.0 * NODES, 0.0 * NODES, arm * NODES], axis=1)
    work = (
        arm * _work(on_leg, np.array([[1.0, 0.0, 0.0]]), poisson)
        + wire.radius * wire.wound * _work(moments, along, poisson)
        + 0.5 * np.pi * wire.bend * _work(*wire.bent(NODES), poisson)
    )
    return float(work / arm**2)


def _work(moments: FloatArray, along: FloatArray, poisson: float) -> float:
    """Mean of bending^2 + (1 + nu) torsion^2 [m^2] over a piece of wire: round wire twists (1 + nu) times as far."""
    torsion = np.sum(moments * along, axis=1)
    bending = np.sum(moments**2, axis=1) - torsion**2
    return float(np.sum(WEIGHTS * (bending + (1.0 + poisson) * torsion**2)))


def stress_factors(module: Numbers) -> tuple[float, float]:
    """Largest stress in the coil, and in the bend, over that of the moment about the axis in a straight wire [1].

    In the coil the largest moment about the axis and the largest that tilts count as if at one place.
    """
    index = module["coil_diameter"] / module["wire_diameter"]
    if module["leg_model"] == "ignored":
        return inner_fibre(index), inner_fibre(index)
    wire = wire_of(module)
    moments, along = wire.coil(np.linspace(0.0, 1.0, 4001))
    highest = np.hypot(moments[:, 2].max(), np.hypot(moments[:, 0], moments[:, 1]).max())
    sharp, normal = inner_fibre(2.0 * module["tang_bend_ratio"] + 1.0), np.cross(along[-1], DOWN)
    ends = []
    for moment, way in zip(*wire.bent(np.array([0.0, 1.0])), strict=True):
        in_plane, across, torsion = (moment @ axis for axis in (normal, np.cross(normal, way), way))
        twisted = 0.5 * BEND_ACROSS * torsion  # a torque's shear stress is half of what it would be as bending
        ends.append(np.sqrt((sharp * in_plane) ** 2 + (BEND_ACROSS * across) ** 2 + 3.0 * twisted**2))
    worst = np.linalg.norm(ends, 12)
    return inner_fibre(index) * highest / wire.pin[0], float(worst) / wire.pin[0]


def inner_fibre(index: float) -> float:
    """Rise of the stress at the inner fibre of a bent wire, Shigley."""
    return (4.0 * index**2 - index - 1.0) / (4.0 * index * (index - 1.0))


def rate(module: Numbers) -> float:
    """Rate of one spring [N*m/rad], E I over the wire's length: that of the coils, or with leg and bend as drawn."""
    length = np.pi * module["coil_diameter"] * module["coil_count"]
    if module["leg_model"] == "bending":
        length = wire_length(module)
    return float(module["spring_youngs_modulus"] * np.pi * module["wire_diameter"] ** 4 / (64.0 * length))


def held_rate(module: Numbers) -> float:
    """Torque of a spring per winding [N*m/rad] of the spring, its pin and its tang's hole, one behind the other.

    The pin, or the boss of a dowel pin, is a Timoshenko beam on a foot that rocks as a rigid disc on a half-space; the
    hole is twisted in a plate without end. `leg_model: ignored` holds the spring rigidly.
    """
    if module["leg_model"] == "ignored":
        return rate(module)
    modulus, poisson = module["structure_youngs_modulus"], module["structure_poissons_ratio"]
    shear, pin, arm = modulus / 2.0 / (1.0 + poisson), 0.5 * module["pin_foot_diameter"], leg(module, 0.0)[1]
    climb = module["coil_pitch"] / (np.pi * module["coil_diameter"])
    above = max(module["coil_end_level"] + climb * arm - module["rotor_top_level"], 0.5 * module["wire_diameter"])
    beam = above**3 / (3.0 * modulus * np.pi / 4.0 * pin**4) + above / (0.9 * shear * np.pi * pin**2)
    foot = above**2 * 3.0 * (1.0 - poisson**2) / (4.0 * modulus * pin**3)
    on_tang = (arm + tang_lever(module)) / arm
    hole = on_tang**2 / (4.0 * np.pi * shear * (0.5 * module["wire_diameter"]) ** 2 * module["tang_length"])
    return 1.0 / (1.0 / rate(module) + (beam + foot) / arm**2 + hole)


def energy(module: Numbers, angle: float) -> float:
    """Elastic energy of all springs and what holds them [J] with the rotor turned."""
    wound = [module["preload_angle"] + winding(module, sense * angle) for sense in (1.0, -1.0)]
    return float(module["spring_pairs"] * 0.5 * held_rate(module) * sum(angle**2 for angle in wound))


def torque(module: Numbers, angle: float) -> float:
    """Torque that holds the rotor there [N*m], the slope of the energy."""
    e = [energy(module, angle + i * STEP) for i in (-2, -1, 1, 2)]
    return (e[0] - 8.0 * e[1] + 8.0 * e[2] - e[3]) / (12.0 * STEP)


def stiffness(module: Numbers, angle: float) -> float:
    """Slope of torque over angle [N*m/rad], the second derivative of the energy."""
    e = [energy(module, angle + i * STEP) for i in (-2, -1, 0, 1, 2)]
    return (-e[0] + 16.0 * e[1] - 30.0 * e[2] + 16.0 * e[3] - e[4]) / (12.0 * STEP**2)


def statics(module: Numbers) -> dict[str, float]:
    """Return what the springs do over the stroke and bear, by the names of the product's outputs.

    Windings are the extremes from stop to stop, stresses those at the inner fibre; fatigue is that of the stroke.
    `yield_strength`, `tensile_strength` [Pa] and `fatigue_ratio` are the wire's.
    """
    wire, stroke = module["wire_diameter"], module["stroke"]
    over = np.linspace(-stroke, stroke, 2 * ANGLES - 1)
    wound = module["preload_angle"] + np.array([winding(module, angle) for angle in over])
    stop = stroke + module["stop_margin"]
    stopped = module["preload_angle"] + np.array([winding(module, angle) for angle in (-stop, stop)])
    stiff = np.array([stiffness(module, angle) for angle in over[ANGLES - 1 :]])
    per_angle = max(stress_factors(module)) * 32.0 * held_rate(module) / (np.pi * wire**3)
    highest, lowest = per_angle * wound.max(), per_angle * max(wound.min(), 0.0)
    strength = module["tensile_strength"]
    fatigue = module["fatigue_ratio"] * strength
    endurance = 0.5 * fatigue / (1.0 - (0.5 * fatigue / strength) ** 2)  # Gerber, from S_r at R = 0
    mean, amplitude = 0.5 * (highest + lowest), 0.5 * (highest - lowest)
    # (n a / S_e) + (n m / S_ut)^2 = 1 for the safety n.
    a, b = (mean / strength) ** 2, amplitude / endurance
    reach = tang_lever(module) + 0.5 * wire
    wider = max(reach + module["radial_clearance"], module["adjuster_radius"] + module["slip_clearance"])
    return {
        "spring_rate": rate(module),
        "held_spring_rate": held_rate(module),
        "spring_stiffness": stiff[0],
        "spring_stiffness_full_stroke": stiff[-1],
        "least_spring_stiffness": stiff.min(),
        "most_spring_stiffness": stiff.max(),
        "stiffness_over_stroke": stiff[-1] / stiff[0],
        "spring_torque_full_stroke": torque(module, stroke),
        "preload_margin": float(stopped.min()),
        "spring_winding": float(stopped.max()),
        "spring_unwinding": float(module["preload_angle"] - stopped.min()),
        "spring_stress": per_angle * stopped.max(),
        "spring_static_safety": module["yield_strength"] / (per_angle * stopped.max()),
        "spring_fatigue_safety": float((-b + np.sqrt(b**2 + 4.0 * a)) / (2.0 * a)),
        "envelope_diameter": 2.0 * (module["placement_radius"] + wider + module["wall_thickness"]),
    }


def broken(module: Numbers, limits: Mapping[tuple[str, str], float]) -> list[str]:
    """Of limits by output and sense (SI) those that do not hold; on the stiffness, at any angle of the stroke."""
    values = statics(module)
    lost = []
    for (name, sense), limit in limits.items():
        ends = {"spring_stiffness": ("least_spring_stiffness", "most_spring_stiffness")}.get(name, (name, name))
        value = values[ends[0] if sense == ">=" else ends[1]]
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
    "spring_rate", "held_spring_rate", "spring_stiffness", "spring_stiffness_full_stroke", "spring_torque_full_stroke",
    "preload_margin", "spring_winding", "spring_unwinding", "spring_stress", "spring_static_safety",
    "spring_fatigue_safety", "envelope_diameter",
)  # fmt: skip
"""The product's outputs that stand in `statics`, but those that follow from two others."""


def with_strength(module: Numbers, springs: Numbers) -> dict[str, Any]:
    """Return a module's numbers with its wire's strength, A / d^m for music wire, which checks the product's."""
    strength = 2211e6 / (1e3 * module["wire_diameter"]) ** 0.145  # ASTM A228, Shigley, table 10-4
    assert abs(springs["spring_tensile_strength"] / strength - 1.0) < 1e-9, "not music wire"
    return {**module, "tensile_strength": strength, "yield_strength": 0.78 * strength, "fatigue_ratio": 0.5}
