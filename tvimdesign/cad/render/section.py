"""The picture of the module without a wedge: cut through a spring on one side and through the polymer on the other."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from math import cos, pi, sin
from pathlib import Path

import cadquery as cq
import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPlane, vtkPlaneCollection, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkCleanPolyData
from vtkmodules.vtkFiltersGeneral import vtkClipClosedSurface

from tvimdesign.cad.export.mesh import Instance
from tvimdesign.cad.geometry.kinds import KINDS, kind_of
from tvimdesign.cad.render.camera import renderer_on_white, write_view
from tvimdesign.cad.render.cut import Cutter, without
from tvimdesign.cad.render.render import actors, poly_data, surface_actors

_SIZE = (1500, 750)
_RISE = 0.3
"""How far the camera looks down, as a slope."""
_BEST_WEDGE = 0.75 * pi
"""Both faces of a wedge that wide are seen nearly square on, and the parts between them are open to the camera."""
SPRINGS = ("spring_right", "spring_left")
POLYMER = ("pcl_arc", "pcl_block")


def write_section(path: Path, solids: Mapping[str, cq.Solid], placed: Mapping[str, Instance]) -> None:
    """Write the picture, whole or not at all; `solids` and `placed` are the parts in their places, by name."""
    first, last = wedge_of(placed)
    renderer = renderer_on_white()
    cutter = _wedge(first, last, placed)
    for name, instance in placed.items():
        colour = KINDS[kind_of(name)].colour
        if kind_of(name) in SPRINGS:
            surface = _spring_outside(instance, first, last)
            shown = surface_actors(surface, colour) if surface.GetNumberOfPolys() else ()
        elif _apart(instance, first, last):
            shown = actors(instance.mesh, instance.matrix, colour)
        else:
            left = without(name, instance, cutter, solids[name])
            shown = actors(left, np.eye(4), colour) if len(left.faces) else ()
        for actor in shown:
            renderer.AddActor(actor)
    towards = 0.5 * (first + last)
    write_view(path, renderer, placed, (cos(towards), sin(towards), _RISE), _SIZE)


def wedge_of(placed: Mapping[str, Instance]) -> tuple[float, float]:
    """Azimuths [rad] between which the module is cut away: through the axis of a spring, and the middle of the polymer.

    Of all pairs that which lies nearest to a wedge whose faces both show; the second is the larger by less than pi.
    """
    springs, polymer = (
        [_azimuth(one) for name, one in placed.items() if kind_of(name) in kinds] for kinds in (SPRINGS, POLYMER)
    )
    pairs = [(a, b) for one, other in product(springs, polymer) for a, b in ((one, other), (other, one))]
    wedges = [(a, a + (b - a) % (2.0 * pi)) for a, b in pairs]
    return min(wedges, key=lambda wedge: (round(abs(wedge[1] - wedge[0] - _BEST_WEDGE), 6), wedge))


def _azimuth(instance: Instance) -> float:
    """Where the middle of a part stands around the module's axis."""
    x, y, _ = instance.points().mean(axis=0)
    return float(np.arctan2(y, x))


def _wedge(first: float, last: float, placed: Mapping[str, Instance]) -> Cutter:
    """A sector about the axis that reaches beyond every part."""
    points = np.vstack([one.points() for one in placed.values()])
    low, high, reach = points[:, 2].min() - 1.0, points[:, 2].max() + 1.0, 4.0 * float(np.abs(points).max())
    corners = [(0.0, 0.0), *((reach * cos(a), reach * sin(a)) for a in np.linspace(first, last, 4))]
    return Cutter(corners, low, high)


def _outwards(first: float, last: float) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Normals of the wedge's faces, out of it."""
    return (sin(first), -cos(first), 0.0), (-sin(last), cos(last), 0.0)


def _apart(instance: Instance, first: float, last: float) -> bool:
    """Whether a face of the wedge has all of a part before it, so that nothing of it is cut away."""
    points = instance.points()
    return any(bool((points @ np.array(outward)).min() >= 0.0) for outward in _outwards(first, last))


def _spring_outside(instance: Instance, first: float, last: float) -> vtkPolyData:
    """The part of a spring outside the wedge. A plane that cuts it clips its closed mesh; no spring meets both."""
    clean = vtkCleanPolyData()
    clean.SetInputData(poly_data(instance.mesh, instance.matrix))
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
