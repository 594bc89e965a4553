"""Every table of a run, for `--full` and summary.txt: what was found, what must hold and rests on what, its price."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table as Grid

from tvimdesign.base.units import format_quantity, from_si, pretty
from tvimdesign.device import Input, Table, table_for
from tvimdesign.report.output.choices_tables import best_rows, choices_with_margins, price_in_words, tally_in_words
from tvimdesign.report.output.summary_table import print_table
from tvimdesign.report.output.tables import current_rows, headline_rows, number, point_rows, variable_rows
from tvimdesign.report.output.thresholds import meaning
from tvimdesign.report.run.summary_tables import (
    assumptions_table,
    checks_table,
    intervals_table,
    prices_table,
)
from tvimdesign.report.run.why import sentences, slack_in_words
from tvimdesign.report.run.yield_words import cost_of_margins, lost_in_words, reached_in_words, yield_of
from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.optimizer.statuses import BELOW_YIELD
from tvimdesign.solve.result import StudyResult

_SENTENCES_SHOWN = 3


def print_full_summary(
    answer: StudyResult,
    table: Table,
    console: Console,
    uncertainty: Mapping[str, Any] | None = None,
    warnings: Sequence[tuple[str, str]] = (),
) -> None:
    """Print everything of an answer; `uncertainty` is what `uncertainty_data` says, `warnings` what to mend and how."""
    console.print(_verdict(answer))
    for sentence in _robustness(answer, table):
        console.print(sentence)
    if not answer.found:
        _print_variables(answer, table, console, "Where the solver ended; this is not a design")
        return
    _print_warnings(answer, warnings, console)
    _print_variables(answer, table, console, "What was varied")
    _print_choosing(answer, table, console)
    _print_drives(answer, table, console)
    _print_points(answer, table, console)
    grid = _grid("What the module is", ("", "value", "unit", "meaning"), right=(1,))
    group = ""
    for section, name, value, unit, description in headline_rows(answer, table):
        if section != group:
            grid.add_row(f"[dim]{section}[/dim]")
            group = section
        grid.add_row(name, value, unit, description)
    console.print(grid)
    _print_checks(answer, table, console)
    print_table(intervals_table((uncertainty or {}).get("intervals", {})), console)
    print_table(assumptions_table((uncertainty or {}).get("assumptions", {})), console)
    _print_prices(answer, table, console)


def _robustness(answer: StudyResult, table: Table) -> list[str]:
    """How far within its limits a robust design is, and what modules drawn at random keep of them."""
    robust, reached = answer.design.study.get("robust"), yield_of(answer)
    if not robust or not answer.found:
        return []
    if reached is None:
        if robust["sigma"] is None:
            return []
        return [
            f"Limits are kept by {robust['sigma']:.3g} standard deviations of the study's tolerances, which is the "
            "margin they show below; `tvimdesign tolerate` checks that on many modules."
        ]
    cost = ", ".join(cost_of_margins(answer, reached, table))
    worst = "; ".join(lost_in_words(one) for one in reached.lost_to)
    return [f"{reached_in_words(reached)}; the margins cost {cost}.", *([f"Most is lost to {worst}."] if worst else [])]


def _print_variables(answer: StudyResult, table: Table, console: Console, title: str) -> None:
    rows = variable_rows(answer, table)
    if not rows:
        return
    grid = _grid(title, ("variable", "start", "end" if not answer.found else "design", "unit", "allowed"), right=(1, 2))
    for row in rows:
        grid.add_row(*row)
    console.print(grid)


def _print_choosing(answer: StudyResult, table: Table, console: Console) -> None:
    """The best combinations of what is listed, the price of going standard, and how the search went."""
    choosing = answer.solution.choosing if answer.solution else None
    if choosing is None or not choosing.best:
        return
    columns, rows = best_rows(choosing, table)
    grid = _grid("The best of what is listed, against the first", columns, right=tuple(range(len(columns))))
    for row in rows:
        grid.add_row(*row)
    console.print(grid)
    price = price_in_words(choosing, table, choices_with_margins(answer))
    if price:
        console.print(escape(price))
    console.print(f"[dim]{escape(tally_in_words(choosing))}[/dim]")


def constant_against(objective: float, found: Solution) -> str:
    """What the objective of the best constant current is to that of the profile's module.

    They are unlike where that has margins for a yield; the line "Current" compares both without.
    """
    if found.yield_reached is not None:
        return "it has no margins for the yield, the profile's module has"
    worse = objective / found.objective - 1.0
    return f"its objective is {abs(worse):.1%} {'higher' if worse > 0.0 else 'lower'}"


def _print_drives(answer: StudyResult, table: Table, console: Console) -> None:
    """Currents that follow a profile, and what the same module does at the constant current of the paper."""
    rows = current_rows(answer.design, table)
    if not rows:
        return
    grid = _grid("What the current does, straight between these moments", ("", "s", "A", ""), right=(1, 2))
    for row in rows:
        grid.add_row(*row)
    console.print(grid)
    best = answer.solution.constant if answer.solution else None
    columns = ("", "profile", *(["best constant"] if best else []), "default", "unit", "meaning")
    grid = _grid("What letting it change buys", columns, right=(1, 2, 3 if best else 2))
    for name, value in answer.constant_current.items():
        unit = table.unit(name)
        values = (answer.design.value(name), *([best.values[name]] if best else []), value)
        grid.add_row(
            name, *(number(from_si(v, unit)) for v in values), pretty(unit), meaning(name, answer.design, table)
        )
    console.print(grid)
    driven = [table.phase(phase).current_input for phase in answer.design.current_profiles]

    def said(values: Mapping[str, float]) -> str:
        return ", ".join(f"{name} {format_quantity(values[name], table.unit(name))}" for name in driven)

    if best and answer.solution:
        beside = constant_against(best.objective, answer.solution)
        console.print(f"Best constant: a design of its own, {said(best.values)}; {beside}.")
    defaults = {name: _default(table, name) for name in driven}
    console.print(f"[dim]Default: this module at {said(defaults)}; the paper heats with 1.5 A.[/dim]")


def _default(table: Table, name: str) -> float:
    row = table.quantity(name)
    assert isinstance(row, Input)
    assert row.default is not None
    return row.default


def _print_points(answer: StudyResult, table: Table, console: Console) -> None:
    points, rows = point_rows(answer, table)
    right = tuple(range(1, len(points) + 1))
    grid = _grid("At the operating points", ("", *points, "unit", "meaning"), right=right)
    for row in rows:
        grid.add_row(*row)
    console.print(grid)


def _grid(title: str, columns: tuple[str, ...], right: tuple[int, ...] = ()) -> Grid:
    grid = Grid(title=title, title_justify="left", title_style="bold", box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for i, column in enumerate(columns):
        grid.add_column(column, justify="right" if i in right else "left", header_style="dim", no_wrap=i == 0)
    return grid


def _verdict(answer: StudyResult) -> str:
    broken = sum(not check.kept for check in answer.checks)
    warned = f", with {len(answer.warnings)} warnings" if answer.warnings else ""
    solution = answer.solution
    if solution is None:
        if math.isinf(answer.design.value("response_time")):
            last = answer.histories["softening"]
            return (
                f"[red]The switch never ends: after {last['time'][-1]:.0f} s the layer's far face is at "
                f"{last['far_face'][-1]:.0f} °C. The current is too weak, or the cold side too warm.[/red]"
            )
        if broken:
            return f"[yellow]Evaluated; {broken} of {len(answer.checks)} rules and requirements do not hold.[/yellow]"
        if answer.undecided:
            count = len(answer.undecided)
            return f"[yellow]Evaluated; history decides whether {count} of the limits hold{warned}.[/yellow]"
        return f"[green]Evaluated; every rule and requirement holds{warned}.[/green]"
    late = solution.out_of_time is not None
    if not answer.found:
        return f"[red]No design found that keeps every limit{' before the time limit' if late else ''}.[/red]"
    starts = solution.free_starts
    converged = sum(start.converged for start in starts)
    optima = len(solution.distinct_optima())
    agree = ", all at one optimum" if optima == 1 else f", at {optima} different optima"
    if converged < 2:
        agree = ", others may be better"
    of_start = sum(answer.design.study["minimize"].values())
    ended = f"[green]Optimal{warned}[/green]"
    if answer.design.status == BELOW_YIELD:
        missed = "The time limit ended the search before its margins were found"
        ended = f"[red]{missed if late else 'Fewer modules keep the limits than the study asks'}{warned}[/red]"
    elif answer.design.above_rating:
        ended = f"[red]The best design is beyond ratings that the study does not accept{warned}[/red]"
    elif answer.design.accepting:
        ended = f"[green]Optimal, accepting: {', '.join(answer.design.accepting)}{warned}[/green]"
    return (
        f"{ended}: {converged} of {len(starts)} starts converged{agree}; objective "
        f"{solution.objective:.5g}, against {of_start:.5g} at the study's own start."
    )


def _print_checks(answer: StudyResult, table: Table, console: Console) -> None:
    """Requirements always; the machine's own rules only where they bind or break."""
    found, hidden = checks_table(answer, table)
    print_table(found, console, _STYLES)
    if hidden:
        console.print(f"[dim]{hidden} rules of the machine hold with a margin.[/dim]")


_STYLES = {"broken": "red", "binds": "yellow", "open": "yellow"}
"""Of a word that says how a limit stands."""


def _print_prices(answer: StudyResult, table: Table, console: Console) -> None:
    """What binds, with its cost in the objective and in each output; the costliest in sentences; what is slack."""
    print_table(prices_table(answer), console)
    for sentence in sentences(answer)[:_SENTENCES_SHOWN]:
        console.print(escape(sentence))
    slack = slack_in_words(answer, table)
    if slack:
        console.print(f"[dim]{escape(slack)}[/dim]")


def _print_warnings(answer: StudyResult, warnings: Sequence[tuple[str, str]], console: Console) -> None:
    """What is wrong and what mends it; and every other optimum that starts ended at."""
    for text, mend in warnings:
        console.print(f"[yellow]Warning[/yellow] {escape(text)}" + (f"; mend: {escape(mend)}" if mend else ""))
    solution, table = answer.solution, table_for(answer.design.mode)
    for start in solution.distinct_optima()[1:] if solution else []:
        where = ", ".join(f"{name} {format_quantity(value, table.unit(name))}" for name, value in start.end.items())
        count, all_ = solution.reached(start) if solution else 0, len(solution.free_starts) if solution else 0
        console.print(
            f"Another optimum, objective {start.objective:.5g}, reached by {count} of {all_} starts: {where}."
        )
