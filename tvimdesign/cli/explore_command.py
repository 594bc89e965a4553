"""The command `explore`: a page on this machine whose controls evaluate and optimise."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tvimdesign.cli import completions
from tvimdesign.cli.folders import name_of
from tvimdesign.cli.options import Settings


def explore(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="STUDY|RESULT|SWEEP",
            help="Study file, folder or design.json of a run, or folder of a sweep.",
            autocompletion=completions.designs_and_studies,
        ),
    ],
    out: Annotated[
        Path | None, typer.Option("--out", help="Folder of what is done; results/<name>-explore unless given.")
    ] = None,
    port: Annotated[int, typer.Option("--port", min=0, max=65535, help="Port; a free one unless given.")] = 0,
    token: Annotated[
        str, typer.Option("--token", help="Secret in the address, for one that stays; drawn unless given.")
    ] = "",
    browse: Annotated[bool, typer.Option("--open/--no-open", help="Open the page in the browser.")] = True,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Begin again, without what was done before.")] = False,
    settings: Settings = None,
) -> None:
    """Serve a page on this machine with controls that evaluate and optimise as they move."""
    from tvimdesign.explore.server import serve

    folder = out or Path("results") / f"{name_of(source)}-explore"
    serve(source, folder, port, token, overwrite=overwrite, browse=browse, settings=settings or ())
