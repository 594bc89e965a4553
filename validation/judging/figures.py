"""A small figure of every case: a curve with its expected points and limits, or values within their limits."""

from __future__ import annotations

import io
from collections.abc import Iterable
from pathlib import Path

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.ticker import NullFormatter

from judging.outcome import Compared, Outcome
from tvimdesign.report.figures.theme import BAND, COLOURS, LIMIT, MARKERS, new_figure, place, style_of

_WIDTH, _HEIGHT = 3.4, 2.1
_WIDE = 30.0
"""An axis whose ends are so many times apart is logarithmic."""
_FURTHEST = 30.0
"""A value beyond so many limits is drawn there, an infinite one too."""
_LONGEST = 26
"""Letters of a label."""


def write_figures(outcomes: Iterable[Outcome], folder: Path) -> None:
    """Write an SVG for each case that was compared, and remove those of cases that are gone."""
    folder.mkdir(parents=True, exist_ok=True)
    compared = [each for each in outcomes if each.quantities]
    for stale in {path.stem for path in folder.glob("*.svg")} - {each.case.name for each in compared}:
        (folder / f"{stale}.svg").unlink()
    for each in compared:
        (folder / f"{each.case.name}.svg").write_bytes(figure(each))


def figure(each: Outcome) -> bytes:
    """Return a case's figure as SVG: the same bytes from the same numbers."""
    curves = [part for part in each.quantities if part.quantity.at and len(part.rows) > 1]
    rows = sum(len(part.rows) for part in each.quantities)
    height = _HEIGHT if curves else 0.55 + 0.16 * min(rows, 40)
    drawn = new_figure(height, _WIDTH)
    if curves:
        _draw_curves(place(drawn, 0.55, 0.4, _WIDTH - 0.7, height - 0.5), each, curves)
    else:
        _draw_shares(place(drawn, 1.6, 0.38, _WIDTH - 1.7, height - 0.43), each)
    target = io.BytesIO()
    with mpl.rc_context({"svg.fonttype": "none"}):  # letters as letters: a third of the bytes
        drawn.savefig(target, format="svg", metadata={"Date": None})
    return target.getvalue()


def _draw_curves(axes: Axes, each: Outcome, curves: list[Compared]) -> None:
    """Draw expected values as points with their limits, found ones as lines."""
    for number, part in enumerate(curves):
        at = [float(value) for value in each.case.inputs[part.quantity.at]]
        order = sorted(range(len(at)), key=at.__getitem__)
        across = [at[i] for i in order]
        expected = [part.rows[i].expected for i in order]
        half = [part.rows[i].limit for i in order]
        colour = COLOURS[number % len(COLOURS)]
        axes.errorbar(
            across, expected, yerr=half, fmt=MARKERS[number % len(MARKERS)], color=colour, markersize=2.5,
            elinewidth=0.8, capsize=1.5, markerfacecolor="none", label=part.quantity.name.replace("_", " "),
        )  # fmt: skip
        axes.plot(across, [part.rows[i].computed for i in order], **style_of(number) | {"linewidth": 0.9})
    _scale(axes, curves)
    across = [float(value) for part in curves for value in each.case.inputs[part.quantity.at]]
    if min(across) > 0.0 and max(across) / min(across) > _WIDE:
        axes.set_xscale("log")
    else:
        axes.ticklabel_format(axis="x", scilimits=(-3, 4))
    axes.set_xlabel(", ".join(dict.fromkeys(part.quantity.at.replace("_", " ") for part in curves)))
    units = {part.quantity.unit for part in curves}
    axes.set_ylabel(units.pop() if len(units) == 1 and units != {"1"} else "")
    axes.legend(loc="best", fontsize=5.5)


def _scale(axes: Axes, curves: list[Compared]) -> None:
    rows = [row for part in curves for row in part.rows]
    lowest = min(min(row.expected - row.limit, row.computed) for row in rows)
    if lowest > 0.0 and max(row.expected for row in rows) / lowest > _WIDE:
        axes.set_yscale("log")
        axes.yaxis.set_minor_formatter(NullFormatter())
    else:
        axes.ticklabel_format(axis="y", scilimits=(-3, 4))


def _draw_shares(axes: Axes, each: Outcome) -> None:
    """Draw each value's place within its limits, from -1 to 1."""
    values = [(part, row) for part in each.quantities for row in part.rows]
    shares = [max(-_FURTHEST, min(row.of_limit, _FURTHEST)) for _, row in values]
    names = [f"{part.quantity.name} {row.label}".strip().replace("_", " ") for part, row in values]
    axes.axvspan(-1.0, 1.0, **BAND)
    axes.axvline(0.0, **LIMIT)
    axes.plot(shares, range(len(values)), "o", color=COLOURS[0], markersize=3.0)
    axes.set_yticks(
        range(len(values)), [name if len(name) <= _LONGEST else name[: _LONGEST - 1] + "…" for name in names]
    )
    axes.set_ylim(len(values) - 0.5, -0.5)
    reach = max(1.15, 1.1 * max(abs(share) for share in shares))
    axes.set_xlim(-reach, reach)
    axes.set_xlabel("of limit")
    axes.tick_params(axis="y", labelsize=5.5, length=0.0)
