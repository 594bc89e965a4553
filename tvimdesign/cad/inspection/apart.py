"""Which placed parts are surely apart: their meshes are further from each other than they can be from their solids.

It spares the kernel's exact common volume where that is nothing. What it does not tell apart may still be.
"""

from __future__ import annotations

from collections.abc import Mapping

from manifold3d import Manifold

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.export.bodies import body_of
from tvimdesign.cad.export.mesh import CHORD, Instance
from tvimdesign.cad.geometry.kinds import kind_of

ROOM = 3.0 * CHORD
"""Between the meshes of parts that are apart [mm]; each mesh is within CHORD of its part."""


class PlacedBodies:
    """The meshes of placed parts as closed bodies; copies of a part share one."""

    def __init__(self, placed: Mapping[str, Instance]) -> None:
        """A part whose mesh does not close has no body, and is never told apart."""
        self._placed = placed
        self._bodies: dict[str, Manifold | None] = {}
        self._in_place: dict[str, Manifold | None] = {}
        self._near: set[tuple[str, str]] = set()

    def apart(self, first: str, second: str) -> bool:
        """Whether two parts have surely no point in common; the gap of bodies that share any volume is zero.

        Where one of a kind is near another kind its copies will be too, and are not tried.
        """
        kinds = (kind_of(first), kind_of(second))
        if kinds in self._near:
            return False
        one, other = self._body(first), self._body(second)
        apart = one is not None and other is not None and one.min_gap(other, ROOM) >= ROOM
        if not apart:
            self._near.add(kinds)
        return apart

    def _body(self, name: str) -> Manifold | None:
        """The body of a part where it stands, found once: a placed body is sorted anew for each question."""
        if name not in self._in_place:
            self._in_place[name] = self._placed_body(name)
        return self._in_place[name]

    def _placed_body(self, name: str) -> Manifold | None:
        kind = kind_of(name)
        if kind not in self._bodies:
            try:
                self._bodies[kind] = body_of(kind, self._placed[name].mesh)
            except GeometryError:
                self._bodies[kind] = None
        body = self._bodies[kind]
        return body.transform(self._placed[name].matrix[:3]) if body else None
