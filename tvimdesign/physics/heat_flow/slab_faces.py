"""Faces of a slab that is one body: what heat through one face, or a part of it, makes of another's temperature.

By separation of variables (Carslaw and Jaeger, Conduction of Heat in Solids, ch. V) and Fourier's parabola of a slab
that is heated evenly (ch. III).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tvimdesign.physics.heat_flow.lumps import Link, Place, Surface, surface_coefficient
from tvimdesign.physics.heat_flow.shape_factors import ZETA_3

AMBIENT = ("ambient", 0)
ACROSS = 1.0 / 6.0
"""Drop of a slab's face below its mean for heat that comes in by the other, over that heat times depth over
conductivity."""


def ledge_across(slenderness: Any) -> Any:
    """Return how much colder than its mean a ledge's lower face is for heat that comes in evenly by its upper one.

    Over heat over k and length, as `shape_factors.ledge_ways`: the sum of those terms with alternating signs,

        1/(6 r) - (3/4 zeta(3) - sum (-1)^(n + 1) exp(-2 n pi r)/n^3)/(pi^3 r^2).
    """
    falling = sum((-1.0) ** (n + 1) * np.exp(-2.0 * n * np.pi * slenderness) / n**3 for n in (1, 2, 3))
    return 1.0 / (6.0 * slenderness) - (0.75 * ZETA_3 - falling) / (np.pi**3 * slenderness**2)


def through_faces(
    above: Place, body: Place, surface: Surface, ambient: Any, onto: Any, across: Any
) -> tuple[Link, Link, Link]:
    """Return the links of a body that is heated over its upper face and loses heat over its lower one, a `surface` of
    its own.

    `onto` leads from what is above to its mean [K/W]. The lower face is colder by `across` [K/W] for what comes in
    above, and the upper one warmer by as much for what leaves below:

        T_above - T = onto q + across p,    p = U (T - across q - T_ambient),

    U the surface's conductance near ambient temperature. Star to mesh; beside the surface's own loss there are links to
    the air, of which one from above that lies below zero.
    """
    outside = surface.area * surface_coefficient(surface, ambient, ambient)
    crossed = across * outside
    whole = onto - across * crossed
    return (
        Link(above, body, (1.0 + crossed) / whole),
        Link(above, AMBIENT, -crossed / whole),
        Link(body, AMBIENT, (1.0 + crossed) * crossed / whole),
    )


def beyond_constriction(share: Any, begin: Any, width: Any) -> Any:
    """Return how much warmer than its mean over the height that slab is at that side, from a place on over a width.

    Lengths over the slab's height, heat over k and length: the heated share's field is the sum of
    2 sin(n pi f)/((n pi)^2 f) exp(-n pi x) cos(n pi y).
    """
    total = 0.0
    for n in range(1, 9):
        falls = n * np.pi * width + 1e-9
        mean = np.exp(-n * np.pi * begin) * (1.0 - np.exp(-falls)) / falls
        total = total + 2.0 * np.sin(n * np.pi * share) / ((n * np.pi) ** 2 * share) * mean
    return total
