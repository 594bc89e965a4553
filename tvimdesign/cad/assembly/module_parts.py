"""Of which parts the module of each mode is built, how each is drawn, and where they stand."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.kinds import MADE_TURNING, SPRINGS
from tvimdesign.cad.geometry.solids import turned
from tvimdesign.cad.parts import compression_parts, fasteners, fittings, heater_parts, motor_parts, shear_parts

_IN_ALL_MODES = (fittings, fasteners, motor_parts)
"""Each says which of its parts a design has and how they are drawn (`drawn`), and places them (`stand`)."""


@dataclass(frozen=True, kw_only=True)
class ModuleParts:
    """The parts of a mode."""

    made: Mapping[str, Callable[[Dimensions], cq.Shape]]
    """How one of each kind is drawn, by kind: those that every module of the mode has, without screws and springs."""
    stand_heaters: Callable[[Dimensions, Mapping[str, cq.Solid], float], dict[str, cq.Shape]]
    """Places pads, PCL and what belongs to them, the rotor at an angle [rad], by name."""

    def drawn(self, dims: Dimensions) -> dict[str, Callable[[Dimensions], cq.Shape]]:
        """Return how one of each kind is drawn but the springs, of what a design has."""
        kinds = {**self.made, **heater_parts.drawn(dims)}
        for parts in _IN_ALL_MODES:
            kinds |= parts.drawn(dims)
        return kinds

    def kinds(self, dims: Dimensions) -> tuple[str, ...]:
        """Return all kinds of part a design has, springs and all."""
        return (*self.drawn(dims), *SPRINGS)

    def stand(self, dims: Dimensions, drawn: Mapping[str, cq.Solid], rotor_angle: float = 0.0) -> dict[str, cq.Solid]:
        """Place the drawn parts, all but the springs, by name."""
        placed = {"housing": turned(drawn["housing"], 0.0)}
        placed |= {name: turned(drawn[name], rotor_angle) for name in MADE_TURNING}
        for parts in _IN_ALL_MODES:
            placed |= parts.stand(dims, drawn, rotor_angle)
        return placed | self.stand_heaters(dims, drawn, rotor_angle)


MODULES = {
    "shear": ModuleParts(made=shear_parts.DRAWN, stand_heaters=shear_parts.stand),
    "compression": ModuleParts(made=compression_parts.DRAWN, stand_heaters=compression_parts.stand),
}
"""By mode."""
