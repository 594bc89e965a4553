"""What a liner gives sideways: through the film around it to the walls of its recess in the rotor plate.

Layer and liner end at one cold wall (`layer_end.end_wall`): the walls of the recess, and below them a lip, if there is
one. The liner's cells give by their own excess over the plate's edge what such a wall takes beside them of an even
fall. The plate is that wall's for a share of its depth (`shape_factors.constriction`).
"""

from __future__ import annotations

from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.shear.layer_end import EndWall
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import lumps, shape_factors
from tvimdesign.physics.heat_flow.liner import Liner
from tvimdesign.physics.heat_flow.lumps import Link, Lump

quantities = QuantityGroup(shared.group)

LINER, PLATE, BESIDE = ("liner", 0), ("plate", 0), ("beside", 0)


@quantities.helper()
def liner_to_wall(liner_sheet: Liner | None, end_wall: EndWall | None) -> Scalar:
    """From a liner to the walls of its recess [W/m K], without the film around it, by its mean excess over them."""
    if liner_sheet is None or end_wall is None:
        return 0.0
    above = 1.0 - end_wall.layer
    excess = above - 0.5 * end_wall.sheet
    return (
        end_wall.conductivity
        * end_wall.end.rim
        / (excess - shape_factors.AT_WALL * end_wall.end.sheet_colder / end_wall.width)
    )


@quantities.helper()
def liner_rim(
    liner_sheet: Liner | None,
    liner_to_wall: Scalar,
    liner_thickness: Scalar,
    liner_film: Scalar,
    liner_film_conductivity: Scalar,
    liner_depth: Scalar,
    edge_length: Scalar,
    rotor_thickness: Scalar,
    structure_conductivity: Scalar,
    plate_to_edge: Scalar,
    rotor_beside: tuple[Lump, ...],
) -> tuple[Link, ...]:
    """Links from a liner to the plate's edge, which lies between plate and strip beside it; none without a liner."""
    if liner_sheet is None:
        return ()
    film = liner_film_conductivity * liner_thickness / liner_film
    onto = structure_conductivity / shape_factors.constriction(liner_depth / rotor_thickness)
    whole = edge_length * lumps.in_series(liner_to_wall, film, onto)
    beside = rotor_beside[0].conductance / plate_to_edge
    return (Link(LINER, PLATE, (1.0 - beside) * whole), Link(LINER, BESIDE, beside * whole))
