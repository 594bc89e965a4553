"""The fork that holds the rotor at rest while its springs are set: a module needs two.

Its legs fill the ways between a tooth of the rotor and its two stops, and a bridge over the tooth joins them. It goes
in and out from above, so that both hands and the lower side are free for the springs' screws.
"""

from __future__ import annotations

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.kinds import Production
from tvimdesign.cad.geometry.solids import join, sector, turned
from tvimdesign.device.components.hard_stops import STOPS

FORK = "setting_fork"
COUNT = STOPS
BRIDGE = 3.0
"""Thickness of the bridge [mm], by which fingers lift it; assumed, 2 to 6."""
MAKING = Production(down="top", why="the bridge on the bed: legs grow upwards, no support")


def fork(dims: Dimensions) -> cq.Shape:
    """Draw the fork where it stands, over a tooth on the x axis."""
    inner, outer, top = dims.stop_inner_radius, dims.stop_outer_radius, dims.rotor_top_level
    play = dims.slip_clearance / dims.stop_contact_radius
    leg = sector(inner, outer, dims.stop_angle - play, dims.slip_clearance, top)
    beside = 0.5 * (dims.stop_tooth_span + dims.stop_angle)
    bridge = sector(inner, outer, dims.stop_tooth_span + 2.0 * dims.stop_angle - play, top, top + BRIDGE)
    return join(bridge, [turned(leg, side * beside) for side in (1.0, -1.0)])
