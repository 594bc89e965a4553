"""The front on the page: its points as curves to brush, and as a table with the file of each design."""

from __future__ import annotations

from typing import Any

from tvimdesign.page.blocks import Block, Cell, Drawn, Grid, Head, Points, Section
from tvimdesign.report.output.axis_labels import axis_label
from tvimdesign.report.output.results_format import FrontEntry, FrontPoint
from tvimdesign.report.output.tables import number
from tvimdesign.report.run.answered_study import AnsweredStudy


def front_section(answered: AnsweredStudy) -> list[Section]:
    """The front of a study that asks for one."""
    front = answered.reported.get("front")
    if front is None:
        return []
    blocks: list[Block] = [Points(front["in_words"])] if front["in_words"] else []
    if front["points"]:
        says = (
            "The front: each point, and each line, is a whole design. Drag along an axis of the lower figure, or set "
            "its ends below, to keep only the designs within."
        )
        blocks += [Drawn("front", "front.js", says, _data(answered, front), libraries=["echarts"]), _table(front)]
    return [Section("front", "Front", blocks)]


def _data(answered: AnsweredStudy, front: FrontEntry) -> dict[str, Any]:
    """Every point's values in the units people read, by column."""
    table = answered.study.table
    names = list(front["units_of_values"])
    return {
        "of": list(front["of"]),
        "names": names,
        "labels": [axis_label(name, table.unit(name)) for name in names],
        "points": [
            {"number": point["number"], "status": point["status"], "values": [point["values"][name] for name in names]}
            for point in front["points"]
        ],
    }


def _table(front: FrontEntry) -> Grid:
    """A row a point, with its design."""
    names, units = list(front["units_of_values"]), front["units_of_values"]
    yields = any("yield_share" in point for point in front["points"])
    heads = [
        Head("point", right=True),
        *(Head(f"{name} [{units[name]}]" if units[name] else name, right=True) for name in names),
    ]
    heads += [*([Head("yield", right=True)] if yields else []), Head(""), Head("design")]
    return Grid("Points of the front", heads, [_row(point, names, yields) for point in front["points"]])


def _row(point: FrontPoint, names: list[str], yields: bool) -> list[Cell]:
    values = [point["values"][name] for name in names]
    cells = [Cell(str(point["number"]), point["number"])]
    cells += [Cell("never", 1e300) if value is None else Cell(number(value), value) for value in values]
    if yields:
        share = point.get("yield_share", 0.0)
        cells.append(Cell(f"{100.0 * share:.3g} %", share))
    said = "" if point["status"] == "between" else point["status"]
    above = point.get("above_rating", [])
    if above:
        said = f"{said} above rating: {', '.join(above)}".strip()
    file = point["design"]
    return [
        *cells,
        Cell(said, tone="bad" if above else ""),
        Cell(file.rpartition("/")[2], links=((file.rpartition("/")[2], file),)),
    ]
