"""Draw the parts of a design and measure them."""

from __future__ import annotations

from collections import Counter

import tvimdesign
from oracle.compare import Value

VOLUME_TOLERANCE = 1e-5
"""How much a volume or an area may differ, relative: the kernel sweeps the wire of a spring no better."""


def part_volumes(design: tvimdesign.Design) -> dict[str, Value]:
    """Return count, volume [mm^3] and area [mm^2] of all parts of each kind, placed at rest.

    Raises
    ------
    GeometryError
        If a part cannot be built.
    """
    from tvimdesign.cad.assembly.assembly import MODULES, drawn_part, place
    from tvimdesign.cad.geometry.dimensions import dimensions
    from tvimdesign.cad.geometry.kinds import kind_of

    dims = dimensions(design)
    drawn = {kind: drawn_part(dims, kind) for kind in MODULES[design.mode].drawn(dims)}
    volumes: Counter[str] = Counter()
    for name, solid in place(dims, drawn).items():
        kind = kind_of(name)
        volumes[f"count:{kind}"] += 1
        volumes[f"volume:{kind}"] += solid.Volume()
        volumes[f"area:{kind}"] += solid.Area()
    return {name: float(value) for name, value in volumes.items()}
