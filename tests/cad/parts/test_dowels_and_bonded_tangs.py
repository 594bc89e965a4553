"""Dowel pins between link and core, and bonded tangs: solids, ways in, print files, drawings, bill and steps."""

from collections.abc import Mapping
from math import hypot

import cadquery as cq
import numpy as np
import pytest
from cad_designs import MM, broken_rules, design_of

from tvimdesign.cad.assembly.assembly import drawn_parts, place
from tvimdesign.cad.assembly.bill_of_materials import beside, bill, bill_csv
from tvimdesign.cad.drawing.drawing_requirements import drawing_requirements
from tvimdesign.cad.drawing.drawing_sheet import figure
from tvimdesign.cad.export.print_files import as_printed
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions
from tvimdesign.cad.geometry.features import holes
from tvimdesign.cad.geometry.kinds import PRODUCTION
from tvimdesign.cad.inspection.order import sequence
from tvimdesign.cad.inspection.size_checks import interference_checks, size_checks
from tvimdesign.cad.parts import fasteners
from tvimdesign.cad.parts.common_parts import link_dowels
from tvimdesign.study.design import Design

TWO = {"link_dowel_count": 2, "link_dowel": "iso_8734_2"}
MODULES: Mapping[str, tuple[str, Mapping[str, float | str]]] = {
    "two": ("shear", TWO),
    "four": ("shear", {}),
    "compression": ("compression", {"core_radius": 8.0 * MM, **TWO}),
}


@pytest.fixture(scope="module", params=[pytest.param("two", marks=pytest.mark.slow), "four", "compression"])
def design(request: pytest.FixtureRequest) -> Design:
    mode, overrides = MODULES[request.param]
    return design_of(request.param, overrides, mode)


@pytest.fixture(scope="module")
def dims(design: Design) -> Dimensions:
    return dimensions(design)


@pytest.fixture(scope="module")
def placed(dims: Dimensions) -> dict[str, cq.Solid]:
    return place(dims, drawn_parts(dims))


def test_pins_fill_their_holes_have_their_size_and_go_in_last(
    design: Design, placed: dict[str, cq.Solid], dims: Dimensions
) -> None:
    found = {check.name: check for check in size_checks(design, placed)}
    wanted = ("link_dowel_volume", "rotor_volume", "link_volume", "rotor_inertia", "parts_inertia", "module_mass")
    assert {name: found[name].ok for name in wanted} == dict.fromkeys(wanted, True)
    assert max(abs(found[name].value) for name in wanted[:4]) < 1e-9
    names = [name for name in placed if name.startswith("link_dowel")]
    assert len(names) == dims.count("dowels_fitted")
    kept = {name: placed[name] for name in placed if name in names or name.startswith(("rotor", "link"))}
    assert [check.name for check in interference_checks(kept, "here") if not check.ok] == []
    top = dims.link_bottom_level + dims.link_thickness
    for name in names:
        box = placed[name].BoundingBox()
        assert (box.zmax, box.zmin) == pytest.approx((top, top - dims.link_dowel_length))
        # Half a millimetre of room is left below each, in the core.
        below = cq.Vector(*placed[name].Center().toTuple()[:2], box.zmin - 0.25)
        assert not placed["rotor"].isInside(below)
        assert placed["rotor"].isInside(below - cq.Vector(0, 0, 0.5))
    order = [one.name for one in sequence(list(placed))]
    assert sorted(order) == sorted(placed)
    assert order.index("link") < order.index("link_screw_1") < order.index("link_dowel_1")


def test_pins_stand_between_the_screws_and_turn_with_the_link(dims: Dimensions) -> None:
    dowels = {"link_dowel": drawn_parts(dims)["link_dowel"]}
    still, turned = (fasteners.stand(dims, dowels, angle) for angle in (0.0, 0.1))
    for name, shape in still.items():
        a, b = shape.Center(), turned[name].Center()
        assert hypot(a.x, a.y) == pytest.approx(0.7 * dims.core_radius)
        azimuth = np.degrees(np.arctan2(a.y, a.x)) % 90.0
        assert min(azimuth, 90.0 - azimuth) == pytest.approx(0.0, abs=1e-6)
        assert (np.arctan2(b.y, b.x) - np.arctan2(a.y, a.x)) % (2.0 * np.pi) == pytest.approx(0.1)


def test_prints_and_drawings_leave_holes_to_be_reamed(
    dims: Dimensions, placed: dict[str, cq.Solid], design: Design
) -> None:
    for kind in ("rotor", "link"):
        reamed = link_dowels(dims)
        lying = as_printed(placed[kind], PRODUCTION[kind], 0.3, reamed)
        sign = -1.0 if PRODUCTION[kind].down == "top" else 1.0
        at = {(round(x, 6), round(sign * y, 6)) for x, y in reamed}
        kept = [one for one in holes(lying) if any(hypot(one.x - x, one.y - y) < 1e-4 for x, y in at)]
        assert [one.radius for one in kept] == pytest.approx([0.5 * dims.link_dowel_diameter] * len(reamed))
        screws = [one.radius for one in holes(lying) if one not in kept]
        assert all(abs(radius - 0.5 * dims.link_dowel_diameter) > 0.05 for radius in screws)
    for kind in ("rotor", "link"):
        seat = drawing_requirements(kind, dims, design.choices).seats[-1]
        assert (seat.fit, seat.size, seat.letter) == ("H7", pytest.approx(dims.link_dowel_diameter), "")
    hole = f"⌀{figure(dims.wire_diameter + 0.5)}: for bonding"  # rounded as everywhere on the drawing
    assert any(hole in note for note in drawing_requirements("housing", dims, design.choices).notes)
    loose = {**design.choices, "tang_hold": "hole"}
    assert not any("bonding" in note for note in drawing_requirements("housing", dims, loose).notes)


def test_the_bill_has_the_pins_and_the_adhesive(design: Design, dims: Dimensions, placed: dict[str, cq.Solid]) -> None:
    items = bill(design, {"tang_adhesive": "An epoxy"}, placed)
    extra = beside(design, {"tang_adhesive": "An epoxy"})
    pins = next(one for one in items if one.kind == "link_dowel")
    assert (pins.quantity, pins.made) == (dims.count("dowels_fitted"), False)
    (adhesive,) = (one for one in extra if one.kind == "tang_adhesive")
    assert adhesive.title == "An epoxy"
    assert adhesive.mass == pytest.approx(1e3 * design.value("tang_adhesive_mass"))
    assert b"tang_adhesive" in bill_csv([*items, *extra])


def test_screws_alone_and_loose_tangs_have_none_of_it() -> None:
    design = design_of("loose", {"link_fit": "clearance", "tang_hold": "hole"})
    dims = dimensions(design)
    assert "link_dowel" not in drawn_parts(dims)
    assert [one.kind for one in beside(design, {})] == [
        "polymer",
        "heater_adhesive",
        "thermistor",
        "polyimide_film",
        "wire_sleeve",
        "mount_screw",
    ]
    assert drawing_requirements("link", dims, design.choices).seats == []
    assert broken_rules(design_of("fitted", {})) == []
