"""From a spread to what its figure is drawn from: plain data in the units people read."""

from __future__ import annotations

from typing import Any

import numpy as np

from tvimdesign.base.units import from_si
from tvimdesign.device import Table
from tvimdesign.report.output.axis_labels import axis_label, name_in_words
from tvimdesign.report.tolerate.tolerance_tables import spreads
from tvimdesign.solve.uncertainty.tolerance import Spread

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
