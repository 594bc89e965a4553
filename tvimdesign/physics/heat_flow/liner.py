"""A sheet between polymer and plate, which is bonded to the plate: a few cells that take up heat.

Finite volumes, two halves of a cell in series (Patankar, Numerical Heat Transfer and Fluid Flow, 1980, sec. 4.2).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

CELLS = 3
"""A sheet of 2 mm heats within 2 % of one of 120 cells; one cell is 3 % off."""


class Liner(NamedTuple):
    """A sheet that lies on the polymer and is bonded to the plate."""

    resistance: Any
    """Of the whole sheet [K/W]."""
    bond: Any
    """Resistance of the bond to the plate [K/W]."""
    capacity: Any
    """Heat capacity of the sheet [J/K]."""

    @property
    def whole(self) -> Any:
        """Return the resistance of sheet and bond [K/W]."""
        return self.resistance + self.bond


def flows(liner: Liner, ends: tuple[Any, Any], ways: tuple[Any, Any], cells: Any) -> Any:
    """Return the heat [W] into the sheet, between its cells, and out of it, by the temperatures of these [K].

    `ends` are the temperatures [K] of what lies before and behind it, `ways` the resistances [K/W] of those up to the
    sheet's face and to the bond.
    """
    (before, behind), (to_face, to_bond) = ends, ways
    half = 0.5 * liner.resistance / CELLS
    within = -np.diff(cells) / (2.0 * half)
    into = (before - cells[0]) / (to_face + half)
    return np.append(np.append(into, within), (cells[-1] - behind) / (half + liner.bond + to_bond))


def heating(liner: Liner, through: Any, beside: Any) -> Any:
    """Return the heating of the cells [K/s] by the heat [W] that passes them and what comes to each from `beside`."""
    return (beside - np.diff(through)) / (liner.capacity / CELLS)
