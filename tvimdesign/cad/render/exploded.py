"""The picture of the module taken apart along its axis, in the order it goes together."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from tvimdesign.cad.assembly.exploded_lifts import VIEWED_FROM, lifts
from tvimdesign.cad.export.mesh import Instance
from tvimdesign.cad.geometry.kinds import KINDS, kind_of
from tvimdesign.cad.render.camera import renderer_on_white, write_view
from tvimdesign.cad.render.render import actors

_SIZE = (1000, 1300)


def write_exploded(path: Path, placed: Mapping[str, Instance]) -> None:
    """Write the picture of the parts apart from each other."""
    renderer, apart = renderer_on_white(), dict[str, Instance]()
    for name, lift in lifts(placed).items():
        moved = placed[name].matrix.copy()
        moved[2, 3] += lift
        apart[name] = Instance(placed[name].mesh, moved)
        for actor in actors(placed[name].mesh, moved, KINDS[kind_of(name)].colour):
            renderer.AddActor(actor)
    write_view(path, renderer, apart, VIEWED_FROM, _SIZE)
