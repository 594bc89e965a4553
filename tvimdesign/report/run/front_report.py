"""A study's front: sought and saved point by point, and reported as tables, words, a figure and a design a point."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tvimdesign.base.errors import AboveRatingError, TvimError
from tvimdesign.base.results_folder import PROGRESS, ResultsFolder
from tvimdesign.base.units import format_quantity, from_si, pretty
from tvimdesign.device import Table
from tvimdesign.report.output.numbers import axis_label, csv_text, finite, head
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.report.output.terminal import Progress
from tvimdesign.solve.pareto.front import Front, FrontSearch, design_at
from tvimdesign.solve.pareto.tradeoff import Point
from tvimdesign.solve.result import StudyResult
from tvimdesign.study import Design, Study, design_json


class FrontOfRun:
    """The front a study asks for, where it does, on its way through a run."""

    def __init__(self, study: Study, folder: ResultsFolder | None = None) -> None:
        """Prepare; in a `folder` each point is stored on the way, so that another run can continue there.

        Raises InputError where the folder holds the beginning of another study's front.
        """
        self.study, self.table = study, study.table
        self.outputs: tuple[str, ...] = study.front.of if study.front else ()
        self.front: Front | None = None
        self.entry: dict[str, Any] | None = None  # The front as plain data
        self.optimum: Point | None = None
        self.designs: list[Design] = []  # One for each point
        self.search = FrontSearch(study, folder if study.front else None)

    def seek(
        self, result: StudyResult, progress: Progress, reported: dict[str, Any], troubles: list[TvimError]
    ) -> None:
        """Seek the front; nothing where none is asked for.

        Messages go into `reported`, points without a design into `troubles`.
        """
        if self.study.front is None or result.solution is None or not result.has_design:
            return
        self.optimum = self.search.begin(result.solution, progress)
        front = self.front = self.search.seek(self.outputs, self.study.front.points, drawn=bool(self.study.robust))
        self.designs = [design_at(result.design, point, i) for i, point in enumerate(front.points, start=1)]
        above = [design.above_rating for design in self.designs]
        self.entry = reported["front"] = plain(front, shown_names(self.study, front), self.table, above)
        if any(above):
            troubles.append(AboveRatingError(ratings_note(above)))
        if front.lost:
            where = "; ".join(f"{failure.where}: {failure.reason}" for failure in front.lost)
            troubles.append(TvimError(f"the front has {len(front.points)} points, but no design was found at {where}"))

    def write(self, folder: ResultsFolder) -> None:
        """Write all of it but its figure."""
        if self.front is None or self.entry is None:
            return
        folder.write("front.csv", front_csv(self.entry))
        folder.write_json("front.json", {**head(), **self.entry})
        for number, design in enumerate(self.designs, start=1):
            folder.write(f"front/{number:02d}.design.json", design_json(design))
        folder.remove(PROGRESS)

    def drawings(self) -> list[Drawing]:
        """Return its figure, where it has points."""
        if self.front is None or self.optimum is None or not self.front.points:
            return []
        return [Drawing("front", "design_figures.front", figure_data(self.front, self.optimum, self.table))]


def shown_names(study: Study, front: Front) -> list[str]:
    """Return the columns of a front's table: traded and other minimised outputs, and the variables that are numbers."""
    numbers = [name for name in study.vary if name in front.points[0].values] if front.points else []
    return list(dict.fromkeys([*front.outputs, *study.minimize, *numbers]))


def ratings_note(above: Sequence[tuple[str, ...]]) -> str:
    """Return which points are beyond ratings that the study does not accept."""
    points = ", ".join(str(number) for number, names in enumerate(above, start=1) if names)
    named = ", ".join(dict.fromkeys(name for names in above for name in names))
    return f"points {points} of the front are beyond their rating, which the study does not accept: {named}"


def front_csv(front: dict[str, Any]) -> str:
    """Return a line for each point, in units; its yield and the ratings it is beyond, if any point has them."""
    points, rows = front["points"], []
    yields, above = (any(key in point for point in points) for key in ("yield_share", "above_rating"))
    for point in points:
        values = point["values"].items()
        row = {"point": point["number"], "status": point["status"]}
        row |= {_head(name, front): math.inf if value is None else value for name, value in values}
        row |= {"yield": str(point.get("yield_share", ""))} if yields else {}
        rows.append(row | ({"above_rating": " ".join(point.get("above_rating", ()))} if above else {}))
    columns = list(rows[0]) if rows else ["point", "status", *(_head(name, front) for name in front["units_of_values"])]
    return csv_text(rows, columns, 8)


def _head(name: str, front: dict[str, Any]) -> str:
    return f"{name} [{front['units_of_values'][name]}]"


def status(front: Front, place: int) -> str:
    """Return what a point is: the knee, an end, or one between."""
    if place == front.knee:
        return "knee"
    return front.points[place].where if front.points[place].where.startswith("least ") else "between"


def plain(front: Front, names: Sequence[str], table: Table, above: Sequence[tuple[str, ...]] = ()) -> dict[str, Any]:
    """Return the front as plain data, in units and in SI; null is never."""

    def entry(number: int, point: Point) -> dict[str, Any]:
        point_entry: dict[str, Any] = {
            "number": number, "status": status(front, number - 1), "design": f"front/{number:02d}.design.json",
            "values": {name: finite(from_si(point.values[name], table.unit(name))) for name in names},
            "si": {name: finite(point.values[name]) for name in names},
        }  # fmt: skip
        if front.yields:
            point_entry["yield_share"] = front.yields[number - 1]
        if above and above[number - 1]:
            point_entry["above_rating"] = list(above[number - 1])
        return point_entry

    return {
        "of": list(front.outputs),
        "units_of_values": {name: pretty(table.unit(name)) for name in names},
        "points": [entry(number, point) for number, point in enumerate(front.points, start=1)],
        "knee": None if front.knee is None else front.knee + 1,
        "in_words": in_words(front, table),
        "spread": front.spread, "sought": front.sought, "dominated": front.dominated,
        "failures": [{"where": failure.where, "reason": failure.reason} for failure in front.failures],
        "notes": list(front.notes),
    }  # fmt: skip


def in_words(front: Front, table: Table) -> list[str]:
    """Return what the front says: its knee and what things cost there, what is degenerate, what is missing."""
    sentences = []
    if front.knee is not None:
        point = front.points[front.knee]
        at = ", ".join(f"{name} {format_quantity(point.values[name], table.unit(name))}" for name in front.outputs)
        sentences.append(f"The knee is point {front.knee + 1}: {at}. Beyond it {'; '.join(_costs(front, front.knee))}.")
    elif front.little_traded:
        sentences.append(_no_trade(front, table))
    elif len(front.points) > 2:
        sentences.append("It has no knee: it is nearly straight.")
    sentences += [f"{note[0].upper()}{note[1:]}." for note in front.notes]
    sentences += [f"No design at {failure.where}: {failure.reason}." for failure in front.failures]
    return sentences


def _no_trade(front: Front, table: Table) -> str:
    """Return which outputs hardly change over the front, and what to do about it."""
    spans = []
    for name in front.little_traded:
        ends = [point.values[name] for point in front.points]
        low, high = (format_quantity(end, table.unit(name)) for end in (min(ends), max(ends)))
        spans.append(f"{name} spans {max(ends) / min(ends) - 1.0:.2%} ({low} to {high})")
    others = [name for name in front.outputs if name not in front.little_traded]
    step = f"take the point with the least {others[0]}" if len(others) == 1 else "any point will do"
    step = f"ask for a front of {' and '.join(others)}" if len(others) > 1 else step
    where = f" in {' and '.join(front.little_traded)}" if len(others) > 1 else ""
    return f"There is no trade to speak of{where}: over the whole front {' and '.join(spans)}; {step}."


def _costs(front: Front, knee: int) -> list[str]:
    """Return what a hundredth less of each output costs from the knee to the nearest point that has less of it."""
    points, here, shares = front.points, front.points[knee], front.shares
    distances = np.linalg.norm(shares - shares[knee], axis=1)
    costs = []
    for less in front.outputs:
        beyond = [i for i, point in enumerate(points) if point.values[less] < here.values[less]]
        there = min(beyond, key=lambda i: distances[i])
        fallen = math.log(here.values[less] / points[there].values[less])
        risen = {
            more: math.log(points[there].values[more] / here.values[more]) / fallen
            for more in front.outputs if more != less
        }  # fmt: skip
        dearer = " and ".join(f"{rate:.2g} % {more}" for more, rate in risen.items() if rate > 0.0)
        costs.append(f"1 % less {less} costs {dearer} (point {there + 1})")
    return costs


def figure_data(front: Front, optimum: Point, table: Table) -> dict[str, Any]:
    """Return every point's outputs in units, with the knee and the weighted optimum."""

    def shown(point: Point) -> list[float]:
        return [from_si(point.values[name], table.unit(name)) for name in front.outputs]

    return {
        "labels": [axis_label(name, table.unit(name)) for name in front.outputs],
        "points": [shown(point) for point in front.points],
        "optimum": shown(optimum),
        "knee": front.knee,
    }


def points_shown(front: Mapping[str, Any], table: Table) -> dict[str, Any]:
    """Return what a page draws of a front as plain data: its points in the table's units, in the order of `names`."""
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
