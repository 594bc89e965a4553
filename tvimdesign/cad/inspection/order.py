"""Checks of the assembly: parts go into their places in the order of the note, and a tool reaches each screw."""

from collections.abc import Iterator, Mapping, Sequence
from math import cos, inf, pi, sin, sqrt

import numpy as np

from tvimdesign.cad.assembly.assembly_note import PlacedPart, coming, steps_of
from tvimdesign.cad.cad_report import SolidCheck, at_least, at_most, finding
from tvimdesign.cad.export.mesh import Array, Instance, Mesh
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.cad.inspection.rays import Triangles, samples
from tvimdesign.cad.parts.common_parts import mounts

SPACING = 2.0  # Between samples of a part that is put in its place [mm]
_SKIN = 0.12
"""How far under a part's surface a sample lies [mm]: more than the meshes of two parts that touch are off together."""
_STEEPEST = -0.1  # A face whose normal has at least this much of the way in is one the part goes in with
_WAY = {"above": np.array([0.0, 0.0, 1.0]), "below": np.array([0.0, 0.0, -1.0])}
"""Back out, by the side a part comes from."""
_FLEXIBLE = ("heater_lead",)  # Wires, which are bent on their way in
TOOL_LENGTH = 60.0  # Free length of a hexagon key's long leg [mm]; assumed: 50 to 100 mm
_TOOL_RAYS = 24


class Standing:
    """The parts that are in place; each keeps its triangles, however many others come after it."""

    def __init__(self, parts: Mapping[str, Mesh] | Mapping[str, Triangles]) -> None:
        """`parts` are meshes or triangles in the module's coordinates, by name."""
        self._parts = {n: part if isinstance(part, Triangles) else Triangles(part) for n, part in parts.items()}

    def first_distances(self, origins: Array, out: Array) -> Array:
        """Return how far rays up or down along the axis come before they meet a part [mm].

        Infinite if they meet none.
        """
        nearest = np.full(len(origins), inf)
        low, high = origins[:, :2].min(axis=0), origins[:, :2].max(axis=0)
        for part in self._parts.values():
            if np.any(part.upper[:2] < low - _SKIN) or np.any(part.lower[:2] > high + _SKIN):
                continue
            near = np.all(
                (origins[:, :2] >= part.lower[:2] - _SKIN) & (origins[:, :2] <= part.upper[:2] + _SKIN), axis=1
            )
            rays = np.flatnonzero(near)
            distances = part.first_hits(origins[rays], np.tile(out, (len(rays), 1))).distance
            nearest[rays] = np.minimum(nearest[rays], distances)
        return nearest

    def nearest(self, point: Array) -> str:
        """Name of the part whose box a point lies closest to."""

        def away(part: Triangles) -> float:
            outside = np.maximum(part.lower - point, point - part.upper)
            return float(np.linalg.norm(np.maximum(outside, 0.0)))

        return min(self._parts, key=lambda name: away(self._parts[name]))


def sequence(names: Sequence[str], dims: Dimensions) -> list[PlacedPart]:
    """Return every part in the order in which it comes into its place, by the steps of the assembly note."""
    kinds = {kind_of(name) for name in names}
    order: list[PlacedPart] = []
    for step in steps_of(kinds, dims):
        order += coming(step.get("place", ()), names)
    return order


def order_checks(dims: Dimensions, placed: Mapping[str, Instance]) -> Iterator[SolidCheck]:
    """Put part after part in its place and compare its way in with those that are there; then look at the screws."""
    meshes = {name: in_module(instance) for name, instance in placed.items()}
    shapes = {name: Triangles(mesh) for name, mesh in meshes.items()}
    order = sequence(list(meshes), dims)
    left = sorted(set(meshes) - {part.name for part in order})
    text = "every part has its step" if not left else f"no step puts these in their places: {', '.join(left)}"
    yield finding("module", "steps", len(left), 0.0, "", at_most(len(left), 0.0), text)
    there: dict[str, Triangles] = {}
    for group in _groups(order):
        together = Standing(there) if there else None
        names = [part.name for part in group]
        if together and kind_of(names[0]) not in _FLEXIBLE:
            # Copies of a part go in alike: what is before one is before all of them but for the angle.
            yield _way_check(kind_of(names[0]), group[0].side, {name: shapes[name] for name in names}, together)
        there |= {name: shapes[name] for name in names}
        if kind_of(names[0]).endswith("_screw"):
            standing, out = Standing(there), _WAY[group[0].side]
            key = dims.of(kind_of(names[0]), "key")
            yield from (_driver(name, _end(meshes[name], out), out, standing, key) for name in names)
    if not any(kind_of(name) == "mount_screw" for name in meshes):
        yield from mount_checks(dims, Standing(there))


def _groups(order: Sequence[PlacedPart]) -> Iterator[list[PlacedPart]]:
    """Yield neighbours in the order that are of one kind and come from one side."""
    group: list[PlacedPart] = []
    for part in order:
        if group and (kind_of(part.name), part.side) != (kind_of(group[0].name), group[0].side):
            yield group
            group = []
        group.append(part)
    if group:
        yield group


def in_module(instance: Instance) -> Mesh:
    """Return mesh of a placed part in the module's coordinates."""
    turn, shift = instance.matrix[:3, :3], instance.matrix[:3, 3]
    return Mesh(instance.mesh.vertices @ turn.T + shift, instance.mesh.faces)


def _way_check(kind: str, side: str, copies: Mapping[str, Triangles], there: Standing) -> SolidCheck:
    """Look back along the way in from every copy: what it meets there, the part would have to pass through."""
    out = _WAY[side]
    points = np.concatenate([_leading(copy, out) for copy in copies.values()])
    distances = there.first_distances(points, out)
    blocked = np.flatnonzero(np.isfinite(distances))
    text = f"comes into its place from {side}, nothing in its way"
    place = None
    if len(blocked):
        first = blocked[int(np.argmin(distances[blocked]))]
        place = points[first] + distances[first] * out
        text = (
            f"comes from {side}, and {there.nearest(place)} is in its way: {len(blocked)} samples of it meet something"
        )
    return finding(
        kind, f"way in from {side}", len(blocked), 0.0, "", at_most(len(blocked), 0.0), text,
        place=place, resolution=SPACING,
    )  # fmt: skip


def _leading(triangles: Triangles, out: Array) -> Array:
    """Return points just under the faces a part goes in with."""
    where = samples(triangles, SPACING, np.flatnonzero(triangles.normal @ out < _STEEPEST))
    inwards = where.point - _SKIN * where.normal
    # Under a face, but also away from its edges: towards the middle of the triangle, as far.
    middle = triangles.corners[where.triangle].mean(axis=1) - where.point
    length = np.linalg.norm(middle, axis=1, keepdims=True)
    return np.asarray(inwards + middle * np.minimum(1.0, _SKIN / np.maximum(length, 1e-9)))


def _end(mesh: Mesh, out: Array) -> Array:
    """Return the middle of a screw's head."""
    ends = mesh.vertices @ out
    return np.asarray(mesh.vertices[ends > ends.max() - 1e-6].mean(axis=0))


def mount_checks(dims: Dimensions, there: Standing) -> Iterator[SolidCheck]:
    """Yield whether a driver comes from above to the screws that fix the housing, the module complete and at rest."""
    for index, (x, y) in enumerate(mounts(dims)):
        yield _driver(f"mount_screw_{index + 1}", np.array([x, y, 0.0]), _WAY["above"], there, dims.mount_screw_key)


def _driver(name: str, head: Array, out: Array, there: Standing, key: float) -> SolidCheck:
    """Return whether a hexagon key comes to a screw along its axis; the screw itself lies behind the rays.

    `key` is the key's width across its flats [mm].
    """
    radius = key / sqrt(3.0)  # of its corners
    angles = np.arange(_TOOL_RAYS) * 2.0 * pi / _TOOL_RAYS
    rim = [[share * radius * cos(angle), share * radius * sin(angle), 0.0] for share in (0.5, 1.0) for angle in angles]
    starts = head + _SKIN * out + np.array([[0.0, 0.0, 0.0], *rim])
    free = there.first_distances(starts, out)
    least = float(free.min())
    text = f"a key of {key:.3g} mm has {TOOL_LENGTH:.3g} mm before the screw"
    place = None
    if least < TOOL_LENGTH:
        place = starts[int(np.argmin(free))] + least * out
        text = f"a key of {key:.3g} mm meets {there.nearest(place)} {least:.3g} mm before the screw"
    return finding(
        name, "driver", min(least, TOOL_LENGTH) if least < inf else TOOL_LENGTH, TOOL_LENGTH, "mm",
        at_least(least, TOOL_LENGTH), text, place=place, resolution=2.0 * pi * radius / _TOOL_RAYS,
    )  # fmt: skip
