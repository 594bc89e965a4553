"""The solids of the frozen joint that carry its torque, cut out of the exported parts, with named faces.

What carries no torque (journal, hub above the floor, pins, posts) is cut away: it would touch its neighbour.
"""

from pathlib import Path
from typing import Any

import numpy as np
from netgen.occ import Axis, Box, Cylinder, Dir, HalfSpace, OCCGeometry, Pnt, Vec

FOOT, EDGE, SEAT = 0.5, 2.0, 0.6
"""Elements at the core's foot, along the arcs' edges, and in the adhesive around a spreader [mm]."""
SIZES = {"plate": 6.0, "housing": 12.0, "layer": 5.0}  # mm
PRESSED, RUBBER = 0.4, 0.8
"""Size of elements in a pad that is pressed, over its thickness; and in one of rubber, which keeps its volume: there
displacements are cubic, as of quadratic ones 0.4 has it a fifth too stiff."""
WINDOW = 0.125, 0.2  # Elements along the windows' edges, over the thickness of the pads on them, and at least [mm]
PAD_GAP = 0.2  # How far the walls of a pad's pocket stand off it [mm]; they are not bonded to it
OTHER_GAPS = 0.3, 0.25, 0.35
"""The same where the first leaves an edge shorter than `SLIVER`, which gets no mesh: a wall beside a vane's end."""
SLIVER = 0.02
BEAD_ROOM = 0.2  # How far a vane's sill stands off a thermistor's hole [mm], which would graze its corner
WALL_GAP = 0.3
"""How far the plain wall stands back from the springs' wells [mm], which would touch it: such a floor gets no mesh."""


def tube(inner: float, outer: float, bottom: float, top: float) -> Any:
    """Return ring about the axis [mm]."""
    whole = Cylinder(Pnt(0, 0, bottom), Dir(0, 0, 1), r=outer, h=top - bottom)
    return whole - Cylinder(Pnt(0, 0, bottom - 1), Dir(0, 0, 1), r=inner, h=top - bottom + 2) if inner else whole


def sectors(
    mm: dict[str, float], bottom: float, top: float, wider: float = 0.0, ledge: float = 0.0, rims: float | None = None
) -> list[Any]:
    """Return one sector with sharp corners for each arc of PCL, wider on each side, or narrower by a ledge [mm].

    `rims` is by how much it is wider along its rims, if not as much as at its ends.
    """
    beyond = (wider if rims is None else rims) - ledge
    inner, outer = mm["pcl_inner_radius"] - beyond, mm["pcl_outer_radius"] + beyond
    half, solids = 0.5 * mm["arc_span"] - ledge / mm["pcl_inner_radius"], []
    for arc in range(round(mm["arc_count"])):
        middle = 2 * np.pi * arc / mm["arc_count"] + np.pi / mm["spring_count"]
        shape = tube(inner, outer, bottom, top)
        for sense in (-1, 1):
            side = middle + sense * half
            out = Vec(-sense * np.sin(side), sense * np.cos(side), 0)
            shape *= HalfSpace(Pnt(wider * out.x, wider * out.y, 0), out)
        solids.append(shape)
    return solids


def parts(folder: Path, mm: dict[str, float], coarser: float, pressed: float = PRESSED) -> list[Any]:
    """Return the solids that carry the torque, named, with the size of their elements.

    `pressed`: of pads, over thickness.
    """

    def read(name: str) -> Any:
        return OCCGeometry(str(folder / f"{name}.step")).shape

    far = 500.0
    bottom, top = mm["rotor_bottom_level"], mm["rotor_top_level"]
    blocks = mm.get("vane_count", 0.0) > 0.0
    journal = mm["pcl_inner_radius"] - 0.3 if blocks else far
    # Pins or their bosses go with their fillets, which end a tenth of a millimetre or more beside the core's.
    inside = mm["pin_radius"] - 0.5 * mm["pin_foot_diameter"] - mm["foot_fillet"] - 0.05
    rotor = read("rotor") - tube(0, journal, -far, bottom) - tube(inside, far, top, far)
    rigid = not blocks and mm["spreader_depth"] > 0.0
    # A liner fills its recess here, the film and the gap at its edges, both of adhesive, with it. Validation asks too
    # what it does with a gap that is empty.
    lined, recess = not blocks and bool(mm.get("liner_depth")), (bottom, bottom + mm.get("liner_depth", 0.0))
    liners = sectors(mm, *recess) if lined else []
    for hollow in sectors(mm, *recess, wider=mm.get("liner_gap", 0.0)) if lined else []:
        rotor -= hollow
    if blocks:
        heaters = [*folder.glob("heater_[0-9]*.step"), *folder.glob("spreader_*.step")]
        housing = _ring_housing(read("housing"), mm, [read(path.stem) for path in sorted(heaters)])
    else:
        housing = _arc_housing(read("housing"), mm, _tile_pockets(mm) if rigid else _pad_pockets(mm))
    kinds = _pressed(folder, mm, pressed) if blocks else _sheared(folder)
    solids = [(rotor, "rotor", SIZES["plate"]), (housing, "housing", SIZES["housing"])]
    solids += [(read(name), label, size) for name, label, size in kinds]
    solids += [(liner, "liner", SIZES["layer"]) for liner in liners]
    if rigid:
        spreaders = [(plate, "spreader", SIZES["layer"]) for plate in sectors(mm, -mm["spreader_depth"], 0.0)]
        solids += [*spreaders, *((adhesive, "seat", SEAT) for adhesive in _seats(mm))]
    elif not blocks:
        solids += [(pad, "pad", SIZES["layer"]) for pad in sectors(mm, -mm["heater_thickness"], 0.0)]
    for shape, label, size in solids:
        for solid in shape.solids:
            solid.name, solid.maxh = label, size * coarser
    return [shape for shape, _, _ in solids]


def _pressed(folder: Path, mm: dict[str, float], pressed: float) -> list[tuple[str, str, float]]:
    """Return files of the blocks of one sense, which are pressed, and of what they press on, with name and size of
    elements.

    Blocks are counted around the axis from a rotor's vane, heaters from a housing's: each has two of them.
    """
    row = round(mm["tiles_per_block"]) if mm["spreader_depth"] else 1
    thin = pressed * mm["heater_thickness"]
    kinds = {"pcl_block": ("pcl", SIZES["layer"], 1, 1), "heater": ("pad", thin, 0, row)}
    if mm["spreader_depth"]:
        kinds |= {"spreader": ("spreader", SIZES["layer"], 0, 1)}
    files = []
    for path in sorted(folder.glob("*_*.step")):
        kind, _, number = path.stem.rpartition("_")
        if kind in kinds:
            label, size, parity, count = kinds[kind]
            if ((int(number) - 1) // count + 1) % 2 == parity:
                files.append((path.stem, label, size))
    return files


def _sheared(folder: Path) -> list[tuple[str, str, float]]:
    """Return files of the arcs of PCL, with name and size of elements.

    Rigid modules lie in grease and slide: they are left out.
    """
    return [(path.stem, "pcl", SIZES["layer"]) for path in sorted(folder.glob("pcl*.step"))]


def _seats(mm: dict[str, float]) -> list[Any]:
    """Return the adhesive along both rims of each spreader."""
    low, gap = -mm["spreader_depth"], mm["spreader_gap"]
    whole, inside = sectors(mm, low, 0.0, rims=gap), sectors(mm, low - 1.0, 1.0)
    return [solid for around, plate in zip(whole, inside, strict=True) for solid in (around - plate).solids]


def _ring_housing(whole: Any, mm: dict[str, float], pads: list[Any]) -> Any:
    """Return the housing of the compression module without its hub above the floor and its wall.

    Pads stand off the floors of their pockets, beyond their ends too: without the gap the lower edge of a block, or the
    end of that edge, would belong to the vane as well, and a line or a point that is tied bears more than a soft pad.
    """
    far, inside = 500.0, 0.5 * (mm["hub_radius"] + mm["pcl_inner_radius"])
    bare = _without_bead_hole(whole, mm) - tube(0, inside, 0.0, far) - tube(mm["pcl_outer_radius"] + 0.5, far, 0.0, far)
    plain = bare.UnifySameDomain()
    housing = plain
    for gap in (PAD_GAP, *OTHER_GAPS):
        housing = _with_gaps(plain, pads, gap)
        if min(float(edge.mass) for edge in housing.edges) > SLIVER:
            break
    return housing


def _without_bead_hole(housing: Any, mm: dict[str, float]) -> Any:
    """Return housing whose floor has no hole for a thermistor, which grazes the corner of a vane's sill."""
    wide, floor = mm.get("thermistor_seat_diameter", 0.0), -mm["floor_thickness"]
    for low, high in (face.bounding_box for face in housing.faces) if wide else ():
        if abs(high.x - low.x - wide) < 1e-3 and abs(high.y - low.y - wide) < 1e-3 and abs(low.z - floor) < 1e-3:
            middle, radius = Pnt(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), floor), 0.5 * wide
            sill = Cylinder(Pnt(middle.x, middle.y, 0.0), Dir(0, 0, 1), r=radius + BEAD_ROOM, h=high.z + 1.0)
            return (housing - sill) + Cylinder(middle, Dir(0, 0, 1), r=radius, h=-floor)
    return housing


def _with_gaps(housing: Any, pads: list[Any], gap: float) -> Any:
    """Return housing whose pockets' walls stand off the pads."""
    for pad in pads:
        for sense in (-1, 0, 1):
            housing -= pad.Move(_along(pad, sense * gap) - Vec(0, 0, gap))
    return housing


def _along(pad: Any, length: float) -> Any:
    """Return a length [mm] along the longest level edge of a plate that stands upright."""
    level = [edge for edge in pad.edges if abs(edge.end.z - edge.start.z) < 1e-6]
    longest = max(level, key=lambda edge: float(edge.mass))
    way = longest.end - longest.start
    return length / way.Norm() * way


def _arc_housing(whole: Any, mm: dict[str, float], openings: list[Any]) -> Any:
    """Return the housing of the shear module with a plain wall, and the openings for its pads with sharp corners.

    Where a radius leaves a tenth of a millimetre straight no mesh is found.
    """
    far = 500.0
    wall = tube(mm["housing_inner_radius"] + WALL_GAP, mm["housing_outer_radius"], 0.0, mm["rim_level"])
    housing = (whole - tube(0, far, 0.0, far)) + wall  # bosses of the wall left out
    # Filled before it is cut, else the rounded openings' edges stay in its faces. Holes of leads are filled too.
    deep = mm["floor_thickness"] if mm["spreader_depth"] else mm["heater_thickness"] + 0.2
    for filling in sectors(mm, -deep, 0.0, wider=mm["slip_clearance"] + 0.1, rims=mm["heater_gap"] + 0.1):
        housing += filling
    for opening in openings:
        housing -= opening
    return housing


def _pad_pockets(mm: dict[str, float]) -> list[Any]:
    """Return pockets of pads cut to the PCL, and the windows below them."""
    pads, floor = -mm["heater_thickness"], -mm["floor_thickness"]
    pockets = sectors(mm, pads, 1.0, wider=PAD_GAP)
    return [*pockets, *sectors(mm, floor - 1.0, pads, ledge=mm["window_ledge"])]


def _tile_pockets(mm: dict[str, float]) -> list[Any]:
    """Return pockets of rigid modules with the spreader on them, and the window below each module."""
    low, top = -mm["floor_thickness"] - 1.0, -mm["pad_depth"]
    deep, long = (0.5 * mm[size] - mm["window_ledge"] for size in ("heater_width", "cold_plate_length"))
    porch = 0.5 * mm["heater_porch"]
    count, pockets = round(mm["tiles_per_arc"]), sectors(mm, top, 1.0, wider=PAD_GAP, rims=mm["spreader_gap"])
    for arc in range(round(mm["arc_count"])):
        middle = 2 * np.pi * arc / mm["arc_count"] + np.pi / mm["spring_count"]
        for tile in range(count):
            inner, outer = mm["tile_radius"] - deep, mm["tile_radius"] + deep
            window = Box(Pnt(inner, porch - long, low), Pnt(outer, porch + long, top))
            turn = middle + mm["tile_pitch"] * (tile - 0.5 * (count - 1))
            pockets.append(window.Rotate(Axis(Pnt(0, 0, 0), Dir(0, 0, 1)), np.degrees(turn)))
    return pockets


def refine(whole: Any, mm: dict[str, float], coarser: float) -> None:
    """Make elements small where stress is looked at: the core's foot, and the edges of the arcs.

    And where a window ends below a pad, whose shear has no bound there.
    """
    top, low, high = mm["rotor_top_level"], -0.01, mm.get("pcl_thickness", -1.0) + 0.01
    fillet = mm.get("foot_fillet", 0.0)
    foot = mm["core_radius"] + fillet
    pads = -mm["heater_thickness"] if "pcl_thickness" in mm and not mm["spreader_depth"] else -np.inf
    for edge in whole.edges:
        box = edge.bounding_box
        flat = box[1].z - box[0].z < 1e-4
        wide = max(box[1].x - box[0].x, box[1].y - box[0].y)
        centre = edge.center
        if flat and min(abs(box[0].z - top), abs(box[0].z - top - fillet)) < 1e-3 and wide < 2.02 * foot:
            if np.hypot(centre.x, centre.y) < foot + 0.01 and wide > 0.5 * mm["core_radius"]:
                edge.maxh = FOOT * coarser
        elif flat and abs(box[0].z - pads) < 1e-3 and _beside_window(edge, mm):
            edge.maxh = max(WINDOW[0] * mm["heater_thickness"], WINDOW[1]) * coarser
        elif flat and low < box[0].z < high and np.hypot(centre.x, centre.y) > mm["core_radius"] + 0.5:
            edge.maxh = EDGE * coarser


def _beside_window(edge: Any, mm: dict[str, float]) -> bool:
    """Return whether a level edge is that of a window below a pad: all of it is a ledge away from the arc's rims."""
    ends = [np.hypot(point.x, point.y) for point in (edge.start, edge.end)]
    inner, outer = mm["pcl_inner_radius"] + mm["window_ledge"], mm["pcl_outer_radius"] - mm["window_ledge"]
    return bool(min(ends) > inner - 0.01 and max(ends) < outer + 0.01)


def name_faces(whole: Any, mm: dict[str, float]) -> None:
    """Name what stands on the ground, and the core's top, which turns; raises ValueError where there is no such."""
    ground, top = -mm["floor_thickness"] - mm["foot_height"], mm["link_bottom_level"]
    for face in whole.faces:
        centre, low, high = face.center, face.bounding_box[0].z, face.bounding_box[1].z
        flat, wide = high - low < 1e-4, face.bounding_box[1].x - face.bounding_box[0].x
        beside = abs((centre.x**2 + centre.y**2) ** 0.5 - mm["placement_radius"]) < 0.2
        if flat and abs(low - top) < 1e-3:
            face.name = "turned"
        elif flat and abs(low - ground) < 1e-3 and beside and wide < 3 * mm["mount_boss_radius"]:  # a foot
            face.name = "fixed"
        else:
            face.name = "free"
    named = {face.name for face in whole.faces}
    if not named >= {"turned", "fixed"}:
        raise ValueError(f"of the faces that turn and that stand on the ground only {named - {'free'}} were found")
