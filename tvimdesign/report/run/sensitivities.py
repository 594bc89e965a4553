"""Sensitivities of headline outputs to variables at the design, as a table on file and the data of a heat map."""

from __future__ import annotations

import csv
import io
from typing import Any

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.units import from_si, pretty, to_si
from tvimdesign.report.output.axis_labels import name_in_words
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_design
from tvimdesign.solve.result import StudyResult
from tvimdesign.solve.sensitivity.output_sensitivity import OutputSensitivities, entries, output_sensitivities

_SHOWN = 5e-3
"""Elasticity below which a row or a column of the heat map has nothing to say."""


def sensitivities(answer: StudyResult, deadline: Deadline) -> tuple[OutputSensitivities, ResolvedModule]:
    """Differentiate what a summary shows and what the study limits or minimises.

    Raises SimulationError, TimeOverError.
    """
    resolved = resolve_design(answer.design)
    outputs = {*answer.design.study["minimize"], *(limit["output"] for limit in answer.design.study["require"])}
    wanted = [
        name
        for name in resolved.table.names(resolved.points)
        if resolved.table.output(name).headline or name in outputs
    ]
    deadline.check("the outputs were differentiated")
    return output_sensitivities(resolved, wanted), resolved


def sensitivities_csv(sensitivities_of_outputs: OutputSensitivities, resolved: ResolvedModule) -> str:
    """Return a line for each output and variable: logarithmic and plain derivative, and what 1 % more adds."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    table = resolved.table
    writer.writerow(["output", "variable", "log_derivative", "derivative", "derivative_unit", "per_percent", "unit"])
    for entry in entries(sensitivities_of_outputs, resolved):
        of, by = (_difference(table.unit(name)) for name in (entry.output, entry.variable))
        derivative = from_si(entry.derivative, of) * to_si(1.0, by)
        share = "" if entry.logarithmic is None else f"{entry.logarithmic:.6g}"
        units = f"{pretty(of) or 1} / {pretty(by) or 1}"
        added = f"{from_si(entry.per_hundredth, of):.6g}"
        writer.writerow([entry.output, entry.variable, share, f"{derivative:.6g}", units, added, pretty(of)])
    return stream.getvalue()


def _difference(unit: str) -> str:
    return "K" if unit == "degC" else unit


def heat_map(sensitivities_of_outputs: OutputSensitivities, resolved: ResolvedModule) -> dict[str, Any]:
    """Return elasticities, one row an output, without the rows and columns in which nothing stands."""
    cells = {(entry.output, entry.variable): entry.logarithmic for entry in entries(sensitivities_of_outputs, resolved)}
    reported = {place for place, value in cells.items() if value is not None and abs(value) >= _SHOWN}
    outputs = [name for name in sensitivities_of_outputs.outputs if any(name == output for output, _ in reported)]
    variables = [
        name for name in sensitivities_of_outputs.variables if any(name == variable for _, variable in reported)
    ]
    values = [[cells[output, variable] or 0.0 for variable in variables] for output in outputs]
    return {
        "outputs": [name_in_words(name) for name in outputs],
        "variables": [name_in_words(name) for name in variables],
        "values": values,
    }
