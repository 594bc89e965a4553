"""A picture of the module: the whole beside a view into it, with the names of the colours. Needs no display."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import cadquery as cq
import numpy as np
import vtkmodules.vtkRenderingFreeType
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  # the two back-ends register themselves
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkFeatureEdges, vtkPolyDataNormals
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkLight,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkTextActor,
    vtkWindowToImageFilter,
)

from tvimdesign.cad.dimensions import Dimensions
from tvimdesign.cad.kinds import KINDS, Rgb, kind_of
from tvimdesign.cad.mesh import Array, Instance, Mesh, solid_mesh
from tvimdesign.cad.modes import MODULES
from tvimdesign.files import write_whole

_SIZE = (1800, 800)
_LEGEND_HEIGHT = 0.1
_EDGE_ANGLE = 30.0
_CUT = ("housing", "rotor")
_HIDDEN = ("link",)


def write_preview(path: Path, dims: Dimensions, drawn: Mapping[str, cq.Solid], placed: Mapping[str, Instance]) -> None:
    """Write the picture as PNG, whole or not at all."""
    opened = {name: instance for name, instance in placed.items() if name not in _HIDDEN}
    for name in _CUT:
        opened[name] = Instance(solid_mesh(_without_quarter(drawn[name], dims)), np.eye(4))
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*_SIZE)
    for left, right, shown in ((0.0, 0.5, placed), (0.5, 1.0, opened)):
        renderer = _view(shown, dims)
        renderer.SetViewport(left, _LEGEND_HEIGHT, right, 1.0)
        window.AddRenderer(renderer)
    window.AddRenderer(_legend(MODULES[dims.mode].kinds(dims)))
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    with TemporaryDirectory(dir=path.parent, prefix=f".{path.name}.") as folder:
        beside = Path(folder) / path.name
        writer = vtkPNGWriter()
        writer.SetFileName(str(beside))
        writer.SetInputConnection(image.GetOutputPort())
        writer.Write()
        write_whole(path, beside.read_bytes())


def _without_quarter(solid: cq.Solid, dims: Dimensions) -> cq.Solid:
    """The part without the quarter that faces the camera."""
    size = 2.0 * dims.envelope_diameter + dims.envelope_height
    return solid.cut(cq.Solid.makeBox(size, size, 2.0 * size, cq.Vector(0, -size, -size)))


def _view(placed: Mapping[str, Instance], dims: Dimensions) -> vtkRenderer:
    """Everything that is placed, seen from the front, above and the right."""
    renderer = vtkRenderer()
    renderer.SetBackground(1.0, 1.0, 1.0)
    for name, instance in placed.items():
        for actor in _actors(instance, KINDS[kind_of(name)].colour):
            renderer.AddActor(actor)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(0.0, 0.0, 0.0)
    camera.SetPosition(1.0, -1.35, 1.25)
    camera.SetViewUp(0.0, 0.0, 1.0)
    renderer.ResetCamera()
    middle = 0.5 * (dims.link_bottom_level + dims.link_thickness - dims.floor_thickness - dims.foot_height)
    towards = np.array(camera.GetPosition()) - np.array(camera.GetFocalPoint())
    camera.SetFocalPoint(0.0, 0.0, middle)
    camera.SetPosition(towards[0], towards[1], towards[2] + middle)
    camera.SetParallelScale(0.5 * dims.envelope_diameter)
    for position, intensity in (((-0.6, 0.9, 1.0), 0.8), ((0.9, 0.1, 0.8), 0.45)):
        light = vtkLight()
        light.SetLightTypeToCameraLight()
        light.SetPosition(*position)
        light.SetIntensity(intensity)
        renderer.AddLight(light)
    renderer.ResetCameraClippingRange()
    return renderer


def _actors(instance: Instance, colour: Rgb) -> Iterable[vtkActor]:
    """The faces of a part in its colour, and its sharp edges in black."""
    clean = vtkCleanPolyData()
    clean.SetInputData(_poly_data(instance.mesh, instance.matrix))
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(clean.GetOutputPort())
    normals.SetFeatureAngle(_EDGE_ANGLE)
    normals.SplittingOn()
    faces = _actor(normals, colour)
    faces.GetProperty().SetAmbient(0.25)
    faces.GetProperty().SetDiffuse(0.75)
    faces.GetProperty().SetSpecular(0.15)
    edges = vtkFeatureEdges()
    edges.SetInputConnection(clean.GetOutputPort())
    edges.SetFeatureAngle(_EDGE_ANGLE)
    edges.ColoringOff()
    lines = _actor(edges, (0.08, 0.08, 0.08))
    lines.GetProperty().SetLineWidth(1.5)
    lines.GetProperty().LightingOff()
    return faces, lines


def _actor(source: vtkPolyDataNormals | vtkFeatureEdges, colour: Rgb) -> vtkActor:
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    mapper.ScalarVisibilityOff()
    # Lines that lie in a face are drawn in front of it.
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*colour)
    return actor


def _poly_data(mesh: Mesh, matrix: Array) -> vtkPolyData:
    points = vtkPoints()
    placed = mesh.vertices @ matrix[:3, :3].T + matrix[:3, 3]
    points.SetData(numpy_to_vtk(placed, deep=True))  # type: ignore[no-untyped-call]  # vtk says no types here
    cells = np.hstack((np.full((len(mesh.faces), 1), 3), mesh.faces)).astype(np.int64)
    triangles = vtkCellArray()
    triangles.SetCells(
        len(mesh.faces),
        numpy_to_vtkIdTypeArray(cells.ravel(), deep=True),  # type: ignore[no-untyped-call]  # vtk says no types here
    )
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(triangles)
    return data


def _legend(kinds: Sequence[str]) -> vtkRenderer:
    """A strip with the names of the parts in their colours."""
    renderer = vtkRenderer()
    renderer.SetViewport(0.0, 0.0, 1.0, _LEGEND_HEIGHT)
    renderer.SetBackground(1.0, 1.0, 1.0)
    width = _SIZE[0] / len(kinds)
    for index, kind in enumerate(kinds):
        x, y = round((index + 0.12) * width), 30
        renderer.AddViewProp(_text("     ", x, y, KINDS[kind].colour))
        renderer.AddViewProp(_text(kind.replace("_", " "), x + 42, y, None))
    return renderer


def _text(text: str, x: int, y: int, background: Rgb | None) -> vtkTextActor:
    actor = vtkTextActor()
    actor.SetInput(text)
    actor.SetPosition(x, y)
    style = actor.GetTextProperty()
    style.SetFontSize(24)
    style.SetColor(0.1, 0.1, 0.1)
    if background:
        style.SetBackgroundColor(*background)
        style.SetBackgroundOpacity(1.0)
    return actor
