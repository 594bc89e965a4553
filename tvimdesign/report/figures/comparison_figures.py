"""The figures of comparisons and of the paper's case: fronts, heat through the PCL, level sets, ratio of modes."""

from __future__ import annotations

from typing import Any

from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

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
