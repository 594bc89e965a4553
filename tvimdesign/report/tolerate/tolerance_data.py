"""The spread of a module as plain data and CSV, apart from what is not known of it, and the data of the figure."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from tvimdesign.base.units import from_si, pretty, si_unit, to_si
from tvimdesign.device import Table
from tvimdesign.report.output.axis_labels import axis_label, name_in_words
from tvimdesign.report.output.number_format import head
from tvimdesign.report.run.uncertainty_data import interval_entry
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule
from tvimdesign.solve.nlp.constraints import in_words
from tvimdesign.solve.uncertainty.design_uncertainty import DesignUncertainty, UncertaintyModel
from tvimdesign.solve.uncertainty.tolerance import Preload, Spread
from tvimdesign.study import Study
from tvimdesign.study.text.values import difference_unit

Row = dict[str, str | float | None]
_NO_SPREAD = 1e-9
"""Standard deviation over the value below which an output does not spread."""


def spreads(found: Spread, i: int) -> bool:
    """Return whether an output spreads at all."""
    return bool(found.deviation[i] > _NO_SPREAD * abs(found.nominal[i])) or bool(found.drawn.never[i] > 0.0)


def output_rows(found: Spread, table: Table) -> Iterator[Row]:
    """Yield one row for each output: as drawn, worst case, root-sum-square and Monte Carlo side by side."""
    for i, name in enumerate(found.outputs):
        unit = table.unit(name)
        values = {
            "as_drawn": found.nominal[i], "worst_low": found.worst.low[i], "worst_high": found.worst.high[i],
            "mean": found.drawn.mean[i], "low": found.drawn.low[i], "high": found.drawn.high[i],
        }  # fmt: skip
        shown = {key: _finite(from_si(float(value), unit)) for key, value in values.items()}
        deviations = {
            "deviation_rss": _finite(from_si(float(found.deviation[i]), difference_unit(unit))),
            "deviation": _finite(from_si(float(found.drawn.deviation[i]), difference_unit(unit))),
        }
        yield {"output": name, "unit": pretty(unit), **shown, **deviations, "never": float(found.drawn.never[i])}


def limit_rows(found: Spread, table: Table) -> Iterator[Row]:
    """Yield one row for each limit: its yield with the interval of 95 %, and its C_pk."""
    for kept in found.kept:
        yield {
            "limit": in_words(kept.limit, table), "output": kept.limit.output, "origin": kept.limit.origin,
            "yield": kept.share.share, "yield_low": kept.share.low, "yield_high": kept.share.high,
            "cpk": _finite(kept.capability),
        }  # fmt: skip


def contributor_rows(found: Spread, table: Table, study: Study) -> Iterator[Row]:
    """Yield one row for each output that spreads and each contributor: tolerance, derivative, and its shares."""
    for i, name in enumerate(found.outputs):
        if not spreads(found, i):
            continue
        for j, contributor in enumerate(found.contributors):
            of, by = difference_unit(table.unit(name)), difference_unit(table.unit(contributor.name))
            tolerance = study.tolerances[contributor.name]
            yield {
                "output": name, "contributor": contributor.name,
                "plus_minus": from_si(contributor.plus_minus, by), "unit": pretty(by),
                "distribution": contributor.distribution, "status": tolerance.status, "source": tolerance.source,
                "derivative": from_si(float(found.derivatives[i, j]), of) * to_si(1.0, by),
                "derivative_unit": f"{pretty(of) or 1} / {pretty(by) or 1}",
                "share": float(found.shares[i, j]), "sobol_first": float(found.first[i, j]),
                "sobol_total": float(found.total[i, j]),
            }  # fmt: skip


def as_csv(rows: Sequence[Mapping[str, Any]]) -> str:
    """Rows of one kind as CSV."""
    stream = io.StringIO()
    writer = csv.DictWriter(stream, list(rows[0]) if rows else [], lineterminator="\n")
    writer.writeheader()
    for row in rows:
        writer.writerow({key: f"{value:.6g}" if isinstance(value, float) else value for key, value in row.items()})
    return stream.getvalue()


def reported(found: Spread, preload: Preload | None, table: Table, study: Study, samples: int) -> dict[str, Any]:
    """Return everything as plain data."""
    return {
        **head(),
        "samples": samples,
        "yield": {"share": found.together.share, "low": found.together.low, "high": found.together.high},
        "outputs": [
            {**row, "si": si} for row, si in zip(output_rows(found, table), _outputs_in_si(found, table), strict=True)
        ],
        "limits": list(limit_rows(found, table)),
        "contributors": list(contributor_rows(found, table, study)),
        "corners": found.worst.corners,
        "free_angle": None if preload is None else _preload(preload),
        "left_out": list(found.left_out),
    }


def _outputs_in_si(found: Spread, table: Table) -> Iterator[dict[str, str | float | None]]:
    """Yield the numbers of each output's row in SI."""
    columns = {
        "as_drawn": found.nominal, "worst_low": found.worst.low, "worst_high": found.worst.high,
        "mean": found.drawn.mean, "low": found.drawn.low, "high": found.drawn.high,
        "deviation_rss": found.deviation, "deviation": found.drawn.deviation,
    }  # fmt: skip
    for i, name in enumerate(found.outputs):
        numbers = {key: _finite(float(column[i])) for key, column in columns.items()}
        yield {**numbers, "unit": pretty(si_unit(table.unit(name)))}


def _preload(preload: Preload) -> dict[str, float]:
    return {
        "as_bought_deg": math.degrees(preload.as_bought),
        "adjusted_deg": math.degrees(preload.adjusted),
        "over_stroke": preload.over_stroke,
        "yield_as_bought": preload.yield_as_bought.share,
        "yield_adjusted": preload.yield_adjusted.share,
    }


def _finite(value: float) -> float | None:
    """JSON has no infinity: what never happens is null."""
    return value if math.isfinite(value) else None


_FEWEST = 4
"""Modules drawn for a yield that is not told here: the analysis has its own."""


def epistemic_uncertainty(resolved: ResolvedModule, found: Spread, workers: int) -> DesignUncertainty:
    """Intervals of what is asked of a module, and how far its limits hold, parts as drawn."""
    return UncertaintyModel(resolved, found.asked).at(resolved, _FEWEST, workers=workers)


def unknown_data(unknown: DesignUncertainty, table: Table) -> dict[str, Any]:
    """That as plain data."""
    holds = unknown.holds
    return {
        "holds": None if holds is None else {"share": holds.share, "low": holds.low, "high": holds.high},
        "held": unknown.held,
        "unmeasured": [one.name for one in unknown.unmeasured],
        "intervals": {
            name: interval_entry(name, one, table, unknown.before.get(name)) for name, one in unknown.intervals.items()
        },
    }


def unknown_rows(data: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return a row an output: what it may be, all together and one at a time, and what carries most of it."""
    return [
        {
            "output": name, "unit": one["unit"], "as_drawn": one["value"], "low": one["low"], "high": one["high"],
            "one_at_a_time_low": one["one_at_a_time"]["low"], "one_at_a_time_high": one["one_at_a_time"]["high"],
            "measure_first": next(iter(one["shares"]), ""), "share": next(iter(one["shares"].values()), None),
            "to_halve": ", ".join(one["to_halve"]),
        }
        for name, one in data["intervals"].items()
    ]  # fmt: skip


def unknown_sentences(unknown: DesignUncertainty, found: Spread) -> list[str]:
    """Return how far the limits hold, and what to measure first; said beside the yield, never in it."""
    if unknown.holds is None:
        return []
    said = (
        f"What nobody knows: with parts as drawn every limit holds in {100.0 * unknown.holds.share:.3g} % of the "
        f"ranges of {len(unknown.unmeasured)} unmeasured values. The yield of {100.0 * found.together.share:.3g} % "
        "counts none of that: it is of the parts, with these values as assumed."
    )
    first = [f"{name}: {one.first} ({100.0 * one.shares[one.first]:.0f} %)"
             for name, one in unknown.intervals.items() if one.first]  # fmt: skip
    return [said, *([f"Measure first, of {'; of '.join(first)}."] if first else [])]


_PARTS = 6
"""Contributors with a colour of their own; the rest is one."""
_PANELS = 6
_BINS = 60
_REACH = 5.0
"""Half of a histogram's axis over the span of the middle half of all modules."""


def figure_data(found: Spread, table: Table) -> dict[str, Any]:
    """Shares of the contributors for what is asked and minimised, and histograms of what is kept least."""
    shown = [i for i, name in enumerate(found.outputs) if name in found.asked and spreads(found, i)]
    order = np.argsort(-np.sum(found.shares[shown], axis=0), kind="stable")
    parts = [
        {
            "name": name_in_words(found.contributors[j].name),
            "shares": [100.0 * float(found.shares[i, j]) for i in shown],
        }
        for j in order[:_PARTS]
    ]
    rest = [100.0 * float(np.sum(found.shares[i, order[_PARTS:]])) for i in shown]
    if any(share > 0.0 for share in rest):
        parts.append({"name": "all others", "shares": rest})
    by_yield = sorted(found.kept, key=lambda kept: kept.share.share)
    rows = dict.fromkeys(found.outputs.index(kept.limit.output) for kept in by_yield)
    every = dict.fromkeys([*rows, *shown])
    panels = [_panel(found, table, i) for i in every if spreads(found, i)][:_PANELS]
    return {"outputs": [name_in_words(found.outputs[i]) for i in shown], "parts": parts, "panels": panels}


def _panel(found: Spread, table: Table, i: int) -> dict[str, Any]:
    name = found.outputs[i]
    unit = table.unit(name)
    values = found.drawn.values[i]
    kept = values[np.isfinite(values)]
    # What one in a thousand modules has would press all others into one bar.
    low, quarter, middle, most, high = np.quantile(kept, [0.0005, 0.25, 0.5, 0.75, 0.9995])
    reach = _REACH * (most - quarter)
    ends = (max(low, middle - reach), min(high, middle + reach)) if reach > 0.0 else (low, high)
    counts, edges = np.histogram(kept, bins=_BINS, range=(float(ends[0]), float(ends[1])))
    limits = [k.limit.limit for k in found.kept if k.limit.output == name]
    span = (2.0 * edges[0] - edges[-1], 2.0 * edges[-1] - edges[0])
    near = [limit for limit in limits if span[0] <= limit <= span[1]]
    share = min((k.share.share for k in found.kept if k.limit.output == name), default=None)
    said = "" if share is None else f"{100.0 * share:.3g} % of modules within limits"
    return {
        "title": said,
        "label": axis_label(name, unit),
        "counts": [int(count) for count in counts],
        "edges": [from_si(float(edge), unit) for edge in edges],
        "limits": [from_si(limit, unit) for limit in near],
        "as_drawn": from_si(float(found.nominal[i]), unit),
    }
