"""The bill of materials and the assembly's solids agree, one for one; drafts are the exact kernel's bodies."""

import csv
import io
from collections import Counter
from collections.abc import Mapping
from math import pi

import numpy as np
import pytest
from cad_designs import BEARING_BLOCKS, BEARINGS, BLOCKS, CASES, DRIVEN, TILES, WRIST, design_of, given

from tvimdesign.base.errors import GeometryError
from tvimdesign.base.record import Record
from tvimdesign.cad.assembly.assembly import MODULES, build, drawn_parts, place
from tvimdesign.cad.assembly.bill_of_materials import _titled, beside, bill, bill_csv
from tvimdesign.cad.assembly.draft_module import draft_module
from tvimdesign.cad.drawing.spring_sheet import spring_lines
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.draft_kernel import CHORD, DraftKernel, DraftSolid
from tvimdesign.cad.geometry.kinds import kind_of
from tvimdesign.cad.geometry.solids import block, cylinder, drawn_by, join, ring, rounded, slot, spoked_disc
from tvimdesign.cad.jobs.build_plan import fits
from tvimdesign.cad.jobs.main import _ordered_by, _titles
from tvimdesign.catalog.catalog import Catalog
from tvimdesign.device import table_for

DESIGNS = [
    pytest.param("shear", BEARINGS, id="bearings"),
    pytest.param("shear", CASES["paper"][1], id="paper", marks=pytest.mark.slow),
    pytest.param("shear", DRIVEN, id="driven", marks=pytest.mark.slow),
    pytest.param("shear", TILES, id="tiles", marks=pytest.mark.slow),
    pytest.param("compression", BEARING_BLOCKS, id="bearing blocks", marks=pytest.mark.slow),
]


@pytest.mark.parametrize(("mode", "changes"), DESIGNS)
def test_every_solid_is_on_the_bill_with_its_count_and_the_reverse(
    mode: str, changes: Mapping[str, float | str]
) -> None:
    priced = {**changes, "structure_price": 40.0, "pcl_price": 50.0, "heater_price": 18.0, "spring_price": 4.0}
    design = design_of("listed", priced, mode)
    placed = place(dimensions(design), drawn_parts(dimensions(design)))
    there = Counter(kind_of(name) for name in placed)
    reported = bill_csv([*bill(design, {}, placed), *beside(design, {})]).decode("utf-8-sig")
    rows = list(csv.DictReader(io.StringIO(reported)))
    listed = Counter({kind: int(row["quantity"]) for row in rows for kind in row["solids"].split()})
    assert listed == there
    named = [kind for row in rows for kind in row["solids"].split()]
    assert len(named) == len(set(named))
    cost = table_for(mode).evaluate(given(priced, mode), ["cost"])["cost"]
    assert sum(float(row["cost_all_usd"] or 0.0) for row in rows) == pytest.approx(float(cost), rel=1e-4)
    assert all(row["title"] and int(row["quantity"]) > 0 and row["price"] for row in rows)
    if "bearing" in changes:  # one bearing is two solids, and is bought once
        (bearing,) = (row for row in rows if row["part"] == "bearing")
        assert bearing["solids"] == "bearing_inner bearing_outer"
        assert bearing["quantity"] == "2"
        assert bearing["title"].endswith("sealed on both sides (2RS)")
    grams = 1e3 * design.values["pcl_volume"] * design.values["pcl_density"]
    assert any(f"{grams:.2f} g for all of it" in row["title"] for row in rows if row["part"] == "polymer")


def test_springs_seats_and_screws_are_ordered_by_number_and_fit() -> None:
    small = {"placement_radius": 16e-3, "leg_overhang": 1.5e-3, "pin_diameter": 1.5e-3}
    mode, overrides = "shear", {"stock_spring": "central_t10180", **small}
    design = design_of("from stock", overrides, mode)
    left, right = (_titled(design, kind, _titles(design)["stock_spring"]) for kind in ("spring_left", "spring_right"))
    assert left.startswith("Torsion spring T10180, wire 0.51 mm, 6 mm outside")
    assert "(Central Springs), wound left" in left
    assert "wound right" in right
    (line,) = (one for one in spring_lines(design, dimensions(design), _titles(design)) if one.name == "from stock")
    assert (line.value, line.note.split(";")[0]) == ("Torsion spring T10180", "Central Springs")
    design = design_of("milled", BEARING_BLOCKS, "compression")
    found = fits(design, dimensions(design))
    # Bearing 6802: 24 mm outside in H6, 15 mm inside on h5.
    assert found["bearing_outer"] == "housing ⌀24 H6"
    assert found["bearing_inner"] == "rotor ⌀15 h5"
    assert {"rotor ⌀2 H7", "link ⌀2 H7"} == set(found["link_dowel"].split(", "))
    assert "thread_locker" in [one.kind for one in beside(design, {})]
    assert "thread_locker" not in [one.kind for one in beside(design_of("paper", {}), {})]
    design = design_of("paper", {"link_screw_length": 16e-3, "link_dowel_length": 10e-3})
    titles = _titles(design)
    assert titles["link_screw"] == "Button head screw ISO 7380-1 - M3 x 16 - A2-70"
    assert titles["link_dowel"] == "Dowel pin ISO 8734 - 2.5 m6 x 10 - A, hardened steel"
    assert titles["peltier_module"] == Catalog().record("peltiers", str(design.choices["peltier_module"])).title
    own = Record("screws", "own", "Screw from the drawer")
    assert _ordered_by(own, design_of("paper", {}), "link_screw") == "Screw from the drawer"
    for category in ("screws", "dowel_pins"):
        for record in (Catalog().record(category, name) for name in Catalog().names(category)):
            assert record.words["designation"].count("{length}") == 1, record.name
            assert record.words["designation"].startswith(record.title.split(" ISO ")[0]), record.name


@pytest.mark.parametrize(
    "name", ["paper", "tiles", "tiles in vanes", "bearings", "sprung blocks", "bearings among blocks"]
)
def test_parts_and_fasteners_are_counted_as_they_are_drawn(name: str) -> None:
    mode, changes = CASES[name]
    design = design_of(name, changes, mode)
    dims = dimensions(design)
    with drawn_by(DraftKernel()):
        drafts = {kind: draw(dims) for kind, draw in MODULES[mode].drawn(dims).items()}
        kinds = [kind_of(part) for part in MODULES[mode].stand(dims, drafts)]
    together = [kind for kind in kinds if kind not in ("heater_lead", "bearing_inner")]
    assert design.values["part_count"] == len(together) + dims.count("spring_count")
    fasteners = [kind for kind in kinds if kind.endswith(("_screw", "_insert", "_dowel"))]
    assert design.values["fastener_count"] == len(fasteners)


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
