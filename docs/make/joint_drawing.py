"""Draws docs/pictures/joint.svg: where the module sits in a joint, and what stands in parallel and in series in it."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch

ROOT = Path(__file__).resolve().parents[2]
_GREY, _BLUE, _ORANGE, _CREAM = "#aebac8", "#2a5ea8", "#eea83a", "#f3eed8"


def draw(path: Path) -> None:
    """Draw the chain of a joint above, and the module's mechanical diagram below."""
    figure = Figure(figsize=(8.6, 3.7))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(0, 86), ylim=(0, 37), aspect="equal")
    axes.axis("off")
    for left, width, colour, text in (
        (2, 18, _GREY, "upper arm\n(fixed)"), (24, 14, _GREY, "motor,\ngearbox"), (42, 18, _ORANGE, "this module"),
        (64, 20, _BLUE, "forearm\n(output link)"),
    ):  # fmt: skip
        _box(axes, (left, 27.5), (width, 7.5), colour, text)
    for left in (20, 38, 60):
        axes.plot([left, left + 4], [31.25, 31.25], color="black", linewidth=3.0)
    axes.plot([42, 16], [27.5, 21.5], color="#8a8a8a", linewidth=0.7, dashes=(5, 3))
    axes.plot([60, 72], [27.5, 21.5], color="#8a8a8a", linewidth=0.7, dashes=(5, 3))
    _inside(axes)
    figure.savefig(path, metadata={"Date": None})


def _inside(axes: Axes) -> None:
    for left, text in ((16, "housing"), (70, "link")):
        axes.plot([left, left], [3.0, 21.0], color="black", linewidth=2.2)
        outwards = -1 if left < 40 else 1
        axes.plot([left, left + 4 * outwards], [12, 12], color="black", linewidth=2.2)
        axes.text(left + 5 * outwards, 12, text, ha="right" if left < 40 else "left", va="center", fontsize=11)
    _spring(axes, 16, 70, 17.5)
    axes.text(43, 20.3, "torsion springs: always there", ha="center", fontsize=10.5)
    axes.plot([16, 24], [8, 8], color="black", linewidth=1.3)
    _box(axes, (24, 4.6), (22, 6.8), _CREAM, "PCL: locks cold,\ndamps hot")
    axes.plot([46, 52], [8, 8], color="black", linewidth=1.3)
    _spring(axes, 52, 70, 8)
    axes.text(61, 3.2, "structure", ha="center", fontsize=10.5)
    axes.annotate("Peltier pads heat and cool it", (33, 4.4), (35, 1.0), ha="center", fontsize=10.5, color="#b3352c")


def _box(axes: Axes, corner: tuple[float, float], size: tuple[float, float], colour: str, text: str) -> None:
    axes.add_patch(FancyBboxPatch(corner, *size, boxstyle="round,pad=0,rounding_size=1.2", facecolor=colour,
                                  edgecolor="black", linewidth=0.8))  # fmt: skip
    ink = "white" if colour == _BLUE else "black"
    middle = (corner[0] + 0.5 * size[0], corner[1] + 0.5 * size[1])
    axes.text(*middle, text, ha="center", va="center", fontsize=11, color=ink)


def _spring(axes: Axes, left: float, right: float, height: float) -> None:
    turns = 2 * round((right - left) / 4.5)
    middle = np.linspace(left + 3.0, right - 3.0, turns + 1)
    zigzag = [height + (0.0 if i in (0, turns) else 1.4 * (-1.0) ** i) for i in range(turns + 1)]
    axes.plot([left, *middle, right], [height, *zigzag, height], color="#24806a", linewidth=1.5)


if __name__ == "__main__":
    mpl.rcParams.update({"svg.hashsalt": "tvimdesign", "font.family": "DejaVu Sans"})
    draw(ROOT / "docs/pictures/joint.svg")
