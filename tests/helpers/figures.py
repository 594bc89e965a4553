"""Checks of every figure: nothing cut off, axes with ticks and words with units, legends beside the data."""

import re
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox
from numpy.typing import NDArray

from tvimdesign.report.figures.theme import sign

NAME = "A study's name"
LABEL = re.compile(r"^[A-Z][^_]* \((?:[^()]+|\(.*\))\)$", re.DOTALL)
"""Words without an underscore, then a unit in brackets."""


def signed(figure: Figure) -> Figure:
    """Return the figure as the process that draws finishes it, laid out; its pixels have tests of their own."""
    sign(figure, NAME)
    figure.draw_without_rendering()
    return figure


def faults(figure: Figure) -> list[str]:
    """Return the faults that an editor would send a figure back for."""
    return [*_cut_off(figure), *_axes_faults(figure), *_covered(figure), *_name_faults(figure)]


def _cut_off(figure: Figure) -> list[str]:
    used, (width, height) = figure.get_tightbbox(), figure.get_size_inches()
    whole = min(used.x0, used.y0) >= 0.0 and used.x1 <= width and used.y1 <= height
    return [] if whole else [f"cut off: {used} on a page of {width} by {height} inches"]


def _axes_faults(figure: Figure) -> list[str]:
    axis_faults = []
    for axes in figure.axes:
        for side, axis in (("x", axes.xaxis), ("y", axes.yaxis)):
            siblings = getattr(axes, f"get_shared_{side}_axes")().get_siblings(axes)
            label = " ".join(getattr(other, f"get_{side}label")() for other in {axes, *siblings}).strip()
            ticks = _numbers(axis)
            if not ticks:
                continue  # rows, each with its name, or a panel whose neighbour shows the numbers
            if len(ticks) < 2:
                axis_faults.append(f"{side} axis with one tick: {label!r}")
            if not LABEL.match(label):
                axis_faults.append(f"{side} axis without words and unit: {label!r}")
    return axis_faults


def _numbers(axis: Any) -> list[str]:
    """Numbers that are drawn at ticks inside an axis's range."""
    low, high = sorted(axis.get_view_interval())
    shown = [tick for tick in axis.get_major_ticks() if tick.label1.get_visible() or tick.label2.get_visible()]
    labels = [tick.label1.get_text() for tick in shown if low <= tick.get_loc() <= high]
    return [label for label in labels if re.search(r"\d", label)]


def _covered(figure: Figure) -> list[str]:
    legends = [*figure.legends, *(axes.get_legend() for axes in figure.axes if axes.get_legend())]
    boxes = [legend.get_window_extent() for legend in legends]
    covered = []
    for box in boxes:
        for axes in figure.axes:
            covered += [f"a legend covers {line.get_label()!r}" for line in axes.lines if _crosses(box, line)]
            covered += ["a legend covers a bar or band" for patch in axes.patches
                      if patch.get_clip_box() is not None and _area(box, _visible(patch, axes)) > 0.0]  # fmt: skip
            covered += ["a legend covers axes' labels" for text in (axes.xaxis.label, axes.yaxis.label)
                      if text.get_text() and _area(box, text.get_window_extent()) > 0.0]  # fmt: skip
        covered += ["two legends overlap" for other in boxes if other is not box and _area(box, other) > 0.0]
    return covered


def _visible(patch: Any, axes: Any) -> Bbox | None:
    return Bbox.intersection(patch.get_window_extent(), axes.bbox)


def _crosses(box: Bbox, line: Any) -> bool:
    """Return whether a line, as far as it is drawn, passes through a box; looked at between its points, too."""
    points = line.get_transform().transform(np.column_stack(line.get_data()).astype(float))
    points = points[np.all(np.isfinite(points), axis=1)]
    if len(points) > 1:
        steps = np.linspace(0.0, 1.0, 20)[:, None, None]
        points = (points[:-1] + steps * np.diff(points, axis=0)).reshape(-1, 2)
    return bool(np.any(_inside(box, points) & _inside(line.axes.bbox, points)))


def _inside(box: Bbox, points: NDArray[np.float64]) -> NDArray[np.bool_]:
    return np.all((points >= box.min) & (points <= box.max), axis=1)


def _area(first: Bbox, other: Bbox | None) -> float:
    shared = Bbox.intersection(first, other) if other is not None else None
    return float(shared.width * shared.height) if shared is not None else 0.0


def _name_faults(figure: Figure) -> list[str]:
    names = [text for text in figure.texts if text.get_text() == NAME]
    if len(names) != 1:
        return [f"the study's name stands {len(names)} times"]
    box = names[0].get_window_extent()
    others = [text for text in figure.texts if text is not names[0]]
    boxes = [text.get_window_extent() for text in others] + [axes.get_tightbbox() for axes in figure.axes]
    boxes += [legend.get_window_extent() for legend in figure.legends]
    return ["something stands on the study's name" for other in boxes if _area(box, other) > 0.0]
