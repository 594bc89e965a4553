"""What a liner gives sideways: through the film around it to the walls of its recess in the rotor plate.

Layer and liner end at one cold wall (`layer_end.end_wall`): the walls of the recess, and below them a lip, if there is
one. The liner's cells give by their own excess over the plate's edge what such a wall takes beside them of an even
fall. The plate is that wall's for a share of its depth (`shape_factors.constriction`).
"""

from __future__ import annotations

from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import lumps, shape_factors
from tvimdesign.physics.heat_flow.lumps import Link

quantities = QuantityGroup(shared.group)

LINER, PLATE, BESIDE = ("liner", 0), ("plate", 0), ("beside", 0)


@quantities.helper()
def liner_to_wall(m: Module) -> Scalar:
    """From a liner to the walls of its recess [W/m K], without the film around it, by its mean excess over them."""
    if m.liner_sheet is None or m.end_wall is None:
        return 0.0
    above = 1.0 - m.end_wall.layer
    excess = above - 0.5 * m.end_wall.sheet
    return (
        m.end_wall.conductivity
        * m.end_wall.end.rim
        / (excess - shape_factors.AT_WALL * m.end_wall.end.sheet_colder / m.end_wall.width)
    )


@quantities.helper()
def liner_rim(m: Module) -> tuple[Link, ...]:
    """Links from a liner to the plate's edge, which lies between plate and strip beside it; none without a liner."""
    if m.liner_sheet is None:
        return ()
    film = m.liner_film_conductivity * m.liner_thickness / m.liner_film
    onto = m.structure_conductivity / shape_factors.constriction(m.liner_depth / m.rotor_thickness)
    whole = m.edge_length * lumps.in_series(m.liner_to_wall, film, onto)
    beside = m.rotor_beside[0].conductance / m.plate_to_edge
    return (Link(LINER, PLATE, (1.0 - beside) * whole), Link(LINER, BESIDE, beside * whole))
