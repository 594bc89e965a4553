"""Mass, centre of mass and inertia of solids, of each alone and of several together."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import cadquery as cq
import numpy as np
from numpy.typing import NDArray
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps

Array = NDArray[np.float64]
_MM, _MM3, _MM5 = 1e-3, 1e-9, 1e-15


@dataclass(frozen=True)
class MassProperties:
    """What a rigid body weighs, in the module's coordinates."""

    mass: float
    """[kg]."""
    centre: Array
    """Centre of mass [m]."""
    inertia: Array
    """Tensor of inertia about the centre of mass [kg*m^2], 3 x 3; off the diagonal it is -integral of x y dm."""

    def plain(self) -> dict[str, object]:
        """All of it, for a JSON file."""
        return {"mass": self.mass, "centre": self.centre.tolist(), "inertia": self.inertia.tolist()}


def of_solid(solid: cq.Solid, density: float) -> MassProperties:
    """Mass properties of a solid drawn in mm, of a density [kg/m^3]; the kernel integrates over its faces."""
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(solid.wrapped, properties)
    centre, tensor = properties.CentreOfMass(), properties.MatrixOfInertia()
    inertia = np.array([[tensor.Value(row, column) for column in (1, 2, 3)] for row in (1, 2, 3)])
    return MassProperties(
        mass=properties.Mass() * _MM3 * density,
        centre=np.array([centre.X(), centre.Y(), centre.Z()]) * _MM,
        inertia=inertia * _MM5 * density,
    )


def together(bodies: Iterable[MassProperties]) -> MassProperties:
    """Several bodies as one: I = sum of I_i + m_i (r^2 1 - r r^T), r from the common centre (parallel axes)."""
    parts = list(bodies)
    mass = sum(part.mass for part in parts)
    centre = np.asarray(sum(part.mass * part.centre for part in parts)) / mass
    inertia = np.zeros((3, 3))
    for part in parts:
        off = part.centre - centre
        inertia += part.inertia + part.mass * (off @ off * np.eye(3) - np.outer(off, off))
    return MassProperties(mass, centre, inertia)
