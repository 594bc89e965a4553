"""The sections of text and tables that the page, `--full` and summary.txt have alike."""

from collections.abc import Mapping
from typing import Any

from tvimdesign.report.output.choices_tables import choices_with_margins, price_in_words, tally_in_words
from tvimdesign.report.output.numbers import at_its_minimum, in_labels, percent
from tvimdesign.report.output.page_sections import number_cell
from tvimdesign.report.page.blocks import Block, Cell, Folded, Grid, Head, Points, Section, Words
from tvimdesign.report.page.page_file import FILE as PAGE
from tvimdesign.report.run.answered_study import AnsweredStudy
from tvimdesign.report.run.blocks import tables
from tvimdesign.report.run.reasons import complaint, sentences
from tvimdesign.report.run.uncertainty_data import lost_in_words
from tvimdesign.solve.result import StudyResult
from tvimdesign.solve.uncertainty.design_uncertainty import share_in_doubt

COSTS = 5  # Active constraints that are shown unfolded, the costliest first


def text_sections(answered: AnsweredStudy) -> list[Section]:
    """Return the sections that the terminal prints; the page has figures between them."""
    if not answered.result.has_design:
        return [Section("conflict", "No design", [conflict_points(answered)]), module_section(answered)]
    front = answered.reported.get("front")
    return [
        module_section(answered),
        *search_section(answered),
        reasons_section(answered),
        assumptions_section(answered),
        *([front_section(front, front["of"])] if front else []),
    ]


def conflict_points(answered: AnsweredStudy) -> Points:
    """Return what cannot hold together, what is violated least, and what to do."""
    return Points(complaint(answered.result).splitlines()[1:])


def module_section(answered: AnsweredStudy) -> Section:
    """Return what was varied, the operating points, the headline quantities and the limits."""
    answer = answered.result
    blocks: list[Block] = [varied] if (varied := tables.variables_grid(answer)).rows else []
    if answer.has_design:
        blocks += [
            tables.points_grid(answer),
            Folded("Load path of the frozen torque", [tables.torque_path_grid(answer)]),
            Folded("What the module is", [tables.module_grid(answer)]),
            Folded("Every limit that is active or required", [tables.checks_grid(answer)]),
        ]
    return Section("module", "Module", blocks)


def search_section(answered: AnsweredStudy) -> list[Section]:
    """Return how the design was found: optima, margins, listed choices and currents; none of an evaluation."""
    answer = answered.result
    lines = _robustness(answer)
    if answer.solution is not None and answer.has_design:
        at_start = sum(answer.design.study["minimize"].values())
        lines.insert(0, f"Objective {answer.solution.objective:.5g}; {at_start:.5g} at the study's first values.")
    blocks: list[Block] = [Points(lines)] if lines else []
    choosing, table = answer.solution.choosing if answer.solution else None, answer.design.table
    if choosing is not None and choosing.best:
        price = price_in_words(choosing, table, choices_with_margins(answer))
        blocks += [tables.choices_grid(choosing, table), Words([*filter(None, [price]), tally_in_words(choosing)])]
    if answer.design.current_profiles:
        blocks += [tables.currents_grid(answer), tables.profile_grid(answer)]
    return [Section("search", "How it was found", blocks)] if blocks else []


def _robustness(answer: StudyResult) -> list[str]:
    """Say what `sigma` means, or to which limits most modules are lost."""
    robust, reached = answer.design.study.get("robust"), answer.yield_reached
    if robust and answer.solution is not None and reached is None and robust["sigma"] is not None:
        return [
            f"Limits are met by {robust['sigma']:.3g} standard deviations of the study's tolerances, which is the "
            "margin they show; `tvimdesign tolerate` checks that on many modules."
        ]
    worst = "; ".join(lost_in_words(answer))
    return [at_its_minimum(f"Most modules are lost to {worst}.")] if worst else []


def reasons_section(answered: AnsweredStudy) -> Section:
    """Return the active constraints in words, with what easing each would buy."""
    answer = answered.result
    costs = [in_labels(line) for line in sentences(answer)]
    why = "No constraint is active: easing any of them changes nothing."
    if answer.solution is None:
        why = "The study varies nothing: its one module was evaluated."
    blocks: list[Block] = [Points(costs[:COSTS]) if costs else Words([why])]
    if costs[COSTS:]:
        blocks.append(Folded(f"{len(costs) - COSTS} more active constraints", [Points(costs[COSTS:])]))
    if answer.solution:
        blocks.append(Words(["Every limit with its margin and shadow price: why.csv."]))
    return Section("why", "Active constraints", blocks)


def assumptions_section(answered: AnsweredStudy) -> Section:
    """Return every unmeasured input with its range and what it moves; then the range of each output."""
    uncertainty = answered.uncertainty
    if not uncertainty:
        words = "How sure the design is was not computed in this run."
        return Section("assumptions", "Assumptions", [Words([words])])
    robust = answered.study.robust
    least = share_in_doubt(robust.plausible if robust else None)
    more = [
        (tables.held_grid(uncertainty, answered.reported["values"], least), ""),
        (tables.doubts_grid(uncertainty, answered.study.table), ""),
        (tables.unmeasured_grid(uncertainty, answered.reported["values"]), f"results.csv, results.json and {PAGE}"),
    ]
    folded = [Folded(grid.caption, [grid], file) for grid, file in more if grid.rows]
    return Section("assumptions", "Assumptions", [tables.intervals_grid(uncertainty["intervals"]), *folded])


def front_section(front: dict[str, Any], names: list[str], drawn: Block | None = None) -> Section:
    """Return the front in words and a table of its points with the columns `names`; `drawn` stands between them."""
    blocks: list[Block] = [Points(front["in_words"])] if front["in_words"] else []
    if front["points"]:
        blocks += [*([drawn] if drawn else []), _points(front, names)]
    return Section("front", "Front", blocks)


def _points(front: dict[str, Any], names: list[str]) -> Grid:
    units, yields = front["units_of_values"], any("yield_share" in point for point in front["points"])
    heads = [Head("point", right=True), *(Head(f"{name} [{units[name]}]" if units[name] else name, right=True)
                                          for name in names)]  # fmt: skip
    heads += [*([Head("yield", right=True)] if yields else []), Head(""), Head("design")]
    beaten = f"; {front['dominated']} more are no better in anything" if front["dominated"] else ""
    note = f"{len(front['points'])} points from {front['sought']} designs sought{beaten}."
    return Grid("Points of the front", heads, [_point(point, names, yields) for point in front["points"]], note)


def _point(point: dict[str, Any], names: list[str], yields: bool) -> list[Cell]:
    values = [point["values"][name] for name in names]
    cells = [Cell(str(point["number"]), point["number"])]
    cells += [number_cell(value) for value in values]
    if yields:
        share = point.get("yield_share", 0.0)
        cells.append(Cell(percent(share), share))
    status, above = "" if point["status"] == "between" else point["status"], point.get("above_rating", [])
    if above:
        status = f"{status} above rating: {', '.join(above)}".strip()
    file = point["design"]
    name = file.rpartition("/")[2]
    return [*cells, Cell(status, tone="bad" if above else ""), Cell(name, links=((name, file),))]


def values_grid(values: Mapping[str, Any]) -> Grid:
    """Return every input and output as results.csv has it."""
    heads = [Head(text, text == "value") for text in ("name", "group", "value", "unit", "status", "meaning", "source")]
    cells = [
        [Cell(name, code=True), Cell(value["group"]),
         number_cell(value["value"], 6),
         *(Cell(value[key]) for key in ("unit", "status", "description", "source"))]
        for name, value in values.items()
    ]  # fmt: skip
    return Grid("Inputs and outputs", heads, cells)
