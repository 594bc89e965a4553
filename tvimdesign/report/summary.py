"""The summary a run prints: verdict, what was found, what must hold, what holds it, what to mind."""

from __future__ import annotations

import math

from rich.console import Console
from rich.markup import escape
from rich.table import Table as Grid

from tvimdesign.device import Table
from tvimdesign.report.tables import headline_rows, number, point_rows, variable_rows
from tvimdesign.solve.answer import Answer, Check
from tvimdesign.units import from_si, pretty

_PRICE_SHOWN = 1e-3
_NOTHING = 1e-5  # of any unit a limit is written in


def print_summary(answer: Answer, table: Table, console: Console) -> None:
    """Print an answer for people."""
    design = answer.design
    console.print(f"[bold]{escape(design.name)}[/bold]  ({design.mode} mode)")
    console.print(_verdict(answer))
    variables = variable_rows(answer, table)
    if variables:
        grid = _grid("What was varied", ("variable", "start", "design", "unit", "allowed"), right=(1, 2))
        for row in variables:
            grid.add_row(*row)
        console.print(grid)
    _print_points(answer, table, console)
    grid = _grid("What the module is", ("", "value", "unit", "meaning"), right=(1,))
    group = ""
    for section, name, value, unit, description in headline_rows(design, table):
        if section != group:
            grid.add_row(f"[dim]{section}[/dim]")
            group = section
        grid.add_row(name, value, unit, description)
    console.print(grid)
    _print_checks(answer, table, console)
    _print_prices(answer, console)
    _print_warnings(answer, table, console)


def _print_points(answer: Answer, table: Table, console: Console) -> None:
    points, rows = point_rows(answer.design, table)
    right = tuple(range(1, len(points) + 1))
    grid = _grid("At the operating points", ("", *points, "unit", "meaning"), right=right)
    for row in rows:
        grid.add_row(*row)
    console.print(grid)
    for point in points:
        low, high = (answer.design.value(f"pcl_melting_{end}") for end in ("start", "end"))
        if low < answer.design.value(f"temperature@{point}") < high:
            console.print(
                f"[yellow]Mind[/yellow] the point {point} lies in the melting range: there the layer depends on its "
                "history, and these figures are those of the equilibrium curve, right in order of magnitude only."
            )


def _grid(title: str, columns: tuple[str, ...], right: tuple[int, ...] = ()) -> Grid:
    grid = Grid(title=title, title_justify="left", title_style="bold", box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for i, column in enumerate(columns):
        grid.add_column(column, justify="right" if i in right else "left", header_style="dim", overflow="fold")
    return grid


def _verdict(answer: Answer) -> str:
    broken = sum(not check.kept for check in answer.checks)
    solution = answer.solution
    if math.isinf(answer.design.value("response_time")):
        unreached = "The switch never ends: the current is too weak, or the cold side too warm, for this criterion."
        return f"[red]{unreached}[/red]"
    if solution is None:
        return (
            "[green]Evaluated; every rule and requirement holds.[/green]"
            if not broken
            else f"[yellow]Evaluated; {broken} of {len(answer.checks)} rules and requirements do not hold.[/yellow]"
        )
    if answer.design.status != "optimal":
        return f"[red]{answer.design.status}[/red]"
    converged = [start for start in solution.starts if start.converged]
    optima = solution.distinct_optima()
    text = f"[green]Optimal[/green]: {len(converged)} of {len(solution.starts)} runs converged"
    if len(converged) > 1:
        text += ", all to the same optimum" if len(optima) == 1 else f", to {len(optima)} different results"
    return f"{text}; objective {solution.objective:.5g} (the start is {sum_of_weights(answer):.5g})."


def sum_of_weights(answer: Answer) -> float:
    """Objective of the study's start: each minimised output over its own value there, times its weight."""
    return float(sum(answer.design.study["minimize"].values()))


def _print_checks(answer: Answer, table: Table, console: Console) -> None:
    """Requirements always; the machine's own rules only where they bind or break."""
    grid = _grid("What must hold", ("", "limit", "value", "unit", "margin", "because"), right=(2, 4))
    hidden = 0
    for check in answer.checks:
        if check.origin != "require" and check.kept and check.margin > _PRICE_SHOWN:
            hidden += 1
            continue
        mark = "[red]broken[/red]" if not check.kept else "[yellow]binds[/yellow]" if _binds(check) else "ok"
        unit = table.unit(check.output)
        because = "the study" if check.origin == "require" else check.origin
        value = from_si(check.value, unit)
        shown = number(0.0 if abs(value) < _NOTHING else value)
        grid.add_row(mark, check.text, shown, pretty(unit), _share(check.margin), because)
    if grid.row_count:
        console.print(grid)
    if hidden:
        console.print(f"[dim]{hidden} rules of the machine hold with room to spare.[/dim]")


def _binds(check: Check) -> bool:
    return abs(check.margin) <= _PRICE_SHOWN


def _share(margin: float) -> str:
    return f"{margin + 0.0 if abs(margin) > 5e-4 else 0.0:+.1%}" if abs(margin) < 100 else "ample"


def _print_prices(answer: Answer, console: Console) -> None:
    if answer.solution is None or answer.design.status != "optimal":
        return
    held = sorted((h for h in answer.solution.held if h.price > _PRICE_SHOWN), key=lambda h: -h.price)
    if not held:
        return
    grid = _grid("What holds the design back", ("limit", "relaxed by", "lowers the objective by"), right=(1, 2))
    for row in held:
        grid.add_row(row.text, row.step, f"{row.price:.2g} %")
    console.print(grid)


def _print_warnings(answer: Answer, table: Table, console: Console) -> None:
    for check in answer.warnings:
        unit = table.unit(check.output)
        value = f"{number(from_si(check.value, unit))} {pretty(unit)}"
        console.print(f"[yellow]Mind[/yellow] {check.output} is {value}: {check.origin}.")
    if answer.solution and answer.design.status == "optimal":
        optima = answer.solution.distinct_optima()
        for start in optima[1:]:
            console.print(
                f"[yellow]Mind[/yellow] run {start.number + 1} ended elsewhere, objective {start.objective:.5g}."
            )
