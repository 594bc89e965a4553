"""The spread of a module as tables: outputs, limits and contributors, in the units people read."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from tvimdesign.base.units import from_si, pretty, si_unit, to_si
from tvimdesign.device import Table
from tvimdesign.report.output.number_format import head
from tvimdesign.solve.nlp.constraints import in_words
from tvimdesign.solve.uncertainty.tolerance import Preload, Spread
from tvimdesign.study import Study
from tvimdesign.study.text.values import difference_unit

Row = dict[str, str | float | None]
_NO_SPREAD = 1e-9
"""Standard deviation over the value below which an output does not spread."""


def spreads(found: Spread, i: int) -> bool:
    """Whether an output spreads at all."""
    return bool(found.deviation[i] > _NO_SPREAD * abs(found.nominal[i])) or bool(found.drawn.never[i] > 0.0)


def output_rows(found: Spread, table: Table) -> Iterator[Row]:
    """One row for each output: as drawn, worst case, root-sum-square and Monte Carlo side by side."""
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
    """One row for each limit: its yield with the interval of 95 %, and its C_pk."""
    for kept in found.kept:
        yield {
            "limit": in_words(kept.limit, table), "output": kept.limit.output, "origin": kept.limit.origin,
            "yield": kept.share.share, "yield_low": kept.share.low, "yield_high": kept.share.high,
            "cpk": _finite(kept.capability),
        }  # fmt: skip


def contributor_rows(found: Spread, table: Table, study: Study) -> Iterator[Row]:
    """One row for each output that spreads and each contributor: tolerance, derivative, and its shares."""
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
    """Everything as plain data."""
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
    """The numbers of each output's row in SI."""
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
