"""The paper against its own numbers: each row says what the paper states, what its formulas give here, the verdict.

The paper is T. Exley et al., "TVIM: Thermo-Active Variable Impedance Module: Evaluating Shear-Mode Capabilities of
Polycaprolactone". What it states stands in `paper_claims.yaml`; every other number is computed when the paper check is.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from functools import cache

from tvimdesign.report.paper import module_rows, rheometer_rows, spring_rows
from tvimdesign.report.paper.published_module import claims


@dataclass(frozen=True)
class PaperFinding:
    """One row of the paper check."""

    claim: str
    where: str
    computed: str
    verdict: str


_COMPUTED = {**spring_rows.COMPUTED, **module_rows.COMPUTED, **rheometer_rows.COMPUTED}


@cache
def findings() -> tuple[PaperFinding, ...]:
    """Compute every row of the paper check."""
    return tuple(
        PaperFinding(claim=row["claim"], where=row["where"], computed=_COMPUTED[row["row"]](), verdict=row["verdict"])
        for row in claims()["rows"]
    )


def print_paper_check(as_json: bool) -> None:
    """Print the paper check for people or for scripts."""
    rows = findings()
    if as_json:
        print(json.dumps([asdict(row) for row in rows], indent=2, ensure_ascii=False))
        return
    from rich.table import Table as Grid

    from tvimdesign.report.output.progress import wide_console

    grid = Grid(title="The paper against its own numbers", title_justify="left", show_lines=True)
    for column, share in (("the paper says", 3), ("computed here", 5), ("verdict", 3)):
        grid.add_column(column, ratio=share)
    for row in rows:
        grid.add_row(f"{row.claim}\n[dim]{row.where}[/dim]", row.computed, row.verdict)
    wide_console().print(grid)
