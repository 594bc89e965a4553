"""The spread of a module as plain data and CSV, apart from what is not known of it, and the data of the figure."""

import math
from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

import numpy as np

from tvimdesign.base.units import from_si, pretty, si_unit, to_si
from tvimdesign.report.output.numbers import axis_label, finite, head, name_in_words
from tvimdesign.solve.uncertainty.tolerance import Preload, Spread
from tvimdesign.study.text.values import difference_unit

Row = dict[str, Any]


def _columns(spread: Spread) -> dict[str, Any]:
    """Return the numbers of the outputs (SI): as drawn, worst case, root-sum-square and Monte Carlo."""
    drawn, worst = spread.drawn, spread.worst
    return {
        "as_drawn": spread.nominal, "worst_low": worst.low, "worst_high": worst.high, "mean": drawn.mean,
        "low": drawn.low, "high": drawn.high, "deviation_rss": spread.deviation, "deviation": drawn.deviation,
    }  # fmt: skip


def output_rows(spread: Spread) -> Iterator[Row]:
    """Yield one row for each output: as drawn, worst case, root-sum-square and Monte Carlo side by side."""
    columns, table = _columns(spread), spread.study.table
    for i, name in enumerate(spread.outputs):
        unit = table.unit(name)
        units = {key: difference_unit(unit) if key.startswith("deviation") else unit for key in columns}
        shown = {key: finite(from_si(float(column[i]), units[key])) for key, column in columns.items()}
        yield {"output": name, "unit": pretty(unit), **shown, "never": float(spread.drawn.never[i])}


def limit_rows(spread: Spread) -> Iterator[Row]:
    """Yield one row for each limit: its yield with the interval of 95 %, and its C_pk."""
    for limit_yield in spread.limit_yields:
        yield {
            "limit": limit_yield.text, "output": limit_yield.limit.output,
            "origin": limit_yield.limit.origin,
            "yield": limit_yield.share.share, "yield_low": limit_yield.share.low, "yield_high": limit_yield.share.high,
            "cpk": finite(limit_yield.capability),
        }  # fmt: skip


def contributor_rows(spread: Spread) -> Iterator[Row]:
    """Yield one row for each output that spreads and each contributor: tolerance, derivative, and its shares."""
    study, table = spread.study, spread.study.table
    for i, name in enumerate(spread.outputs):
        if not spread.spreads(i):
            continue
        for j, contributor in enumerate(spread.contributors):
            of, by = difference_unit(table.unit(name)), difference_unit(table.unit(contributor.name))
            tolerance = study.tolerances[contributor.name]
            yield {
                "output": name, "contributor": contributor.name,
                "plus_minus": from_si(contributor.plus_minus, by), "unit": pretty(by),
                "distribution": contributor.distribution, "status": tolerance.status, "source": tolerance.source,
                "derivative": from_si(float(spread.derivatives[i, j]), of) * to_si(1.0, by),
                "derivative_unit": f"{pretty(of) or 1} / {pretty(by) or 1}",
                "share": float(spread.shares[i, j]), "sobol_first": float(spread.first[i, j]),
                "sobol_total": float(spread.total[i, j]),
            }  # fmt: skip


def reported(spread: Spread, preload: Preload | None) -> dict[str, Any]:
    """Return everything as plain data."""
    columns, rows = _columns(spread), list(output_rows(spread))
    for i, row in enumerate(rows):
        numbers = {key: finite(float(column[i])) for key, column in columns.items()}
        row["si"] = {**numbers, "unit": pretty(si_unit(spread.study.table.unit(spread.outputs[i])))}
    return {
        **head(),
        "samples": spread.drawn.values.shape[1],
        "yield": spread.together and asdict(spread.together),
        "outputs": rows,
        "limits": list(limit_rows(spread)),
        "contributors": list(contributor_rows(spread)),
        "corners": spread.worst.corners,
        "free_angle": None if preload is None else {
            "as_bought_deg": math.degrees(preload.as_bought),
            "adjusted_deg": math.degrees(preload.adjusted),
            "over_stroke": preload.over_stroke,
            "yield_as_bought": preload.yield_as_bought.share,
            "yield_adjusted": preload.yield_adjusted.share,
        },
        "left_out": list(spread.left_out),
    }  # fmt: skip


_PARTS = 6  # Contributors with a colour of their own; the rest is one
_PANELS = 6
_BINS = 60
_REACH = 5.0  # Half of a histogram's axis over the span of the middle half of all modules


def figure_data(spread: Spread) -> dict[str, Any]:
    """Return contributors' shares of requirements and minimised outputs, and histograms of the least satisfied."""
    shown = [i for i, name in enumerate(spread.outputs) if name in spread.requested and spread.spreads(i)]
    order = np.argsort(-np.sum(spread.shares[shown], axis=0), kind="stable")
    parts = [
        {
            "name": name_in_words(spread.contributors[j].name),
            "shares": [100.0 * float(spread.shares[i, j]) for i in shown],
        }
        for j in order[:_PARTS]
    ]
    remainder = [100.0 * float(np.sum(spread.shares[i, order[_PARTS:]])) for i in shown]
    if any(share > 0.0 for share in remainder):
        parts.append({"name": "all others", "shares": remainder})
    by_yield = sorted(spread.limit_yields, key=lambda limit_yield: limit_yield.share.share)
    rows = dict.fromkeys(spread.outputs.index(limit_yield.limit.output) for limit_yield in by_yield)
    every = dict.fromkeys([*rows, *shown])
    panels = [_panel(spread, i) for i in every if spread.spreads(i)][:_PANELS]
    return {"outputs": [name_in_words(spread.outputs[i]) for i in shown], "parts": parts, "panels": panels}


def _panel(spread: Spread, i: int) -> dict[str, Any]:
    name = spread.outputs[i]
    unit = spread.study.table.unit(name)
    values = spread.drawn.values[i]
    finite = values[np.isfinite(values)]
    # What one in a thousand modules has would press all others into one bar.
    low, quarter, middle, most, high = np.quantile(finite, [0.0005, 0.25, 0.5, 0.75, 0.9995])
    reach = _REACH * (most - quarter)
    ends = (max(low, middle - reach), min(high, middle + reach)) if reach > 0.0 else (low, high)
    counts, edges = np.histogram(finite, bins=_BINS, range=(float(ends[0]), float(ends[1])))
    limits = [k.limit.limit for k in spread.limit_yields if k.limit.output == name]
    span = (2.0 * edges[0] - edges[-1], 2.0 * edges[-1] - edges[0])
    near = [limit for limit in limits if span[0] <= limit <= span[1]]
    share = min((k.share.share for k in spread.limit_yields if k.limit.output == name), default=None)
    caption = "" if share is None else f"{100.0 * share:.3g} % of modules within limits"
    return {
        "title": caption,
        "label": axis_label(name, unit),
        "counts": [int(count) for count in counts],
        "edges": [from_si(float(edge), unit) for edge in edges],
        "limits": [from_si(limit, unit) for limit in near],
        "as_drawn": from_si(float(spread.nominal[i]), unit),
    }
