"""Of which parts the module of each mode is built, how each is drawn, and where they stand."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import cadquery as cq

from tvimdesign.cad import compression, shear
from tvimdesign.cad.dimensions import Dimensions
from tvimdesign.cad.kinds import SPRINGS


@dataclass(frozen=True, kw_only=True)
class Module:
    """The parts of a mode."""

    drawn: Mapping[str, Callable[[Dimensions], cq.Shape]]
    """How one of each kind is drawn, by kind; the springs, which all modes have, are not among them."""
    stand: Callable[[Dimensions, Mapping[str, cq.Solid], float], dict[str, cq.Shape]]
    """Places pads and PCL, the rotor at an angle [rad], by name."""
    fixed: tuple[str, ...]
    """Kinds that neither turn nor change their shape."""

    @property
    def kinds(self) -> tuple[str, ...]:
        """All kinds of part, springs and all."""
        return (*self.drawn, *SPRINGS)


MODULES = {
    "shear": Module(drawn=shear.DRAWN, stand=shear.stand, fixed=shear.FIXED),
    "compression": Module(drawn=compression.DRAWN, stand=compression.stand, fixed=compression.FIXED),
}
"""By mode."""
