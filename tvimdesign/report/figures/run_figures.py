"""The figures of every run: each takes plain data and returns a matplotlib figure."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullLocator

from tvimdesign.report.figures.canvas import new_figure, png

_TICKS = 6
"""Steps of an axis at most: every tick, with its line and label, takes a millisecond to draw."""


def warm_up() -> None:
    """Draw something on every kind of axes, so that fonts and caches are loaded before there is work."""
    figure = new_figure()
    linear, logarithmic = figure.subplots(1, 2)
    linear.plot([0.0, 1.0], label="°")
    linear.barh([0.0], [1.0])
    linear.legend(title="text")
    logarithmic.semilogy([1.0, 1e3])
    _plain_decades(logarithmic.yaxis)
    png(figure)


def cycle(data: dict[str, Any]) -> Figure:
    """The working cycle: temperatures, impedance and current over time, and temperatures through the layer."""
    figure = new_figure(11.0, 7.0)
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
    """Times and values of a column over both phases."""
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
    for phase, label, style in (
        ("stiffening", "cooling: freezes supercooled", "-"),
        ("equilibrium_stiffening", "cooling, as the melting curve would claim", "--"),
    ):
        if phase in data:
            times = [end + time for time in data[phase]["time"]]
            axes.semilogy(times, data[phase]["joint_impedance"], color="tab:blue", linestyle=style, label=label)
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
    colours, profiles = mpl.colormaps["plasma"], history["profiles"]
    for profile, shade in zip(profiles, np.linspace(0.0, 0.9, len(profiles)), strict=True):
        axes.plot(data["depths"], profile["temperatures"], color=colours(shade), label=f"{profile['time']:.0f} s")
    axes.axhspan(data["melting"][0], data["melting"][1], alpha=0.12, color="tab:orange")
    axes.set(ylabel="temperature (°C)", title=title)
    axes.legend(fontsize=8, title="after", loc="upper left", bbox_to_anchor=(1.0, 1.0))


def impedance(data: dict[str, Any]) -> Figure:
    """Stiffness and damping against temperature, of the layer alone and of the joint."""
    sweep = data["sweep"]
    figure = new_figure(10.0)
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
    figure.subplots_adjust(left=0.095, right=0.98, bottom=0.12, top=0.92, wspace=0.24)
    return figure


def mass(data: dict[str, Any]) -> Figure:
    """Mass of each part the module has."""
    parts = sorted(((name, value) for name, value in data["parts"].items() if value > 0.0), key=lambda item: item[1])
    figure = new_figure(8.0, 3.5)
    axes = figure.subplots()
    bars = axes.barh([name for name, _ in parts], [value for _, value in parts], color="tab:blue")
    axes.bar_label(bars, fmt="%.1f g", padding=3)
    axes.margins(x=0.12)
    axes.set(xlabel="mass (g)", title=f"{sum(data['parts'].values()):.0f} g in all, without wires")
    axes.grid(axis="y", visible=False)
    figure.subplots_adjust(left=0.12, right=0.96, bottom=0.15, top=0.9)
    return figure


def _colour(margin: float, kept: bool) -> str:
    if not kept:
        return "tab:red"
    return "tab:green" if margin > 5e-4 else "tab:orange"


_BELOW, _ABOVE = 0.75, 0.5  # inches: of any number of lines, ends of axes and legend stand below, the title above


def bounds(data: dict[str, Any]) -> Figure:
    """The design between its bounds, and the margin of every limit."""
    free, limits = data["free"], data["limits"]
    inches = 0.6 + 0.28 * max(len(free), len(limits), 6)
    figure = new_figure(11.5, inches)
    where, margins = figure.subplots(1, 2)
    high = inches - _BELOW - _ABOVE
    lines = list(range(len(free)))
    where.hlines(lines, 0.0, 1.0, color="lightgrey", linewidth=6, capstyle="round")
    begins, ends = ([row[name] for row in reversed(free)] for name in ("start", "share"))
    where.plot(begins, lines, "o", color="white", markeredgecolor="grey", label="start")
    where.plot(ends, lines, "o", color="tab:blue", label="design")
    where.set(xticks=[0, 1], xticklabels=["lower bound", "upper bound"], xlim=(-0.05, 1.05))
    if free:
        where.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.35 / high), ncols=2)
    shown = [max(min(row["margin"], 1.0), -1.0) for row in reversed(limits)]
    colours = [_colour(row["margin"], row["kept"]) for row in reversed(limits)]
    margins.barh(range(len(limits)), [v if abs(v) > 0.01 else 0.01 for v in shown], color=colours)
    margins.set(xticks=[0.0], xticklabels=["limit"], xlim=(-1.05, 1.05))
    for axes, title in ((where, "What varies"), (margins, "What must hold (bars end at 100 %)")):
        axes.set_title(title, y=1.0 + 0.1 / high)
    _beside(where, [f"{row['name']}  {row['text']}" for row in reversed(free)], 8)
    _beside(margins, [f"{row['name']}   {row['text']}" for row in reversed(limits)], 7)
    figure.subplots_adjust(left=0.17, right=0.99, bottom=_BELOW / inches, top=1.0 - _ABOVE / inches, wspace=1.0)
    return figure


def _beside(axes: Any, names: list[str], size: int) -> None:
    """Names to the left of lines or bars, from the lowest up: as ticks they would be five things to draw each."""
    axes.set_yticks([])
    for i, name in enumerate(names):
        axes.text(-0.02, i, name, ha="right", va="center", fontsize=size, transform=axes.get_yaxis_transform())
