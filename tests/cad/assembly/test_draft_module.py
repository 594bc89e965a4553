"""Drafts: the same bodies as the exact kernel's, closed, with their sharp edges."""

from collections.abc import Mapping
from math import pi

import numpy as np
import pytest
from cad_designs import BLOCKS, WRIST, design_of

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.assembly.assembly import MODULES, build
from tvimdesign.cad.assembly.draft_module import draft_module
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.draft_kernel import CHORD, DraftKernel, DraftSolid
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.cad.geometry.solids import block, cylinder, drawn_by, join, ring, rounded, slot, spoked_disc

KERNEL = DraftKernel()
COARSEST = 0.027
"""Share that a polygon of 16 corners falls short of its circle: 1 - sin(x) / x, x a sixteenth of a turn; 2.55 %."""


def _volume(solid: DraftSolid) -> float:
    return float(solid.placed.volume())


def _short(radius: float) -> float:
    """Return the share that a polygon's area may lack of its circle's: with a chord c off the arc, 4 c / (3 r)."""
    return 4.0 * CHORD / (3.0 * radius)


def test_drafts_have_the_volumes_of_formulas_and_change_nothing_exact() -> None:
    with drawn_by(KERNEL):
        assert _volume(block((1.0, 5.0), 3.0, -1.0, 1.0)) == pytest.approx(24.0)
        assert _volume(cylinder(20.0, 0.0, 2.0, (3.0, 4.0))) == pytest.approx(pi * 400.0 * 2.0, rel=_short(20.0))
        assert _volume(ring(10.0, 20.0, 0.0, 2.0)) == pytest.approx(pi * 300.0 * 2.0, rel=_short(10.0))
        assert _volume(slot(5.0, 30.0, 0.0, 2.0)) == pytest.approx((pi * 25.0 + 300.0) * 2.0, rel=_short(10.0))
        corners = rounded(block((0.0, 20.0), 20.0, 0.0, 2.0), 4.0)
        assert _volume(corners) == pytest.approx((400.0 - (4.0 - pi) * 16.0) * 2.0, rel=0.01)
        drilled = join(block((0.0, 20.0), 20.0, 0.0, 2.0), [cylinder(4.0, 2.0, 5.0, (10.0, 0.0))])
        drilled = drilled.cut(cylinder(2.0, 0.0, 5.0, (10.0, 0.0)))
        assert _volume(drilled) == pytest.approx(800.0 + pi * (16.0 * 3.0 - 4.0 * 5.0), rel=0.01)
    with drawn_by(KERNEL):
        cylinder(5.0, 0.0, 1.0)
    assert cylinder(5.0, 0.0, 1.0).Volume() == pytest.approx(25.0 * pi, rel=1e-9)
    asked = (10.0, 3.0, 25.0, 2.0, [0.0, 2.0 * pi / 3.0, 4.0 * pi / 3.0], (0.0, 5.0))
    with drawn_by(KERNEL):
        draft = spoked_disc(*asked)
    assert _volume(draft) == pytest.approx(spoked_disc(*asked).Volume(), rel=0.01)
    with drawn_by(KERNEL), pytest.raises(GeometryError, match="do not fit"):
        rounded(block((0.0, 4.0), 4.0, 0.0, 2.0), 3.0)


@pytest.mark.parametrize(("mode", "sizes"), [("shear", WRIST), ("compression", BLOCKS)])
@pytest.mark.slow
def test_a_draft_is_the_module_that_is_built(mode: str, sizes: Mapping[str, float | str]) -> None:
    design = design_of("drafted", sizes, mode)
    draft, exact = draft_module(dimensions(design)), build(design)
    assert set(draft.places) == set(exact)
    with drawn_by(KERNEL):
        dims = dimensions(design)
        volumes = {kind: _volume(draw(dims)) for kind, draw in MODULES[mode].drawn(dims).items()}
    for name, solid in exact.items():
        kind, box = kind_of(name), solid.BoundingBox()
        if kind in volumes:  # springs are tubes, and their volumes are held elsewhere
            assert volumes[kind] == pytest.approx(solid.Volume(), rel=COARSEST), name
        matrix = draft.places[name]
        points = draft.meshes[kind].points @ matrix[:3, :3].T + matrix[:3, 3]
        lows, highs = (box.xmin, box.ymin, box.zmin), (box.xmax, box.ymax, box.zmax)
        assert points.min(axis=0) == pytest.approx(lows, abs=0.35), name
        assert points.max(axis=0) == pytest.approx(highs, abs=0.35), name


def test_a_draft_has_normals_outwards_and_the_edges_of_its_parts() -> None:
    draft = draft_module(dimensions(design_of("drafted", WRIST)))
    retainer = draft.meshes["retainer"]
    a, b, c = (retainer.points[retainer.triangles[:, i]] for i in range(3))
    across = np.cross(b - a, c - a)
    facing = np.einsum("ij,ij->i", across, retainer.normals[retainer.triangles[:, 0]])
    assert np.all(facing[np.linalg.norm(across, axis=1) > 1e-9] > 0.0)
    # A ring has four circles for edges, and no upright one.
    ends = retainer.edges.reshape(-1, 2, 3)
    assert np.all(ends[:, 0, 2] == ends[:, 1, 2])
    assert len({(round(float(z), 6)) for z in ends[:, 0, 2]}) == 2
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum()
    radii = {round(float(np.hypot(*point[:2])), 3) for point in ends[:, 0]}
    assert len(radii) == 2
    assert lengths == pytest.approx(2.0 * 2.0 * pi * sum(radii), rel=0.03)
