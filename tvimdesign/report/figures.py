"""The figures of a run: each takes plain data and returns a matplotlib figure, without pyplot and without a display."""

from __future__ import annotations

import io
import math
from typing import Any

import matplotlib as mpl
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

mpl.rcParams.update(
    {
        "font.size": 10,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "grid.alpha": 0.3,
        "legend.frameon": False,
        "axes.titley": 1.02,  # a place of its own: otherwise matplotlib measures every label to find one
    }
)
_PROFILES = 7


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
    linear.legend(title="text")
    logarithmic.semilogy([1.0, 1e3])
    figure.savefig(io.BytesIO(), format="png", dpi=120)


def switch_temperatures(data: dict[str, Any]) -> Figure:
    """Temperature at the layer's faces over time, and through the layer at several times."""
    history = data["history"]
    figure = _figure(10.0)
    over_time, through = figure.subplots(1, 2)
    time = history["time"]
    cells = [name for name in history if name.startswith("cell_")]
    for name, label in (("hot_side", "Peltier hot side"), ("near_face", "near face"), ("far_face", "far face"),
                        ("cold_side", "Peltier cold side")):  # fmt: skip
        over_time.plot(time, history[name], label=label)
    over_time.axhspan(data["melting"][0], data["melting"][1], alpha=0.12, color="tab:orange", label="melting range")
    over_time.axhline(data["target"], color="black", linewidth=0.8, linestyle=":", label="target")
    over_time.set(xlabel="time (s)", ylabel="temperature (°C)", title="Over the switch")
    over_time.legend(fontsize=8)
    depths = [0.0, *((i + 0.5) / len(cells) * data["thickness"] for i in range(len(cells))), data["thickness"]]
    colours = mpl.colormaps["plasma"]
    for i in range(_PROFILES):
        at = round(i / (_PROFILES - 1) * (len(time) - 1))
        line = [history["near_face"][at], *(history[name][at] for name in cells), history["far_face"][at]]
        through.plot(depths, line, color=colours(0.9 * i / (_PROFILES - 1)), label=f"{time[at]:.0f} s")
    through.axhspan(data["melting"][0], data["melting"][1], alpha=0.12, color="tab:orange")
    through.set(xlabel="depth from the Peltier pads (mm)", ylabel="temperature (°C)", title="Through the PCL layer")
    through.legend(fontsize=8, title="after", loc="upper left", bbox_to_anchor=(1.0, 1.0))
    figure.subplots_adjust(left=0.07, right=0.91, bottom=0.12, top=0.92, wspace=0.2)
    return figure


def impedance(data: dict[str, Any]) -> Figure:
    """Stiffness and damping against temperature, of the layer alone and of the joint."""
    sweep = data["sweep"]
    figure = _figure(10.0)
    stiffness, damping = figure.subplots(1, 2)
    for axes, kind, unit in ((stiffness, "stiffness", "N·m/rad"), (damping, "damping", "N·m·s/rad")):
        axes.semilogy(sweep["temperature"], sweep[f"pcl_{kind}"], label="PCL layer alone", linestyle="--")
        axes.semilogy(sweep["temperature"], sweep[f"joint_{kind}"], label="joint: springs, layer, structure")
        axes.yaxis.set_minor_locator(NullLocator())  # minor ticks of a log axis take longer to draw than all else
        axes.axvspan(
            data["melting"][0], data["melting"][1], alpha=0.12, color="tab:orange", label="melting: depends\non history"
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
    for i, row in enumerate(reversed(free)):
        where.plot([0.0, 1.0], [i, i], color="lightgrey", linewidth=6, solid_capstyle="round")
        where.plot(row["start"], i, "o", color="white", markeredgecolor="grey", label="start" if i == 0 else None)
        where.plot(row["share"], i, "o", color="tab:blue", label="design" if i == 0 else None)
        where.text(1.04, i, row["text"], va="center", fontsize=8)
    where.set(yticks=range(len(free)), yticklabels=[row["name"] for row in reversed(free)], xticks=[0, 1],
              xticklabels=["lower bound", "upper bound"], title="What varies")  # fmt: skip
    if free:
        where.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.06), ncols=2)
    where.set_xlim(-0.05, 1.35)
    shown = [max(min(row["margin"], 1.0), -1.0) for row in reversed(limits)]
    colours = [_colour(row["margin"], row["kept"]) for row in reversed(limits)]
    bars = margins.barh(range(len(limits)), [v if abs(v) > 0.01 else 0.01 for v in shown], color=colours)
    margins.bar_label(bars, [row["text"] for row in reversed(limits)], fontsize=7, padding=2)
    margins.set(yticks=range(len(limits)), yticklabels=[row["name"] for row in reversed(limits)], xlim=(-1.7, 1.5))
    margins.set(xticks=[0.0], xticklabels=["limit"], title="What must hold (bars end at 100 %)")
    margins.tick_params(axis="y", labelsize=7)
    for axes in (where, margins):
        axes.grid(axis="y", visible=False)
    inches = figure.get_figheight()
    figure.subplots_adjust(left=0.13, right=0.99, bottom=0.75 / inches, top=1.0 - 0.35 / inches, wspace=0.75)
    return figure


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
