"""A measurement as plain data: parameters with intervals, notes, residuals, and the figure's panels."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tvimdesign.base.units import from_si, pretty
from tvimdesign.report.output.number_format import finite, head, number_entry
from tvimdesign.simulation.measurement.fitting.fit import Estimate, Fit
from tvimdesign.simulation.measurement.measure_files import Measured

_MOST_PANELS = 6
_DECADES = 30.0
"""Largest over smallest value from which on an axis is logarithmic."""


def fit_data(measured: Measured) -> dict[str, Any]:
    """Return the content of `fit.json`."""
    measurement = measured.measurement
    names = [parameter.name for parameter in measurement.fit.problem.parameters]
    shown = [names.index(parameter.name) for parameter in measurement.fit.parameters]
    return {
        **head(),
        "kind": measured.kind.name,
        "files": [{"path": str(file.path), "sha256": file.sha256} for file in measured.files],
        "parameters": [_entry(parameter) for parameter in measurement.fit.parameters],
        "derived": [_entry(quantity) for quantity in measurement.fit.derived],
        "correlation": {
            "names": [names[i] for i in shown],
            "rows": [[finite(float(measurement.fit.correlation[i, j])) for j in shown] for i in shown],
        },
        "noise": [
            {"channel": channel.name, "deviation": _deviation(channel.relative, noise, channel.unit), "unit":
             "1" if channel.relative else channel.unit, "values": len(channel.measured)}
            for channel, noise in zip(measurement.fit.problem.channels, measurement.fit.noise, strict=True)
        ],
        "notes": list(measurement.notes),
        "words": list(measurement.fit.words),
        "misfit": measurement.fit.misfit,
        "read": measured.read(),
    }  # fmt: skip


def _entry(estimate: Estimate) -> dict[str, Any]:
    return {
        "name": estimate.name,
        **number_entry(estimate.value, estimate.unit, (estimate.low, estimate.high)),
        "meaning": estimate.meaning,
    }


def _deviation(relative: bool, noise: float, unit: str) -> float:
    return noise if relative else from_si(noise, unit) - from_si(0.0, unit)


def residuals_csv(fit: Fit) -> str:
    """Return every value with what the fit predicts, in the units of the data; a row each."""
    lines = ["channel,over,over unit,at,unit,measured,fitted,residual over noise"]
    for channel, predicted, noise in zip(fit.problem.channels, fit.predicted, fit.noise, strict=True):
        over = from_si_array(channel.at, channel.at_unit)
        measured, fitted = (from_si_array(values_si, channel.unit) for values_si in (channel.measured, predicted))
        left = np.log(channel.measured / predicted) if channel.relative else channel.measured - predicted
        name = channel.name.replace(",", ";")
        lines += [
            f"{name},{channel.at_name},{channel.at_unit},{x:.8g},{channel.unit},{y:.8g},{z:.8g},{r:.4g}"
            for x, y, z, r in zip(over, measured, fitted, left / noise, strict=True)
        ]
    return "\n".join(lines) + "\n"


def from_si_array(values: Any, unit: str) -> Any:
    """Return values in a unit."""
    zero = from_si(0.0, unit)
    return zero + (from_si(1.0, unit) - zero) * values


def figure_data(measured: Measured) -> dict[str, Any]:
    """Return the panels of the figure: values and curves, each with its residuals below."""
    fit = measured.measurement.fit
    why = "; the equations do not describe the data: no record" if fit.misfit else ""
    return {"title": f"{measured.kind.name}: measured and fitted{why}", "panels": list(_panels(fit))}


def _panels(fit: Fit) -> Iterator[dict[str, Any]]:
    """Yield a panel for every channel, the first few of many."""
    for channel, predicted, noise in list(zip(fit.problem.channels, fit.predicted, fit.noise, strict=True))[
        :_MOST_PANELS
    ]:
        left = np.log(channel.measured / predicted) if channel.relative else channel.measured - predicted
        words, _, where = channel.name.partition(" of ")
        x = from_si_array(channel.at, channel.at_unit)
        y = from_si_array(channel.measured, channel.unit)
        yield {
            "title": where.replace("\\", "/").rpartition("/")[-1],  # the file, without its folders
            "x_label": f"{channel.at_name} / {pretty(channel.at_unit)}", "y_label": f"{words} / {pretty(channel.unit)}",
            "log_x": bool(np.min(x) > 0.0 and np.max(x) > _DECADES * np.min(x)), "log_y": channel.relative,
            "x": x.tolist(), "measured": y.tolist(), "fitted": from_si_array(predicted, channel.unit).tolist(),
            "residual": (left / noise).tolist(),
        }  # fmt: skip
