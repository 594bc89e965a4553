"""Labelled sections in docs/pictures, drawn from the parts: every radius, level and height by its name."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from math import dist, pi
from pathlib import Path
from typing import Any

import cadquery as cq
import matplotlib as mpl
import numpy as np
import yaml
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline

from tvimdesign.cad.assembly.assembly import drawn_parts, place
from tvimdesign.cad.geometry.dimensions import Dimensions, dimensions_of
from tvimdesign.cad.geometry.kinds import KINDS, kind_of
from tvimdesign.cad.geometry.solids import turned
from tvimdesign.device import Choice, table_for
from tvimdesign.study import given, read_study

ROOT = Path(__file__).resolve().parents[2]
LABELS: dict[str, Any] = yaml.safe_load((Path(__file__).parent / "section_labels.yaml").read_text())
SECTIONS = ("paper_reconstructed", "paper_compression", "elbow_machined", "held_layer", "with_motor")
"""Modules that are drawn, as each study starts: both modes, then ball bearings, a wave spring with lips, a motor."""
VARIANTS = {
    "held_layer": ("paper_reconstructed", {"axial_preload": "wave_21x25", "melt_lip": "rings"}),
    "with_motor": ("paper_reconstructed", {"motor": "ilm_e70x10", "encoder": "on_axis_28"}),
}
"""Of those that no study holds: the study, and what its module has beside."""
FOLDERS = ("studies", "tests/studies")
LENGTHS = re.compile(r"_(radius|level|height|thickness)$")
_SIGN = {"left": -1.0, "right": 1.0}
_SPACING = 3.2
"""Least distance [mm of the module] between two labels."""
_COLOURS = {"radii": "#1f4e9c", "levels": "#a3301f", "heights": "#2c6b2f"}


def start(study: str) -> Dimensions:
    """Return the dimensions of a study's module at the study's start, in mm."""
    name, more = VARIANTS.get(study, (study, {}))
    read = read_study(next(path for folder in FOLDERS if (path := ROOT / folder / f"{name}.yaml").exists()))
    read = read.model_copy(update={"module": {**read.module, **more}})
    table = table_for(read.mode)
    known = table.settled(given(read))
    numbers = {name: float(value) for name, value in known.items() if isinstance(value, (int, float, np.floating))}
    return dimensions_of(
        read.mode, numbers, {row.name: str(getattr(known[row.name], "name", known[row.name])) for row in table.choices}
    )


def to_label(dims: Dimensions) -> list[str]:
    """Return the radii, levels, heights and thicknesses of a module, by name."""
    table = table_for(dims.mode)
    lengths = [q.name for q in table.quantities if not isinstance(q, Choice) and q.unit == "mm"]
    names = [name for name in lengths if LENGTHS.search(name)]
    skipped = {q.name for q in table.quantities if q.group in {"Gaps", "Process"}} | _unused(dims)
    return [name for name in names if name not in skipped and dims.by_name.get(name, 0.0) != 0.0]


def _unused(dims: Dimensions) -> set[str]:
    """Return the inputs that count only with something the module lacks."""
    inputs = table_for(dims.mode).inputs
    return {q.name for q in inputs if any(_lacks(dims, feature.choice) for feature in q.requires)}


def _lacks(dims: Dimensions, choice: str) -> bool:
    """Return True if a module lacks a choice's part, by a dimension that is zero without it."""
    sign = {"motor": "drive_height", "cover": "cover_height", "preload_adjuster": "adjuster_radius",
            "encoder": "encoder_board_radius",
            "axial_preload": "preload_height"}  # fmt: skip
    return dims.by_name.get(sign.get(choice, ""), 1.0) == 0.0


def labelled(dims: Dimensions) -> dict[str, list[str]]:
    """Return the names of each list of `LABELS` that are drawn for a module."""
    unused = _unused(dims)
    return {
        kind: [name for name, how in entries.items() if name not in unused and _is_drawn(dims, name, how)]
        for kind, entries in LABELS.items()
    }


def _is_drawn(dims: Dimensions, name: str, how: Any) -> bool:
    if isinstance(how, Mapping) and dims.mode not in how.get("modes", [dims.mode]):
        return False
    needs = (name, how["needs"]) if isinstance(how, Mapping) and "needs" in how else (name,)
    return all(dims.by_name.get(need, 0.0) != 0.0 for need in needs)


def total(dims: Dimensions, text: Any) -> float:
    """Evaluate a sum such as `placement_radius - post_radius` or `0.5 rim_level` in mm."""
    value = 0.0
    for sign, factor, name in re.findall(r"([+-]?)\s*(\d*\.?\d*)\s*([a-z_]*)", str(text)):
        if factor or name:
            size = float(factor or 1.0) * (getattr(dims, name) if name else 1.0)
            value += -size if sign == "-" else size
    return value


# --- the cut parts ---------------------------------------------------------------------------------------------------


def cut_faces(solid: cq.Shape, plane: cq.Face, flat: Sequence[int]) -> list[Outline]:
    """Cut a solid by a plane; return outlines in two of the three coordinates."""
    return [
        Outline.make_compound_path(
            _wound(_outline(face.outerWire(), flat), 1.0), *(_wound(_outline(w, flat), -1.0) for w in face.innerWires())
        )
        for face in solid.intersect(plane).Faces()
    ]


def _wound(outline: Outline, sense: float) -> Outline:
    """Orient an outline counter-clockwise (1) or clockwise (-1), so that holes stay empty."""
    x, y = outline.vertices.T
    area = 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    return Outline(outline.vertices[:: 1 if area * sense > 0 else -1])


def _outline(wire: cq.Wire, flat: Sequence[int]) -> Outline:
    """Return a wire as points; its edges come in order, each in its own sense."""
    first, *others = [_sampled(edge) for edge in wire]
    if others and min(dist(first[0], end) for end in (others[0][0], others[0][-1])) < 1e-6:
        first.reverse()
    points = first
    for piece in others:
        points += piece[::-1] if dist(piece[-1], points[-1]) < dist(piece[0], points[-1]) else piece
    return Outline([[point[axis] for axis in flat] for point in points])


def _sampled(edge: cq.Edge) -> list[tuple[float, ...]]:
    count = 2 if edge.geomType() == "LINE" else int(np.clip(2.0 * edge.Length(), 12, 200))
    return [at.toTuple() for at in edge.positions(np.linspace(0.0, 1.0, count).tolist())]


def half_section(placed: Mapping[str, cq.Shape], azimuth: float, size: float) -> dict[str, list[Outline]]:
    """Return outlines of all parts in the half plane at an azimuth [rad], by name: radius right, level up."""
    plane = cq.Face.makePlane(size, 2.0 * size, cq.Vector(0.5 * size, 0.0, 0.0), cq.Vector(0.0, 1.0, 0.0))
    outlines_by_name: dict[str, list[Outline]] = {}
    for name, shape in placed.items():
        box = shape.BoundingBox()
        if box.zmax > -size and (outlines := cut_faces(turned(shape, -azimuth), plane, (0, 2))):
            outlines_by_name[name] = outlines
    return outlines_by_name


# --- the drawing -----------------------------------------------------------------------------------------------------


def draw(study: str, path: Path) -> None:
    """Draw one study's module: left half cut through a spring, right half between two springs."""
    dims = start(study)
    placed = place(dims, drawn_parts(dims))
    size = 2.0 * dims.envelope_diameter + dims.envelope_height
    halves = {"left": 0.0, "right": pi / dims.count("spring_count")}
    figure, axes = _sheet(dims)
    for half, azimuth in halves.items():
        for name, outlines in half_section(placed, azimuth, size).items():
            for outline in outlines:
                mirrored = Outline(outline.vertices * [_SIGN[half], 1.0], outline.codes)
                colour = KINDS[kind_of(name)].colour
                axes.add_patch(PathPatch(mirrored, facecolor=colour, edgecolor="black", linewidth=0.5, alpha=0.85))
    bottom, top = _bounds(dims)
    axes.plot([0.0, 0.0], [bottom - 3.0, top + 2.0], color="black", linewidth=0.7, dashes=(14, 3, 2, 3))
    _label_radii(axes, dims)
    _label_sides(axes, dims)
    figure.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else {"Software": None}, dpi=110)


def _sheet(dims: Dimensions) -> tuple[Figure, Axes]:
    """Make a sheet with room for the labels; a unit is a millimetre of the module."""
    bottom, top = _bounds(dims)
    outside = max(dims.housing_outer_radius, dims.by_name.get("motor_outer_radius", 0.0))
    width, height = 2.0 * (outside + 43.0), top - bottom + 72.0
    figure = Figure(figsize=(0.0745 * width, 0.0745 * height))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(-0.5 * width, 0.5 * width), ylim=(bottom - 37.0, top + 35.0), aspect="equal")
    axes.axis("off")
    return figure, axes


def _bounds(dims: Dimensions) -> tuple[float, float]:
    return (total(dims, "-floor_thickness - foot_height - drive_height"),
            total(dims, "link_bottom_level + link_thickness + link_screw_head_height"))  # fmt: skip


def _label_radii(axes: Axes, dims: Dimensions) -> None:
    """Write names of radii, upright, above and below the section, with a line from dot to name."""
    bottom, top = _bounds(dims)
    for side, edge in (("above", top + 3.0), ("below", bottom - 4.0)):
        marks = []
        for name in labelled(dims)["radii"]:
            how = LABELS["radii"][name]
            if how["labels"] == side:
                marks.append((_SIGN[how["half"]] * total(dims, how.get("place", name)), total(dims, how["at"]), name))
        for name in labelled(dims)["widths"]:
            how = LABELS["widths"][name]
            if how["labels"] == side:
                ends = [_SIGN[how["half"]] * total(dims, how[key]) for key in ("from", "to")]
                _arrow(axes, (ends[0], total(dims, how["at"])), (ends[1], total(dims, how["at"])))
                marks.append((0.5 * sum(ends), total(dims, how["at"]), name))
        up = 1.0 if side == "above" else -1.0
        for (radius, level, name), at in _spread(marks, 0):
            line = [(radius, level), (radius, edge), (at, edge + 5.0 * up), (at, edge + 6.0 * up)]
            colour = _COLOURS["heights" if name in LABELS["widths"] else "radii"]
            axes.plot(*zip(*line, strict=True), color=colour, linewidth=0.5)
            if name in LABELS["radii"]:
                axes.plot(radius, level, "o", color=colour, markersize=2.2)
            axes.text(at, edge + 6.5 * up, _text(dims, name), rotation=90, color=colour, fontsize=8.5,
                      ha="center", va="bottom" if up > 0 else "top")  # fmt: skip


def _label_sides(axes: Axes, dims: Dimensions) -> None:
    """Write names of levels and heights beside the section; an arrow spans a height."""
    chosen = labelled(dims)
    outside = max(dims.housing_outer_radius, dims.by_name.get("motor_outer_radius", 0.0)) + 5.0
    for half, sign in _SIGN.items():
        marks: list[tuple[float, float, str]] = []
        for name in chosen["levels"]:
            how = LABELS["levels"][name]
            if how["half"] == half:
                marks.append((getattr(dims, name), sign * total(dims, how["at"]), name))
        for name in chosen["heights"]:
            how = LABELS["heights"][name]
            if how["half"] == half:
                low, high, at = (total(dims, how[key]) for key in ("from", "to", "at"))
                _arrow(axes, (sign * at, low), (sign * at, high))
                marks.append((0.5 * (low + high), sign * at, name))
        for (level, radius, name), at in _spread(marks, 0):
            colour = _COLOURS["levels" if name in chosen["levels"] else "heights"]
            beside = [sign * (outside + more) for more in (0.0, 5.0, 6.0)]
            axes.plot([radius, *beside], [level, level, at, at], color=colour, linewidth=0.5)
            if name in chosen["levels"]:
                axes.plot(radius, level, "o", color=colour, markersize=2.2)
            axes.text(sign * (outside + 6.5), at, _text(dims, name), color=colour, fontsize=8.5, va="center",
                      ha="left" if sign > 0 else "right")  # fmt: skip


def _arrow(axes: Axes, start_at: tuple[float, float], end_at: tuple[float, float]) -> None:
    """Draw an arrow with two heads that spans a thickness."""
    style = {"arrowstyle": "<->", "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 5}
    axes.annotate("", start_at, end_at, arrowprops={"color": _COLOURS["heights"], **style})


def _text(dims: Dimensions, name: str) -> str:
    return f"{name}  {getattr(dims, name):.3g}"


def _spread(marks: Iterable[tuple[float, float, str]], axis: int) -> list[tuple[tuple[float, float, str], float]]:
    """Place each mark's label: in order, close to the mark, and no closer than `_SPACING`."""
    ordered = sorted(marks, key=lambda mark: mark[axis])
    places = [mark[axis] for mark in ordered]
    for _ in range(200):
        moved = False
        for index in range(1, len(places)):
            overlap = _SPACING - (places[index] - places[index - 1])
            if overlap > 1e-6:
                places[index - 1] -= 0.5 * overlap
                places[index] += 0.5 * overlap
                moved = True
        if not moved:
            break
    return list(zip(ordered, places, strict=True))


def missing(study: str) -> list[str]:
    """Return radii, levels and heights of a study's module that no label shows and no reason excuses."""
    dims = start(study)
    shown = labelled(dims)
    known = {*shown["radii"], *shown["levels"], *shown["heights"], *shown["widths"], *LABELS["elsewhere"]}
    absent = {name for name, how in LABELS["radii"].items() if "needs" in how and name not in shown["radii"]}
    return [name for name in to_label(dims) if name not in known | absent]


def main() -> None:
    """Write every drawing, or those of the studies named."""
    mpl.rcParams.update({"svg.hashsalt": "tvimdesign", "svg.fonttype": "none", "font.family": "DejaVu Sans"})
    for study in sys.argv[1:] or SECTIONS:
        draw(study, ROOT / f"docs/pictures/section_{study}.svg")


if __name__ == "__main__":
    main()
