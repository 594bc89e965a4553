"""A picture of the module: the whole beside a view into it, with the names of the colours. Needs no display."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import cadquery as cq
import numpy as np
from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer

from tvimdesign.cad.assembly.module_parts import MODULES
from tvimdesign.cad.export.mesh import Instance
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.kinds import KINDS, kind_of
from tvimdesign.cad.render.camera import look, renderer_on_white
from tvimdesign.cad.render.cut import Cutter, without
from tvimdesign.cad.render.render import actors, legend, legend_height, write_png

_SIZE = (1800, 800)
_FROM = (1.0, -1.35, 1.25)
_CUT = ("housing", "rotor")
_HIDDEN = ("link", "link_dowel", "cover", "cover_screw")


def write_preview(path: Path, dims: Dimensions, drawn: Mapping[str, cq.Solid], placed: Mapping[str, Instance]) -> None:
    """Write the picture as PNG, whole or not at all."""
    opened = {name: instance for name, instance in placed.items() if kind_of(name) not in _HIDDEN}
    size = 2.0 * dims.envelope_diameter + dims.envelope_height
    quarter = Cutter([(0.0, -size), (size, -size), (size, 0.0), (0.0, 0.0)], -size, size)  # faces the camera
    for name in _CUT:
        opened[name] = Instance(without(name, placed[name], quarter, drawn[name]), np.eye(4))
    kinds = MODULES[dims.mode].kinds(dims)
    views = []
    below = legend_height(kinds, _SIZE)
    aspect = _SIZE[1] * (1.0 - below) / (0.5 * _SIZE[0])
    whole = {name: _actors(name, instance) for name, instance in placed.items()}
    cut = {name: _actors(name, opened[name]) if name in _CUT else whole[name] for name in opened}
    for left, right, shown, drawings in ((0.0, 0.5, placed, whole), (0.5, 1.0, opened, cut)):
        renderer = _view(shown, drawings, aspect)
        renderer.SetViewport(left, below, right, 1.0)
        views.append(renderer)
    write_png(path, _SIZE, [*views, legend(kinds, _SIZE)])


def _actors(name: str, instance: Instance) -> tuple[vtkActor, vtkActor]:
    return actors(instance.mesh, instance.matrix, KINDS[kind_of(name)].colour)


def _view(
    placed: Mapping[str, Instance], drawings: Mapping[str, tuple[vtkActor, vtkActor]], aspect: float
) -> vtkRenderer:
    """Everything that is placed, seen from the front, above and the right."""
    renderer = renderer_on_white()
    for name in placed:
        for actor in drawings[name]:
            renderer.AddActor(actor)
    look(renderer, placed, _FROM, aspect)
    return renderer
