"""The figures of a module itself: stiffness and damping over temperature, torque over angle, mass of its parts."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure

from tvimdesign.report.figures.theme import (
    BAND,
    COLOURS,
    LIMIT,
    SMALL,
    TICKS,
    WIDTH,
    caption,
    heading,
    legend_above,
    log_ticks,
    new_figure,
    place,
    style_of,
)


def impedance(data: dict[str, Any]) -> Figure:
    """Draw stiffness and damping against temperature, of layer and joint; bands: what history leaves."""
    sweep = data["sweep"]
    figure = new_figure(3.4)
    caption(figure, f"At {data['frequency']:g} Hz; pale areas: what the layer's history leaves open")
    for kind, left in (("stiffness", 0.62), ("damping", 4.12)):
        axes = place(figure, left, 0.42, 2.85, 2.2)
        for i, (part, label) in enumerate((("pcl", "PCL layer alone"), ("joint", "joint: springs, layer, structure"))):
            style = style_of(i)
            axes.plot(sweep["temperature"], sweep[f"{part}_{kind}"], label=label, **style)
            ends = (sweep[f"{part}_{kind}_{end}"] for end in ("low", "high"))
            axes.fill_between(sweep["temperature"], *ends, alpha=0.25, color=style["color"], linewidth=0.0)
        axes.set_yscale("log")
        axes.axvspan(*data["melting"], label="melting range", **{**BAND, "color": "0.5"})
        if kind == "stiffness":
            axes.axhline(data["springs"], label="springs alone", **LIMIT)
        log_ticks(axes.yaxis)
        axes.locator_params(axis="x", nbins=TICKS)
        axes.set(xlabel="Layer temperature (°C)", ylabel=data["labels"][kind])
        legend_above(axes, 2)
    return figure


def torque(data: dict[str, Any]) -> Figure:
    """Draw the torque that turns the joint as a sine through its stroke, a panel for each operating point."""
    loops = data["loops"]
    figure = new_figure(2.6)
    caption(figure, data["title"])
    gap, left = 0.62, 0.55
    wide = (WIDTH - left - 0.15 - gap * (len(loops) - 1)) / len(loops)
    for i, loop in enumerate(loops):
        axes = place(figure, left + i * (wide + gap), 0.42, wide, 1.55)
        axes.plot(loop["angle"], loop["torque"], label="joint", **style_of(0))
        axes.plot(loop["angle"], loop["springs"], label="springs alone", **style_of(1))
        axes.set(xlabel=data["labels"]["angle"], ylabel=data["labels"]["torque"])
        heading(axes, loop["title"])
        axes.locator_params(nbins=TICKS)
        if i == 0:
            handles = axes.get_legend_handles_labels()
    figure.legend(*handles, loc="upper right", bbox_to_anchor=(1.0, 1.0), ncols=2)
    return figure


def mass(data: dict[str, Any]) -> Figure:
    """Draw the mass of each part the module has."""
    parts = sorted(((name, value) for name, value in data["parts"].items() if value > 0.0), key=lambda item: item[1])
    figure = new_figure(1.0 + 0.2 * len(parts))
    axes = place(figure, 1.1, 0.42, 5.6, 0.2 * len(parts))
    bars = axes.barh([name for name, _ in parts], [value for _, value in parts], color=COLOURS[0])
    axes.bar_label(bars, fmt="%.1f g", padding=3, fontsize=SMALL)
    axes.margins(x=0.12, y=0.02)
    axes.set(xlabel=data["label"])
    axes.grid(axis="y", visible=False)
    caption(figure, f"{sum(data['parts'].values()):.0f} g in all, without wires")
    return figure
