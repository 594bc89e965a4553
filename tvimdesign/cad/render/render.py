"""Pictures without a display: faces and edges of parts, lights, names of colours, and fields on bent surfaces."""

from collections.abc import Iterable, Mapping, Sequence
from functools import cache, lru_cache
from importlib import import_module
from io import BytesIO
from math import ceil, copysign
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkLogger, vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkFeatureEdges, vtkPolyDataNormals
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkLight,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkTextActor,
    vtkWindowToImageFilter,
)

from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.cad.export.mesh import Array, Instance, Mesh
from tvimdesign.cad.geometry.kinds import KINDS, Rgb, kind_of

for _back_end in ("vtkRenderingOpenGL2", "vtkRenderingFreeType"):
    import_module(f"vtkmodules.{_back_end}")  # it registers itself as what draws, and what writes
vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)  # that there is no display is no news: nothing is shown on one

_EDGE_ANGLE = 30.0
_COMPRESSION = 1  # Of zlib, least: lines and plain faces come out no larger than with more
_COLUMN, _LINE = 290, 45  # Least width and height of a name in the legend [pixels]


def write_png(path: Path, size: tuple[int, int], renderers: Iterable[vtkRenderer]) -> None:
    """Render into a PNG of a size in pixels, whole or not at all."""
    window, shown = _window(), list(renderers)
    window.SetSize(*size)
    for renderer in shown:
        window.AddRenderer(renderer)
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    image.ShouldRerenderOff()  # it is drawn already
    image.Update()
    points = vtk_to_numpy(image.GetOutput().GetPointData().GetScalars()).reshape(size[1], size[0], 3)
    stream = BytesIO()
    # VTK's own writer takes many times as long for a file that is no smaller.
    Image.fromarray(np.ascontiguousarray(points[::-1])).save(stream, format="png", compress_level=_COMPRESSION)
    atomic_write(path, stream.getvalue())
    for renderer in shown:
        window.RemoveRenderer(renderer)


@cache
def _window() -> vtkRenderWindow:
    """Return the one that all pictures of a process are drawn in: each new one would compile its shaders again."""
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetNumberOfLayers(2)  # the second shines through the first
    window.SetMultiSamples(0)  # edges are smoothed once they are drawn (`look`), in a fifth of the time
    return window


def actors(mesh: Mesh, matrix: Array, colour: Rgb) -> tuple[vtkActor, vtkActor]:
    """Return the faces of a placed part in its colour, and its sharp edges in black."""
    placed = vtkMatrix4x4()
    placed.DeepCopy(matrix.ravel().tolist())
    both = _coloured(_mappers(mesh), colour)
    for actor in both:
        actor.SetUserMatrix(placed)
    return both


def surface_actors(surface: vtkPolyData, colour: Rgb) -> tuple[vtkActor, vtkActor]:
    """Return the faces of a surface in a colour, and its sharp edges in black."""
    return _coloured(_faces_and_edges(surface), colour)


_Mappers = tuple[vtkPolyDataMapper, vtkPolyDataMapper]


@lru_cache(maxsize=64)
def _mappers(mesh: Mesh) -> _Mappers:
    """Return what draws faces and sharp edges of a mesh in its own coordinates: all copies of a part, in all
    pictures."""
    return _faces_and_edges(poly_data(mesh, np.eye(4)))


def _faces_and_edges(surface: vtkPolyData) -> _Mappers:
    clean = vtkCleanPolyData()
    clean.SetInputData(surface)
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(clean.GetOutputPort())
    normals.SetFeatureAngle(_EDGE_ANGLE)
    normals.SplittingOn()
    edges = vtkFeatureEdges()
    edges.SetInputConnection(clean.GetOutputPort())
    edges.SetFeatureAngle(_EDGE_ANGLE)
    edges.ColoringOff()
    edges.BoundaryEdgesOff()
    edges.NonManifoldEdgesOff()
    return _mapper(normals), _mapper(edges)


def _mapper(source: vtkPolyDataNormals | vtkFeatureEdges) -> vtkPolyDataMapper:
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    mapper.ScalarVisibilityOff()
    # Lines that lie in a face are drawn in front of it.
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    return mapper


def _coloured(mappers: _Mappers, colour: Rgb) -> tuple[vtkActor, vtkActor]:
    faces, lines = vtkActor(), vtkActor()
    faces.SetMapper(mappers[0])
    faces.GetProperty().SetColor(*colour)
    faces.GetProperty().BackfaceCullingOn()  # of a closed mesh nobody sees them, and drawing them takes as long
    faces.GetProperty().SetAmbient(0.25)
    faces.GetProperty().SetDiffuse(0.75)
    faces.GetProperty().SetSpecular(0.15)
    lines.SetMapper(mappers[1])
    lines.GetProperty().SetColor(0.08, 0.08, 0.08)
    lines.GetProperty().SetLineWidth(1.5)
    lines.GetProperty().LightingOff()
    return faces, lines


def poly_data(mesh: Mesh, matrix: Array) -> vtkPolyData:
    """Return triangles of a mesh, placed."""
    points = vtkPoints()
    placed = mesh.vertices @ matrix[:3, :3].T + matrix[:3, 3]
    points.SetData(numpy_to_vtk(placed, deep=True))
    corners = numpy_to_vtkIdTypeArray(mesh.faces.ravel().astype(np.int64), deep=True)
    triangles = vtkCellArray()
    triangles.SetData(3, corners)
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(triangles)
    return data


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


def legend_height(kinds: Sequence[str], size: tuple[int, int]) -> float:
    """Return the share of a picture's height that the names of some kinds take."""
    return (_LINE * _lines(kinds, size[0]) + 15) / size[1]


def _lines(kinds: Sequence[str], width: int) -> int:
    return ceil(len(kinds) / min(len(kinds), max(1, width // _COLUMN)))


def legend(kinds: Sequence[str], size: tuple[int, int], items: Mapping[str, int] | None = None) -> vtkRenderer:
    """Return a strip below a picture of a size in pixels, with the parts' names, and numbers if given, in colours."""
    renderer = renderer_on_white()
    renderer.SetViewport(0.0, 0.0, 1.0, legend_height(kinds, size))
    rows = _lines(kinds, size[0])
    columns = ceil(len(kinds) / rows)
    for index, kind in enumerate(kinds):
        x, y = round((index % columns + 0.12) * size[0] / columns), 15 + _LINE * (rows - 1 - index // columns)
        renderer.AddViewProp(_text("     ", x, y, KINDS[kind].colour))
        number = f"{items[kind]} " if items else ""
        renderer.AddViewProp(_text(number + kind.replace("_", " "), x + 42, y, None))
    return renderer


Triple = tuple[float, float, float]
_MARGIN = 1.06  # Picture over what is on it


def renderer_on_white(shown: Iterable[vtkActor] = ()) -> vtkRenderer:
    """Return a picture of faces and edges."""
    renderer = vtkRenderer()
    renderer.SetBackground(1.0, 1.0, 1.0)
    for actor in shown:
        renderer.AddActor(actor)
    return renderer


_LABEL_ROOM = 0.03  # Least distance of two numbers in a picture, over the height of all parts


def write_view(
    path: Path, renderer: vtkRenderer, placed: Mapping[str, Instance], from_here: Triple, size: tuple[int, int],
    named: Iterable[str] = (), items: Mapping[str, int] | None = None, through: Sequence[vtkActor] = (),
) -> None:  # fmt: skip
    """Write what is seen of placed parts from a direction, with the legend of their kinds, or of those `named`.

    Numbers of `items`, by kind, stand beside the parts, to the right of all of a kind. What is in `through` shines
    through all the others.
    """
    kinds = list(items or dict.fromkeys(kind_of(name) for name in named or placed))
    below = legend_height(kinds, size)
    sight = np.array(from_here) / np.linalg.norm(from_here)
    right = np.cross((0.0, 0.0, 1.0), sight)
    upward = np.cross(sight, right) / np.linalg.norm(right)
    heights = np.vstack([instance.points() for instance in placed.values()]) @ upward
    room, taken = _LABEL_ROOM * float(np.ptp(heights)), list[np.ndarray]()
    for kind, number in (items or {}).items():
        points = np.vstack([instance.points() for name, instance in placed.items() if kind_of(name) == kind])
        at = points[np.argmax(points @ right)]
        while any(np.linalg.norm(np.cross(at - other, sight)) < room for other in taken):
            at = at - 0.5 * room * upward
        taken.append(at)
        beside = _text(f" {number}", 0, 0, None)
        beside.GetPositionCoordinate().SetCoordinateSystemToWorld()
        beside.GetPositionCoordinate().SetValue(*at)
        renderer.AddViewProp(beside)
    layers = [renderer, renderer_on_white(through)] if through else [renderer]
    for layer, drawn in enumerate(layers):
        drawn.SetLayer(layer)
        drawn.SetViewport(0.0, below, 1.0, 1.0)
        look(drawn, placed, from_here, size[1] * (1.0 - below) / size[0])
    write_png(path, size, [*layers, legend(kinds, size, items)])


_COUNTED = 3  # Times that the picture in which points are counted is smaller


def shares_seen(
    placed: Mapping[str, Instance], from_here: Triple, groups: Mapping[str, Sequence[vtkActor]], size: tuple[int, int]
) -> dict[str, float]:
    """Return which share of each group's faces is seen from a direction, of what is seen of it alone, but for ""."""
    window, (width, height), buffer = _window(), (side // _COUNTED for side in size), vtkFloatArray()
    renderer = renderer_on_white(actor for group in groups.values() for actor in group)
    look(renderer, placed, from_here, height / width)
    renderer.UseFXAAOff()
    window.SetSize(width, height)
    window.AddRenderer(renderer)
    depths = dict[str, Array]()
    for shown in (*filter(None, groups), ""):  # all of them last
        for group, actors in groups.items():
            for actor in actors:
                actor.SetVisibility(shown in (group, ""))
        window.Render()
        window.GetZbufferData(0, 0, width - 1, height - 1, buffer)
        depths[shown] = np.array(vtk_to_numpy(buffer))
    window.RemoveRenderer(renderer)
    whole = depths.pop("")
    return {group: np.sum((at < 1.0) & (at == whole)) / max(np.sum(at < 1.0), 1) for group, at in depths.items()}


def look(renderer: vtkRenderer, placed: Mapping[str, Instance], from_here: Triple, aspect: float) -> None:
    """Look at placed parts from a direction; `aspect` is height over width of what they are drawn on."""
    towards = np.array(from_here) / np.linalg.norm(from_here)
    right = np.cross((0.0, 0.0, 1.0), towards)
    right /= np.linalg.norm(right)
    upward = np.cross(towards, right)
    points = np.vstack([instance.points() for instance in placed.values()])
    across, along = points @ right, points @ upward
    middle = 0.5 * ((across.min() + across.max()) * right + (along.min() + along.max()) * upward)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*middle)
    camera.SetPosition(*(middle + 4.0 * float(np.abs(points).max()) * towards))  # from outside all of them
    camera.SetViewUp(0.0, 0.0, 1.0)
    camera.SetParallelScale(0.5 * _MARGIN * max(float(np.ptp(along)), float(np.ptp(across)) * aspect))
    renderer.UseFXAAOn()
    for (x, y, z), intensity in (((-0.6, 0.9, 1.0), 0.8), ((0.9, 0.1, 0.8), 0.45)):
        light = vtkLight()
        light.SetLightTypeToCameraLight()
        light.SetPosition(x, copysign(y, towards[2]), z)  # who looks up has lamps below
        light.SetIntensity(intensity)
        renderer.AddLight(light)
    renderer.ResetCameraClippingRange()


_SIZE = (1400, 1000)
_FROM = (1.0, -1.35, 0.9)
_TOP_QUANTILE = 0.999  # Share of the corners within the scale: at a sharp one the stress has no largest value
_BODY = 0.82  # Share of the picture's width that the body has; the rest is the scale's
_LARGEST_WAY = 0.06  # How far the farthest corner is drawn to move, in sizes of the body


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
    renderer = renderer_on_white([surface])
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
