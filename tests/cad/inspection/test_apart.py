"""Which parts are surely apart by their meshes: never two that touch, or one inside the other."""

import cadquery as cq
import numpy as np
import pytest

from tvimdesign.cad.export.mesh import Instance, solid_mesh
from tvimdesign.cad.inspection.size_checks import ROOM, PlacedBodies, interference_checks


def cylinder(radius: float, height: float = 10.0) -> cq.Solid:
    return cq.Solid.makeCylinder(radius, height)


def at(solid: cq.Solid, x: float) -> Instance:
    matrix = np.eye(4)
    matrix[0, 3] = x
    return Instance(solid_mesh(solid), matrix)


@pytest.mark.parametrize(
    ("gap", "apart"), [(-1.0, False), (0.0, False), (0.5 * ROOM, False), (1.5 * ROOM, True), (5.0, True)]
)
def test_parts_are_apart_if_their_meshes_are_further_than_their_error(gap: float, apart: bool) -> None:
    placed = {"rotor": at(cylinder(5.0), 0.0), "cover": at(cylinder(5.0), 10.0 + gap)}
    assert PlacedBodies(placed).apart("rotor", "cover") == apart


def test_parts_are_apart_by_bores_copies_and_closed_meshes() -> None:
    placed = {"housing": at(cylinder(20.0, 30.0), 0.0), "link_dowel_1": at(cylinder(2.0).translate((0, 0, 10.0)), 0.0)}
    assert not PlacedBodies(placed).apart("housing", "link_dowel_1")
    bored = cylinder(20.0, 30.0).cut(cylinder(3.0, 30.0)).Solids()[0]
    placed = {"housing": at(bored, 0.0), "link_screw_1": at(cylinder(2.0, 30.0), 0.0)}
    assert PlacedBodies(placed).apart("housing", "link_screw_1")
    broken = at(cylinder(5.0), 50.0)
    open_mesh = Instance(type(broken.mesh)(broken.mesh.vertices, broken.mesh.faces[1:]), broken.matrix)
    assert not PlacedBodies({"housing": at(cylinder(5.0), 0.0), "cover": open_mesh}).apart("housing", "cover")
    placed = {
        "housing": at(cylinder(5.0), 0.0),
        "pcl_arc_1": at(cylinder(5.0), 10.0),
        "pcl_arc_2": at(cylinder(5.0), 50.0),
    }
    bodies = PlacedBodies(placed)
    assert not bodies.apart("housing", "pcl_arc_1")
    assert not bodies.apart("housing", "pcl_arc_2")


def test_only_parts_that_may_meet_are_compared_with_the_same_result() -> None:
    ring = cylinder(20.0, 30.0).cut(cylinder(3.0, 30.0)).Solids()[0]
    solids = {"housing": ring, "link_screw_1": cylinder(2.0, 30.0), "rotor": cylinder(3.5, 30.0)}
    bodies = PlacedBodies({name: at(solid, 0.0) for name, solid in solids.items()})
    asked: list[tuple[str, str]] = []

    def apart(first: str, second: str) -> bool:
        asked.append((first, second))
        return bodies.apart(first, second)

    plain, quick = (list(interference_checks(solids, "at rest", **more)) for more in ({}, {"apart": apart}))
    assert plain == quick
    assert [check.ok for check in quick] == [True, False, False, True]
    assert len(asked) == 3


@pytest.mark.parametrize("cut", [None, 1, 2, 3])
def test_the_copy_that_cuts_a_part_is_found_among_all(cut: int | None) -> None:
    solids = {"housing": cylinder(20.0)}
    for number in (1, 2, 3):
        x, y = 25.0 * np.cos(2.0 * number), 25.0 * np.sin(2.0 * number)
        nearer = 0.9 if number == cut else 1.0  # the others touch it along a line
        solids[f"pcl_arc_{number}"] = cylinder(5.0).translate((float(nearer * x), float(nearer * y), 0.0))
    found = {check.name: check for check in interference_checks(solids, "at rest")}
    for number in (1, 2, 3):
        check = found[f"housing | pcl_arc_{number} at rest"]
        assert check.ok == (number != cut)
        alone = solids["housing"].intersect(solids[f"pcl_arc_{number}"]).Volume()
        assert check.value == pytest.approx(alone, rel=1e-9)
