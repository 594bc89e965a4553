"""A strip that is heated along its edge, as three bodies in a row."""

from __future__ import annotations

from typing import Any

from tvimdesign.physics.heat_flow.lumps import Lump, Surface, surface_coefficient

STRIP, WAYS = (0.087, 0.247, 0.666), (0.029, 0.153, 0.395)
"""Three bodies in place of a strip that is heated at its edge: from that edge on their shares of it, and the way from
what comes before to each, as shares of its width.

With these a strip takes as much heat from an edge that warms up evenly as the heat equation says, within 0.6 % from a
hundredth of w^2/alpha on. Bodies with their means in their middles take 5 to 15 % too little until that time is over.
"""
BEYOND = 1.0 - sum(WAYS)
"""Way from the last of them to the strip's other edge; a steady flow has the whole width before it."""
AT_END = 1.0 - 0.5 * STRIP[-1] / BEYOND
"""Share of the way from the last of them to that edge at which their share of the strip has its mean temperature while
heat flows on steadily."""


def bodies(area: Any, heat_capacity: Any, across: Any, surface: Surface) -> tuple[Lump, ...]:
    """A strip heated along its edge, in three bodies in a row from the edge on.

    Its area [m^2], its heat capacity per area [J/m^2 K], k t L/w [W/K], which conducts across its whole width, and
    what it loses to the air, for an area of one. The first body's conductance is from the edge itself.
    """
    return tuple(
        Lump(across / way, share * area * heat_capacity, surface._replace(area=share * area * surface.area))
        for share, way in zip(STRIP, WAYS, strict=True)
    )


def end(surface: Surface, along: Any, onward: Any, ambient: Any) -> tuple[Surface, Any, Any]:
    """Surface of a strip's last body, its conductance [W/K] to what takes heat at the strip's end, and surface [m^2]
    that counts there.

    `along` is the conductance from the body to the end, `onward` from there. The body's part of the strip is colder
    than the body while heat flows on, by `AT_END` of what the end is: that share of its surface is at the end, which
    has a temperature between body and onward (star to delta).
    """
    at_end = AT_END * surface.area
    total = along + onward + at_end * surface_coefficient(surface, ambient, ambient)
    own = surface.area - at_end * (1.0 - along / total)
    return surface._replace(area=own), along * onward / total, at_end * onward / total
