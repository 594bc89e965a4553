"""The command `cad`: the parts of a design, of a study, or of chosen cells of a sweep."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tvimdesign.cli import completions
from tvimdesign.cli.folders import default_folder, name_of
from tvimdesign.cli.options import AsJson, Out, Overwrite


def cad(
    design: Annotated[
        Path,
        typer.Argument(
            metavar="DESIGN|STUDY|SWEEP",
            help="design.json of a run, a study file, or with --cells the folder of a sweep.",
            autocompletion=completions.designs_and_studies,
        ),
    ],
    cells: Annotated[
        str, typer.Option("--cells", metavar="CELLS", help="Cells of the sweep, such as 3,7-9, or best.")
    ] = "",
    out: Out = None,
    overwrite: Overwrite = False,
    json: AsJson = False,
) -> None:
    """Make the parts of a design: STEP, print files, drawings, checks; in a folder beside the run's, ending in -cad."""
    if cells:
        from tvimdesign.report.sweep.cell_parts import make_parts_of_cells

        folder = out or design.parent / f"{name_of(design)}-cad"
        make_parts_of_cells(design, folder, cells, overwrite=overwrite, as_json=json)
        return
    from tvimdesign.report.run.run_study import make_parts

    make_parts(design, out or default_folder(design), overwrite=overwrite, as_json=json)
