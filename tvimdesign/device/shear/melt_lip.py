"""Lips of the rotor plate along the molten layer's edges, and the melt that creeps out past them in a hot hour.

They turn in their own track, so nothing rubs on them. The melt's surface is held between a lip's edge and the floor,
and what leaves must go through the narrow gap below it. The plate is printed with that face up, so the lips need no
support.

Melt creeps out in a hot hour, and a rotor that hangs on it draws it thicker. The worst way up is taken: the axis level,
so that gravity acts along the layer, across an arc's radial width; and for the rotor's weight, upside down. To and fro
of the joint moves no melt on average, as slow flow can be reversed [1], and turns it outwards by w^2 r, a thousandth of
gravity at 1 Hz; both are left out, and so are normal stresses of fast shear. The half-width of a meniscus holds the
melt only where an edge holds the meniscus: at lips, not between flat faces. [1] Happel and Brenner, Low Reynolds Number
Hydrodynamics, sec. 1-2.

A lip takes heat from the layer it touches and passes it to the plate it stands on. It is a body without a state: layer
and pads heat it at its side and its lower edge, the floor heats or cools its lower face (`floor_heat.below_lips`), and
it gives all of that to the plate's edge. Its heat capacity is in the plate beside the arcs (`layer_heat.rotor_beside`).
"""

import numpy as np

from tvimdesign.device.components.axial_preload import GRAVITY, HOUR
from tvimdesign.device.core.clearances import MM
from tvimdesign.device.shear.floor_heat import BELOW
from tvimdesign.device.table import Feature, Module, QuantityGroup, Scalar, at_most
from tvimdesign.physics.heat_flow import layer_end, shape_factors
from tvimdesign.physics.heat_flow.layer_end import Arm, Lip
from tvimdesign.physics.heat_flow.lumps import STRIP, WAYS, Place
from tvimdesign.physics.polymers import melt
from tvimdesign.physics.solids.shapes import Section, ring

NO_LIP = "none"
WITH_LIP = (Feature("melt_lip", NO_LIP),)
LEAST_LIP = 0.1 * MM  # Least height of a lip; assumed, 0.1 to 0.2 mm: a layer of a print
places = QuantityGroup("Layout")
weights = QuantityGroup("Size and weight")
rules = QuantityGroup("Gaps", WITH_LIP)
places.choices("melt_lip")
places.formulas("melt_lip")


@places.helper()
def plate_lean(m: Module) -> Scalar:
    """Angle at which the leaning rotor's outer lip is down on the floor [rad], its other side held at the hub."""
    if m.melt_lip == NO_LIP:
        return np.inf
    return (m.running_clearance + m.stop_play) / (m.hub_radius + m.rotor_radius)


@weights.helper(requires=WITH_LIP, default=Section(0.0, 0.0))
def melt_lip_moments(m: Module) -> Section:
    """Volume of both lips and its polar moment about the axis."""
    inner, outer = ring(m.melt_lip_inner_radius, m.pcl_inner_radius), ring(m.pcl_outer_radius, m.rotor_radius)
    return inner.plus(outer).times(m.melt_lip_height)


@rules.gap("the layer is too thin for lips: a thicker one, less running_clearance, or none")
def melt_lip_margin(m: Module) -> Scalar:
    """Height of the lips beyond the least that is worth while."""
    return m.melt_lip_height - LEAST_LIP


rules.margins("melt_lip")


retention = QuantityGroup("Axial play")
DRAWN = 1.1  # Thickness over that at the start up to which the time is given


@retention.output("Pa")
def melt_head(m: Module) -> Scalar:
    """Pressure of the melt over the radial width of an arc that stands upright."""
    return m.pcl_melt_density * GRAVITY * m.arc_width


@retention.output("Pa")
def melt_hold(m: Module) -> Scalar:
    """Pressure that the melt's surface holds below a lip; zero between flat faces, on which it may creep."""
    if m.melt_lip == NO_LIP:
        return 0.0 * m.pcl_surface_tension
    return melt.meniscus_pressure(m.pcl_surface_tension, m.running_clearance + m.freezing_travel)


_CREEPS = "so much of the molten layer creeps out in an hour with the axis level (assumed, 0.5 to 5 %)"


@retention.output("%", advice=(at_most(0.01, _CREEPS),))
def melt_loss(m: Module) -> Scalar:
    """Share of the layer that gravity moves out past an edge in an hour at the hot point, the axis level."""
    gap, length = m.pcl_thickness + m.freezing_travel, m.arc_width
    if m.melt_lip != NO_LIP:
        length = melt.gaps_in_series(m.arc_width, gap, m.rotor_rim, m.running_clearance + m.freezing_travel)
    head = np.fmax(m.melt_head - m.melt_hold, 0.0)
    return HOUR * melt.gap_speed(head / length, gap, m.pcl_viscosity_at_hot) / m.arc_width


@retention.output("s")
def layer_drawing_time(m: Module) -> Scalar:
    """Time in which rotor, link and retainer, hanging on the molten layer alone, draw it a tenth thicker."""
    length, weight = m.arc_count * m.arc_span * m.pcl_mean_radius, GRAVITY * m.turning_mass
    ends = (m.pcl_thickness, DRAWN * m.pcl_thickness)
    return melt.squeeze_time(weight, m.pcl_viscosity_at_hot, length, m.arc_width, *ends)


quantities = QuantityGroup("Switch")

SPREADER, FACE, PLATE, BESIDE = ("spreader", 0), ("face", 0), ("plate", 0), ("beside", 0)
Means = tuple[tuple[Place, Scalar], ...]
UNEVEN = 0.5
"""Share that is left at the arcs' edge of the rise of the plate's face over its mean: half, as where a heated face
ends."""


@quantities.helper()
def lip_height(m: Module) -> Scalar:
    """Height of the lips that heat passes [m]: as high as the rules ask where they are lower; none without lips."""
    return 0.0 if m.melt_lip == NO_LIP else np.fmax(m.melt_lip_height, LEAST_LIP)


@quantities.helper()
def lip_over(m: Module) -> tuple[Scalar, ...]:
    """Width of the lips over each body of the strip beside the arcs [m]; none without lips.

    They reach over the first of these, smoothly as they get wider than that, and on over the next.
    """
    if m.melt_lip == NO_LIP:
        return (0.0,) * len(STRIP)
    return shape_factors.reaches(m.rotor_rim, [share * m.beside_area / m.edge_length for share in STRIP])


@quantities.helper()
def lip_ways(m: Module) -> tuple[Scalar, ...]:
    """Length that lips take off the ways along the plate beside the arcs, up to each body, over its depth [1].

    Heat goes through plate and lip beside one another, after a step down to the lip's edge and before one up from it.
    """
    if m.melt_lip == NO_LIP:
        return (0.0,) * len(STRIP)
    share = m.rotor_thickness / (m.rotor_thickness + m.lip_height)
    ways = [way * m.beside_area / m.edge_length for way in WAYS]
    covered = shape_factors.reaches(m.rotor_rim, ways)
    within = [1.0, *(lip / way for lip, way in zip(covered, ways, strict=True)), 0.0]
    ends = [within[i + 1] - within[i + 2] for i in range(len(ways))]
    ends[0] = ends[0] + 1.0
    step = shape_factors.step(share)
    return tuple(step * end - lip * (1.0 - share) / m.rotor_thickness for lip, end in zip(covered, ends, strict=True))


def _lip_faces(m: Module) -> tuple[Scalar, ...]:
    """Return how much warmer lips' lower faces are than the plate above them, over each body of the strip, over how
    much warmer their sides are than the plate's edge [1] (`shape_factors.beyond_constriction`); nothing without
    lips."""
    if m.melt_lip == NO_LIP:
        return (0.0,) * len(STRIP)
    depth = m.lip_height + m.rotor_thickness
    share, begin, rises = m.lip_height / depth, 0.0, []
    for covered in m.lip_over:
        rises.append(
            shape_factors.beyond_constriction(share, begin / depth, covered / depth) / shape_factors.constriction(share)
        )
        begin = begin + covered
    return tuple(rises)


@quantities.helper()
def lip_root(m: Module) -> tuple[Means, Means] | None:
    """Places whose mean is the strip's temperature at the arcs' edge: what lips begin from, and its mean in depth.

    The latter lies on the way from above the arcs to the first body beside them. What heat through a lip's side and
    through the plate crowd less for one another (`shape_factors.constriction`) is a resistance below zero before that.
    """
    if m.melt_lip == NO_LIP:
        return None
    share = m.lip_height / (m.lip_height + m.rotor_thickness)
    together = shape_factors.constriction(share) * share / (1.0 - share)
    way = WAYS[0] * m.beside_area / m.edge_length / (m.rotor_thickness + m.lip_height)
    whole = m.structure_conductivity * m.edge_length / m.rotor_beside[0].conductance
    from_lip, mean = (way - together) / whole, way / whole
    return (
        ((FACE, UNEVEN), (PLATE, from_lip - UNEVEN), (BESIDE, 1.0 - from_lip)),
        ((PLATE, mean), (BESIDE, 1.0 - mean)),
    )


@quantities.helper()
def lip(m: Module) -> Lip | None:
    """Lip of the plate with what heats and cools it; none without lips.

    Layer and pads give heat to its side (`cold_end`), and to its lower edge through the clearance. From there it
    spreads as from a share of the end of a slab that is as deep as plate and lip together (`constriction`). Its
    lower face meets the floor (`_lip_faces`).
    """
    if m.cold_end is None or m.lip_root is None:
        return None
    share = m.lip_height / (m.lip_height + m.rotor_thickness)
    onto = shape_factors.constriction(share) / (1.0 - share)
    (root, mean), (conductivity, slot) = m.lip_root, m.air_beside
    arms = [
        Arm(m.structure_conductivity / onto * m.edge_length, root),
        Arm(layer_end.below_lip(slot)[0] * conductivity * m.edge_length, ((SPREADER, 1.0),)),
    ]
    for i, (through, warmer, floor) in enumerate(zip(m.below_lips, _lip_faces(m), BELOW, strict=True)):
        edge = tuple((place, weight * warmer) for place, weight in mean)
        arms.append(Arm(through, ((("around", floor), 1.0), (("beside", i), -1.0), *edge), warmer))
    return Lip(m.cold_end.of_layer * m.edge_length, m.cold_end.of_pads * m.edge_length, tuple(arms))
