"""Data of the stack that the heat equation needs, and its profile at one instant.

A liner is a sheet between polymer and plate, bonded to the plate: finite volumes, two halves of a cell in series
(Patankar, Numerical Heat Transfer and Fluid Flow, 1980, sec. 4.2)."""

from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.heat_flow import peltier
from tvimdesign.physics.heat_flow.layer_end import Lip, WarmLip
from tvimdesign.physics.heat_flow.lumps import Body, Link, Lump, Place, Surface
from tvimdesign.physics.polymers import polymer, transitions


class Stack(NamedTuple):
    """Everything the heat equation needs to know of the stack."""

    area: Any  # Area the heat passes [m^2], the same for all layers
    thickness: Any  # Thickness of the polymer [m]
    density: Any
    conductivity_solid: Any
    conductivity_melt: Any
    melting: polymer.Melting
    peltier: peltier.PeltierModule
    cold_capacity: Any  # Heat capacity of the cold side [J/K], without the legs'
    hot_capacity: Any
    cold_surface: Surface  # Surface of the cold side towards the air; not used where there is a sink
    hot_contact: Any  # Conductance of the contact with the polymer [W/m^2 K], of the hot side or of the spreader on it
    plate_contact: Any
    plate_thickness: Any
    plate_conductivity: Any
    plate_heat_capacity: Any  # Per volume [J/m^3 K]
    plate_surface: Surface  # The plate's outer face; its area is the stack's
    ambient: Any  # [K]
    plate_cells: int
    beside: tuple[Lump, ...] = ()
    """Bodies that the plate belongs to: the first takes heat from all the plate's cells, each next from the one before.
    """
    uneven_conductance: Any = None
    """Conductance [W/K] sideways for what the plate's temperature differs over its depth from its mean; as for the mean
    where not given."""
    legs_capacity: Any = None  # Heat capacity of what is between the pads' sides [J/K]; without, heat passes it at once
    sink: Lump | None = None  # A body between the cold side and the air
    around: tuple[Body, ...] = ()  # Bodies that the pads are set in
    links: tuple[Link, ...] = ()  # Other links between the column and the bodies beside and around it
    motion_heat: Any = 0.0  # Heat that the joint's motion makes in each polymer cell [W]
    layer_resistance: Any = 0.0
    """Of the polymer, where the heater's current passes it [ohm]; its heat is the same in each cell."""
    freezing: transitions.Kinetics | None = None
    """Kinetics of freezing; without them the equilibrium melting curve holds."""
    liner: "Liner | None" = None  # A sheet between polymer and plate; `plate_contact` is then that of polymer and sheet
    lip: Lip | None = None  # A lip of the plate at the layer's edge
    lip_temperatures: tuple[Any, Any] | None = None
    """Of the lip [K], where they are unknowns beside the state; see `warm_lip`."""
    spreader: Lump | None = None  # A plate between the pads' hot side and the polymer; its `surface` is not used


class Profile(NamedTuple):
    """Temperatures [K] through the stack at one instant, and the solid fraction of each polymer cell."""

    cold: Any
    hot: Any
    spreader: Any  # Spreader on the hot side, or that side itself
    near: Any  # Polymer's face towards the Peltier element
    cells: Any
    far: Any  # Polymer's face towards the plate
    plate_face: Any  # Plate's face towards the polymer
    plate: Any
    beside: Any  # Lumps beside the plate
    sink: Any  # The sink, if there is one
    around: Any  # Lumps around the pads
    legs: Any  # Middle of the pads' legs, where they have a heat capacity
    liner: Any  # Cells of the sheet between polymer and plate, if there is one
    fractions: Any
    through_layer: Any  # Heat [W] into the first polymer cell, between the cells, and out of the last
    through_liner: Any  # Heat [W] into the sheet's first cell, between its cells, and out of the last
    through_plate: Any  # Heat [W] into the first plate cell, between the cells, and out to the air
    lip: WarmLip | None = None  # The plate's lip, if there is one

    def at(self, place: Place) -> Any:
        """Return the temperature [K] of a place that a link may end at; of the legs that of their middle."""
        group, index = place
        if group in ("layer", "plate"):
            return np.mean(self.cells if group == "layer" else self.plate)
        if group in ("cold", "hot", "spreader"):
            return getattr(self, group)
        return (self.plate if group == "face" else getattr(self, group))[index]


LINER_CELLS = 3  # A sheet of 2 mm heats within 2 % of one of 120 cells; one cell is 3 % off


class Liner(NamedTuple):
    """A sheet that lies on the polymer and is bonded to the plate."""

    resistance: Any  # Of the whole sheet [K/W]
    bond: Any  # Resistance of the bond to the plate [K/W]
    capacity: Any  # Heat capacity of the sheet [J/K]

    @property
    def whole(self) -> Any:
        """Return the resistance of sheet and bond [K/W]."""
        return self.resistance + self.bond


def liner_flows(liner: Liner, ends: tuple[Any, Any], ways: tuple[Any, Any], cells: Any) -> Any:
    """Return the heat [W] into the sheet, between its cells, and out of it, by the temperatures of these [K].

    `ends` are the temperatures [K] of what lies before and behind it, `ways` the resistances [K/W] of those up to the
    sheet's face and to the bond.
    """
    (before, behind), (to_face, to_bond) = ends, ways
    half = 0.5 * liner.resistance / LINER_CELLS
    within = -np.diff(cells) / (2.0 * half)
    into = (before - cells[0]) / (to_face + half)
    return np.append(np.append(into, within), (cells[-1] - behind) / (half + liner.bond + to_bond))


def liner_heating(liner: Liner, through: Any, beside: Any) -> Any:
    """Return the heating of the cells [K/s] by the heat [W] that passes them and what comes to each from `beside`."""
    return (beside - np.diff(through)) / (liner.capacity / LINER_CELLS)
