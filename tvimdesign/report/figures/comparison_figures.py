"""The figures of comparisons and of the paper's case: fronts, heat through the PCL, level sets, ratio of modes."""

from __future__ import annotations

import math
import textwrap
from typing import Any

from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from tvimdesign.report.figures import theme

_LEFT, _GAP = 0.62, 0.65  # inches


def fronts(data: dict[str, Any]) -> Figure:
    """Draw fronts of all studies, a panel for each pair of outputs; the optimum of each study is filled."""
    figure = theme.new_figure(3.25)
    theme.caption(figure, data["title"])
    wide = _width(len(data["panels"]), _GAP, 0.15)
    for k, panel in enumerate(data["panels"]):
        axes = theme.place(figure, _LEFT + k * (wide + _GAP), 0.72, wide, 1.9)
        for i, line in enumerate(panel["lines"]):
            style = {"marker": theme.MARKERS[i % len(theme.MARKERS)], **theme.style_of(i)}
            axes.plot(line["x"], line["y"], markerfacecolor="white", label=line["label"], **style)
            axes.plot(*line["optimum"], **style | {"linestyle": "", "markersize": 7})
        axes.set(xlabel=panel["x_label"], ylabel=panel["y_label"])
        axes.locator_params(nbins=theme.TICKS)
    figure.legend(*axes.get_legend_handles_labels(), loc="lower center", ncols=min(4, len(panel["lines"])))
    return figure


def _width(count: int, gap: float, right: float) -> float:
    """Return the width [inches] of so many panels side by side."""
    return (theme.WIDTH - _LEFT - right - gap * (count - 1)) / count


def heat(data: dict[str, Any]) -> Figure:
    """Draw the polymer's temperature over time while it heats, every study on one scale of colours."""
    studies, gap = data["studies"], 0.5
    figure = theme.new_figure(3.0)
    theme.caption(figure, data["title"])
    wide = _width(len(studies), gap, 0.85)
    scale = Normalize(data["coldest"], data["hottest"])
    for i, panel in enumerate(studies):
        axes = theme.place(figure, _LEFT + i * (wide + gap), 0.45, wide, 1.85)
        # A gradient of colours is a picture even in a vector file: as triangles it would be a thousand shapes.
        axes.pcolormesh(panel["time"], panel["depth"], panel["temperature"], shading="gouraud", cmap="inferno",
                        norm=scale, rasterized=True)  # fmt: skip
        axes.contour(panel["time"], panel["depth"], panel["temperature"], levels=data["melting"], colors="white",
                     linewidths=0.8)  # fmt: skip
        axes.set_xlabel("Time (s)")
        axes.set_ylabel("Depth from the Peltier pads (mm)")
        axes.grid(visible=False)
        axes.locator_params(nbins=theme.TICKS)
        theme.heading(axes, panel["label"])
    colours = theme.place(figure, theme.WIDTH - 0.7, 0.45, 0.1, 1.85)
    figure.colorbar(ScalarMappable(scale, "inferno"), cax=colours, label="Temperature (°C)")
    return figure


_LETTERS = 36
"""Of a line of a label below a panel."""
_PLACES = {"near_face_time": "near face at its target", "mean_time": "mean at its target",
           "far_face_time": "far face at its target", "softening_time": "joint soft"}  # fmt: skip


def level_sets(data: dict[str, Any]) -> Figure:
    """Draw the thickness of one response time against other parameters, a line for each place of the sensor."""
    figure = theme.new_figure(3.2)
    low, high = data["range"]
    theme.caption(figure, f"What gives {data['wanted']:g} s: thickness from {low:g} to {high:g} mm")
    wide = (7.1 - 0.55 - 0.15) / len(data["panels"]) - 0.18
    for i, panel in enumerate(data["panels"]):
        axes = theme.place(figure, 0.55 + i * (wide + 0.27), 0.76, wide, 1.9)
        for j, (name, label) in enumerate(_PLACES.items()):
            line = [math.nan if y is None else y for y in panel["lines"][name]]
            axes.plot(panel["x"], line, marker=theme.MARKERS[j], markersize=3.0, label=label, **theme.style_of(j))
        axes.plot(*panel["published"], "k+", markersize=9, label="as assumed here")
        axes.set(ylim=(0.0, high))
        axes.set_xlabel(textwrap.fill(panel["label"], _LETTERS))
        if panel["logarithmic"]:
            axes.set_xscale("log")
            theme.log_ticks(axes.xaxis)
        else:
            axes.locator_params(axis="x", nbins=theme.TICKS)
        if i:
            axes.tick_params(labelleft=False)
        else:
            axes.set_ylabel("Thickness of the layer (mm)")
    figure.legend(*axes.get_legend_handles_labels(), loc="lower center", ncols=5)
    return figure


def tornado(data: dict[str, Any]) -> Figure:
    """Draw the ratio of the times: a bar for each input through its range, a mark for each other choice."""
    bars, choices, middle = data["bars"][::-1], data["choices"][::-1], data["ratio"]
    rows = len(bars) + len(choices)
    figure = theme.new_figure(1.3 + 0.2 * rows)
    axes = theme.place(figure, 3.4, 0.62, 3.4, 0.2 * rows)
    for i, choice in enumerate(choices):
        axes.plot(choice["ratio"], i, "D", color=theme.COLOURS[4], markersize=3.0)
        axes.text(choice["ratio"], i, f"  {choice['ratio']:.2f}", fontsize=5.5, ha="left", va="center")
    for i, bar in enumerate(bars, start=len(choices)):
        for end, ratio, colour, hatch in zip(bar["ends"], bar["ratios"], theme.COLOURS, theme.HATCHES, strict=False):
            if ratio is not None:  # one of the two never gets there
                axes.barh(i, ratio - middle, left=middle, facecolor=colour, hatch=hatch, edgecolor="white",
                          linewidth=0.0, height=0.7)  # fmt: skip
                axes.text(ratio, i, f" {end} ", fontsize=5.5, va="center", ha="left" if ratio > middle else "right")
    axes.axvline(middle, color="black", linewidth=0.8)
    theme.row_texts(axes, [choice["label"] for choice in choices] + [bar["label"] for bar in bars], [])
    axes.set(xlabel="Time in compression over time in shear (–)", ylim=(-0.6, rows - 0.4))
    axes.grid(axis="y", visible=False)
    axes.margins(x=0.12)
    theme.caption(figure, "The paper's 2 : 1, with each assumed input alone through its plausible range")
    ends = [Patch(facecolor=theme.COLOURS[i], hatch=theme.HATCHES[i], edgecolor="white", label=label)
            for i, label in enumerate(("lower end of the range", "upper end of the range"))]  # fmt: skip
    other = Line2D([], [], marker="D", color=theme.COLOURS[4], linestyle="", markersize=3.0, label="another choice")
    figure.legend(handles=[*ends, other], loc="lower center", ncols=3, fontsize=theme.SMALL)
    return figure
