"""What is left of a part to look into the module: its mesh less an upright prism, or the kernel's cut of it."""

from __future__ import annotations

from collections.abc import Sequence

import cadquery as cq
import numpy as np
from manifold3d import CrossSection, FillRule, Manifold

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.export.bodies import body_of, mesh_of
from tvimdesign.cad.export.mesh import Instance, Mesh, solid_mesh
from tvimdesign.cad.geometry.kinds import kind_of


class Cutter:
    """An upright prism that is taken away."""

    def __init__(self, corners: Sequence[tuple[float, float]], bottom: float, top: float) -> None:
        """`corners` of its section, between two levels [mm]."""
        self._corners, self._bottom, self._top = corners, bottom, top

    def body(self) -> Manifold:
        """As triangles."""
        section = CrossSection([np.array(self._corners)], FillRule.NonZero)
        return Manifold.extrude(section, self._top - self._bottom).translate((0.0, 0.0, self._bottom))

    def solid(self) -> cq.Solid:
        """As the kernel has it."""
        outline = cq.Workplane().workplane(offset=self._bottom).polyline(list(self._corners)).close()
        body = outline.extrude(self._top - self._bottom).val()
        assert isinstance(body, cq.Solid)
        return body


def without(name: str, instance: Instance, cutter: Cutter, solid: cq.Solid) -> Mesh:
    """The mesh of a placed part without the cutter, in the module's coordinates; empty where nothing is left."""
    try:
        body = body_of(kind_of(name), instance.mesh).transform(instance.matrix[:3])
    except GeometryError:
        left = solid.cut(cutter.solid())
        return solid_mesh(left) if left.Solids() else Mesh(np.empty((0, 3)), np.empty((0, 3), dtype=np.int64))
    return mesh_of(body - cutter.body())
