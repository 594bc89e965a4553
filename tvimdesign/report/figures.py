"""The figures of runs and virtual tests: each takes plain data and returns a matplotlib figure, without a display."""

from __future__ import annotations

import bisect
import io
import math
from typing import Any

import matplotlib as mpl
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullLocator

mpl.rcParams.update(
    {
        "font.size": 10,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "grid.alpha": 0.3,
        "legend.frameon": False,
        "text.hinting": "none",  # a tenth of the drawing
        "axes.titley": 1.02,  # a place of its own: otherwise matplotlib measures every label to find one
    }
)
_PROFILES = 5
_TICKS = 6
"""Steps of an axis at most: every tick, with its line and label, takes a millisecond to draw."""
_ACROSS = 3
_DECADES_SHOWN = 1e10
"""Largest over smallest value of a logarithmic axis: what is smaller is nothing, and would press all else flat."""


def _figure(width: float = 8.0, height: float = 4.5) -> Figure:
    # Margins are set by each figure: matplotlib's own layouts take half of the drawing time.
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    return figure


def warm_up() -> None:
    """Draw something on every kind of axes, so that fonts and caches are loaded before there is work."""
    figure = _figure()
    linear, logarithmic = figure.subplots(1, 2)
    linear.plot([0.0, 1.0], label="°")
    linear.barh([0.0], [1.0])
    linear.legend(title="text")
    logarithmic.semilogy([1.0, 1e3])
    _plain_decades(logarithmic.yaxis)
    figure.savefig(io.BytesIO(), format="png", dpi=120)


def cycle(data: dict[str, Any]) -> Figure:
    """The working cycle: temperatures, impedance and current over time, and temperatures through the layer."""
    figure = _figure(11.0, 7.0)
    grid = figure.add_gridspec(12, 2, width_ratios=[1.4, 1.0])
    over_time, current, impedance = (
        figure.add_subplot(grid[rows, 0]) for rows in (slice(5), slice(5, 7), slice(7, 12))
    )
    heating, cooling = (figure.add_subplot(grid[rows, 1]) for rows in (slice(5), slice(7, 12)))
    soft, stiff = data["softening"], data.get("stiffening")
    _temperatures(over_time, soft, stiff, data)
    current.plot(*_joined(soft, stiff, "current"), color="tab:green")
    current.set_ylabel("current (A)")
    _impedance_over_time(impedance, soft, data)
    for axes in (over_time, current, impedance):
        axes.axvline(soft["time"][-1], color="grey", linewidth=0.8)
        axes.sharex(impedance)
    for axes in (over_time, current):
        axes.tick_params(axis="x", labelbottom=False)
    (cooling if stiff else heating).set_xlabel("depth from the Peltier pads (mm)")
    _through(heating, soft, data, "Through the layer while it heats")
    if stiff:
        _through(cooling, stiff, data, "Through the layer while it cools")
    else:
        cooling.set_axis_off()
    for axes in (over_time, current, heating, cooling):
        axes.locator_params(nbins=_TICKS)
    figure.subplots_adjust(left=0.08, right=0.9, bottom=0.07, top=0.95, wspace=0.2, hspace=1.4)
    return figure


def _joined(soft: dict[str, Any], stiff: dict[str, Any] | None, name: str) -> tuple[list[float], list[float]]:
    """Times and values of a column over both stages."""
    if not stiff:
        return soft["time"], soft[name]
    end = soft["time"][-1]
    return [*soft["time"], *(end + time for time in stiff["time"])], [*soft[name], *stiff[name]]


def _temperatures(axes: Any, soft: dict[str, Any], stiff: dict[str, Any] | None, data: dict[str, Any]) -> None:
    for name, label in (("hot_side", "pads, inner side"), ("near_face", "layer, near face"),
                        ("far_face", "layer, far face"), ("cold_side", "pads, outer side")):  # fmt: skip
        axes.plot(*_joined(soft, stiff, name), label=label)
    axes.axhspan(data["melting"][0], data["melting"][1], alpha=0.12, color="tab:orange", label="melting range")
    axes.axhline(data["target"], color="black", linewidth=0.8, linestyle=":", label="target")
    axes.set(ylabel="temperature (°C)", title="Over the cycle: heating, then cooling")
    axes.legend(fontsize=7, loc="upper right", ncols=2, frameon=True, framealpha=0.8, edgecolor="none")


def _impedance_over_time(axes: Any, soft: dict[str, Any], data: dict[str, Any]) -> None:
    end = soft["time"][-1]
    axes.semilogy(soft["time"], soft["joint_impedance"], color="tab:red", label="heating")
    for stage, label, style in (
        ("stiffening", "cooling: freezes supercooled", "-"),
        ("equilibrium_stiffening", "cooling, as the melting curve would claim", "--"),
    ):
        if stage in data:
            times = [end + time for time in data[stage]["time"]]
            axes.semilogy(times, data[stage]["joint_impedance"], color="tab:blue", linestyle=style, label=label)
    for threshold in ("soft", "stiff"):
        axes.axhline(data[threshold], color="black", linewidth=0.8, linestyle=":")
        axes.text(0.0, data[threshold], f"{threshold} ", va="bottom", fontsize=8)
    _plain_decades(axes.yaxis)
    axes.set(xlabel="time (s)", ylabel="joint impedance (N·m/rad)")
    axes.legend(fontsize=7, loc="lower right", frameon=True, framealpha=0.8, edgecolor="none")


def _plain_decades(axis: Any) -> None:
    """Decades as plain numbers and nothing between: minor ticks and exponents take longer to draw than all else."""
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def _through(axes: Any, history: dict[str, Any], data: dict[str, Any], title: str) -> None:
    time = history["time"]
    cells = [name for name in history if name.startswith("cell_")]
    depths = [0.0, *((i + 0.5) / len(cells) * data["thickness"] for i in range(len(cells))), data["thickness"]]
    colours = mpl.colormaps["plasma"]
    for i in range(_PROFILES):
        wanted = time[-1] * i / (_PROFILES - 1)
        at = min(bisect.bisect_left(time, wanted), len(time) - 1)
        line = [history["near_face"][at], *(history[name][at] for name in cells), history["far_face"][at]]
        axes.plot(depths, line, color=colours(0.9 * i / (_PROFILES - 1)), label=f"{time[at]:.0f} s")
    axes.axhspan(data["melting"][0], data["melting"][1], alpha=0.12, color="tab:orange")
    axes.set(ylabel="temperature (°C)", title=title)
    axes.legend(fontsize=8, title="after", loc="upper left", bbox_to_anchor=(1.0, 1.0))


def impedance(data: dict[str, Any]) -> Figure:
    """Stiffness and damping against temperature, of the layer alone and of the joint."""
    sweep = data["sweep"]
    figure = _figure(10.0)
    stiffness, damping = figure.subplots(1, 2)
    for axes, kind, unit in ((stiffness, "stiffness", "N·m/rad"), (damping, "damping", "N·m·s/rad")):
        for part, label, style in (
            ("pcl", "PCL layer alone", "--"),
            ("joint", "joint: springs, layer, structure", "-"),
        ):
            (line,) = axes.semilogy(sweep["temperature"], sweep[f"{part}_{kind}"], label=label, linestyle=style)
            ends = (sweep[f"{part}_{kind}_{end}"] for end in ("low", "high"))
            axes.fill_between(sweep["temperature"], *ends, alpha=0.2, color=line.get_color(), linewidth=0.0)
        _plain_decades(axes.yaxis)
        axes.axvspan(
            data["melting"][0], data["melting"][1], alpha=0.12, color="tab:orange", label="melting; bands: by history"
        )
        axes.set(
            xlabel="layer temperature (°C)",
            ylabel=f"{kind} ({unit})",
            title=f"{kind.title()} at {data['frequency']:g} Hz",
        )
    stiffness.axhline(data["springs"], color="black", linewidth=0.8, linestyle=":", label="springs alone")
    stiffness.legend(fontsize=8)
    damping.legend(fontsize=8)
    figure.subplots_adjust(left=0.07, right=0.98, bottom=0.12, top=0.92, wspace=0.22)
    return figure


def mass(data: dict[str, Any]) -> Figure:
    """Mass of each part."""
    parts = sorted(data["parts"].items(), key=lambda item: item[1])
    figure = _figure(8.0, 3.5)
    axes = figure.subplots()
    bars = axes.barh([name for name, _ in parts], [value for _, value in parts], color="tab:blue")
    axes.bar_label(bars, fmt="%.1f g", padding=3)
    axes.margins(x=0.12)
    axes.set(xlabel="mass (g)", title=f"{sum(data['parts'].values()):.0f} g in all, without screws and wires")
    axes.grid(axis="y", visible=False)
    figure.subplots_adjust(left=0.12, right=0.96, bottom=0.15, top=0.9)
    return figure


def _colour(margin: float, kept: bool) -> str:
    if not kept:
        return "tab:red"
    return "tab:green" if margin > 5e-4 else "tab:orange"


def bounds(data: dict[str, Any]) -> Figure:
    """The design between its bounds, and the margin of every limit."""
    free, limits = data["free"], data["limits"]
    figure = _figure(11.5, 0.6 + 0.28 * max(len(free), len(limits), 6))
    where, margins = figure.subplots(1, 2)
    lines = list(range(len(free)))
    where.hlines(lines, 0.0, 1.0, color="lightgrey", linewidth=6, capstyle="round")
    begins, ends = ([row[name] for row in reversed(free)] for name in ("start", "share"))
    where.plot(begins, lines, "o", color="white", markeredgecolor="grey", label="start")
    where.plot(ends, lines, "o", color="tab:blue", label="design")
    where.set(xticks=[0, 1], xticklabels=["lower bound", "upper bound"], xlim=(-0.05, 1.05), title="What varies")
    if free:
        where.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.06), ncols=2)
    shown = [max(min(row["margin"], 1.0), -1.0) for row in reversed(limits)]
    colours = [_colour(row["margin"], row["kept"]) for row in reversed(limits)]
    margins.barh(range(len(limits)), [v if abs(v) > 0.01 else 0.01 for v in shown], color=colours)
    margins.set(xticks=[0.0], xticklabels=["limit"], xlim=(-1.05, 1.05), title="What must hold (bars end at 100 %)")
    _beside(where, [f"{row['name']}  {row['text']}" for row in reversed(free)], 8)
    _beside(margins, [f"{row['name']}   {row['text']}" for row in reversed(limits)], 7)
    inches = figure.get_figheight()
    figure.subplots_adjust(left=0.17, right=0.99, bottom=0.75 / inches, top=1.0 - 0.5 / inches, wspace=1.0)
    return figure


def _beside(axes: Any, names: list[str], size: int) -> None:
    """Names to the left of lines or bars, from the lowest up: as ticks they would be five things to draw each."""
    axes.set_yticks([])
    for i, name in enumerate(names):
        axes.text(-0.02, i, name, ha="right", va="center", fontsize=size, transform=axes.get_yaxis_transform())


def trial(data: dict[str, Any]) -> Figure:
    """The panels of a virtual test side by side, at most three in a row; bands where the layer's history decides."""
    panels = data["panels"]
    down = -(-len(panels) // _ACROSS)
    across = -(-len(panels) // down)
    key = 0.15 * max(len(panel["lines"]) for panel in panels) + 0.2  # inches of legend below each panel
    width, height = 4.6 * across + 0.55, (3.9 + key) * down + 0.1
    figure = _figure(width, height)
    grid = figure.subplots(down, across, squeeze=False).ravel()
    for axes, panel in zip(grid, panels, strict=False):
        _panel(axes, panel)
    for axes in grid[len(panels) :]:
        axes.set_axis_off()
    figure.suptitle(data["title"], y=1.0 - 0.14 / height, va="top")
    figure.subplots_adjust(left=0.95 / width, right=1.0 - 0.15 / width, bottom=(0.5 + key) / height,
                           top=1.0 - 0.8 / height, wspace=0.28, hspace=0.34 + key / 3.0)  # fmt: skip
    return figure


_STYLES = ("-", ":", "-.", (0, (1, 3)))
"""Lines of one colour, in the order in which they come."""


def _panel(axes: Any, panel: dict[str, Any]) -> None:
    """One pair of axes of a virtual test; a colour for each beginning of a label."""
    styles: dict[str, list[Any]] = {}
    for line in panel["lines"]:
        family = line["label"].partition(",")[0]
        left = styles.setdefault(family, list(_STYLES))
        colour = f"C{list(styles).index(family)}"
        style = "--" if line["dashed"] else left.pop(0) if left else "-"
        axes.plot(line["x"], line["y"], color=colour, linestyle=style, label=line["label"])
        if line["band"]:
            axes.fill_between(line["x"], *line["band"], color=colour, alpha=0.15, linewidth=0.0)
    if panel["log_x"]:
        axes.set_xscale("log")
    if panel["log_y"]:
        _logarithmic(axes, panel["lines"])
    axes.set(xlabel=panel["x_label"], ylabel=panel["y_label"], title=panel["title"])
    axes.legend(fontsize=7, loc="upper center", bbox_to_anchor=(0.5, -0.16))


def _logarithmic(axes: Any, lines: list[dict[str, Any]]) -> None:
    """A logarithmic y axis that shows no more decades than there is something on."""
    axes.set_yscale("log", nonpositive="clip")
    drawn = [value for line in lines for part in (line["y"], *(line["band"] or ())) for value in part if value > 0.0]
    least, most = max(min(drawn), max(drawn) / _DECADES_SHOWN), max(drawn)
    axes.set_ylim(least / 1.5, most * 1.5)
    if most / least > 100.0:  # minor ticks take longer to draw than all else; within a decade they are the only ones
        axes.yaxis.set_minor_locator(NullLocator())


_PLACES = {"near_face_time": "near face at its target", "mean_time": "mean at its target",
           "far_face_time": "far face at its target", "softening_time": "joint soft"}  # fmt: skip


def level_sets(data: dict[str, Any]) -> Figure:
    """Thickness that gives one response time against other parameters, a line for each place of the sensor."""
    figure = _figure(4.2 * len(data["panels"]), 4.5)
    every = figure.subplots(1, len(data["panels"]), sharey=True, squeeze=False)[0]
    for axes, one in zip(every, data["panels"], strict=True):
        for place, label in _PLACES.items():
            line = [math.nan if y is None else y for y in one["lines"][place]]
            none = all(math.isnan(y) for y in line)
            axes.plot(one["x"], line, marker=".", label=f"{label}: none here" if none else label)
        axes.plot(*one["published"], "k+", markersize=10, label="as assumed here")
        axes.set(xlabel=one["label"], ylim=(0.0, data["range"][1]))
        if one["logarithmic"]:
            axes.set_xscale("log")
        axes.legend(fontsize=7)
    every[0].set_ylabel("thickness of the layer (mm)")
    figure.suptitle(f"What gives {data['wanted']:g} s: thickness from {data['range'][0]:g} to {data['range'][1]:g} mm")
    figure.subplots_adjust(left=0.06, right=0.98, bottom=0.14, top=0.9, wspace=0.08)
    return figure


def tornado(data: dict[str, Any]) -> Figure:
    """Ratio of compression to shear time: a bar for each input through its range, a mark for each other choice."""
    bars, choices, middle = data["bars"][::-1], data["choices"][::-1], data["ratio"]
    figure = _figure(9.0, 1.2 + 0.3 * (len(bars) + len(choices)))
    axes = figure.subplots()
    for i, choice in enumerate(choices):
        axes.plot(choice["ratio"], i, "D", color="tab:green")
        axes.text(choice["ratio"], i + 0.15, f"{choice['ratio']:.2f}", fontsize=7, ha="center", va="bottom")
    for i, bar in enumerate(bars, start=len(choices)):
        for end, ratio, colour in zip(bar["ends"], bar["ratios"], ("tab:blue", "tab:orange"), strict=True):
            if ratio is not None:  # one of the two never gets there
                axes.barh(i, ratio - middle, left=middle, color=colour, height=0.7)
                axes.text(ratio, i, f" {end} ", fontsize=7, va="center", ha="left" if ratio > middle else "right")
    axes.axvline(middle, color="black", linewidth=0.8)
    labels = [choice["label"] for choice in choices] + [bar["label"] for bar in bars]
    axes.set(yticks=range(len(labels)), yticklabels=labels, xlabel="time in compression over time in shear")
    axes.tick_params(axis="y", labelsize=7)
    axes.grid(axis="y", visible=False)
    axes.margins(x=0.1, y=0.02)
    figure.suptitle("The paper's 2 : 1, with each assumed input alone through its plausible range")
    inches = figure.get_figheight()
    figure.subplots_adjust(left=0.42, right=0.98, bottom=0.5 / inches, top=1.0 - 0.4 / inches)
    return figure
