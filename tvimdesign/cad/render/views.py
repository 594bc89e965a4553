"""Two pictures of the module: taken apart along its axis in the order it goes together, and cut through its axis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPlane, vtkPlaneCollection, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkCleanPolyData
from vtkmodules.vtkFiltersGeneral import vtkClipClosedSurface
from vtkmodules.vtkRenderingCore import vtkRenderer

from tvimdesign.cad.export.mesh import Array, Instance
from tvimdesign.cad.geometry.kinds import KINDS, kind_of
from tvimdesign.cad.render.render import actors, legend, legend_height, lit, poly_data, surface_actors, write_png

_ORDER = (
    "encoder_board", "encoder_magnet", "motor_screw", "motor_retainer", "motor_housing", "motor_stator",
    "motor_bearing", "motor_rotor", "motor_hub", "retainer_screw", "retainer", "retainer_insert", "adjuster_screw",
    "housing", "cover_insert", "preload_spring", "bearing_outer", "bearing_inner", "adjuster_insert", "adjuster",
    "peltier_pad", "pcl_arc", "pcl_block", "rotor", "link_insert", "spring_right", "spring_left", "mount_screw",
    "cover", "cover_screw", "link", "link_screw", "link_dowel",
)  # fmt: skip
"""Along the axis from below; kinds that are not named come last."""
_LIDS = ("cover",)
"""Closed plates, which are lifted until all of what lies below them is seen."""
_TOGETHER = ({"spring_right", "spring_left"},)
_EXPLODED, _SECTION = (1000, 1300), (1500, 750)
_ROOM = 1.03
"""Picture over what is on it."""
Triple = tuple[float, float, float]
_FROM: Triple = (1.0, -1.35, 0.75)
_DOWN = _FROM[2] / float(np.hypot(_FROM[0], _FROM[1]))
_APART = 0.12
"""Gap between kinds over the module's width."""


def write_exploded(path: Path, placed: Mapping[str, Instance]) -> None:
    """Write the picture of the parts apart from each other."""
    renderer = _renderer()
    for name, lift in lifts(placed).items():
        moved = placed[name].matrix.copy()
        moved[2, 3] += lift
        for actor in actors(placed[name].mesh, moved, KINDS[kind_of(name)].colour):
            renderer.AddActor(actor)
    _write(path, renderer, placed, _FROM, _EXPLODED)


def lifts(placed: Mapping[str, Instance]) -> dict[str, float]:
    """How far each part is lifted along the axis [mm], so that no kind reaches into the one below it."""
    names = sorted(placed, key=lambda name: (_rank(kind_of(name)), name))
    points = {name: _points(placed[name]) for name in names}
    width = max(float(np.ptp(at[:, 0])) for at in points.values())
    floor, below, lifted = 0.0, 0.0, dict[str, float]()
    for rank in dict.fromkeys(_rank(kind_of(name)) for name in names):
        group = [name for name in names if _rank(kind_of(name)) == rank]
        low = min(float(points[name][:, 2].min()) for name in group)
        high = max(float(points[name][:, 2].max()) for name in group)
        reach = max(float(np.hypot(points[name][:, 0], points[name][:, 1]).max()) for name in group)
        # What is wider than the kind below it would hide it from a camera that looks down.
        hidden = reach + below if kind_of(group[0]) in _LIDS else max(reach - below, 0.0)
        floor += hidden * _DOWN if below else 0.0
        lifted |= dict.fromkeys(group, floor - low)
        floor += high - low + _APART * width
        below = reach
    return lifted


def _rank(kind: str) -> int:
    """Place of a kind along the axis; both hands of spring have one."""
    first = next((min(_ORDER.index(one) for one in group) for group in _TOGETHER if kind in group), None)
    return first if first is not None else _ORDER.index(kind) if kind in _ORDER else len(_ORDER)


def write_section(path: Path, placed: Mapping[str, Instance]) -> None:
    """Write the picture of the half behind the plane y = 0, its cut faces closed."""
    renderer = _renderer()
    for name, instance in placed.items():
        half = _behind(instance)
        if half.GetNumberOfPolys():
            for actor in surface_actors(half, KINDS[kind_of(name)].colour):
                renderer.AddActor(actor)
    _write(path, renderer, placed, (0.0, -1.0, 0.25), _SECTION)


def _behind(instance: Instance) -> vtkPolyData:
    """The part of a closed mesh at y > 0, closed again."""
    merged = vtkCleanPolyData()
    merged.SetInputData(poly_data(instance.mesh, instance.matrix))
    plane = vtkPlane()
    # A hair beside the axis: a plane through vertices and edges leaves slivers.
    plane.SetOrigin(0.0, 1e-3, 0.0)
    plane.SetNormal(0.0, 1.0, 0.0)
    planes = vtkPlaneCollection()
    planes.AddItem(plane)
    clip = vtkClipClosedSurface()
    clip.SetInputConnection(merged.GetOutputPort())
    clip.SetClippingPlanes(planes)
    clip.Update()
    half: vtkPolyData = clip.GetOutput()
    return half


def _points(instance: Instance) -> Array:
    """Vertices of a placed part."""
    return np.asarray(instance.mesh.vertices @ instance.matrix[:3, :3].T + instance.matrix[:3, 3])


def _renderer() -> vtkRenderer:
    renderer = vtkRenderer()
    renderer.SetBackground(1.0, 1.0, 1.0)
    return renderer


def _write(
    path: Path, renderer: vtkRenderer, placed: Mapping[str, Instance], from_here: Triple, size: tuple[int, int]
) -> None:
    """Look at all there is from a direction, and write the picture with its legend."""
    kinds: Sequence[str] = list(dict.fromkeys(kind_of(name) for name in placed))
    below = legend_height(kinds, size)
    renderer.SetViewport(0.0, below, 1.0, 1.0)
    _look(renderer, from_here, size[1] * (1.0 - below) / size[0])
    write_png(path, size, [renderer, legend(kinds, size)])


def _look(renderer: vtkRenderer, from_here: Triple, aspect: float) -> None:
    """Look at all there is from a direction; `aspect` is height over width of what it is drawn on."""
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(0.0, 0.0, 0.0)
    camera.SetPosition(*from_here)
    camera.SetViewUp(0.0, 0.0, 1.0)
    renderer.ResetCamera()
    box = np.array(renderer.ComputeVisiblePropBounds()).reshape(3, 2)
    corners = np.array([[box[0, i], box[1, j], box[2, k]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    towards = np.array(from_here) / np.linalg.norm(from_here)
    right = np.cross((0.0, 0.0, 1.0), towards)
    right /= np.linalg.norm(right)
    wide, high = (float(np.ptp(corners @ way)) for way in (right, np.cross(towards, right)))
    camera.SetParallelScale(0.5 * _ROOM * max(high, wide * aspect))
    lit(renderer)
