"""Figures of a tolerance analysis, a fit and a sweep."""

import math
from typing import Any

from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from tvimdesign.report.figures import theme

_ACROSS = 3


def spread(data: dict[str, Any]) -> Figure:
    """Draw bars of contributors above, histograms with limits below."""
    panels, outputs = data["panels"], data["outputs"]
    down = -(-len(panels) // _ACROSS)
    bars_high, row = 0.17 * len(outputs) + 0.1, 1.85
    keys = 0.14 * -(-len(data["parts"]) // 4) + 0.1
    figure = theme.new_figure(theme.NAME_STRIP + keys + bars_high + 0.5 + row * down + 0.3)
    top = figure.get_figheight() - theme.NAME_STRIP - keys
    _contributors(theme.place(figure, 2.0, top - bars_high, 4.9, bars_high), data)
    for i, panel in enumerate(panels):
        bottom = top - bars_high - 0.5 - row * (i // _ACROSS + 1) + 0.5
        _histogram(theme.place(figure, 0.6 + (i % _ACROSS) * 2.28, bottom, 1.75, 1.0), panel)
    marks = [
        Line2D([], [], color=theme.BROKEN, linewidth=1.5, label="limit"),
        Line2D([], [], label="as drawn", **theme.LIMIT),
    ]
    figure.legend(handles=marks, loc="lower center", ncols=2)
    return figure


def _contributors(axes: Any, data: dict[str, Any]) -> None:
    rows = range(len(data["outputs"]))
    left = [0.0] * len(rows)
    for i, part in enumerate(data["parts"]):
        colour = theme.COLOURS[i] if i < len(theme.COLOURS) else theme.FAINT
        axes.barh(rows, part["shares"], left=left, facecolor=colour, hatch=theme.HATCHES[i % len(theme.HATCHES)],
                  edgecolor="white", linewidth=0.3, label=part["name"])  # fmt: skip
        left = [a + b for a, b in zip(left, part["shares"], strict=True)]
    axes.set(xlabel="Share of the variance (%)", xlim=(0.0, 100.0), ylim=(len(rows) - 0.4, -0.6))
    axes.grid(visible=False)
    axes.set_yticks([])  # as ticks the texts of the rows would be five things to draw each
    for i, text in enumerate(data["outputs"]):
        axes.text(-0.015, i, text, ha="right", va="center", fontsize=theme.SMALL, parse_math=False,
                  transform=axes.get_yaxis_transform())  # fmt: skip
    axes.legend(ncols=4, loc="lower right", bbox_to_anchor=(1.0, 1.0))


def _histogram(axes: Any, panel: dict[str, Any]) -> None:
    axes.stairs(panel["counts"], panel["edges"], fill=True, color=theme.COLOURS[0], alpha=0.5)
    for limit in panel["limits"]:
        axes.axvline(limit, color=theme.BROKEN, linewidth=1.5)
    axes.axvline(panel["as_drawn"], **theme.LIMIT)
    axes.set(xlabel=panel["label"], ylabel="Modules (count)")
    axes.locator_params(nbins=4)
    axes.grid(visible=False)
    theme.heading(axes, panel["title"])


_PANELS_ACROSS = 2
_LEFT, _GAP, _HIGH, _LOW, _ABOVE, _BELOW = 0.65, 0.75, 1.5, 0.5, 0.3, 0.5  # inches
_LONGEST = 84  # letters of the titles in a row


def fit(data: dict[str, Any]) -> Figure:
    """Draw two panels in a row at most."""
    panels = data["panels"]
    down, across = -(-len(panels) // _PANELS_ACROSS), min(len(panels), _PANELS_ACROSS)
    row = _HIGH + _LOW + _ABOVE + _BELOW + 0.08
    lines = 1 + data["title"].count("\n")
    figure = theme.new_figure(theme.NAME_STRIP + 0.08 + 0.14 * lines + row * down)
    theme.caption(figure, data["title"])
    for panel, left, up, wide in theme.in_rows(panels, across, _LEFT, _GAP, row):
        below = theme.place(figure, left, _BELOW + up, wide, _LOW)
        above = theme.place(figure, left, _BELOW + up + _LOW + 0.08, wide, _HIGH)
        _fit_panel(above, below, panel, _LONGEST // across)
    return figure


def _fit_panel(above: Any, below: Any, panel: dict[str, Any], longest: int) -> None:
    title = panel["title"]
    theme.heading(above, title if len(title) <= longest else "… " + title[-longest:])
    order = sorted(range(len(panel["x"])), key=panel["x"].__getitem__) if panel["log_x"] else range(len(panel["x"]))
    above.plot(panel["x"], panel["measured"], "o", color=theme.COLOURS[0], markersize=2.5, label="measured")
    above.plot(
        [panel["x"][i] for i in order], [panel["fitted"][i] for i in order], color=theme.COLOURS[1], label="fitted"
    )
    below.plot(panel["x"], panel["residual"], "o", color=theme.COLOURS[0], markersize=2.0)
    below.axhline(0.0, color="0.5", linewidth=0.6)
    above.set_ylabel(panel["y_label"])
    below.set_ylabel("residual / σ")
    below.set_xlabel(panel["x_label"])
    above.set_xticklabels([])
    for axes in (above, below):
        axes.locator_params(nbins=theme.TICKS)
        if panel["log_x"]:
            axes.set_xscale("log")
            theme.log_ticks(axes.xaxis)
    if panel["log_y"]:
        above.set_yscale("log")
        theme.log_ticks(above.yaxis)
    above.set_xticklabels([])
    above.legend(loc="best", fontsize=6)


_EACH = 2.0  # Inches of a panel


def sweep(data: dict[str, Any]) -> Figure:
    """Draw each output; cells that violate a limit are hollow."""
    panels, cloud = data["panels"], bool(data["y"])
    labelled = any(series["label"] for panel in panels for series in panel["series"])
    height = 0.75 + len(panels) * (_EACH + 0.3)
    figure = theme.new_figure(height)
    wide = theme.WIDTH - (1.9 if cloud or labelled else 0.9)
    for number, panel in enumerate(panels):
        bottom = 0.55 + (len(panels) - 1 - number) * (_EACH + 0.3)
        axes = theme.place(figure, 0.75, bottom, wide, _EACH)
        last = number == len(panels) - 1
        if cloud:
            _cloud(figure, axes, panel, theme.place(figure, 0.75 + wide + 0.12, bottom, 0.1, _EACH))
        else:
            _lines(axes, panel, joined=data["joined"])
        axes.set(xlabel=data["x"] if last else "", ylabel=data["y"] if cloud else panel["label"])
        axes.locator_params(nbins=theme.TICKS)
        if labelled and not cloud and number == 0:
            figure.legend(
                *axes.get_legend_handles_labels(), loc="upper right", title=data["legend"], title_fontsize=theme.SMALL
            )
    if any(not all(series["met"]) for panel in panels for series in panel["series"]):
        theme.caption(figure, "Hollow: a limit is violated.")
    return figure


def _lines(axes: Any, panel: dict[str, Any], *, joined: bool) -> None:
    for number, series in enumerate(panel["series"]):
        style = theme.style_of(number)
        if not joined:
            style = {**style, "linestyle": ""}
        axes.plot(series["x"], series["y"], marker="o", markersize=3.5, label=series["label"] or None, **style)
        broken = [
            (x, y) for x, y, satisfied in zip(series["x"], series["y"], series["met"], strict=True) if not satisfied
        ]
        if broken:
            axes.plot(*zip(*broken, strict=True), linestyle="", marker="o", markersize=3.5, color=theme.BROKEN,
                      markerfacecolor="white")  # fmt: skip


def _cloud(figure: Figure, axes: Any, panel: dict[str, Any], scale: Any) -> None:
    (series,) = panel["series"]
    points = list(zip(series["x"], series["y"], series["colour"], series["met"], strict=True))
    if not points:
        return
    satisfied, broken = ([point for point in points if point[3] == which] for which in (True, False))
    ends = {"vmin": min(series["colour"]), "vmax": max(series["colour"])}
    for some, size in ((broken, 5), (satisfied, 14)):
        if some:
            x, y, colour, _ = zip(*some, strict=True)
            hollow = {"marker": "o", "linewidths": 0.0} if some is satisfied else {"marker": "."}
            axes.scatter(x, y, c=colour, cmap=theme.SEQUENCE, s=size, **hollow, **ends)
    figure.colorbar(ScalarMappable(Normalize(**ends), theme.SEQUENCE), cax=scale, label=panel["label"])


def atlas(data: dict[str, Any]) -> Figure:
    """Draw the fronts of torque over mass against the full cycle, and the map of the densest module of each cell."""
    figure = theme.new_figure(4.4)
    fronts = theme.place(figure, 0.6, 1.15, 3.2, 2.75)
    for number, series in enumerate(data["series"]):
        colour = ATLAS_COLOURS[number % len(ATLAS_COLOURS)]
        marker = theme.MARKERS[number % len(theme.MARKERS)]
        sizes = [2.0 + 4.0 * max(math.log10(max(energy, 1.0)), 0.0) for energy in series["energy"]]
        fronts.plot(series["cycle"], series["density"], color=colour, linewidth=0.9)
        fronts.scatter(series["cycle"], series["density"], s=sizes, color=colour, marker=marker, zorder=3,
                       label=series["label"])  # fmt: skip
        for cycle, density, band in zip(series["cycle"], series["density"], series["bands"], strict=True):
            if band:
                low, high, fast, slow = band
                line: dict[str, Any] = {"color": colour, "linewidth": 0.4, "alpha": 0.4}
                fronts.plot([cycle, cycle], [low, high], **line)
                fronts.plot([fast, min(slow, 1e3)], [density, density], **line)
    for device in data.get("devices", ()):
        fronts.plot(*device["place"], device["marker"], color="0.35", markersize=3.5, fillstyle=device["fill"])
    fronts.set(xscale="log", yscale="log", xlabel="full cycle: soft and stiff again [s]")
    fronts.set_ylabel("torque asked over mass [N·m/kg]")
    for axis in (fronts.xaxis, fronts.yaxis):
        theme.log_ticks(axis)
    handles, labels = fronts.get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="lower left", ncols=2, fontsize=theme.SMALL, columnspacing=0.8, handletextpad=0.2
    )
    _map(figure, data["map"])
    theme.caption(figure, data["caption"])
    return figure


def _map(figure: Figure, data: dict[str, Any]) -> None:
    """Draw the densest module of each cell of torque and longest cycle; grey cells are empty."""
    axes = theme.place(figure, 4.45, 1.15, 1.95, 2.75)
    mesh = axes.pcolormesh(
        range(len(data["cycles"]) + 1), range(len(data["torques"]) + 1),
        [[math.nan if value is None else value for value in row] for row in data["density"]],
        cmap=theme.SEQUENCE, norm=LogNorm(),
    )  # fmt: skip
    axes.set_facecolor("0.8")
    for across, up in data["unanswered"]:
        axes.text(across + 0.5, up + 0.5, "?", ha="center", va="center", fontsize=theme.SMALL)
    axes.grid(visible=False)
    for name, values in (("x", data["cycles"]), ("y", data["torques"])):
        ticks = [place + 0.5 for place in range(len(values))]
        axes.set(**{f"{name}ticks": ticks, f"{name}ticklabels": [f"{value:g}" for value in values]})
    axes.tick_params(axis="x", labelrotation=90)
    axes.set(xlabel="longest cycle [s]", ylabel="torque asked [N·m]")
    scale = figure.colorbar(mesh, cax=theme.place(figure, 6.5, 1.15, 0.1, 2.75), label="N·m/kg")
    theme.log_ticks(scale.ax.yaxis)


ATLAS_COLOURS = (*theme.COLOURS, "#882255", "#999933", "#661100")
