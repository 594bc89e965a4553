"""Options of commands whose work can be parted: to processes here, to the jobs of an array, to a cluster."""

from __future__ import annotations

from typing import Annotated

import typer

Workers = Annotated[int, typer.Option("--workers", min=0, help="Processes here; as many as processors unless given.")]
Shard = Annotated[
    str,
    typer.Option(
        "--shard", metavar="I/N", help="Compute part I of N: a job of a batch system's array; all share the folder."
    ),
]
Scheduler = Annotated[
    str, typer.Option("--scheduler", metavar="ADDRESS", help="Compute on a dask cluster, such as tcp://host:8786.")
]
Resume = Annotated[
    bool, typer.Option("--resume", help="Go on in that folder: cells that are there are not computed again.")
]
