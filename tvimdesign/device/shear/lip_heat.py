"""Heat that the rotor plate's lips take from the layer they touch, and pass to the plate they stand on.

A lip is a body without a state: layer and pads heat it at its side and its lower edge, the floor heats or cools its
lower face (`floor_heat.below_lips`), and it gives all of that to the plate's edge. Its heat capacity is in the plate
beside the arcs (`layer_heat.rotor_beside`).
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.shear.floor_heat import BELOW
from tvimdesign.device.shear.melt_lip import LEAST_LIP, NO_LIP
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import layer_end, shape_factors
from tvimdesign.physics.heat_flow.layer_end import Arm, Lip
from tvimdesign.physics.heat_flow.lumps import STRIP, WAYS, Place

quantities = QuantityGroup("Switch")

HOT, FACE, PLATE, BESIDE = ("hot", 0), ("face", 0), ("plate", 0), ("beside", 0)
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
    within = [1.0, *(one / way for one, way in zip(covered, ways, strict=True)), 0.0]
    ends = [within[i + 1] - within[i + 2] for i in range(len(ways))]
    ends[0] = ends[0] + 1.0
    step = shape_factors.step(share)
    return tuple(step * end - one * (1.0 - share) / m.rotor_thickness for one, end in zip(covered, ends, strict=True))


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
        Arm(layer_end.below_lip(slot)[0] * conductivity * m.edge_length, ((HOT, 1.0),)),
    ]
    for i, (through, warmer, floor) in enumerate(zip(m.below_lips, _lip_faces(m), BELOW, strict=True)):
        edge = tuple((place, weight * warmer) for place, weight in mean)
        arms.append(Arm(through, ((("around", floor), 1.0), (("beside", i), -1.0), *edge), warmer))
    return Lip(m.cold_end.of_layer * m.edge_length, m.cold_end.of_pads * m.edge_length, tuple(arms))
