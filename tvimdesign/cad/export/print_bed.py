"""The print bed: where parts lie on it, and the settings of their process as PrusaSlicer reads them from a 3MF."""

from collections.abc import Mapping, Sequence
from math import ceil, degrees, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.signal import fftconvolve
from scipy.spatial import ConvexHull

from tvimdesign.cad.geometry.dimensions import Dimensions

LINE = 0.4
"""Width of a printed line [mm] of the commonest nozzle, which is as wide."""
LAYER = 0.2
"""Height of a layer [mm]; assumed, 0.1 to 0.3: half of a line."""
GAP = 5.0
"""Between parts on the bed [mm]; assumed, 3 to 10: supports stand in it."""
CELL = 2.0
"""Side of the squares in which a bed is filled [mm]."""
_MARGIN = 0.5 * GAP + CELL / sqrt(2.0)
"""How far from a part the middle of a square may lie that has something of half of the gap around it [mm]."""
SLICER_CONFIG = "Metadata/Slic3r_PE.config"
"""Where PrusaSlicer keeps its settings in a 3MF, a line each behind a semicolon; it skips the first line."""
_ROUNDING = 1e-6
Array = NDArray[np.float64]


class Spot(NamedTuple):
    """Place of a part: its bed, the corner of its box nearest the origin [mm], turned by 90 degrees or not."""

    bed: int
    x: float
    y: float
    turned: bool


def lay_out(outlines: Sequence[Array], bed: tuple[float, float]) -> list[Spot | None]:
    """Lay parts on as few beds as it takes, the largest first, each as near the front as it can be; all in mm.

    An outline is the points of a part, from above; what counts is their convex hull. Parts keep `GAP` from each other
    and half of it from the edge. One that is too large for a bed gets None. What lies on a bed is around its middle.
    """
    cells = int(bed[0] / CELL), int(bed[1] / CELL)
    taken: list[NDArray[np.bool_]] = []
    spots: list[Spot | None] = [None] * len(outlines)
    hulls = [points[ConvexHull(points).vertices] for points in outlines]
    for index in sorted(range(len(hulls)), key=lambda each: (-ConvexHull(hulls[each]).volume, each)):
        ways = [(_covered(hulls[index]), False), (_covered(_turned(hulls[index])), True)]
        ways = [
            (mask, is_turned) for mask, is_turned in ways if mask.shape[0] <= cells[0] and mask.shape[1] <= cells[1]
        ]
        number = 0
        while ways and spots[index] is None:
            taken += [np.zeros(cells, dtype=np.bool_)] if number == len(taken) else []
            places = [(*place, is_turned) for mask, is_turned in ways if (place := _first_free(taken[number], mask))]
            if places:
                y, x, is_turned = min(places)
                mask = next(mask for mask, way in ways if way == is_turned)
                taken[number][x : x + mask.shape[0], y : y + mask.shape[1]] |= mask
                spots[index] = Spot(number, CELL * x + _MARGIN, CELL * y + _MARGIN, is_turned)
            number += 1
    shifts = []
    for covered in taken:
        ends = [CELL * (1 + int(np.flatnonzero(covered.any(axis=axis)).max())) for axis in (1, 0)]
        shifts.append([0.5 * (side - end) for side, end in zip(bed, ends, strict=True)])
    return [spot and spot._replace(x=spot.x + shifts[spot.bed][0], y=spot.y + shifts[spot.bed][1]) for spot in spots]


def _turned(points: Array) -> Array:
    return np.stack((-points[:, 1], points[:, 0]), axis=1)


def _covered(points: Array) -> NDArray[np.bool_]:
    """Return the squares that a hull covers with half of the gap around it; its box starts `_MARGIN` from the first."""
    low, high = points.min(axis=0) - _MARGIN, points.max(axis=0) + _MARGIN
    x, y = (low[axis] + CELL * (np.arange(ceil((high[axis] - low[axis]) / CELL)) + 0.5) for axis in (0, 1))
    sides = ConvexHull(points).equations  # normals outwards, and the way from there to the origin
    away = sides[:, 0, None, None] * x[:, None] + sides[:, 1, None, None] * y + sides[:, 2, None, None]
    return np.asarray(away.max(axis=0) <= _MARGIN)


def _first_free(taken: NDArray[np.bool_], mask: NDArray[np.bool_]) -> tuple[int, int] | None:
    """Return row and column nearest the front, then the left, where a mask covers no square that is taken."""
    shared = fftconvolve(taken.astype(float), mask[::-1, ::-1].astype(float), mode="valid")
    x, y = np.nonzero(shared < 0.5)
    return min(zip(y.tolist(), x.tolist(), strict=True), default=None)


def walls(dims: Dimensions) -> int:
    """Return how many lines of plastic go around everything: as many as make the thinnest wall of the process."""
    return ceil(dims.minimum_wall / LINE - _ROUNDING)


def description(dims: Dimensions, material: str, temperatures: Mapping[str, str]) -> str:
    """Return the settings in words, for any slicer; `temperatures` [degC] by their names."""
    heat = "".join(f", {name.removesuffix('_temperature')} at {value} °C" for name, value in temperatures.items())
    return f"{material}: {LINE:g} mm nozzle, layers of {LAYER:g} mm, {walls(dims)} walls, infill 100 %{heat}"


def slicer_config(dims: Dimensions, density: float, temperatures: Mapping[str, str]) -> str:
    """Return the settings for PrusaSlicer; `density` in kg/m3.

    Supports stand where faces lean more than the process bears, on the bed only, and end a layer short of the part.
    """
    length, width = dims.bed_length, dims.bed_width
    settings = {
        "printer_technology": "FFF",
        "bed_shape": f"0x0,{length:g}x0,{length:g}x{width:g},0x{width:g}",
        "max_print_height": f"{dims.bed_height:g}",
        "nozzle_diameter": f"{LINE:g}",
        "extrusion_width": f"{LINE:g}",
        "layer_height": f"{LAYER:g}",
        "first_layer_height": f"{LAYER:g}",
        "perimeters": f"{walls(dims)}",
        "fill_density": "100%",
        "fill_pattern": "rectilinear",
        "skirts": "0",
        "support_material": "1",
        "support_material_buildplate_only": "1",
        "support_material_contact_distance": f"{LAYER:g}",
        "support_material_threshold": f"{90.0 - degrees(dims.overhang_angle):.0f}",
        "filament_density": f"{1e-3 * density:g}",
    }
    for name in ("temperature", "bed_temperature"):
        value = temperatures["nozzle_temperature" if name == "temperature" else name]
        settings |= {name: value, f"first_layer_{name}": value}
    return "".join(
        f"; {line}\n" for line in ("tvimdesign", "", *(f"{name} = {text}" for name, text in settings.items()))
    )
