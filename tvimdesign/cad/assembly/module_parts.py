"""Of which parts the module of each mode is built, how each is drawn, and where they stand."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.kinds import SPRINGS
from tvimdesign.cad.parts import (
    adjuster_parts,
    compression_parts,
    cover_parts,
    cutout_parts,
    dowel_parts,
    insert_parts,
    liner_parts,
    motor_parts,
    purchased_parts,
    shear_parts,
    thermistor_parts,
    tile_parts,
    vane_tile_parts,
)


@dataclass(frozen=True, kw_only=True)
class ModuleParts:
    """The parts of a mode."""

    made: Mapping[str, Callable[[Dimensions], cq.Shape]]
    """How one of each kind is drawn, by kind; without springs and what is bought, which all modes have."""
    spreaders: Mapping[str, Callable[[Dimensions], cq.Shape]]
    """How one of what lies on rigid Peltier modules is drawn, by kind."""
    stand: Callable[[Dimensions, Mapping[str, cq.Solid], float], dict[str, cq.Shape]]
    """Places pads and PCL, the rotor at an angle [rad], by name."""
    fixed: tuple[str, ...]
    """Kinds that neither turn nor change their shape."""

    def drawn(self, dims: Dimensions) -> dict[str, Callable[[Dimensions], cq.Shape]]:
        """How one of each kind is drawn but the springs, of what a design has."""
        adjusters = {"adjuster": adjuster_parts.adjuster, "adjuster_screw": adjuster_parts.adjuster_screw}
        return {
            **self.made,
            **(self.spreaders if dims.spreader_depth else {}),
            **thermistor_parts.drawn(dims),
            **liner_parts.drawn(dims),
            **cutout_parts.drawn(dims),
            **purchased_parts.drawn(dims),
            **(adjusters if dims.adjuster_radius else {}),
            **(cover_parts.DRAWN if dims.cover_height else {}),
            **insert_parts.drawn(dims),
            **dowel_parts.drawn(dims),
            **motor_parts.drawn(dims),
        }

    def kinds(self, dims: Dimensions) -> tuple[str, ...]:
        """All kinds of part a design has, springs and all."""
        return (*self.drawn(dims), *SPRINGS)


MODULES = {
    "shear": ModuleParts(
        made=shear_parts.DRAWN,
        spreaders=tile_parts.DRAWN,
        stand=shear_parts.stand,
        fixed=(*shear_parts.FIXED, *motor_parts.FIXED),
    ),
    "compression": ModuleParts(
        made=compression_parts.DRAWN,
        spreaders=vane_tile_parts.DRAWN,
        stand=compression_parts.stand,
        fixed=(*compression_parts.FIXED, *motor_parts.FIXED),
    ),
}
"""By mode."""
