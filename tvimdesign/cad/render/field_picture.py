"""A picture of a field on a surface in colours, its shape bent as it is loaded, with a scale. Needs no display."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

from tvimdesign.cad.export.mesh import Array, Instance, Mesh
from tvimdesign.cad.render.render import look, poly_data, renderer_on_white, write_png

_SIZE = (1400, 1000)
_FROM = (1.0, -1.35, 0.9)
_TOP_QUANTILE = 0.999
"""Share of the corners within the scale: at a sharp one the stress has no largest value."""
_BODY = 0.82
"""Share of the picture's width that the body has; the rest is the scale's."""
_LARGEST_WAY = 0.06
"""How far the farthest corner is drawn to move, in sizes of the body."""


def write_field_picture(path: Path, points: Array, triangles: Any, values: Array, ways: Array, title: str) -> None:
    """Write the picture as PNG; `values` and `ways` are those of the points, shapes (n,) and (n, 3), in mm."""
    size, farthest = float(np.ptp(points, axis=0).max()), float(np.linalg.norm(ways, axis=1).max())
    bent = points + ways * (_LARGEST_WAY * size / farthest if farthest else 0.0)
    mesh = Mesh(bent, triangles)
    data = poly_data(mesh, np.eye(4))
    data.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(values), deep=True))
    colours = vtkLookupTable()
    colours.SetHueRange(0.62, 0.0)
    colours.SetRange(0.0, float(np.quantile(values, _TOP_QUANTILE)))
    colours.Build()
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.SetLookupTable(colours)
    mapper.UseLookupTableScalarRangeOn()
    surface = vtkActor()
    surface.SetMapper(mapper)
    surface.GetProperty().SetAmbient(0.35)
    renderer = renderer_on_white()
    renderer.AddActor(surface)
    renderer.SetViewport(0.0, 0.0, _BODY, 1.0)
    look(renderer, {"": Instance(mesh, np.eye(4))}, _FROM, _SIZE[1] / (_BODY * _SIZE[0]))
    beside = renderer_on_white()
    beside.SetViewport(_BODY, 0.0, 1.0, 1.0)
    beside.AddViewProp(_scale(colours, title))
    write_png(path, _SIZE, [renderer, beside])


def _scale(colours: vtkLookupTable, title: str) -> vtkScalarBarActor:
    bar = vtkScalarBarActor()
    bar.SetLookupTable(colours)
    bar.SetTitle(title)
    bar.SetNumberOfLabels(5)
    bar.SetLabelFormat("%.3g")
    bar.SetPosition(0.05, 0.1)
    bar.SetWidth(0.9)
    bar.SetHeight(0.8)
    bar.SetBarRatio(0.25)
    bar.UnconstrainedFontSizeOn()
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(0.1, 0.1, 0.1)
        text.SetFontSize(20)
        text.ItalicOff()
        text.ShadowOff()
        text.BoldOff()
    return bar
