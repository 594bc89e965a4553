"""Of which parts the module of each mode is built, how each is drawn, and where they stand."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import cadquery as cq

from tvimdesign.cad import adjuster, bought, compression, cover, drive, inserts, shear
from tvimdesign.cad.dimensions import Dimensions
from tvimdesign.cad.kinds import SPRINGS


@dataclass(frozen=True, kw_only=True)
class Module:
    """The parts of a mode."""

    made: Mapping[str, Callable[[Dimensions], cq.Shape]]
    """How one of each kind is drawn, by kind; without springs and what is bought, which all modes have."""
    stand: Callable[[Dimensions, Mapping[str, cq.Solid], float], dict[str, cq.Shape]]
    """Places pads and PCL, the rotor at an angle [rad], by name."""
    fixed: tuple[str, ...]
    """Kinds that neither turn nor change their shape."""

    def drawn(self, dims: Dimensions) -> dict[str, Callable[[Dimensions], cq.Shape]]:
        """How one of each kind is drawn but the springs, of what a design has."""
        adjusters = {"adjuster": adjuster.adjuster, "adjuster_screw": adjuster.adjuster_screw}
        return {
            **self.made,
            **bought.drawn(dims),
            **(adjusters if dims.adjuster_radius else {}),
            **(cover.DRAWN if dims.cover_height else {}),
            **inserts.drawn(dims),
            **drive.drawn(dims),
        }

    def kinds(self, dims: Dimensions) -> tuple[str, ...]:
        """All kinds of part a design has, springs and all."""
        return (*self.drawn(dims), *SPRINGS)


MODULES = {
    "shear": Module(made=shear.DRAWN, stand=shear.stand, fixed=(*shear.FIXED, *drive.FIXED)),
    "compression": Module(made=compression.DRAWN, stand=compression.stand, fixed=(*compression.FIXED, *drive.FIXED)),
}
"""By mode."""
