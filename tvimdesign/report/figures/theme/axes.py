"""What axes of every figure have alike: ticks of logarithmic axes, legends beside the data, names beside rows."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator, NullLocator

from tvimdesign.report.figures.theme.style import SMALL

TICKS = 6
"""Steps of an axis at most: every tick, with its line and label, takes a millisecond to draw."""
_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def log_ticks(axis: Any) -> None:
    """Few ticks with plain numbers on an axis made logarithmic, at least two whatever it spans, none between them."""
    low, high = sorted(axis.get_view_interval())
    inside = [value for value in _log_values(low, high) if low <= value <= high]
    if len(inside) < 2:
        inside = [value for value in MaxNLocator(4).tick_values(low, high) if low <= value <= high]
    axis.set_major_locator(FixedLocator(inside))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: plain(value)))


def _log_values(low: float, high: float) -> list[float]:
    """Powers of ten, with their doubles and fives where the axis spans less than three of them."""
    decades = math.log10(high / low)
    steps = (1.0, 2.0, 5.0) if decades < 2.5 else (1.0,)
    every = max(1, math.ceil(decades / TICKS))
    first = every * math.floor(math.log10(low) / every)
    return [step * 10.0**power for power in range(first, math.ceil(math.log10(high)) + 1, every) for step in steps]


def plain(value: float) -> str:
    """A tick's number for people: 0.5, 200, 10⁶."""
    if value == 0.0 or 1e-3 <= abs(value) < 1e5:
        return f"{value:.6g}"
    mantissa, _, power = f"{value:.3e}".partition("e")
    raised = "10" + str(int(power)).translate(_RAISED)
    return raised if float(mantissa) == 1.0 else f"{float(mantissa):g}·{raised}"


def heading(axes: Any, text: str) -> None:
    """A title above the axes; matplotlib's own measures every label to find its place."""
    axes.annotate(text, (0.0, 1.0), (0.0, 4.0), xycoords="axes fraction", textcoords="offset points", fontsize=7.5)


def legend_above(axes: Any, columns: int) -> None:
    """The legend above the axes, where it covers nothing."""
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns)


def legend_beside(axes: Any, title: str) -> None:
    """The legend right of the axes."""
    axes.legend(title=title, loc="upper left", bbox_to_anchor=(1.0, 1.0), title_fontsize=SMALL)


def row_texts(axes: Any, left: Sequence[str], right: Sequence[str]) -> None:
    """Texts to both sides of rows, from the lowest up: as ticks they would be five things to draw each."""
    axes.set_yticks([])
    for texts, x, side in ((left, -0.015, "right"), (right, 1.015, "left")):
        for i, text in enumerate(texts):
            axes.text(x, i, text, ha=side, va="center", fontsize=SMALL, transform=axes.get_yaxis_transform(),
                      parse_math=False)  # fmt: skip
