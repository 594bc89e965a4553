"""What every variable does to every headline output at the design, as a table on file and the data of a heat map."""

from __future__ import annotations

import csv
import io
from typing import Any

from tvimdesign.base.units import from_si, pretty, to_si
from tvimdesign.catalog import Catalog
from tvimdesign.device import Table
from tvimdesign.simulation.resolved_module import Rig, rig_of_design
from tvimdesign.solve.result import Answer
from tvimdesign.solve.sensitivity.output_sensitivity import FINER, Elasticities, elasticities, entries

_SHOWN = 5e-3
"""Elasticity below which a row or a column of the heat map has nothing to say."""


def sensitivities(answer: Answer, catalog: Catalog, table: Table) -> tuple[Elasticities, Rig]:
    """Differentiate what a summary shows and what the study limits or minimises. Raises SimulationError."""
    rig = rig_of_design(answer.design, catalog, table)
    asked = {*answer.design.study["minimize"], *(one["output"] for one in answer.design.study["require"])}
    wanted = [name for name in table.names(rig.points) if table.output(name).headline or name in asked]
    options = answer.design.study["solver"]
    return elasticities(rig, FINER * options["elements"], options["cells"], wanted), rig


def sensitivities_csv(found: Elasticities, rig: Rig) -> str:
    """One line for each output and variable: d ln output / d ln variable, the derivative, and what 1 % more adds."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    table = rig.table
    writer.writerow(["output", "variable", "log_derivative", "derivative", "derivative_unit", "per_percent", "unit"])
    for one in entries(found, rig):
        of, by = (_difference(table.unit(name)) for name in (one.output, one.variable))
        derivative = from_si(one.derivative, of) * to_si(1.0, by)
        share = "" if one.logarithmic is None else f"{one.logarithmic:.6g}"
        units = f"{pretty(of) or 1} / {pretty(by) or 1}"
        added = f"{from_si(one.per_hundredth, of):.6g}"
        writer.writerow([one.output, one.variable, share, f"{derivative:.6g}", units, added, pretty(of)])
    return stream.getvalue()


def _difference(unit: str) -> str:
    return "K" if unit == "degC" else unit


def heat_map(found: Elasticities, rig: Rig) -> dict[str, Any]:
    """Elasticities, one row an output, without the rows and columns in which nothing stands."""
    cells = {(one.output, one.variable): one.logarithmic for one in entries(found, rig)}
    told = {place for place, value in cells.items() if value is not None and abs(value) >= _SHOWN}
    outputs = [name for name in found.outputs if any(name == output for output, _ in told)]
    variables = [name for name in found.variables if any(name == variable for _, variable in told)]
    values = [[cells[output, variable] or 0.0 for variable in variables] for output in outputs]
    return {"outputs": outputs, "variables": variables, "values": values}
