"""The figure of a virtual test: curves with bands, and oscillations whose later swings are drawn as a band."""

import textwrap
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from tvimdesign.report.figures import theme

Array = NDArray[np.float64]
SWINGS_DRAWN = 6  # Swings drawn one by one; on a logarithmic axis later ones stand closer than a line is wide
_ROUNDING = 2e-3  # Share of a curve's range by which it must turn back for a swing


class Drawn(NamedTuple):
    """A curve as it is drawn: lines, and a band between two lines over `band_x`, empty where all is drawn as a line."""

    lines: tuple[tuple[Array, Array], ...]
    band_x: Array
    low: Array
    high: Array


def drawn(x: Array, y: Array) -> Drawn:
    """Split a curve into the line of its first swings, the band of those after, and the line once it is at rest."""
    turns = _turns(y)
    empty: Array = np.array([])
    if len(turns) <= 4 * SWINGS_DRAWN:
        return Drawn(((x, y),), empty, empty, empty)
    later = turns[2 * SWINGS_DRAWN :]
    first, last = later[0], later[-1]
    sides = [np.interp(x[later], x[side], y[side]) for side in (later[::2], later[1::2])]
    lines = [(x[: first + 1], y[: first + 1])]
    if x[-1] - x[last] > x[last] - x[later[-3]]:  # longer than a swing: it has come to rest
        lines.append((x[last:], y[last:]))
    return Drawn(tuple(lines), x[later], np.minimum(*sides), np.maximum(*sides))


def _turns(y: Array) -> NDArray[np.int64]:
    """Return samples at which a curve turns back by more than rounding, alternately highs and lows."""
    least = _ROUNDING * (float(np.max(y)) - float(np.min(y)))
    steps = np.diff(y)
    candidates = np.flatnonzero(steps[:-1] * steps[1:] < 0.0) + 1
    indices = [0]
    for at in candidates:
        step = y[at] - y[indices[-1]]
        if len(indices) > 1 and step * (y[indices[-1]] - y[indices[-2]]) > 0.0:
            indices[-1] = int(at)  # higher still, or lower still, after a ripple
        elif abs(step) > least:
            indices.append(int(at))
    return np.array(indices[1:], dtype=np.int64)


_ACROSS = 3
_DECADES_SHOWN = 1e10
"""Largest over smallest value of a logarithmic axis: what is smaller is nothing, and would press all else flat."""
_LEFT, _GAP, _HIGH, _ABOVE, _BELOW = 0.6, 0.62, 1.6, 0.3, 0.42  # inches
_KEY = 0.15  # inches: a line of the legend
_LETTERS = 95  # Letters of a legend's line, over its columns
_MANY = "band: swings too close to be drawn one by one"


def trial(data: dict[str, Any]) -> Figure:
    """Return the panels of a virtual test, at most three in a row; a line looks the same on each of them."""
    panels = data["panels"]
    down = -(-len(panels) // _ACROSS)
    across = -(-len(panels) // down)
    styles = _styles(panels)
    columns = max(1, min(3, _LETTERS // (max(map(len, styles)) + 8)))
    key = _KEY * -(-(len(styles) + 1) // columns) + 0.1
    row = _HIGH + _ABOVE + _BELOW
    figure = theme.new_figure(theme.NAME_STRIP + 0.22 + row * down + key)
    theme.caption(figure, textwrap.shorten(data["title"], 100, placeholder=" …"))
    for panel, left, up, wide in theme.in_rows(panels, across, _LEFT, _GAP, row):
        _panel(theme.place(figure, left, key + _BELOW + up, wide, _HIGH), panel, styles)
    handles = {
        label: handle for axes in figure.axes for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    if any(axes.collections and axes.get_label() == _MANY for axes in figure.axes):
        handles[_MANY] = Patch(color="0.5", alpha=0.35, linewidth=0.0)
    figure.legend(list(handles.values()), list(handles), loc="lower left", ncols=columns)
    return figure


def _styles(panels: list[dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """Colour and line style of every label.

    A colour for each family, that is each beginning of a label, and a style for each label in its family; where every
    panel shows one family alone, a colour for each label in it.
    """
    families: dict[str, list[str]] = {}
    aside: list[str] = []
    for line in (line for panel in panels for line in panel["lines"]):
        members = families.setdefault(_family(line), [])
        if line["label"] not in members and not line["dashed"]:
            members.append(line["label"])
        model = line["label"].rpartition(", ")[2]
        if line["dashed"] and model not in aside:
            aside.append(model)
    alone = all(len({_family(line) for line in panel["lines"]}) == 1 for panel in panels)
    styles: dict[str, dict[str, Any]] = {}
    for line in (line for panel in panels for line in panel["lines"]):
        label, members = line["label"], families[_family(line)]
        if line["dashed"]:
            place_in, style = len(members), theme.ASIDE[aside.index(label.rpartition(", ")[2]) % len(theme.ASIDE)]
        else:
            place_in, style = members.index(label), theme.LINE_STYLES[members.index(label) % len(theme.LINE_STYLES)]
        colour = place_in if alone else list(families).index(_family(line))
        styles[label] = {"color": theme.COLOURS[colour % len(theme.COLOURS)], "linestyle": style}
    return styles


def _family(line: dict[str, Any]) -> str:
    family: str = line["label"].partition(",")[0]
    return family


def _panel(axes: Any, panel: dict[str, Any], styles: dict[str, dict[str, Any]]) -> None:
    for line in panel["lines"]:
        style = styles[line["label"]]
        if panel["log_x"] and not panel["log_y"]:
            _swinging(axes, line, style)
        else:
            axes.plot(line["x"], line["y"], label=line["label"], **style)
        if line["band"]:
            axes.fill_between(line["x"], *line["band"], color=style["color"], alpha=0.2, linewidth=0.0)
    if panel["log_x"]:
        axes.set_xscale("log")
        theme.log_ticks(axes.xaxis)
    else:
        axes.locator_params(axis="x", nbins=theme.TICKS - 1)
    if panel["log_y"]:
        _logarithmic(axes, panel["lines"])
    else:
        axes.locator_params(axis="y", nbins=theme.TICKS)
    axes.set(xlabel=panel["x_label"], ylabel=panel["y_label"])
    theme.heading(axes, panel["title"])


def _swinging(axes: Any, line: dict[str, Any], style: dict[str, Any]) -> None:
    """Draw a curve over a logarithmic axis of time, whose later swings are the band they fill."""
    parts = drawn(np.array(line["x"], dtype=float), np.array(line["y"], dtype=float))
    for i, (x, y) in enumerate(parts.lines):
        axes.plot(x, y, label=line["label"] if i == 0 else "_", **style)
    if len(parts.band_x):
        axes.set_label(_MANY)
        axes.fill_between(parts.band_x, parts.low, parts.high, color=style["color"], alpha=0.35, linewidth=0.0)


def _logarithmic(axes: Any, lines: list[dict[str, Any]]) -> None:
    """Set a logarithmic y axis that shows no more decades than there is something on."""
    axes.set_yscale("log", nonpositive="clip")
    shown = [value for line in lines for part in (line["y"], *(line["band"] or ())) for value in part if value > 0.0]
    least, most = max(min(shown), max(shown) / _DECADES_SHOWN), max(shown)
    axes.set_ylim(least / 1.5, most * 1.5)
    theme.log_ticks(axes.yaxis)
