"""Pictures of the module: whole and opened, taken apart, and cut through."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from math import cos, pi, sin
from pathlib import Path

import cadquery as cq
import numpy as np
from manifold3d import CrossSection, FillRule, Manifold
from vtkmodules.vtkCommonDataModel import vtkPlane, vtkPlaneCollection, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkCleanPolyData
from vtkmodules.vtkFiltersGeneral import vtkClipClosedSurface
from vtkmodules.vtkRenderingCore import vtkActor

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.assembly.assembly import MODULES, VIEWED_FROM, lifts
from tvimdesign.cad.assembly.assembly_note import PlacedPart
from tvimdesign.cad.export.mesh import Instance, Mesh, solid_mesh
from tvimdesign.cad.export.print_files import body_of, mesh_of
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.kinds import KINDS, SPRINGS, kind_of
from tvimdesign.cad.render import render


class Cutter:
    """An upright prism that is taken away."""

    def __init__(self, corners: Sequence[tuple[float, float]], bottom: float, top: float) -> None:
        """`corners` of its section, between two levels [mm]."""
        self._corners, self._bottom, self._top = corners, bottom, top

    def body(self) -> Manifold:
        """Return as triangles."""
        section = CrossSection([np.array(self._corners)], FillRule.NonZero)
        return Manifold.extrude(section, self._top - self._bottom).translate((0.0, 0.0, self._bottom))

    def solid(self) -> cq.Solid:
        """Return as the kernel has it."""
        outline = cq.Workplane().workplane(offset=self._bottom).polyline(list(self._corners)).close()
        body = outline.extrude(self._top - self._bottom).val()
        assert isinstance(body, cq.Solid)
        return body


def without(name: str, instance: Instance, cutter: Cutter, solid: cq.Solid) -> Mesh:
    """Return the mesh of a placed part without the cutter, in the module's coordinates; empty where nothing is left."""
    try:
        body = body_of(kind_of(name), instance.mesh).transform(instance.matrix[:3])
    except GeometryError:
        left = solid.cut(cutter.solid())
        return solid_mesh(left) if left.Solids() else Mesh(np.empty((0, 3)), np.empty((0, 3), dtype=np.int64))
    return mesh_of(body - cutter.body())


_PREVIEW_SIZE = (1800, 800)
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
    below = render.legend_height(kinds, _PREVIEW_SIZE)
    aspect = _PREVIEW_SIZE[1] * (1.0 - below) / (0.5 * _PREVIEW_SIZE[0])
    for left, shown in ((0.0, placed), (0.5, opened)):
        renderer = render.renderer_on_white(_all_actors(shown))
        render.look(renderer, shown, _FROM, aspect)
        renderer.SetViewport(left, below, left + 0.5, 1.0)
        views.append(renderer)
    render.write_png(path, _PREVIEW_SIZE, [*views, render.legend(kinds, _PREVIEW_SIZE)])


def _all_actors(placed: Mapping[str, Instance]) -> Iterator[vtkActor]:
    return (actor for name, instance in placed.items() for actor in _actors(name, instance))


def _actors(name: str, instance: Instance) -> tuple[vtkActor, vtkActor]:
    return render.actors(instance.mesh, instance.matrix, KINDS[kind_of(name)].colour)


_EXPLODED_SIZE = (1000, 1300)


def write_exploded(path: Path, placed: Mapping[str, Instance], items: Mapping[str, int]) -> None:
    """Write the picture of the parts apart from each other, with their numbers in the bill of materials by kind."""
    apart = {name: _lifted(placed[name], lift) for name, lift in lifts(placed).items()}
    renderer = render.renderer_on_white(_all_actors(apart))
    render.write_view(path, renderer, apart, VIEWED_FROM, _EXPLODED_SIZE, items=items)


def _lifted(instance: Instance, lift: float) -> Instance:
    matrix = instance.matrix.copy()
    matrix[2, 3] += lift
    return Instance(instance.mesh, matrix)


_STEP_SIZE = (900, 600)
_STEP_APART = 0.2  # Way from one kind of part to the next above its place, over the module's width
_PALE = (0.86, 0.87, 0.88)
_FROM_BELOW = (VIEWED_FROM[0], VIEWED_FROM[1], -VIEWED_FROM[2])
_LITTLE, _OPACITY = 0.4, 0.6  # Kinds seen by a smaller share than this shine through what hides them, so strongly
_GOING_WITH = {
    "heater_lead": "heater", "adjuster_insert": "adjuster",
    **dict.fromkeys(("leg_pin", "link_insert", "retainer_insert", "liner"), "rotor"),
}  # fmt: skip
"""Kinds that hang on another one, or are in it already, when that is put in."""


def write_steps(folder: Path, placed: Mapping[str, Instance], steps: Mapping[str, Sequence[PlacedPart]]) -> None:
    """Write a picture for each step, by its file: parts before they go in, or once they are out, in colour, over what
    is there, pale.

    Parts that a step is about, and moves from no side, are in their places: alone, where none of them stands yet; from
    above or below, wherever more is seen of each kind. Kinds that are little seen shine through what hides them.
    """
    apart = _STEP_APART * max(float(np.ptp(instance.points()[:, 0])) for instance in placed.values())
    standing = set[str]()
    for file, parts in steps.items():
        sides, coming = dict[str, str](), dict[str, Instance]()
        for part in parts:
            group = _GOING_WITH.get(kind_of(part.name), kind_of(part.name))
            side = sides.setdefault(group, part.side if standing else "")
            way = {"above": apart, "below": -apart, "": 0.0}[side]
            coming[part.name] = _lifted(placed[part.name], way * (list(sides).index(group) + 1.0))
        around = standing - coming.keys() if any(part.side or part.name in standing for part in parts) else ()
        there = {name: placed[name] for name in placed if name in around}
        drawn = {name: render.actors(part.mesh, part.matrix, _PALE) for name, part in there.items()}
        drawn |= {name: _actors(name, instance) for name, instance in coming.items()}
        groups: dict[str, list[vtkActor]] = {"": [drawn[name][0] for name in there]}
        for name in coming:
            groups.setdefault(kind_of(name), []).append(drawn[name][0])
        cameras = [VIEWED_FROM] * (set(sides.values()) != {"below"}) + [_FROM_BELOW] * ("above" not in sides.values())
        views = [(render.shares_seen(there | coming, camera, groups, _STEP_SIZE), camera) for camera in cameras]
        seen, camera = max(views, key=lambda view: sum(view[0].values()))
        through = list(_all_actors({name: coming[name] for name in coming if seen[kind_of(name)] < _LITTLE}))
        for actor in through:
            actor.GetProperty().SetOpacity(_OPACITY)
        renderer = render.renderer_on_white(actor for both in drawn.values() for actor in both)
        render.write_view(folder / file, renderer, there | coming, camera, _STEP_SIZE, coming, through=through)
        standing ^= {part.name for part in parts if part.side}


_SECTION_SIZE = (1500, 750)
_RISE = 0.3  # How far the camera looks down, as a slope
_BEST_WEDGE = 0.75 * pi
"""Both faces of a wedge that wide are seen nearly square on, and the parts between them are open to the camera."""
POLYMER = ("pcl_arc", "pcl_block")


def write_section(path: Path, solids: Mapping[str, cq.Solid], placed: Mapping[str, Instance]) -> None:
    """Write the picture, whole or not at all; `solids` and `placed` are the parts in their places, by name."""
    first, last = wedge_of(placed)
    renderer = render.renderer_on_white()
    cutter = _wedge(first, last, placed)
    for name, instance in placed.items():
        colour = KINDS[kind_of(name)].colour
        if kind_of(name) in SPRINGS:
            surface = _spring_outside(instance, first, last)
            shown = render.surface_actors(surface, colour) if surface.GetNumberOfPolys() else ()
        elif any((instance.points() @ outward).min() >= 0.0 for outward in _outwards(first, last)):  # it is uncut
            shown = render.actors(instance.mesh, instance.matrix, colour)
        else:
            left = without(name, instance, cutter, solids[name])
            shown = render.actors(left, np.eye(4), colour) if len(left.faces) else ()
        for actor in shown:
            renderer.AddActor(actor)
    towards = 0.5 * (first + last)
    render.write_view(path, renderer, placed, (cos(towards), sin(towards), _RISE), _SECTION_SIZE)


def wedge_of(placed: Mapping[str, Instance]) -> tuple[float, float]:
    """Return azimuths [rad] between which the module is cut away: through the axis of a spring, if there is one, and
    the middle of the polymer.

    Of all pairs that which lies nearest to a wedge whose faces both show; the second is the larger by less than pi.
    """
    springs, polymer = (
        [_azimuth(part) for name, part in placed.items() if kind_of(name) in kinds] for kinds in (SPRINGS, POLYMER)
    )
    pairs = [(a, b) for pair in product(springs or polymer, polymer) for a, b in (pair, pair[::-1])]
    wedges = [(a, a + (b - a) % (2.0 * pi)) for a, b in pairs]
    return min(wedges, key=lambda wedge: (round(abs(wedge[1] - wedge[0] - _BEST_WEDGE), 6), wedge))


def _azimuth(instance: Instance) -> float:
    """Return where the middle of a part stands around the module's axis."""
    x, y, _ = instance.points().mean(axis=0)
    return float(np.arctan2(y, x))


def _wedge(first: float, last: float, placed: Mapping[str, Instance]) -> Cutter:
    """Return a sector about the axis that reaches beyond every part."""
    points = np.vstack([part.points() for part in placed.values()])
    low, high, reach = points[:, 2].min() - 1.0, points[:, 2].max() + 1.0, 4.0 * float(np.abs(points).max())
    corners = [(0.0, 0.0), *((reach * cos(a), reach * sin(a)) for a in np.linspace(first, last, 4))]
    return Cutter(corners, low, high)


def _outwards(first: float, last: float) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Return the normals of the wedge's faces, out of it."""
    return (sin(first), -cos(first), 0.0), (-sin(last), cos(last), 0.0)


def _spring_outside(instance: Instance, first: float, last: float) -> vtkPolyData:
    """Return part of a spring outside the wedge. A plane that cuts it clips its closed mesh; no spring meets both."""
    clean = vtkCleanPolyData()
    clean.SetInputData(render.poly_data(instance.mesh, instance.matrix))
    clean.Update()
    whole: vtkPolyData = clean.GetOutput()
    points = instance.points()
    planes = vtkPlaneCollection()
    for outward in _outwards(first, last):
        ahead = points @ np.array(outward)
        if ahead.min() >= 0.0:
            return whole
        if ahead.max() > 0.0:
            plane = vtkPlane()
            # A hair beside the axis: a plane through vertices and edges leaves slivers.
            plane.SetOrigin(*(1e-3 * part for part in outward))
            plane.SetNormal(*outward)
            planes.AddItem(plane)
    if not planes.GetNumberOfItems():
        return vtkPolyData()
    clip = vtkClipClosedSurface()
    clip.SetInputData(whole)
    clip.SetClippingPlanes(planes)
    clip.Update()
    left: vtkPolyData = clip.GetOutput()
    return left
