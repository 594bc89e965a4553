"""What the rotor plate passes along the ring above blocks, pads and vanes, and from there inwards and outwards."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.compression.ring_heat import ABOVE, ABOVE_PADS, ABOVE_VANES, ABOVE_WALLS, RIM, WITHIN
from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import lumps
from tvimdesign.physics.heat_flow.lip import Lip
from tvimdesign.physics.heat_flow.lumps import STRIP, WAYS, Body, Link, Place

quantities = QuantityGroup(shared.group)


@quantities.helper()
def shares_above(m: Module) -> tuple[tuple[Place, Scalar], ...]:
    """Bodies of the rotor plate above the ring, and each one's share of it."""
    ring = m.heated_length + m.plate_depth + m.wall_depth
    heated = [(("beside", i), share * m.heated_length / ring) for i, share in zip(ABOVE, STRIP, strict=True)]
    walls = [(("around", i), share * m.wall_depth / ring) for i, share in zip(ABOVE_WALLS, STRIP, strict=True)]
    return (("beside", ABOVE_VANES), m.plate_depth / ring), *heated, *walls


@quantities.helper()
def plate_links(m: Module) -> tuple[Link, ...]:
    """From the rotor plate above the rotor's vanes to what is beside it, but its lowest tenth, which is next in the
    chain; and to the core from all but the upper one above blocks and pads, after which the core is next."""
    to_heated = m.structure_conductivity * m.rotor_thickness * m.ring_width * m.ways_along[0]
    vanes, core = ("beside", ABOVE_VANES), ("beside", ABOVE[-1] + 1)
    along = [Link(vanes, ("beside", i), share * to_heated) for i, share in zip(ABOVE[1:], STRIP[1:], strict=True)]
    inwards = [
        Link(place, core, share * m.core_and_link.conductance)
        for place, share in m.shares_above
        if place != ("beside", ABOVE[-1])
    ]
    upwards = m.structure_conductivity * m.ring_width * m.pads_share * m.heated_length / (WAYS[1] * m.rotor_thickness)
    beyond = m.structure_conductivity * m.rotor_thickness * m.ring_width / m.wall_depth
    walls = [
        Link(("around", i - 1), ("around", i), beyond / way) for i, way in zip(ABOVE_WALLS[1:], WAYS[1:], strict=True)
    ]
    return (*along, *inwards, *walls, Link(("around", ABOVE_PADS), ("beside", ABOVE[1]), upwards))


@quantities.helper()
def core_share(m: Module) -> Scalar:
    """What of the conductance to the core begins at the last body of the rotor plate."""
    return dict(m.shares_above)["beside", ABOVE[-1]]


@quantities.helper()
def plate_losses(m: Module) -> tuple[lumps.Loss, ...]:
    """From the rotor plate above blocks and pads to what is above the housing's vanes, and from all of it above the
    ring to what is without and within; and the air there.

    What ends free has its mean temperature a third of the way to its end.
    """
    sheet = m.structure_conductivity * m.rotor_thickness * m.ring_width
    along = sheet / (0.25 * m.heated_length + WAYS[0] * m.wall_depth)
    walls = [m.around_pads[i].surface for i in ABOVE_WALLS]
    air = sum(one.area * lumps.surface_coefficient(one, m.ambient_temperature, m.ambient_temperature) for one in walls)
    onward = lumps.in_series(sheet / ((1.0 / 3.0 - WAYS[0]) * m.wall_depth), air)
    found = [
        lumps.Loss(Link(("beside", i), ("around", ABOVE_WALLS[0]), share * along), share * onward)
        for i, share in zip(ABOVE, STRIP, strict=True)
    ]
    around = 2.0 * np.pi * m.structure_conductivity * m.rotor_thickness
    without = around / np.log(1.0 + (m.rotor_radius - m.pcl_outer_radius) / (3.0 * m.pcl_outer_radius))
    within = -around / np.log(1.0 - (m.pcl_inner_radius - m.core_radius) / (3.0 * m.pcl_inner_radius))
    for beyond, conductance in ((RIM, without), (WITHIN, within)):
        for place, share in m.shares_above:
            link = Link(place, ("around", beyond), share * conductance)
            found.append(_onward(link, m.around_pads, m.ambient_temperature, share))
    return tuple(found)


@quantities.helper()
def loss_links(m: Module) -> tuple[Link, ...]:
    """What passes heat from the plate to bodies around it."""
    return tuple(loss.link for loss in m.plate_losses)


@quantities.helper()
def lip(_: Module) -> Lip | None:
    """No lip stands at a block."""
    return None


def _onward(link: Link, bodies: tuple[Body, ...], ambient: Scalar, share: Scalar) -> lumps.Loss:
    """A link to a body that loses a share of its heat to the air behind it."""
    surface = bodies[link.second[1]].surface
    return lumps.Loss(link, share * surface.area * lumps.surface_coefficient(surface, ambient, ambient))
