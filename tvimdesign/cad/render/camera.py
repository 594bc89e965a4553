"""The camera: it looks at all there is from a direction, and what it sees is written with the names of the colours."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from vtkmodules.vtkRenderingCore import vtkRenderer

from tvimdesign.cad.export.mesh import Instance
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.cad.render.render import legend, legend_height, lit, write_png

Triple = tuple[float, float, float]
_MARGIN = 1.06
"""Picture over what is on it."""


def renderer_on_white() -> vtkRenderer:
    """An empty picture."""
    renderer = vtkRenderer()
    renderer.SetBackground(1.0, 1.0, 1.0)
    return renderer


def write_view(
    path: Path, renderer: vtkRenderer, placed: Mapping[str, Instance], from_here: Triple, size: tuple[int, int]
) -> None:
    """Write what is seen of placed parts from a direction, with the legend of their kinds, whole or not at all."""
    kinds = list(dict.fromkeys(kind_of(name) for name in placed))
    below = legend_height(kinds, size)
    renderer.SetViewport(0.0, below, 1.0, 1.0)
    look(renderer, placed, from_here, size[1] * (1.0 - below) / size[0])
    write_png(path, size, [renderer, legend(kinds, size)])


def look(renderer: vtkRenderer, placed: Mapping[str, Instance], from_here: Triple, aspect: float) -> None:
    """Look at placed parts from a direction; `aspect` is height over width of what they are drawn on."""
    towards = np.array(from_here) / np.linalg.norm(from_here)
    right = np.cross((0.0, 0.0, 1.0), towards)
    right /= np.linalg.norm(right)
    upward = np.cross(towards, right)
    points = np.vstack([one.points() for one in placed.values()])
    across, along = points @ right, points @ upward
    middle = 0.5 * ((across.min() + across.max()) * right + (along.min() + along.max()) * upward)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*middle)
    camera.SetPosition(*(middle + towards))
    camera.SetViewUp(0.0, 0.0, 1.0)
    renderer.ResetCamera()
    offset = middle - np.array(camera.GetFocalPoint())  # ResetCamera looks at the middle of a box around all
    camera.SetFocalPoint(*middle)
    camera.SetPosition(*(np.array(camera.GetPosition()) + offset))
    camera.SetParallelScale(0.5 * _MARGIN * max(float(np.ptp(along)), float(np.ptp(across)) * aspect))
    renderer.UseFXAAOn()
    lit(renderer)
