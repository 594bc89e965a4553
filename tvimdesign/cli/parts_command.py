"""The command `cad`: the parts of a design, of a study, or of chosen cells of a sweep."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tvimdesign.base.errors import InputError
from tvimdesign.cli import completions
from tvimdesign.cli.folders import default_folder, name_of
from tvimdesign.cli.options import AsJson, Out, Overwrite
from tvimdesign.cli.shared_options import Resume, Scheduler, Shard, Workers


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
    workers: Workers = 0,
    shard: Shard = "",
    scheduler: Scheduler = "",
    resume: Resume = False,
    out: Out = None,
    overwrite: Overwrite = False,
    json: AsJson = False,
) -> None:
    """Make the parts of a design: STEP, print files, drawings, checks; in a folder beside the run's, ending in -cad."""
    if cells:
        from tvimdesign.report.sweep.cell_parts import make_parts_of_cells
        from tvimdesign.sweep.run_sweep import Where

        make_parts_of_cells(
            design, out or design.parent / f"{name_of(design)}-cad", cells, Where.of(workers, scheduler, shard),
            overwrite=overwrite, resume=resume, as_json=json,
        )  # fmt: skip
        return
    if shard or scheduler or resume or workers:
        raise InputError("--workers, --shard, --scheduler and --resume are for cells of a sweep: name some by --cells")
    from tvimdesign.report.run.run_study import make_parts

    make_parts(design, out or default_folder(design), overwrite=overwrite, as_json=json)
