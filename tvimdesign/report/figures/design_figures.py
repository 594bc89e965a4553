"""Figures of an optimum: ends of ranges and limits, and the front.

The figures of a module itself: stiffness and damping over temperature, torque over angle, mass of its parts.
"""

from __future__ import annotations

import itertools
from typing import Any

from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from tvimdesign.report.figures import theme

_ROW = 0.155  # inches
_LEFT, _WIDE = 2.75, 3.0  # inches: names stand left of the axes, numbers right of them
_ABOVE, _BELOW = 0.24, 0.5  # inches of a block: its title above, numbers and label of its axis below
_KEYS = 0.3  # inches: the legend below all
_CLIPPED = 100.0
"""Margin [%] at which a bar ends, with an arrow."""
_KINDS: dict[str, dict[str, Any]] = {
    "kept": {"color": theme.COLOURS[0]},
    "broken": {"facecolor": theme.BROKEN, "hatch": "//////", "edgecolor": "white"},
    "advice": {"facecolor": theme.COLOURS[1], "hatch": "......", "edgecolor": "white"},
}
_MEANING = {"kept": "holds", "broken": "does not hold", "advice": "advice that the design does not follow"}


def bounds(data: dict[str, Any]) -> Figure:
    """Return a block of what varies, then one of limits for each unit their margins are read in."""
    blocks = [len(data["free"])] * bool(data["free"]) + [len(group["rows"]) for group in data["margins"]]
    inches = theme.NAME_STRIP + _KEYS + sum(_ROW * (rows + 1) + _ABOVE + _BELOW for rows in blocks)
    figure = theme.new_figure(max(inches, 1.0))
    top = figure.get_figheight() - theme.NAME_STRIP
    draw = [(_free, data["free"])] * bool(data["free"]) + [(_margins, group) for group in data["margins"]]
    for rows, (function, content) in zip(blocks, draw, strict=True):
        high = _ROW * (rows + 1)
        axes = theme.place(figure, _LEFT, top - _ABOVE - high, _WIDE, high)
        function(axes, content)
        axes.set_ylim(-1.0, rows)
        top -= high + _ABOVE + _BELOW
    _legend(figure, data)
    return figure


def _free(axes: Any, free: list[dict[str, Any]]) -> None:
    rows = free[::-1]
    lines = range(len(rows))
    axes.hlines(lines, 0.0, 100.0, color=theme.FAINT, linewidth=3.0)
    axes.plot([100.0 * row["start"] for row in rows], lines, "o", color="white", markeredgecolor="black")
    axes.plot([100.0 * row["share"] for row in rows], lines, "D", color=theme.COLOURS[0])
    axes.set(xlim=(-3.0, 103.0), xticks=[0, 25, 50, 75, 100])
    theme.heading(axes, "What varies")
    axes.set_xlabel("Place between the lower and the upper bound (%)")
    axes.grid(axis="y", visible=False)
    theme.row_texts(axes, [row["name"] for row in rows], [row["text"] for row in rows])


def _margins(axes: Any, group: dict[str, Any]) -> None:
    rows = group["rows"][::-1]
    reach = _CLIPPED if group["unit"] == "%" else max([abs(row["margin"]) for row in rows if row["finite"]] + [1e-9])
    for i, row in enumerate(rows):
        shown = max(-reach, min(reach, row["margin"]))
        if row["kind"] == "binds":
            axes.plot(0.0, i, "D", color="black", markersize=3.5, zorder=3)
        else:
            axes.barh(i, shown, height=0.72, linewidth=0.0, **_KINDS[row["kind"]])
        if not row["finite"] or abs(row["margin"]) > 1.000001 * reach:
            axes.plot(shown * 1.03, i, ">" if shown > 0.0 else "<", color="black", markersize=3.0, clip_on=False)
    axes.axvline(0.0, color="black", linewidth=0.8)
    theme.heading(axes, group["title"])
    axes.set(xlim=(-1.08 * reach, 1.08 * reach), xlabel=group["label"])
    axes.grid(axis="y", visible=False)
    axes.locator_params(axis="x", nbins=theme.TICKS, symmetric=True)
    theme.row_texts(axes, [row["name"] for row in rows], [row["text"] for row in rows])


def _legend(figure: Figure, data: dict[str, Any]) -> None:
    """Explain the marks on the figure."""
    kinds = {row["kind"] for group in data["margins"] for row in group["rows"]}
    far = any(
        abs(row["margin"]) > _CLIPPED for group in data["margins"] if group["unit"] == "%" for row in group["rows"]
    )
    marks: list[Any] = []
    if data["free"]:
        marks += [Line2D([], [], marker="o", color="white", markeredgecolor="black", linestyle="", label="start"),
                  Line2D([], [], marker="D", color=theme.COLOURS[0], linestyle="", label="design")]  # fmt: skip
    marks += [Patch(label=text, **_KINDS[kind]) for kind, text in _MEANING.items() if kind in kinds]
    if "binds" in kinds:
        marks.append(Line2D([], [], marker="D", color="black", linestyle="", markersize=3.5, label="binds"))
    if far:
        marks.append(Line2D([], [], marker=">", color="black", linestyle="", markersize=3.0, label="beyond the scale"))
    if marks:
        figure.legend(handles=marks, loc="lower center", ncols=len(marks))


def front(data: dict[str, Any]) -> Figure:
    """Draw a front's points, the knee and the weighted optimum; of three outputs the first colours the points."""
    labels, points = data["labels"], data["points"]
    pairs = list(itertools.combinations(range(len(labels)), 2))
    key = 0.62 if len(labels) > 2 else 0.0  # inches below the panels: the scale of colours
    figure = theme.new_figure(2.85 + key)
    gap, left = 0.65, 0.62
    wide = min((theme.WIDTH - left - 0.15 - gap * (len(pairs) - 1)) / len(pairs), 4.5)
    scale = Normalize(min(point[0] for point in points), max(point[0] for point in points))
    for i, (x, y) in enumerate(pairs):
        axes = theme.place(figure, left + i * (wide + gap), 0.45 + key, wide, 1.85)
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
        if kind == "stiffness":
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
    gap, left = 0.62, 0.55
    wide = (theme.WIDTH - left - 0.15 - gap * (len(loops) - 1)) / len(loops)
    for i, loop in enumerate(loops):
        axes = theme.place(figure, left + i * (wide + gap), 0.42, wide, 1.55)
        axes.plot(loop["angle"], loop["torque"], label="joint", **theme.style_of(0))
        axes.plot(loop["angle"], loop["springs"], label="springs alone", **theme.style_of(1))
        axes.set(xlabel=data["labels"]["angle"], ylabel=data["labels"]["torque"])
        theme.heading(axes, loop["title"])
        axes.locator_params(nbins=theme.TICKS)
        if i == 0:
            handles = axes.get_legend_handles_labels()
    figure.legend(*handles, loc="upper right", bbox_to_anchor=(1.0, 1.0), ncols=2)
    return figure


def mass(data: dict[str, Any]) -> Figure:
    """Draw the mass of each part the module has."""
    parts = sorted(((name, value) for name, value in data["parts"].items() if value > 0.0), key=lambda item: item[1])
    figure = theme.new_figure(1.0 + 0.2 * len(parts))
    axes = theme.place(figure, 1.1, 0.42, 5.6, 0.2 * len(parts))
    bars = axes.barh([name for name, _ in parts], [value for _, value in parts], color=theme.COLOURS[0])
    axes.bar_label(bars, fmt="%.1f g", padding=3, fontsize=theme.SMALL)
    axes.margins(x=0.12, y=0.02)
    axes.set(xlabel=data["label"])
    axes.grid(axis="y", visible=False)
    theme.caption(figure, f"{sum(data['parts'].values()):.0f} g in all, without wires")
    return figure
