"""Labelled plans in docs/pictures: cuts through the PCL, with dimensions around the axis."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi, sin
from pathlib import Path

import cadquery as cq
import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from section_drawing import ROOT, cut_faces, start

from tvimdesign.cad.assembly.assembly import drawn_parts, place
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.kinds import KINDS, kind_of

_INK = "#1f4e9c"


def draw(study: str, path: Path) -> None:
    """Draw the plan of a study's module, as the study starts."""
    dims = start(study)
    shear = dims.mode == "shear"
    level = 0.5 * dims.pcl_thickness if shear else 0.5 * dims.vane_height
    size = 3.0 * dims.housing_outer_radius
    plane = cq.Face.makePlane(size, size, cq.Vector(0.0, 0.0, level), cq.Vector(0.0, 0.0, 1.0))
    reach = dims.housing_outer_radius if shear else dims.pcl_outer_radius
    figure = Figure(figsize=(9.0, 5.3 if shear else 6.6))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(-1.95 * reach, 1.95 * reach), ylim=(-1.1 * reach, (1.2 if shear else 1.76) * reach), aspect="equal")
    axes.axis("off")
    for name, shape in place(dims, drawn_parts(dims)).items():
        for outline in cut_faces(shape, plane, (0, 1)):
            colour = KINDS[kind_of(name)].colour
            axes.add_patch(PathPatch(outline, facecolor=colour, edgecolor="black", linewidth=0.5, alpha=0.85))
    (_label_shear if shear else _label_compression)(axes, dims)
    figure.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else {"Software": None}, dpi=110)


def _label_shear(axes: Axes, dims: Dimensions) -> None:
    middle, out = pi / dims.count("spring_count"), dims.housing_outer_radius
    ends = (middle - 0.5 * dims.arc_span, middle + 0.5 * dims.arc_span)
    _around(axes, dims.pcl_outer_radius + 2.0, ends, "arc_span", (1.1 * out, 0.80 * out))
    names = ("housing_outer_radius", "housing_inner_radius", "pcl_outer_radius", "pcl_inner_radius", "hub_radius")
    _radii(axes, dims, names, -1.9 * out, 1.1 * out)
    _radii(axes, dims, ("placement_radius",), 1.1 * out, -0.35 * out, azimuth=0.0)


def _label_compression(axes: Axes, dims: Dimensions) -> None:
    mean, out = 0.5 * (dims.pcl_inner_radius + dims.pcl_outer_radius), dims.pcl_outer_radius
    rotor, block, housing = 0.5 * dims.rotor_vane_angle, dims.block_angle, dims.housing_vane_angle
    pad = dims.heater_thickness / mean
    far = rotor + block + housing
    _around(axes, mean, (-rotor, rotor), "vane_thickness", (1.35 * out, -0.15 * out))
    _around(axes, mean, (rotor, rotor + block), "block_depth", (1.35 * out, 0.28 * out))
    _around(axes, mean, (rotor + block + pad, far - pad), "housing_vane_thickness", (1.35 * out, 0.70 * out))
    _around(axes, mean, (far - pad, far), "heater_thickness", (1.35 * out, 1.10 * out))
    names = ("slot_outer_radius", "slot_inner_radius", "pcl_outer_radius", "pcl_inner_radius", "hub_radius")
    _radii(axes, dims, names, -1.85 * out, 1.60 * out)


def _around(axes: Axes, radius: float, angles: tuple[float, float], name: str, at: Sequence[float]) -> None:
    """Draw an arc between two azimuths [rad], and a line from its middle to its name."""
    points = [(radius * cos(angle), radius * sin(angle)) for angle in np.linspace(*angles, 40)]
    axes.plot(*zip(*points, strict=True), color="#2c6b2f", linewidth=1.6)
    for end in (points[0], points[-1]):
        axes.plot(*end, "o", color="#2c6b2f", markersize=2.5)
    axes.annotate(name, points[20], at, color="#2c6b2f", fontsize=9.5, va="center",
                  arrowprops={"arrowstyle": "-", "color": "#2c6b2f", "linewidth": 0.6})  # fmt: skip


def _radii(
    axes: Axes, dims: Dimensions, names: Sequence[str], left: float, top: float, azimuth: float | None = None
) -> None:
    """Draw arrows from the axis to radii, names in a column; without an azimuth [rad] they fan out to the left."""
    for index, name in enumerate(names):
        radius, angle = getattr(dims, name), 1.52 + 0.14 * index if azimuth is None else azimuth
        tip = (radius * cos(angle), radius * sin(angle))
        axes.annotate("", tip, (0.0, 0.0), arrowprops={"arrowstyle": "->", "color": _INK, "linewidth": 0.9,
                                                       "shrinkA": 0, "shrinkB": 0})  # fmt: skip
        axes.annotate(f"{name}  {radius:.3g}", tip, (left, top * (1.0 - 0.13 * index)), color=_INK, fontsize=9.5,
                      arrowprops={"arrowstyle": "-", "color": _INK, "linewidth": 0.5})  # fmt: skip


def main() -> None:
    """Write the plans of both modes."""
    mpl.rcParams.update({"svg.hashsalt": "tvimdesign", "svg.fonttype": "none", "font.family": "DejaVu Sans"})
    for study in ("paper_reconstructed", "paper_compression"):
        draw(study, ROOT / f"docs/pictures/plan_{study}.svg")


if __name__ == "__main__":
    main()
