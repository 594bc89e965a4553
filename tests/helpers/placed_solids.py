"""Solids of a module's parts where they stand, for tests of what is between them."""

from collections.abc import Iterable

import cadquery as cq

from tvimdesign.cad.assembly.assembly import MODULES, drawn_part
from tvimdesign.cad.geometry.dimensions import Dimensions


def placed_solids(dims: Dimensions, kinds: Iterable[str]) -> dict[str, cq.Solid]:
    """Housing and pads, layer and what goes with them, of kinds of parts that are drawn, by the name of each."""
    drawn = {kind: drawn_part(dims, kind) for kind in kinds}
    standing = MODULES[dims.mode].stand_heaters(dims, drawn, 0.0)
    return {"housing": drawn["housing"], **{name: shape.Solids()[0] for name, shape in standing.items()}}
