"""Figures of a design: fronts, stiffness and damping over temperature, torque over angle."""

import itertools
from typing import Any

from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from tvimdesign.report.figures import theme


def front(data: dict[str, Any]) -> Figure:
    """Draw a front's points, the knee and the weighted optimum; of three outputs the first colours the points."""
    labels, points = data["labels"], data["points"]
    pairs = list(itertools.combinations(range(len(labels)), 2))
    key = 0.62 if len(labels) > 2 else 0.0  # inches below the panels: the scale of colours
    figure = theme.new_figure(2.85 + key)
    scale = Normalize(min(point[0] for point in points), max(point[0] for point in points))
    for (x, y), left, _, wide in theme.in_rows(pairs, len(pairs), 0.62, 0.65):
        axes = theme.place(figure, left, 0.45 + key, min(wide, 4.5), 1.85)
        across, up = [point[x] for point in points], [point[y] for point in points]
        if len(labels) == 2:
            axes.plot(across, up, marker="o", label="front", **theme.style_of(0))
        else:
            axes.scatter(
                across, up, c=[point[0] for point in points], cmap=theme.SEQUENCE, norm=scale, s=16, label="front"
            )
        _marks(axes, data, x, y)
        axes.set(xlabel=labels[x], ylabel=labels[y])
        axes.locator_params(nbins=theme.TICKS)
    figure.legend(*axes.get_legend_handles_labels(), loc="upper right", ncols=3)
    if key:
        colours = theme.place(figure, 1.8, 0.4, 3.5, 0.1)
        figure.colorbar(ScalarMappable(scale, theme.SEQUENCE), cax=colours, orientation="horizontal", label=labels[0])
    return figure


def _marks(axes: Any, data: dict[str, Any], x: int, y: int) -> None:
    if data["knee"] is not None:
        knee = data["points"][data["knee"]]
        axes.plot(
            knee[x], knee[y], linestyle="", marker="D", color=theme.BROKEN, markersize=8, fillstyle="none", label="knee"
        )
    optimum = data["optimum"]
    axes.plot(optimum[x], optimum[y], linestyle="", marker="*", color=theme.COLOURS[1], markeredgecolor="black",
              markeredgewidth=0.5, markersize=9, label="weighted optimum")  # fmt: skip


def fronts(data: dict[str, Any]) -> Figure:
    """Draw fronts of all studies, a panel for each pair of outputs; the optimum of each study is filled."""
    figure = theme.new_figure(3.25)
    theme.caption(figure, data["title"])
    for panel, left, _, wide in theme.in_rows(data["panels"], len(data["panels"]), 0.62, 0.65):
        axes = theme.place(figure, left, 0.72, wide, 1.9)
        for i, line in enumerate(panel["lines"]):
            style = {"marker": theme.MARKERS[i % len(theme.MARKERS)], **theme.style_of(i)}
            axes.plot(line["x"], line["y"], markerfacecolor="white", label=line["label"], **style)
            axes.plot(*line["optimum"], **style | {"linestyle": "", "markersize": 7})
        axes.set(xlabel=panel["x_label"], ylabel=panel["y_label"])
        axes.locator_params(nbins=theme.TICKS)
    figure.legend(*axes.get_legend_handles_labels(), loc="lower center", ncols=min(4, len(panel["lines"])))
    return figure


def impedance(data: dict[str, Any]) -> Figure:
    """Draw stiffness and damping against temperature, of layer and joint; bands: what history leaves."""
    sweep = data["sweep"]
    figure = theme.new_figure(3.4)
    theme.caption(figure, f"At {data['frequency']:g} Hz; pale areas: what the layer's history leaves open")
    for kind, left in (("stiffness", 0.62), ("damping", 4.12)):
        axes = theme.place(figure, left, 0.42, 2.85, 2.2)
        for i, (part, label) in enumerate((("pcl", "PCL layer alone"), ("joint", "joint: springs, layer, structure"))):
            style = theme.style_of(i)
            axes.plot(sweep["temperature"], sweep[f"{part}_{kind}"], label=label, **style)
            ends = (sweep[f"{part}_{kind}_{end}"] for end in ("low", "high"))
            axes.fill_between(sweep["temperature"], *ends, alpha=0.25, color=style["color"], linewidth=0.0)
        axes.set_yscale("log")
        axes.axvspan(*data["melting"], label="melting range", **{**theme.BAND, "color": "0.5"})
        if kind == "stiffness" and data["springs"]:
            axes.axhline(data["springs"], label="springs alone", **theme.LIMIT)
        theme.log_ticks(axes.yaxis)
        axes.locator_params(axis="x", nbins=theme.TICKS)
        axes.set(xlabel="Layer temperature (°C)", ylabel=data["labels"][kind])
        theme.legend_above(axes, 2)
    return figure


def torque(data: dict[str, Any]) -> Figure:
    """Draw the torque that turns the joint as a sine through its stroke, a panel for each operating point."""
    loops = data["loops"]
    figure = theme.new_figure(2.6)
    theme.caption(figure, data["title"])
    for loop, left, _, wide in theme.in_rows(loops, len(loops), 0.55, 0.62):
        axes = theme.place(figure, left, 0.42, wide, 1.55)
        axes.plot(loop["angle"], loop["torque"], label="joint", **theme.style_of(0))
        if any(loop["springs"]):
            axes.plot(loop["angle"], loop["springs"], label="springs alone", **theme.style_of(1))
        for side in (-1.0, 1.0):
            axes.axvline(side * data["stop_angle"], label="hard stops" if side > 0.0 else None, **theme.style_of(2))
        axes.set(xlabel=data["labels"]["angle"], ylabel=data["labels"]["torque"])
        theme.heading(axes, loop["title"])
        axes.locator_params(nbins=theme.TICKS)
    figure.legend(*axes.get_legend_handles_labels(), loc="upper right", bbox_to_anchor=(1.0, 1.0), ncols=3)
    return figure
