"""A picture of the module: the whole beside a view into it, with the names of the colours. Needs no display."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import cadquery as cq
import numpy as np
from vtkmodules.vtkRenderingCore import vtkRenderer

from tvimdesign.cad.assembly.module_parts import MODULES
from tvimdesign.cad.export.mesh import Instance, solid_mesh
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.kinds import KINDS, kind_of
from tvimdesign.cad.render.render import actors, legend, legend_height, lit, write_png

_SIZE = (1800, 800)
_CUT = ("housing", "rotor")
_HIDDEN = ("link", "link_dowel", "cover", "cover_screw")


def write_preview(path: Path, dims: Dimensions, drawn: Mapping[str, cq.Solid], placed: Mapping[str, Instance]) -> None:
    """Write the picture as PNG, whole or not at all."""
    opened = {name: instance for name, instance in placed.items() if kind_of(name) not in _HIDDEN}
    for name in _CUT:
        opened[name] = Instance(solid_mesh(_without_quarter(drawn[name], dims)), np.eye(4))
    kinds = MODULES[dims.mode].kinds(dims)
    views = []
    for left, right, shown in ((0.0, 0.5, placed), (0.5, 1.0, opened)):
        renderer = _view(shown, dims)
        renderer.SetViewport(left, legend_height(kinds, _SIZE), right, 1.0)
        views.append(renderer)
    write_png(path, _SIZE, [*views, legend(kinds, _SIZE)])


def _without_quarter(solid: cq.Solid, dims: Dimensions) -> cq.Solid:
    """The part without the quarter that faces the camera."""
    size = 2.0 * dims.envelope_diameter + dims.envelope_height
    return solid.cut(cq.Solid.makeBox(size, size, 2.0 * size, cq.Vector(0, -size, -size)))


def _view(placed: Mapping[str, Instance], dims: Dimensions) -> vtkRenderer:
    """Everything that is placed, seen from the front, above and the right."""
    renderer = vtkRenderer()
    renderer.SetBackground(1.0, 1.0, 1.0)
    for name, instance in placed.items():
        for actor in actors(instance.mesh, instance.matrix, KINDS[kind_of(name)].colour):
            renderer.AddActor(actor)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(0.0, 0.0, 0.0)
    camera.SetPosition(1.0, -1.35, 1.25)
    camera.SetViewUp(0.0, 0.0, 1.0)
    renderer.ResetCamera()
    middle = 0.5 * (
        dims.link_bottom_level + dims.link_thickness - dims.floor_thickness - dims.foot_height - dims.drive_height
    )
    towards = np.array(camera.GetPosition()) - np.array(camera.GetFocalPoint())
    camera.SetFocalPoint(0.0, 0.0, middle)
    camera.SetPosition(towards[0], towards[1], towards[2] + middle)
    camera.SetParallelScale(0.5 * dims.envelope_diameter + 0.3 * dims.drive_height)
    lit(renderer)
    return renderer
