"""Heat that the rotor plate's lips take from the layer they touch, and pass to the plate they stand on.

A lip is a body without a state: layer and pads heat it at its side and its lower edge, the floor heats or cools its
lower face (`floor_heat.below_lips`), and it gives all of that to the plate's edge. Its heat capacity is in the plate
beside the arcs (`layer_heat.rotor_beside`).
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.shear.floor_heat import BELOW
from tvimdesign.device.shear.layer_end import ColdEnd
from tvimdesign.device.shear.melt_lip import LEAST_LIP, NO_LIP
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import shape_factors, slab_faces, stepped_sheet, still_air
from tvimdesign.physics.heat_flow.lip import Lip
from tvimdesign.physics.heat_flow.lumps import Lump, Place
from tvimdesign.physics.heat_flow.star import Arm
from tvimdesign.physics.heat_flow.strip import STRIP, WAYS

quantities = QuantityGroup(shared.group)

HOT, FACE, PLATE, BESIDE = ("hot", 0), ("face", 0), ("plate", 0), ("beside", 0)
Means = tuple[tuple[Place, Scalar], ...]
UNEVEN = 0.5
"""What is left at the arcs' edge of how much warmer the plate's face is than its mean: half, as where a heated face
ends."""


@quantities.helper()
def lip_height(melt_lip: str, melt_lip_height: Scalar) -> Scalar:
    """Height of the lips that heat passes [m]: as high as the rules ask where they are lower; none without lips."""
    return 0.0 if melt_lip == NO_LIP else np.fmax(melt_lip_height, LEAST_LIP)


@quantities.helper()
def lip_over(melt_lip: str, rotor_rim: Scalar, beside_area: Scalar, edge_length: Scalar) -> tuple[Scalar, ...]:
    """Width of the lips over each body of the strip beside the arcs [m]; none without lips.

    They reach over the first of these, smoothly as they get wider than that, and on over the next.
    """
    if melt_lip == NO_LIP:
        return (0.0,) * len(STRIP)
    return stepped_sheet.reaches(rotor_rim, [share * beside_area / edge_length for share in STRIP])


@quantities.helper()
def lip_ways(
    melt_lip: str,
    lip_height: Scalar,
    rotor_rim: Scalar,
    beside_area: Scalar,
    edge_length: Scalar,
    rotor_thickness: Scalar,
) -> tuple[Scalar, ...]:
    """What lips take off the ways along the plate beside the arcs, up to each body, over its depth [1]: below nothing.

    Heat goes through plate and lip beside one another, after a step down to the lip's edge and before one up from it.
    """
    if melt_lip == NO_LIP:
        return (0.0,) * len(STRIP)
    share = rotor_thickness / (rotor_thickness + lip_height)
    ways = [way * beside_area / edge_length for way in WAYS]
    covered = stepped_sheet.reaches(rotor_rim, ways)
    within = [1.0, *(one / way for one, way in zip(covered, ways, strict=True)), 0.0]
    ends = [within[i + 1] - within[i + 2] for i in range(len(ways))]
    ends[0] = ends[0] + 1.0
    step = stepped_sheet.step(share)
    return tuple(step * end - one * (1.0 - share) / rotor_thickness for one, end in zip(covered, ends, strict=True))


@quantities.helper()
def lip_faces(
    melt_lip: str, lip_height: Scalar, rotor_thickness: Scalar, lip_over: tuple[Scalar, ...]
) -> tuple[Scalar, ...]:
    """How much warmer lips' lower faces are than the plate above them, over each body of the strip, over how much
    warmer their sides are than the plate's edge [1] (`slab_faces.beyond_constriction`); nothing without lips."""
    if melt_lip == NO_LIP:
        return (0.0,) * len(STRIP)
    depth = lip_height + rotor_thickness
    share, begin, found = lip_height / depth, 0.0, []
    for covered in lip_over:
        found.append(
            slab_faces.beyond_constriction(share, begin / depth, covered / depth) / shape_factors.constriction(share)
        )
        begin = begin + covered
    return tuple(found)


@quantities.helper()
def lip_root(
    melt_lip: str,
    rotor_beside: tuple[Lump, ...],
    lip_height: Scalar,
    beside_area: Scalar,
    rotor_thickness: Scalar,
    edge_length: Scalar,
    structure_conductivity: Scalar,
) -> tuple[Means, Means] | None:
    """Places whose mean is the strip's temperature at the arcs' edge: what lips begin from, and its mean in depth.

    The latter lies on the way from above the arcs to the first body beside them. What heat through a lip's side and
    through the plate crowd less for one another (`shape_factors.constriction`) is a resistance below zero before that.
    """
    if melt_lip == NO_LIP:
        return None
    share = lip_height / (lip_height + rotor_thickness)
    together = shape_factors.constriction(share) * share / (1.0 - share)
    way = WAYS[0] * beside_area / edge_length / (rotor_thickness + lip_height)
    whole = structure_conductivity * edge_length / rotor_beside[0].conductance
    from_lip, mean = (way - together) / whole, way / whole
    return (
        ((FACE, UNEVEN), (PLATE, from_lip - UNEVEN), (BESIDE, 1.0 - from_lip)),
        ((PLATE, mean), (BESIDE, 1.0 - mean)),
    )


@quantities.helper()
def lip(
    cold_end: ColdEnd | None,
    air_beside: tuple[Scalar, Scalar],
    below_lips: tuple[Scalar, ...],
    lip_faces: tuple[Scalar, ...],
    lip_root: tuple[Means, Means] | None,
    lip_height: Scalar,
    edge_length: Scalar,
    rotor_thickness: Scalar,
    structure_conductivity: Scalar,
) -> Lip | None:
    """What heats and cools a lip; none without lips.

    Layer and pads give heat to its side (`cold_end`), and to its lower edge through the clearance. From there it
    spreads as from a share of the end of a slab that is as deep as plate and lip together (`constriction`). Its
    lower face meets the floor (`lip_faces`).
    """
    if cold_end is None or lip_root is None:
        return None
    share = lip_height / (lip_height + rotor_thickness)
    onto = shape_factors.constriction(share) / (1.0 - share)
    (root, mean), (conductivity, slot) = lip_root, air_beside
    arms = [
        Arm(structure_conductivity / onto * edge_length, root),
        Arm(still_air.below_lip(slot)[0] * conductivity * edge_length, ((HOT, 1.0),)),
    ]
    for i, (through, warmer, floor) in enumerate(zip(below_lips, lip_faces, BELOW, strict=True)):
        edge = tuple((place, weight * warmer) for place, weight in mean)
        arms.append(Arm(through, ((("around", floor), 1.0), (("beside", i), -1.0), *edge), warmer))
    return Lip(cold_end.of_layer * edge_length, cold_end.of_pads * edge_length, tuple(arms))
