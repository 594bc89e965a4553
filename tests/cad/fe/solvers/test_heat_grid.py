"""Cells of the heat's solver: sheets, flat backs of pads, and of which part a cell is."""

from typing import Any

import heat_grid
import heat_lines
import numpy as np
import pytest

VANE = {
    "pcl_inner_radius": 13.0, "pcl_outer_radius": 24.0, "core_radius": 8.0, "seat_radius": 8.4, "hub_radius": 11.4,
    "slot_inner_radius": 15.75, "slot_outer_radius": 21.25, "rotor_radius": 32.3,
    "housing_inner_radius": 67.0, "housing_outer_radius": 70.0,
    "pad_depth": 1.5, "rotor_vane_angle": 0.216, "block_angle": 0.216, "vane_count": 6.0, "rotor_bottom_level": 12.8,
    "vane_height": 12.4, "floor_thickness": 4.0, "slot_top_level": 10.4, "rotor_top_level": 16.8,
    "link_bottom_level": 28.6, "spreader_depth": 0.0, "hub_top_level": 12.8,
}  # fmt: skip
ARC = {
    "pcl_inner_radius": 17.4, "pcl_outer_radius": 29.7, "core_radius": 7.4, "seat_radius": 12.0, "hub_radius": 14.0,
    "melt_lip_inner_radius": 15.9, "melt_lip_height": 2.9, "running_clearance": 0.1, "hub_top_level": 2.9,
    "rotor_bottom_level": 3.0, "rotor_top_level": 7.0, "link_bottom_level": 14.5, "rotor_radius": 31.2,
    "housing_inner_radius": 51.3, "housing_outer_radius": 54.3,
    "window_ledge": 2.0, "arc_span": 1.4, "arc_count": 4.0, "spring_count": 4.0,
    "pocket_inner_radius": 17.35, "pocket_outer_radius": 29.75, "pocket_span": 1.4 + 2.0 * 0.05 / 17.4,
    "pad_depth": 3.7, "spreader_depth": 0.5, "floor_thickness": 6.5,
    "tile_radius": 22.7, "tiles_per_arc": 1.0, "tile_pitch": 1.04, "peltier_length": 20.0, "peltier_width": 10.0,
    "cold_plate_length": 20.0,
}  # fmt: skip


def box(low: Any, high: Any) -> tuple[Any, Any]:
    """Return triangles of a box."""
    points = np.array([[(low, high)[k][a] for a, k in enumerate(ends)] for ends in np.ndindex(2, 2, 2)], dtype=float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return points, np.array([three for a, b, c, d in quads for three in ((a, b, c), (a, c, d))])


def test_a_line_through_a_box_passes_its_lower_and_upper_face() -> None:
    points, triangles = box((0, 0, 1), (2, 3, 5))
    assert heat_grid._crossed(points, triangles, 1.1, 0.7) == pytest.approx([1.0, 5.0])
    assert len(heat_grid._crossed(points, triangles, 2.1, 0.7)) == 0


def test_parts_have_their_ends_and_sheets_stand_between_them() -> None:
    found = heat_lines.lines(0.0, 1.0, (1.0, 4, 0.5), (1.0, 0, 1.0), (1.0, 3, 1.0), (4.0, 3, 1.0))
    assert found.ends[[0, 4, 5, -1]] == pytest.approx([0.0, 1.0, 1.0, 4.0])
    assert list(found.sheets) == [False] * 4 + [True] + [False] * 3
    widths = np.diff(found.ends)
    assert widths[1:4] / widths[:3] == pytest.approx(0.5)
    assert found.thickened[-1] == pytest.approx(heat_lines.THIN)


def test_a_pad_in_a_vane_has_a_flat_back() -> None:
    grid = heat_lines.grid_of(VANE, 1.0, 0.19)
    face = 0.5 * VANE["rotor_vane_angle"] + VANE["block_angle"]
    behind = face + np.arcsin(VANE["pad_depth"] / VANE["pcl_inner_radius"])
    radius = np.linspace(VANE["pcl_inner_radius"], VANE["pcl_outer_radius"], 7)
    turned = grid.turned(np.full(7, behind), radius)
    # As far from the plane of the face everywhere.
    assert radius * np.sin(turned - face) == pytest.approx(VANE["pad_depth"])
    end = np.pi / VANE["vane_count"]
    assert grid.turned(np.full(7, end), radius) == pytest.approx(end)
    assert np.all(np.diff(grid.turned(grid.around.ends, np.full(len(grid.around.ends), 20.0))) >= 0.0)


@pytest.mark.parametrize(
    ("before", "after", "between"),
    [("hot", "layer", "near"), ("rotor", "layer", "far"), ("layer", "air", "air"), ("air", "housing", "housing"),
     ("layer", "", ""), ("rotor", "rotor", "rotor"), ("layer", "key", "key"), ("hot", "spreader", "spread"),
     ("housing", "near", "edge"), ("edge", "rotor", "edge")],
)  # fmt: skip
def test_what_a_sheet_is_of(before: str, after: str, between: str) -> None:
    assert heat_grid._sheet(before, after) == between


def test_a_cell_is_of_the_part_its_middle_is_in() -> None:
    # Half a vane that is one box of housing below the floor's face and one of rotor above the blocks.
    far = 200.0
    surfaces = {}
    for name, low, high in (("housing", -4.0, 0.0), ("rotor", 12.8, 16.8)):
        surfaces[f"{name}.points"], surfaces[f"{name}.triangles"] = box((-far, -far, low), (far, far, high))
    grid = heat_lines.grid_of(VANE, 1.6, 0.19)
    found = heat_grid.materials_of(grid, surfaces)
    levels = grid.up.middles
    assert set(found[:, :, levels < 0.0].ravel()) == {"housing"}
    assert set(found[:, :, (levels > 12.8) & (levels < 16.8)].ravel()) == {"rotor"}
    assert set(found[:, :, (levels > 0.0) & (levels < 12.8)].ravel()) == {"", "air"}


def test_lips_and_hub_stand_a_clearance_away_from_what_they_face() -> None:
    # A plate from 3 mm on whose lips reach down to 0.1 mm above the floor; the hub ends 0.1 mm below the plate.
    far, surfaces = 200.0, {}
    for name, low, high in (("housing", -6.5, 0.0), ("rotor", 0.1, 7.0)):
        surfaces[f"{name}.points"], surfaces[f"{name}.triangles"] = box((-far, -far, low), (far, far, high))
    grid = heat_lines.grid_of(ARC, 1.92, 0.19)
    found = heat_grid.materials_of(grid, surfaces)
    lips = (grid.along.middles > ARC["melt_lip_inner_radius"]) & (grid.along.middles < ARC["pcl_inner_radius"])
    levels = grid.up.middles
    assert set(found[lips][:, :, (levels > 0.0) & (levels < 0.1)].ravel()) == {"air"}
    assert np.any((levels > ARC["hub_top_level"]) & (levels < ARC["rotor_bottom_level"]))
    for name in ("hub_radius", "housing_inner_radius", "housing_outer_radius"):
        assert np.any(grid.along.ends == ARC[name])


def parts_of(surfaces: dict[str, Any]) -> dict[str, Any]:
    """Return points and triangles of boxes, by the names the export gives them."""
    return {f"{name}.{kind}": one for name, ends in surfaces.items()
            for kind, one in zip(("points", "triangles"), box(*ends), strict=True)}  # fmt: skip


def test_pads_lips_and_layers_stand_off_by_a_slot() -> None:
    far, low = 200.0, VANE["rotor_bottom_level"] - VANE["vane_height"]
    boxes = {"housing": ((-far, -far, -4.0), (far, far, low)), "peltier_pad_1": ((-far, -far, low), (far, far, 12.4))}
    grid = heat_lines.grid_of(VANE, 1.0, 0.19)
    found = heat_grid.materials_of(grid, parts_of(boxes))
    pads = grid.around.middles > heat_lines.face_angle(VANE)
    ring = (grid.along.middles > VANE["hub_radius"]) & (grid.along.middles < VANE["pcl_outer_radius"])
    column = found[ring][0, np.flatnonzero(pads)[1]]
    slot = np.flatnonzero(column == "edge")
    assert len(slot) == 1
    assert column[slot[0] - 1] == "housing"
    assert column[slot[0] + 1] in heat_grid.PADS
    ends = grid.up.ends[slot[0] : slot[0] + 2]
    assert ends == pytest.approx([low - 0.19, low])
    # All housing below the layer, even in the pocket's corner, and all rotor beside it.
    far, (inner, outer), depth = 200.0, (ARC["pcl_inner_radius"], ARC["pcl_outer_radius"]), ARC["pad_depth"]
    grid = heat_lines.grid_of(ARC, 1.0, 0.19)
    found = heat_grid.materials_of(grid, parts_of({"housing": ((-far, -far, -6.5), (far, far, 0.0))}))
    r, a, z = grid.along.middles, grid.around.middles, grid.up.middles
    within = (r > inner - 0.19) & (r < outer + 0.19)
    arc = a < 0.5 * ARC["arc_span"]
    assert set(found[np.ix_(within, arc, (z > -depth) & (z < 0.0))].ravel()) == {"edge", "seat"}
    rims = within & ((r < inner) | (r > outer))
    assert set(found[np.ix_(rims, arc, (z > -ARC["spreader_depth"]) & (z < 0.0))].ravel()) == {"seat"}
    assert set(found[np.ix_(within, arc, z < -depth)].ravel()) == {"housing"}
    assert "edge" not in found[~within]
    for edge in (inner - 0.19, inner, outer, outer + 0.19):
        assert np.min(np.abs(grid.along.ends - edge)) < 1e-9


def test_cells_are_narrow_at_edges_and_tiles_end_at_lines() -> None:
    parts = heat_lines.graded((0.0, 4.0, 10.0), (10.0,), 1.0, 1.0)
    ends = [0.0, *(end for end, _, _ in parts)]
    assert 4.0 in ends
    assert ends[-1] - ends[-2] == pytest.approx(heat_lines.EDGE, rel=0.5)
    assert max(np.diff(ends)) < heat_lines.WIDEST * 1.5
    grid = heat_lines.grid_of(ARC, 1.0, 0.19)
    for edge in (22.7 - 5.0, 22.7 + 5.0, 22.7 - 3.0):
        assert np.min(np.abs(grid.along.ends - edge)) < 1e-9


def test_the_air_around_blocks_is_shut_in_and_that_of_a_slot_is_its_own() -> None:
    grid = heat_lines.grid_of(VANE, 1.0, 0.19)
    names = np.full((len(grid.along.middles), len(grid.around.middles), len(grid.up.middles)), "", dtype="U20")
    found = heat_grid.enclosed(grid, names)
    r, a, z = grid.along.middles, grid.around.middles, grid.up.middles
    inside = (r > VANE["slot_inner_radius"]) & (r < VANE["slot_outer_radius"])
    behind = a > heat_lines.face_angle(VANE)
    assert set(found[np.ix_(inside, behind, z < VANE["slot_top_level"])].ravel()) == {"slot"}
    assert set(found[np.ix_(inside, ~behind, (z > 0.0) & (z < VANE["rotor_bottom_level"]))].ravel()) == {"chamber"}
    beyond = (r > VANE["rotor_radius"]) & (r < VANE["housing_inner_radius"])
    assert set(found[beyond][:, :, z > 0.0].ravel()) == {"room"}
    assert set(found[r > VANE["housing_inner_radius"]].ravel()) == {""}
    # Arcs lie in gaps whose air is drawn.
    arcs = heat_lines.grid_of(ARC, 1.0, 0.19)
    shape = [len(one.middles) for one in (arcs.along, arcs.around, arcs.up)]
    assert set(heat_grid.enclosed(arcs, np.full(shape, "", dtype="U20")).ravel()) == {"", "room"}
