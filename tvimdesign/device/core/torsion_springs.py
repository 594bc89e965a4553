"""The torsion springs in the module: their rate, what they are to the output, and what they bear.

Kinematics are those of a right-hand spring, which winds up when the rotor turns in its negative sense; the other hand
is its mirror image."""

import numpy as np

from tvimdesign.device.table import Feature, Module, QuantityGroup, Scalar, at_least, at_most
from tvimdesign.physics import spring
from tvimdesign.physics.solids import structure
from tvimdesign.physics.spring import leg_curvature, leg_ratio, leg_turned, output_stiffness, pair_turned

quantities = QuantityGroup("Springs", sprung=True)

quantities.choices("torsion_springs")
_AS_DRAWN = Feature("transmission", "unity")
_OVER_STROKE = (
    "spring_stiffness", "spring_stiffness_half_stroke", "spring_stiffness_seven_tenths_stroke",
    "spring_stiffness_six_sevenths_stroke", "spring_stiffness_full_stroke",
)  # fmt: skip
"""Between two of these it goes beyond both by less than 0.05 % of itself (a test holds that)."""
STROKE_SHARES = (0.5, 0.7, 6.0 / 7.0, 1.0)
"""Angles over the stroke, nearly even in their squares: in those the stiffness is nearly linear."""


@quantities.output("N*m/rad", headline=True)
def spring_rate(m: Module) -> Scalar:
    """Rate of one torsion spring, k_torsion."""
    return spring.rate(m.spring_youngs_modulus, m.wire_diameter, m.coil_diameter, m.active_coils, m.rate_model)


@quantities.output("1", at_least(4.0, "cold coiling, EN 13906-3", exists_above=1.2),
             at_most(20.0, "cold coiling, EN 13906-3"))  # fmt: skip
def spring_index(m: Module) -> Scalar:
    """Coil diameter over wire diameter, C."""
    return spring.spring_index(m.wire_diameter, m.coil_diameter)


@quantities.output("1")
def transmission_ratio(m: Module) -> Scalar:
    """Winding of a spring per angle of the rotor at rest."""
    if m.transmission == "unity":
        return 1.0
    # The leg turns against the rotor: the spring winds when the rotor turns the other way.
    return -leg_ratio(m.pin_radius, m.placement_radius, 0.0, m.leg_offset)


@quantities.output("1/rad")
def transmission_curvature(m: Module) -> Scalar:
    """Change of that ratio with the winding direction of the rotor, at rest."""
    if m.transmission == "unity":
        return 0.0
    return leg_curvature(m.pin_radius, m.placement_radius, 0.0, m.leg_offset)


@quantities.output("N*m/rad", headline=True, also_limited=_OVER_STROKE[1:], parts_differ_with=_AS_DRAWN)
def spring_stiffness(m: Module) -> Scalar:
    """Stiffness of the springs alone about the axis at rest, K_s; a limit on it holds over the whole stroke."""
    return output_stiffness(
        m.spring_count, m.held_spring_rate, m.preload_angle, m.transmission_ratio, m.transmission_curvature
    )


Wound = tuple[Scalar, Scalar]  # Torque and tangent stiffness of one spring of either hand, over the rate: [rad] and [1]


@quantities.helper()
def over_stroke(m: Module) -> list[Wound]:
    """A pair of springs at `STROKE_SHARES`."""
    angles = [share * m.stroke for share in STROKE_SHARES]
    if m.transmission == "unity":
        return [(2.0 * angle, 2.0) for angle in angles]
    return [pair_turned(angle, m.preload_angle, m.pin_radius, m.placement_radius, m.leg_offset) for angle in angles]


@quantities.output("N*m", at_least(0.0, "the springs push the soft joint away: less preload_angle, or a longer leg"))
def spring_torque_full_stroke(m: Module) -> Scalar:
    """Torque of all springs about the axis at full stroke."""
    return m.spring_pairs * m.held_spring_rate * m.over_stroke[3][0]


@quantities.output("N*m/rad")
def spring_stiffness_half_stroke(m: Module) -> Scalar:
    """Stiffness of all springs about the axis at half the stroke, the slope of torque over angle."""
    return m.spring_pairs * m.held_spring_rate * m.over_stroke[0][1]


@quantities.output("N*m/rad")
def spring_stiffness_seven_tenths_stroke(m: Module) -> Scalar:
    """Stiffness of all springs about the axis at seven tenths of the stroke, the slope of torque over angle."""
    return m.spring_pairs * m.held_spring_rate * m.over_stroke[1][1]


@quantities.output("N*m/rad")
def spring_stiffness_six_sevenths_stroke(m: Module) -> Scalar:
    """Stiffness of all springs about the axis at six sevenths of the stroke, the slope of torque over angle."""
    return m.spring_pairs * m.held_spring_rate * m.over_stroke[2][1]


@quantities.output("N*m/rad")
def spring_stiffness_full_stroke(m: Module) -> Scalar:
    """Stiffness of all springs about the axis at full stroke, the slope of torque over angle."""
    return m.spring_pairs * m.held_spring_rate * m.over_stroke[3][1]


@quantities.output("N*m/rad", headline=True, least_of=_OVER_STROKE, parts_differ_with=_AS_DRAWN)
def least_spring_stiffness(m: Module) -> Scalar:
    """Least stiffness of the springs alone about the axis over the stroke."""
    inside = np.fmin(m.spring_stiffness_half_stroke, m.spring_stiffness_seven_tenths_stroke)
    inside = np.fmin(inside, m.spring_stiffness_six_sevenths_stroke)
    return np.fmin(np.fmin(m.spring_stiffness, inside), m.spring_stiffness_full_stroke)


_BENT = "the springs' stiffness changes by more than a tenth over the stroke"


@quantities.output("1", advice=(at_least(0.9, _BENT), at_most(1.1, _BENT)), headline=True)
def stiffness_over_stroke(m: Module) -> Scalar:
    """Stiffness of the springs alone at full stroke over that at rest."""
    return m.spring_stiffness_full_stroke / m.spring_stiffness


@quantities.helper()
def windings(m: Module) -> list[Scalar]:
    """Winding of a spring from rest [rad] with the rotor at a stop, at the end of the stroke, and at those opposite."""
    angles = [m.stop_angle, m.stroke, -m.stroke, -m.stop_angle]
    if m.transmission == "unity":
        return angles
    return [leg_turned(m.pin_radius, m.placement_radius, -angle, m.leg_offset) for angle in angles]


@quantities.helper()
def stroke_windings(m: Module) -> tuple[Scalar, Scalar]:
    """Largest and least winding of a spring over the stroke [rad]; one that lifts off has none."""
    return m.preload_angle + m.windings[1], np.fmax(m.preload_angle + m.windings[2] - m.spring_play, 0.0)


@quantities.output("rad")
def spring_winding(m: Module) -> Scalar:
    """Largest winding of a spring: the preload and the way to the stop in its winding direction."""
    return m.preload_angle + m.windings[0]


@quantities.output("rad")
def spring_unwinding(m: Module) -> Scalar:
    """Unwinding of a spring from rest to the stop against its winding direction."""
    return -m.windings[3]


quantities.margins("torsion_springs")


@quantities.output("MPa")
def spring_tensile_strength(m: Module) -> Scalar:
    """Tensile strength of the wire at its diameter."""
    ranges = m.spring_material.table("strength")
    return spring.tensile_strength(m.wire_diameter, [(range_["coefficient"], range_["exponent"]) for range_ in ranges])


@quantities.output("1", advice=(at_least(1.0, "the strength of this wire is extrapolated to its size"),))
def wire_range_margin(m: Module) -> Scalar:
    """Wire diameter against the nearer end of the range the material's strength is known for, above one inside."""
    ranges = m.spring_material.table("strength")
    thinnest = min(range_["wire_diameter_from"] for range_ in ranges)
    thickest = max(range_["wire_diameter_to"] for range_ in ranges)
    return np.fmin(m.wire_diameter / thinnest, thickest / m.wire_diameter)


@quantities.output("mm")
def spring_wound_diameter(m: Module) -> Scalar:
    """Mean coil diameter at full winding."""
    return spring.loaded_coil_diameter(m.coil_diameter, m.coil_count, m.spring_winding)


@quantities.output("mm")
def winding_mandrel(m: Module) -> Scalar:
    """Diameter of the mandrel that a spring is wound on, from which it springs back to its size."""
    wound = spring.wound_coil_diameter(
        m.coil_diameter, m.wire_diameter, m.spring_tensile_strength, m.spring_youngs_modulus
    )
    return wound - m.wire_diameter


@quantities.output("mm")
def spring_body_length(m: Module) -> Scalar:
    """Axial length of the coils at full winding."""
    return spring.body_length(m.wire_diameter, m.coil_count, m.spring_winding, m.coil_gap)


_GRADE_2 = 1.0  # the factor Q of DIN 2194 for its middle grade


@quantities.output("mm")
def coil_diameter_tolerance(m: Module) -> Scalar:
    """Tolerance of the coil diameter, DIN 2194 grade 2, to either side."""
    return spring.diameter_tolerance(m.wire_diameter, m.coil_diameter, _GRADE_2)


@quantities.output("deg")
def free_angle_tolerance(m: Module) -> Scalar:
    """Tolerance of a spring's free angle, DIN 2194 grade 2, to either side."""
    return spring.free_angle_tolerance(m.coil_count, m.spring_index, _GRADE_2)


@quantities.output("deg")
def fitted_angle_tolerance(m: Module) -> Scalar:
    """Deviation of the free angle of springs that go in, to either side, as sorted; none with adjusters."""
    return np.fmax(np.fmin(m.free_angle_tolerance, m.free_angle_sorting) - 0.5 * m.preload_adjustment, 0.0)


@quantities.output("1", advice=(at_least(0.2, "four of five springs as bought stay out"),))
def sorted_share(m: Module) -> Scalar:
    """Share of the springs as bought that go in: all with adjusters, else those within `free_angle_sorting`."""
    if m.preload_adjuster != "fixed":
        return 1.0
    return spring.share_within(m.free_angle_sorting, m.free_angle_tolerance)


@quantities.helper()
def full_pin_force(m: Module) -> Scalar:
    """Force of a leg on its pin at full winding [N]."""
    return m.held_spring_rate * m.spring_winding / m.leg_arm


@quantities.helper()
def pin_lever(m: Module) -> Scalar:
    """Height of the leg above the rotor plate [m].

    No leg lies lower than on the plate; without that, the search is lost beyond the pole at height zero.
    """
    return np.fmax(m.coil_end_level + m.helix_slope * m.leg_arm - m.rotor_top_level, 0.5 * m.wire_diameter)


@quantities.output("1", at_least(1.0, "the rotor's pins would break off between two layers of the print"))
def pin_safety(m: Module) -> Scalar:
    """Bending strength of the rotor's pins, or of dowel pins' bosses, cold, over the stress at full winding."""
    return m.structure_layer_strength / spring.bending_stress(m.full_pin_force * m.pin_lever, m.pin_foot_diameter, 1.0)


@quantities.output("1", advice=(at_least(1.0, "pins may crack at their fillet: a thicker pin, or a larger fillet"),))
def pin_foot_safety(m: Module) -> Scalar:
    """Bending strength of the rotor's pins, cold, over the peak of the stress at their fillet at full winding."""
    return m.pin_safety / structure.bent_at_fillet(m.pin_foot_diameter, m.foot_fillet)
