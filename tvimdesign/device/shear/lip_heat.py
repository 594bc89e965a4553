"""Heat that the rotor plate's lips take from the layer they touch, and pass to the plate they stand on.

A lip is a body without a state: layer and pads heat it at its side, and it gives all of that to the plate's edge. Its
heat capacity is in the plate beside the arcs (`layer_heat.rotor_beside`), which its lower face heats and cools as well
(`floor_heat.below_lips`).
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.shear.layer_end import ColdEnd
from tvimdesign.device.shear.melt_lip import LEAST_LIP, NO_LIP
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import lumps, star, stepped_sheet
from tvimdesign.physics.heat_flow.lumps import STRIP, WAYS, Link
from tvimdesign.physics.heat_flow.star import Arm

quantities = QuantityGroup(shared.group)

HOT, LAYER, FACE, BESIDE = ("hot", 0), ("layer", 0), ("face", 0), ("beside", 0)
AT_EDGE = ((FACE, 0.5), (BESIDE, 0.5))
"""The plate's face at the arcs' edge: the mean of above and beside, as where a heated face ends."""


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
def lip_arms(
    cold_end: ColdEnd | None,
    lip_height: Scalar,
    edge_length: Scalar,
    rotor_thickness: Scalar,
    structure_conductivity: Scalar,
) -> tuple[Arm, ...]:
    """What heats and cools a lip; nothing without lips.

    Layer and pads give heat to its side (`cold_end`). From there it spreads as from a share of the end of a slab that
    is as deep as plate and lip together (`lumps.constriction`).
    """
    if cold_end is None:
        return ()
    onto = lumps.constriction(lip_height / (lip_height + rotor_thickness))
    return (
        Arm(cold_end.of_layer * edge_length, ((LAYER, 1.0),)),
        Arm(cold_end.of_pads * edge_length, ((HOT, 1.0),)),
        Arm(structure_conductivity / onto * edge_length, AT_EDGE),
    )


@quantities.helper()
def lip_links(lip_arms: tuple[Arm, ...]) -> tuple[Link, ...]:
    """What lips pass between pads, layer and plate; nothing without lips."""
    return star.meshed(lip_arms) if lip_arms else ()
