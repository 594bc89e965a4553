"""The figures over a working cycle: temperatures and profiles, stiffness and damping, power and energy."""

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from tvimdesign.report.figures import theme

_PHASES = (
    ("softening", "heating"),
    ("stiffening", "cooling: freezes supercooled"),
    ("equilibrium_stiffening", "cooling, as the melting curve would claim"),
)
_SUMS = ("electrical_energy",)
"""Columns that begin at zero in every phase, and add up over the cycle."""
_LEFT, _WIDE = 0.62, 3.4  # inches: where panels over time begin, and how wide they are beside others


def cycle(data: dict[str, Any]) -> Figure:
    """Return the working cycle: temperatures, current and impedance over time, and temperatures through the layer."""
    figure = theme.new_figure(5.85)
    over_time = theme.place(figure, _LEFT, 3.55, _WIDE, 1.6)
    current = theme.place(figure, _LEFT, 2.72, _WIDE, 0.62, sharex=over_time)
    impedance = theme.place(figure, _LEFT, 0.9, _WIDE, 1.6, sharex=over_time)
    soft, stiff = data["softening"], data.get("stiffening")
    _temperatures(over_time, soft, stiff, data)
    current.plot(*_joined(soft, stiff, "current"), **theme.style_of(4) | {"linestyle": "-"})
    current.set_ylabel(data["labels"]["current"])
    _phases(impedance, data, "joint_impedance")
    _thresholds(impedance, data)
    impedance.set_xlabel("Time (s)")
    impedance.legend(loc="upper left", bbox_to_anchor=(0.0, -0.24), ncols=2)
    _share_time((over_time, current, impedance), soft)
    profiles = [(soft, "Through the layer while it heats", 3.55)]
    if stiff:
        profiles.append((stiff, "Through the layer while it cools", 0.9))
    for history, title, bottom in profiles:
        axes = theme.place(figure, 4.8, bottom, 1.42, 1.6)
        _through(axes, history, data, title)
        axes.locator_params(nbins=theme.TICKS)
    for axes in (over_time, current):
        axes.locator_params(nbins=theme.TICKS)
    return figure


def stiffness_and_damping(data: dict[str, Any]) -> Figure:
    """Draw stiffness and damping of the joint through the cycle, at the frequency of where each phase leads."""
    figure = theme.new_figure(4.75)
    theme.caption(figure, data["title"])
    stiffness = theme.place(figure, _LEFT, 2.42, 6.1, 1.72)
    damping = theme.place(figure, _LEFT, 0.42, 6.1, 1.72, sharex=stiffness)
    _phases(stiffness, data, "joint_stiffness")
    if data["springs"]:
        stiffness.axhline(data["springs"], label="springs alone", **theme.LIMIT)
        low, high = stiffness.get_ylim()
        stiffness.set_ylim(min(low, 0.8 * data["springs"]), high)
    theme.log_ticks(stiffness.yaxis)
    _phases(damping, data, "joint_damping")
    damping.set_xlabel("Time (s)")
    _share_time((stiffness, damping), data["softening"])
    theme.legend_above(stiffness, 4)
    damping.locator_params(axis="x", nbins=2 * theme.TICKS)
    return figure


def power_and_energy(data: dict[str, Any]) -> Figure:
    """Return what the supply gives through the cycle, and what that adds up to."""
    figure = theme.new_figure(4.6)
    power = theme.place(figure, _LEFT, 2.42, 6.1, 1.72)
    energy = theme.place(figure, _LEFT, 0.42, 6.1, 1.72, sharex=power)
    for axes, name in ((power, "electrical_power"), (energy, "electrical_energy")):
        _phases(axes, data, name, logarithmic=False)
        axes.locator_params(nbins=theme.TICKS)
        axes.set_ylim(bottom=0.0)
    energy.set_xlabel("Time (s)")
    _share_time((power, energy), data["softening"])
    theme.legend_above(power, 4)
    return figure


def _share_time(panels: tuple[Any, ...], soft: dict[str, Any]) -> None:
    """Draw a line through all panels where heating ends, and label times below the lowest panel alone."""
    for axes in panels:
        axes.axvline(soft["time"][-1], color="0.5", linewidth=0.7, zorder=0.5)
    for axes in panels[:-1]:
        axes.tick_params(axis="x", labelbottom=False)


def _joined(soft: dict[str, Any], stiff: dict[str, Any] | None, name: str) -> tuple[list[float], list[float]]:
    """Return times and values of a column over both phases."""
    if not stiff:
        return soft["time"], soft[name]
    end = soft["time"][-1]
    return [*soft["time"], *(end + time for time in stiff["time"])], [*soft[name], *stiff[name]]


def _temperatures(axes: Any, soft: dict[str, Any], stiff: dict[str, Any] | None, data: dict[str, Any]) -> None:
    for i, (name, label) in enumerate(data["places"].items()):
        axes.plot(*_joined(soft, stiff, name), label=label, **theme.style_of(i))
    axes.axhspan(*data["melting"], label="melting range", **theme.BAND)
    axes.axhline(data["target"], label="target", **theme.LIMIT)
    axes.set_ylabel("Temperature (°C)")
    theme.legend_above(axes, 3)


def _phases(axes: Any, data: dict[str, Any], name: str, *, logarithmic: bool = True) -> None:
    """Draw a column of every phase over time, cooling from the end of heating on."""
    for i, (phase, label) in enumerate(_PHASES):
        if phase in data:
            begin = 0.0 if phase == "softening" else data["softening"]["time"][-1]
            added = data["softening"][name][-1] if phase != "softening" and name in _SUMS else 0.0
            values = [added + value for value in data[phase][name]]
            axes.plot([begin + time for time in data[phase]["time"]], values, label=label, **theme.style_of(i))
    axes.set_ylabel(data["labels"][name])
    if logarithmic:
        axes.set_yscale("log")
        theme.log_ticks(axes.yaxis)


def _thresholds(axes: Any, data: dict[str, Any]) -> None:
    low, high = axes.get_ylim()
    for name in ("soft", "stiff"):
        axes.axhline(data[name], **theme.LIMIT)
        axes.annotate(name, (1.0, data[name]), (2.0, 0.0), xycoords=axes.get_yaxis_transform(),
                      textcoords="offset points", va="center", fontsize=theme.SMALL)  # fmt: skip
    axes.set_ylim(min(low, data["soft"] / 1.2), max(high, data["stiff"] * 1.2))
    theme.log_ticks(axes.yaxis)


def _through(axes: Any, history: dict[str, Any], data: dict[str, Any], title: str) -> None:
    colours, profiles = mpl.colormaps[theme.SEQUENCE], history["profiles"]
    for i, (profile, shade) in enumerate(zip(profiles, np.linspace(0.0, 0.85, len(profiles)), strict=True)):
        style = theme.style_of(i) | {"color": colours(shade)}
        axes.plot(data["depths"], profile["temperatures"], label=f"{profile['time']:.0f} s", **style)
    axes.axhspan(*data["melting"], **theme.BAND)
    axes.set(xlabel="Depth from the heaters (mm)", ylabel="Temperature (°C)")
    theme.heading(axes, title)
    axes.legend(title="after", loc="upper left", bbox_to_anchor=(1.0, 1.0), title_fontsize=theme.SMALL)
