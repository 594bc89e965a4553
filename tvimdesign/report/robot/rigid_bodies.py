"""The two rigid bodies of a joint, as the CAD process makes them of the solids."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from tvimdesign.cad.cad_report import CadReport
from tvimdesign.cad.jobs.bodies_main import BASE, BODIES, MESHES, MOVING
from tvimdesign.cad.make import make_cad

"""Seconds after which the CAD process is given up."""


@dataclass(frozen=True)
class RigidBody:
    """What a simulator is told of a body, in the module's coordinates: the rotor's axis is z."""

    name: str
    mass: float
    """[kg]."""
    centre: tuple[float, float, float]
    """Centre of mass [m]."""
    inertia: tuple[tuple[float, float, float], ...]
    """Tensor about the centre of mass [kg*m^2], three rows."""
    mesh: str
    """File in metres, relative to the folder of the model."""

    def about_axis(self) -> float:
        """Moment of inertia about the rotor's axis [kg*m^2], by the parallel axes."""
        return self.inertia[2][2] + self.mass * (self.centre[0] ** 2 + self.centre[1] ** 2)


def make_bodies(
    design: Path, folder: Path, progress: Callable[[str], None] | None = None
) -> tuple[RigidBody, RigidBody, CadReport]:
    """Make what stands and what turns of a design.json, with their meshes in the folder. Raises GeometryError."""
    report = make_cad(design, folder, progress, job="tvimdesign.cad.jobs.bodies_main")
    data = json.loads((folder / BODIES).read_text())
    base, moving = (
        RigidBody(
            name=name,
            mass=data[name]["mass"],
            centre=tuple(data[name]["centre"]),
            inertia=tuple(tuple(row) for row in data[name]["inertia"]),
            mesh=f"{MESHES}/{name}.stl",
        )
        for name in (BASE, MOVING)
    )
    return base, moving, report
