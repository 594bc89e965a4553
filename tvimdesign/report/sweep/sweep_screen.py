"""What the terminal says of a sweep."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape

from tvimdesign.base.units import pretty
from tvimdesign.page.page_file import FILE
from tvimdesign.report.output.progress import duration
from tvimdesign.report.output.tables import number
from tvimdesign.sweep.plan import SweepPlan


def print_sweep(told: dict[str, Any], plan: SweepPlan, out: Path, console: Console) -> None:
    """Print how the cells ended, the best of them, and where to look first."""
    run = told["run"]
    done = "evaluated" if told["task"] == "evaluate" else "optimised"
    console.print(f"[bold]{escape(told['study'])}[/bold]: {told['cells']} cells {done} ({told['method']})")
    ended = ", ".join(f"{count} {status.replace('_', ' ')}" for status, count in told["statuses"].items())
    console.print(f"  {escape(ended)}", soft_wrap=True)
    console.print(f"  {run['reused']} reused, {run['computed']} computed in {duration(run['seconds'])}{_work(run)}")
    for name, best in told["best"].items():
        console.print(f"  least {name}: {_best(best, plan)}", soft_wrap=True)
    if not told["best"]:
        console.print("  no cell keeps every limit: `reason` in the table says which limits each breaks")
    console.print(f"\nLook first: [bold]{escape(str(out / FILE))}[/bold]; the tables are beside it", soft_wrap=True)


def _work(run: dict[str, Any]) -> str:
    if not run["computed"]:
        return ""
    each = f", {1e3 * run['cells_s'] / max(run['cells'], 1):.0f} ms of the processor a cell"
    died = f", {run['died']} workers died and were replaced" if run["died"] else ""
    return each + died


def _best(best: dict[str, Any], plan: SweepPlan) -> str:
    texts = plan.points.texts(int(best["cell"]) - 1)
    at = ", ".join(f"{axis.name} {text}" for axis, text in zip(plan.axes, texts, strict=True))
    unit = pretty(best["unit"])
    return escape(f"{number(best['value'])}{f' {unit}' if unit else ''} in cell {best['cell']:g} ({at})")
