"""Figures of a design over temperature, angle and its working cycle, fronts, and one page on A4."""

import itertools
import textwrap
from itertools import zip_longest
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from PIL import Image

from tvimdesign.report.figures import theme
from tvimdesign.report.figures.theme import FAINT, NAME_STRIP, new_figure


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
        axes.plot(loop["angle"], loop["torque"], label="joint, small motions", **theme.style_of(0))
        if "springs" in loop:
            axes.plot(loop["spring_angle"], loop["springs"], label="springs alone", **theme.style_of(1))
        for side in (-1.0, 1.0):
            axes.axvline(side * data["stop_angle"], label="hard stops" if side > 0.0 else None, **theme.style_of(2))
        axes.set(xlabel=data["labels"]["angle"], ylabel=data["labels"]["torque"])
        theme.heading(axes, loop["title"])
        axes.locator_params(nbins=theme.TICKS)
    figure.legend(*axes.get_legend_handles_labels(), loc="upper right", bbox_to_anchor=(1.0, 1.0), ncols=3)
    return figure


_WIDE, _HIGH = 8.27, 11.69  # inches: A4
_LEFT, _BOTTOM = 0.7, 0.6
_ACROSS = _WIDE - 2.0 * _LEFT
_LINE, _SMALL, _SIZE = 0.165, 7.5, 8.5  # inches of a line; points
_LETTERS = 100  # Letters of a line of text across the page
_LABEL = 1.3  # inches that the labels of facts take
_TONES = {"good": "#1b6b3a", "warn": "#8a5300", "bad": "#a8201a", "": "black"}
_MOST_ROWS = 22
_PICTURE = 2.9  # inches high at most


class _Sheet:
    """A figure that is filled from the top down."""

    def __init__(self) -> None:
        self.figure = new_figure(_HIGH, _WIDE)
        self.left = _HIGH - _BOTTOM - NAME_STRIP  # Inches from the foot of the page up to the next line

    def text(self, text: str, at: float = 0.0, size: float = _SIZE, **more: Any) -> None:
        """Write at a distance from the left margin [inches], on the line of now."""
        place = ((_LEFT + at) / _WIDE, self.left / _HIGH)
        self.figure.text(*place, text, va="top", fontsize=size, parse_math=False, **more)

    def down(self, inches: float = _LINE) -> None:
        """Go on to the next line."""
        self.left -= inches

    def rule(self) -> None:
        """Draw a thin line across the page."""
        line = self.figure.add_axes((_LEFT / _WIDE, (self.left + 0.04) / _HIGH, _ACROSS / _WIDE, 1e-4))
        line.axhline(0.0, color=FAINT, linewidth=0.6)
        line.set_axis_off()

    def lines(self, text: str, label: str, **style: Any) -> None:
        """Write a text behind its label, each in as many lines as it takes."""
        wide, narrow = (int(_LETTERS * inches / _ACROSS) for inches in (_ACROSS - _LABEL, _LABEL))
        for left, right in zip_longest(textwrap.wrap(label, narrow), textwrap.wrap(text, wide), fillvalue=""):
            self.text(left, **style)
            self.text(right, _LABEL)
            self.down()


def summary(data: dict[str, Any]) -> Figure:
    """Return the page of a run's first screen."""
    sheet = _Sheet()
    sheet.text(textwrap.shorten(data["title"], 60, placeholder=" …"), size=15.0, weight="bold")
    sheet.down(0.3)
    sheet.text(data["kind"], color="0.35")
    sheet.down(1.4 * _LINE)
    for line in textwrap.wrap(data["status"], 70):
        sheet.text(line, size=12.0, weight="bold", color=_TONES[data["tone"]])
        sheet.down(0.24)
    sheet.down(0.5 * _LINE)
    if data["rows"]:
        _table(sheet, data["heads"], data["rows"])
    for label, text in data["facts"]:
        sheet.lines(text, label, color="0.35")
    for text, cure in data["warnings"]:
        sheet.lines(text + (f"; {cure}" if cure else ""), "Warning", color=_TONES["warn"], weight="bold")
    if data["picture"]:
        _picture(sheet, Path(data["picture"]))
    sheet.left = _BOTTOM
    sheet.text(data["made_by"], size=_SMALL, color="0.35")
    return sheet.figure


def _table(sheet: _Sheet, heads: list[str], rows: list[list[str]]) -> None:
    """Write the requirements: as many as have a place, and how many more there are."""
    ends = (0.0, 1.9, 3.05, 4.35, 5.4)
    for at, head in zip(ends, heads, strict=False):
        sheet.text(head, at, color="0.35")
    sheet.down()
    for row in rows[:_MOST_ROWS]:
        sheet.rule()
        for at, text in zip(ends, row, strict=False):
            tone = "bad" if text.startswith("violated") else "warn" if text == "at the limit" else ""
            sheet.text(textwrap.shorten(text, 32, placeholder=" …"), at, color=_TONES[tone])
        sheet.down()
    if len(rows) > _MOST_ROWS:
        sheet.text(f"{len(rows) - _MOST_ROWS} more in report.html", color="0.35")
        sheet.down()
    sheet.rule()
    sheet.down(0.5 * _LINE)


def _picture(sheet: _Sheet, path: Path) -> None:
    """Draw the module in the room that is left, if there is enough to see it."""
    sheet.down(0.5 * _LINE)
    room = min(_PICTURE, sheet.left - _BOTTOM - _LINE)
    if room < 0.8:
        return
    with Image.open(path) as opened:
        pixels = np.asarray(opened.convert("RGB").reduce(2))
    high = min(room, _ACROSS * pixels.shape[0] / pixels.shape[1])
    wide = high * pixels.shape[1] / pixels.shape[0]
    axes = sheet.figure.add_axes((_LEFT / _WIDE, (sheet.left - high) / _HIGH, wide / _WIDE, high / _HIGH))
    axes.imshow(pixels, interpolation="none", aspect="auto")
    axes.set_axis_off()


_PHASES = (
    ("softening", "heating"),
    ("stiffening", "cooling: freezes supercooled"),
    ("equilibrium_stiffening", "cooling, as the melting curve would claim"),
)
_SUMS = ("electrical_energy",)  # Columns that begin at zero in every phase, and add up over the cycle
_TIME_LEFT, _TIME_WIDE = 0.62, 3.4  # inches: where panels over time begin, and how wide they are beside others


def cycle(data: dict[str, Any]) -> Figure:
    """Return the working cycle: temperatures, current and impedance over time, and temperatures through the layer."""
    figure = theme.new_figure(5.85)
    over_time = theme.place(figure, _TIME_LEFT, 3.55, _TIME_WIDE, 1.6)
    current = theme.place(figure, _TIME_LEFT, 2.72, _TIME_WIDE, 0.62, sharex=over_time)
    impedance = theme.place(figure, _TIME_LEFT, 0.9, _TIME_WIDE, 1.6, sharex=over_time)
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
    stiffness = theme.place(figure, _TIME_LEFT, 2.42, 6.1, 1.72)
    damping = theme.place(figure, _TIME_LEFT, 0.42, 6.1, 1.72, sharex=stiffness)
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
    power = theme.place(figure, _TIME_LEFT, 2.42, 6.1, 1.72)
    energy = theme.place(figure, _TIME_LEFT, 0.42, 6.1, 1.72, sharex=power)
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
