"""Torsional stiffness of what carries the layer: shaft with holes, flat rings, feet, and the lever on top.

Sources: [T] Timoshenko and Goodier, Theory of Elasticity, 3rd ed.: torsion of round bars, holes in shear, rings sheared
in their plane; [B] Timoshenko, Strength of Materials, part I, 3rd ed., ch. 5 (bending and shear of beams); [RHW]
Richart, Hall, Woods, Vibrations of Soils and Foundations, ch. 10 (a rocking disc). Numbers that are calibrated stand
for ways of the torque that these leave out; FE of the drawn parts gave them.
"""

from typing import Any, NamedTuple

import numpy as np


def shear_modulus(youngs_modulus: Any, poissons_ratio: Any) -> Any:
    """Return G = E/(2 (1 + nu)) [Pa]."""
    return youngs_modulus / (2.0 * (1.0 + poissons_ratio))


def shear_yield(tensile_yield: Any) -> Any:
    """Return the shear stress at which a body yields [Pa], sigma/sqrt(3) (Shigley, section 5-5, distortion energy)."""
    return tensile_yield / np.sqrt(3.0)


def mises(shear: Any) -> Any:
    """Return the von Mises stress [Pa] of pure shear, 3^(1/2) tau."""
    return np.sqrt(3.0) * shear


def shaft_stiffness(modulus: Any, radius: Any, length: Any) -> Any:
    """Round bar, G pi r^4/(2 L) [N*m/rad]."""
    return modulus * np.pi * radius**4 / (2.0 * length)


def shaft_torque(shear_yield: Any, radius: Any) -> Any:
    """Return the torque [N*m] at which a round bar starts to yield at its surface, tau pi r^3/2."""
    return 0.5 * np.pi * shear_yield * radius**3


def hole_weakening(hole_radius: Any, circle_radius: Any, count: Any, shaft_radius: Any) -> Any:
    """Return the share [1] of a shaft's polar moment that holes along it, on a circle about its axis, cost: 4 n r^2
    b^2/R^4.

    A hole in even shear costs twice the energy of what was bored out [T]; holes far from one another and from the rim.
    One on the axis costs its own moment, r^4/R^4.
    """
    return np.fmax(4.0 * count * hole_radius**2 * circle_radius**2, count * hole_radius**4) / shaft_radius**4


def stub_stress(force: Any, lever: Any, width: Any, depth: Any) -> Any:
    """Return the von Mises stress [Pa] at the root of a short beam, as a gear's tooth (Shigley, eq. 14-1): 6 F l/(b
    w^2), and mean shear.

    `force` [N] acts along the width w at the lever l; b is the depth across it. Corners at the root are left out.
    """
    return np.sqrt((6.0 * force * lever / (depth * width**2)) ** 2 + 3.0 * (force / (depth * width)) ** 2)


def stub_compliance(youngs_modulus: Any, shear_modulus: Any, lever: Any, width: Any, depth: Any) -> Any:
    """Return the way of a force on such a beam over it [m/N], 4 l^3/(E b w^3) + 1.2 l/(G b w) [B]."""
    return 4.0 * lever**3 / (youngs_modulus * depth * width**3) + 1.2 * lever / (shear_modulus * depth * width)


SHAFT_ENTRY = 0.10
"""Length over radius by which the way into the plate lengthens a core; calibrated to validation/fe_structure."""
BORE_ENTRY = 0.15  # Length over radius by which holes that go on into the plate weaken that way; calibrated likewise
FILLET_SHORTENS, THIN_SHORTENS = 0.495, 0.0046
"""Of a fillet's radius q at the core's foot: how much shorter the core is by it, 0.495 + 0.0046 (r/h)^2 on a plate of
the thickness h. Torsion of a round bar on a plate by numbers (validation/fe_structure/fillets.csv), radii of 6 to 12 mm
on 1.5 to 5 mm, fillets up to 2 mm: within 0.11 mm of core."""
FILLET_GIVES, FILLET_BEARS = 0.136, 0.023
"""Of it, likewise: how much core the plate gives more, as the torque enters further out, 0.136 - 0.023 q r/h^2 as the
fillet bears beside the plate; within 0.025 mm. Over the length q beside the core the plate gives q r/(4 h) of core, of
which a fillet takes over the more, the higher it is against the plate."""


class Bores(NamedTuple):
    """Holes along a shaft from its end."""

    weakening: Any  # Share [1] of its polar moment that they cost, as of `hole_weakening`
    depth: Any  # Depth [m]
    circle_radius: Any  # Radius of the circle they stand on [m]


def shorter_by_fillet(radius: Any, plate: Any, fillet: Any) -> Any:
    """Return the length [m] by which a fillet at its foot makes a core shorter, on a plate of a thickness."""
    return (FILLET_SHORTENS + THIN_SHORTENS * (radius / plate) ** 2) * fillet


def bored_shaft_stiffness(
    modulus: Any, radius: Any, length: Any, first: Bores, second: Bores, shorter: Any = 0.0
) -> Any:
    """Round bar with two sets of holes from its upper end, standing on a plate [N*m/rad].

    G pi r^4/2 over L + sum l w/(1 - w) + 0.10 r, less what a fillet makes it `shorter` (`shorter_by_fillet`), summed
    over the length l that both sets reach and that only one does, down to 0.15 r below the plate's face. FE of cores as
    drawn: within 7 %.
    """
    deep = [np.fmin(bores.depth, length + BORE_ENTRY * radius) for bores in (first, second)]
    both = np.fmin(*deep)
    stretches = [
        (both, first.weakening + second.weakening),
        (deep[0] - both, first.weakening),
        (deep[1] - both, second.weakening),
    ]
    longer = sum(reach * weakening / (1.0 - weakening) for reach, weakening in stretches) + SHAFT_ENTRY * radius
    return shaft_stiffness(modulus, radius, length + longer - shorter)


LEANS_AT_FOOT = 0.75
"""Length over radius by which a core's foot in its plate lengthens it in bending; calibrated to FE, 0.6 to 0.85."""


def bent_shaft_compliance(
    stiffness: Any, youngs_modulus: Any, poissons_ratio: Any, radius: Any, length: Any, beyond: Any
) -> Any:
    """Return how far a force across a core moves a point `beyond` its end, over the force [m/N]; the plate stays.

    A cantilever whose torsional `stiffness` K tells how much longer its holes make it, E I = (1 + nu) G J, with shear:
    (((l + h)^3 - h^3)/(3 l (1 + nu)) + r^2/1.8)/K, and 0.75 r more of it at the foot [B].
    """
    spread = ((length + beyond) ** 3 - beyond**3) / (3.0 * length * (1.0 + poissons_ratio)) + radius**2 / 1.8
    foot = LEANS_AT_FOOT * radius * (length + beyond) ** 2 / (youngs_modulus * 0.25 * np.pi * radius**4)
    return spread / stiffness + foot


FOOT_MEAN = 1e-3
"""Length [m] above the foot over which the stress is a mean: the corner is sharp, so at a point it has no value."""
FOOT_ON_PLATE = 0.796
"""Rise of a core's stress at its foot on a plate as thick as its radius, a millimetre, that drives arcs, where no hole
is near: 0.775 by numbers [T], times 1.03 as it is not the same all around; that calibrated to FE."""
SHARP_FOOT, THIN_PLATE = 0.26, 0.137
"""Powers of the radius over a millimetre, and over the plate's thickness, with which it grows: torsion of a stepped
round bar by numbers [T], radii of 5.7 to 16 mm, 1.7 to 4 times the plate's thickness, within 1.3 %."""
BORED_FOOT = 1.41  # Rise by the share of the polar moment that holes through the foot cost; calibrated to FE
NEAR_FOOT = 0.25
"""Way above the foot, over the core's radius, within which the end of a hole is felt there; calibrated likewise."""
AMONG_VANES = 1.045
"""Factor on that for a plate with vanes around it, which pull unevenly; with what cups the plate
(`wedge.foot_bending`), FE of 14 cores within 5 %."""


def felt_at_foot(radius: Any, length: Any, *holes: Bores) -> Any:
    """Return the share of the polar moment [1] that holes cost at a core's foot, as far as they go through it or end
    near it.

    sum w/(1 + exp((L - l)/(0.25 r))), l the depth of the holes in a core of the length L.
    """
    return sum(bores.weakening / (1.0 + np.exp((length - bores.depth) / (NEAR_FOOT * radius))) for bores in holes)


def foot_rise_on_plate(radius: Any, length: Any, plate: Any, *holes: Bores, fillet: Any = 0.0) -> Any:
    """Return the rise [1] of a core's stress at its foot on a plate that drives arcs; FE of 31 sharp feet as drawn
    within 4 %.

    0.796 (r/d)^0.26 (r/h)^0.137 (1 + 1.41 w), w as of `felt_at_foot`, a mean over the length d. In a corner of 270
    degrees of solid the stress goes with the power -1/3 of the distance [T]; what is even besides makes it 0.26. A
    fillet takes that down (`filleted_foot`).
    """
    sharp = (radius / FOOT_MEAN) ** SHARP_FOOT * (radius / plate) ** THIN_PLATE
    bored = 1.0 + BORED_FOOT * felt_at_foot(radius, length, *holes)
    return FOOT_ON_PLATE * sharp * bored * filleted_foot(fillet)


FELT_FILLET = 1.16
"""Fillet over `FOOT_MEAN` from which on the stress falls; torsion of a stepped round bar by finite elements
(validation/fe_structure/fillets.csv), radii of 6 to 12 mm on 1.5 to 5 mm, fillets up to 2 mm: within 4 %."""


def filleted_foot(fillet: Any) -> Any:
    """Return what a fillet makes of the rise [1] of the stress at a sharp foot: (1 + (q/1.16 d)^6)^(-0.26/6), d a
    millimetre.

    Of both feet the highest mean over the length d along the surface counts. A fillet that is small against d leaves
    that as it is; along one that is large it is the peak, which goes with the power -0.26 of q, as the mean beside a
    sharp foot does with that of d.
    """
    return (1.0 + (fillet / (FELT_FILLET * FOOT_MEAN)) ** 6) ** (-SHARP_FOOT / 6.0)


def bent_at_fillet(diameter: Any, fillet: Any) -> Any:
    """Return the rise [1] of the bending stress at the fillet of a round bar on a far wider one, 0.879 (q/d)^-0.332.

    Peterson's chart for a shoulder of 6 times the diameter, fitted by Norton (Machine Design, fig. C-2); at least 1.
    """
    return np.fmax(0.87868 * (fillet / diameter) ** -0.33243, 1.0)


def foot_rise_among_vanes(radius: Any, length: Any, plate: Any, *holes: Bores, fillet: Any = 0.0) -> Any:
    """Return the rise [1] of a core's stress at its foot on a plate with vanes, 1.045 times that on one that drives
    arcs."""
    return AMONG_VANES * foot_rise_on_plate(radius, length, plate, *holes, fillet=fillet)


def bored_shaft_torque(shear_yield: Any, radius: Any, foot: Any, *holes: Bores) -> Any:
    """Return the torque [N*m] at which a round bar with holes that stands on a plate starts to yield: at its foot, or
    at a hole.

    tau pi r^3/2 over the larger of the rise at the `foot` and, of each set of holes, max(1, 2 b/r)/(1 - w): beside a
    hole on the circle b the shear is doubled [T]. Sets that stand between one another shield each other and count
    apart.
    """
    worst = foot
    for bores in holes:
        beside = np.fmax(1.0, 2.0 * bores.circle_radius / radius)
        worst = np.fmax(worst, beside / (1.0 - bores.weakening))
    return shaft_torque(shear_yield, radius) / worst


def ring_stiffness(modulus: Any, thickness: Any, inner_radius: Any, outer_radius: Any) -> Any:
    """Return the flat ring turned in its plane, inner edge against outer edge, 4 pi G h/(1/a^2 - 1/b^2) [N*m/rad]."""
    return 4.0 * np.pi * modulus * thickness / (inner_radius**-2 - outer_radius**-2)


PLATE_ENTRY = 0.38
"""Rise of 1/a^2 with (h/a)^2 as the torque enters a plate from its face: torsion of a stepped round bar, solved by
numbers [T], gives 0.35 to 0.40 for plates 0.25 to 1 of the core's radius thick."""
BORED_ENTRY = 0.2
"""Rise of 1/a^2 besides with the share of the core's polar moment that holes cost at its foot; calibrated to
validation/fe_structure."""


def plate_stiffness(
    modulus: Any, thickness: Any, core_radius: Any, inner_radius: Any, felt: Any = 0.0, fillet: Any = 0.0
) -> Any:
    """Return the plate turned by a core that stands on it, out to the inner edge of what it drives [N*m/rad].

    1/K = ((1 + 0.38 (h/a)^2 + 0.2 w)/a^2 - 1/b^2)/(4 pi G h) + (0.136 - 0.023 q a/h^2) q/(G J): the torque spreads over
    the plate's thickness as it enters, goes around holes on its way, w of `felt_at_foot`, and out through a fillet q
    around the core, J the core's polar moment.
    """
    entry = 1.0 + PLATE_ENTRY * (thickness / core_radius) ** 2 + BORED_ENTRY * felt
    around = ring_stiffness(modulus, thickness, core_radius / np.sqrt(entry), inner_radius)
    longer = (FILLET_GIVES - FILLET_BEARS * fillet * core_radius / thickness**2) * fillet
    return 1.0 / (1.0 / around + longer / shaft_stiffness(modulus, core_radius, 1.0))


def covered_ring_stiffness(modulus: Any, thickness: Any, inner_radius: Any, outer_radius: Any, covered: Any) -> Any:
    """Return the ring of a plate that is driven on the share c of its circle, sqrt(c) of the whole ring's [N*m/rad].

    The root is calibrated to validation/fe_structure, c 0.25 to 0.89: the plate beside an arc helps along.
    """
    return ring_stiffness(modulus, thickness, inner_radius, outer_radius) * np.sqrt(covered)


def evenly_relieved(inner_radius: Any, outer_radius: Any) -> Any:
    """Return the compliance of a ring over that of the same turned inner edge against outer [1], relieved by a stiff
    layer.

    The layer takes the torque over with a traction in proportion to the radius, so that M = T (b^4 - r^4)/(b^4 - a^4)
    is left at r; the mean of (M/T)^2 over dr/r^3.
    """
    a, b = inner_radius, outer_radius
    whole = 0.5 * (a**-2 - b**-2)
    return (b**8 * whole - b**4 * (b**2 - a**2) + (b**6 - a**6) / 6.0) / (b**4 - a**4) ** 2 / whole


def face_compliance(modulus: Any, thickness: Any, polar: Any) -> Any:
    """Return what a plate gives over its own thickness, driven on one face [rad/(N*m)]: h/(3 G J).

    The shear falls from the traction to nothing at the other face, so a third of the thickness counts; J is the polar
    moment of what drives it. Source: the energy of a shear that falls evenly [T].
    """
    return thickness / (3.0 * modulus * polar)


FLOOR_BENDS, FLOOR_DENTS = 0.76, 0.89
"""Moments [N*m/rad] that a floor holds the upper end of a foot with: over E t^3, as a thin one bends, and over E r^3,
as a thick one gives around the foot; a rigid disc on a half-space is held with 8 G r^3/(3 (1 - nu)), 1.5 [RHW], and a
foot is bored and stands at the floor's edge. Both calibrated to validation/fe_structure."""


def foot_tilt(radius: Any, bore_radius: Any, height: Any, floor: Any) -> Any:
    """Return the rise [1] of a foot's compliance in bending as the floor above lets it turn: 1 built in, 4 free to.

    1 + 3/(1 + c), h/(c I) = 1/(0.76 t^3) + 1/(0.89 r^3), a floor of the thickness t of what the foot is made of: a beam
    built in below, with a spring against turning above [B].
    """
    inertia = 0.25 * np.pi * (radius**4 - bore_radius**4)
    give = 1.0 / (FLOOR_BENDS * floor**3) + 1.0 / (FLOOR_DENTS * radius**3)
    return 1.0 + 3.0 / (1.0 + height / (inertia * give))


def foot_stiffness(
    youngs_modulus: Any, shear_modulus: Any, radius: Any, bore_radius: Any, height: Any, tilt: Any = 1.0
) -> Any:
    """Return the sideways stiffness of a bored round foot, built in below, and above too but for its `foot_tilt` q
    [N/m].

    1/k = q h^3/(12 E I) + h/(0.9 G A), [B].
    """
    inertia = 0.25 * np.pi * (radius**4 - bore_radius**4)
    area = np.pi * (radius**2 - bore_radius**2)
    return 1.0 / (tilt * height**3 / (12.0 * youngs_modulus * inertia) + height / (0.9 * shear_modulus * area))


def foot_bending_stress(force: Any, radius: Any, bore_radius: Any, height: Any, tilt: Any = 1.0) -> Any:
    """Return the largest bending stress of such a foot under a sideways force at its upper end, at its lower end [Pa].

    M r/I with M = F h (q + 2)/6: a beam built in below has M = F h where its upper end turns as it likes (q = 4), F h/2
    where that is held (q = 1). A spring against turning there, c = k h/(E I), takes F h c/(2 (1 + c)) off, and the
    `foot_tilt` is q = 1 + 3/(1 + c) [B].
    """
    inertia = 0.25 * np.pi * (radius**4 - bore_radius**4)
    return force * height * (tilt + 2.0) / 6.0 * radius / inertia


def pocketed_thickness(thickness: Any, count: Any, radius: Any, depth: Any, circle_radius: Any) -> Any:
    """Return the mean thickness [m] of a floor along a circle on which round pockets stand, t - n r d/(pi R); geometry.

    Sheets of unlike thickness side by side that turn by the same angle bear in proportion to it.
    """
    return thickness - count * radius * depth / (np.pi * circle_radius)


def spot_stiffness(modulus: Any, poissons_ratio: Any, thickness: Any, radius: Any, reach: Any) -> Any:
    """Return the sheet pushed in its plane on a round spot at its edge [N/m]: 4 pi G h/((3 - nu) ln(l/r)).

    A force within a wide sheet moves what is near by (3 - nu) F ln(l/r)/(8 pi G h) against what lies at the `reach` l
    [T]; at a free edge, where half of the sheet is missing, it counts twice.
    """
    return 4.0 * np.pi * modulus * thickness / ((3.0 - poissons_ratio) * np.log(reach / radius))


def hoop_compliance(youngs_modulus: Any, section: Any, length: Any, count: Any, radius: Any) -> Any:
    """Return the ledges along a circle that hand what they are pushed along with over at both ends [rad/(N*m)]: L/(12 E
    A n r^2).

    Each of n is a bar of the section A and the length L, pushed evenly: half of it is stretched, half pressed [B].
    """
    return length / (12.0 * youngs_modulus * section * count * radius**2)


def under_ledges_compliance(seats: tuple[Any, Any], between: Any, beyond: Any) -> Any:
    """Return the floor below pads or tiles that lie on an inner and an outer ledge around a window [rad/(N*m)]: s^2 C_b
    + C_o.

    The inner ledge bears the share s = c_2/(c_1 + c_2 + C_b) of the torque: its way out to the other ledge goes through
    what gives by `between`, the ledge as a hoop and the ribs beside the windows. `seats` are the compliances c of what
    lies on both ledges, `beyond` is that from the outer ledge on. Source: statics of two ways in parallel.
    """
    inner, outer = seats
    share = outer / (inner + outer + between)
    return share**2 * between + beyond


def footed_floor_stiffness(ring: Any, spot: Any, foot: Any, count: Any, foot_radius: Any) -> Any:
    """Return the floor with feet on a circle [N*m/rad]: 1/K = 1/K_ring + (1/k_spot + 1/k)/(n r^2).

    `ring` is the floor's stiffness from the PCL's rim to the feet, `spot` that of the floor around a foot in its plane,
    `foot` that of a foot sideways [N/m]. With `under_ledges_compliance` in series and the `pocketed_thickness` of the
    first two, FE of 71 floors, 2.5 to 6.5 mm thick: 69 within a tenth, the others 13 and 19 % too stiff.
    """
    return 1.0 / (1.0 / ring + (1.0 / spot + 1.0 / foot) / (count * foot_radius**2))


LEVER_ROOT, LEVER_DEPTH = 0.55, 0.91
"""Shares of the clamped radius that a lever does not bend over, and of its thickness that it bends over besides, as it
is held on one face; calibrated to validation/fe_link."""
LEVER_LOCAL = -1.1  # Give of clamp and hole times E t; calibrated likewise


def lever_stiffness(
    youngs_modulus: Any, shear_modulus: Any, width: Any, thickness: Any, length: Any, clamped_radius: Any
) -> Any:
    """Return the lever clamped on a round face, pushed sideways at its end: torque over the end's way over its length
    [N*m/rad].

    d/F = l^3/(3 E I) + 1.2 l/(G A) - 1.1/(E t), l = L - 0.55 r + 0.91 t [B]; K = L^2 F/d. FE of 13 links: within 3 %.
    """
    free = length - LEVER_ROOT * clamped_radius + LEVER_DEPTH * thickness
    bending = free**3 / (3.0 * youngs_modulus * thickness * width**3 / 12.0)
    shearing = 1.2 * free / (shear_modulus * width * thickness)
    return length**2 / (bending + shearing + LEVER_LOCAL / (youngs_modulus * thickness))


def series(*stiffnesses: Any) -> Any:
    """Return the stiffness of springs in series, 1/K = sum 1/K_i [N*m/rad]."""
    return 1.0 / sum(1.0 / stiffness for stiffness in stiffnesses)


def overhung_load(force: Any, height: Any, spread: Any) -> Any:
    """Return the load [N] on the nearer of two bearings, `spread` [m] apart, of a force `height` [m] beyond it: F (1 +
    h/s).

    Source: statics, moments about the farther bearing.
    """
    return force * (1.0 + height / spread)
