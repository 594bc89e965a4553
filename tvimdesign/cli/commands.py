"""The commands: thin, and quick to answer; what a command needs is imported when it runs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from typer import Argument, Option

from tvimdesign.base.errors import InputError
from tvimdesign.cli import options
from tvimdesign.cli.design_commands import atlas, compare, explore, robot, simulate, sweep, tolerate, verify

app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    help="Size thermo-active variable impedance modules: a study file in, a module that can be made out.",
    epilog="Exit codes: 0 done, 2 bad input, 3 infeasible or not converged, 4 partly done, 130 interrupted.",
)


def _print_version(requested: bool) -> None:
    if requested:
        from tvimdesign import __version__

        typer.echo(__version__)
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, Option("--version", help="Print the version.", callback=_print_version, is_eager=True)
    ] = False,
) -> None:
    pass


@app.command()
def run(
    study: options.StudyFile,
    out: options.Out = None,
    overwrite: options.Overwrite = False,
    cad: options.Cad = True,
    plots: options.Plots = True,
    resume: Annotated[
        bool, Option("--resume", help="Continue the front of an earlier run in that folder that was stopped.")
    ] = False,
    prove: Annotated[bool, Option("--prove", help="Solve every combination of listed choices as well.")] = False,
    full: Annotated[bool, Option("--full", help="Print the tables, too, as summary.txt has them.")] = False,
    time_limit: options.TimeLimit = "",
    settings: options.Settings = None,
    json: options.AsJson = False,
) -> None:
    """Optimise or evaluate a study; write a folder of results."""
    from tvimdesign.report.run.run_study import run_study

    run_study(
        study, out or options.default_folder(study), overwrite=overwrite, cad=cad, plots=plots,
        prove=prove, resume=resume, full=full, as_json=json,
        settings=options.changes(settings, time_limit),
    )  # fmt: skip


@app.command()
def check(study: options.StudyFile, settings: options.Settings = None, json: options.AsJson = False) -> None:
    """Check a study: every mistake, and limits that conflict."""
    from tvimdesign.report.run.run_study import check_study

    check_study(study, settings or (), as_json=json)


@app.command()
def new(
    file: Annotated[
        Path | None, Argument(help="Study file to write; study.yaml, or the example's name, unless given.")
    ] = None,
    example: Annotated[str, Option(help="A shipped study to start from.", autocompletion=options.examples)] = "",
    result: Annotated[
        Path | None,
        Option(
            "--from",
            metavar="RESULT",
            help="design.json or folder of a run: write its module as a study that `run` answers the same.",
            autocompletion=options.designs_and_studies,
        ),
    ] = None,
    built: Annotated[
        bool, Option("--built", help="With --from: its parts are made, and stay as drawn beside what is measured.")
    ] = False,
    list_all: Annotated[bool, Option("--list", help="List the shipped studies.")] = False,
) -> None:
    """Write a study to start from. It is commented, or a shipped one, or the module of a result."""
    from tvimdesign.report.run.study_files import list_examples, write_new_study

    if list_all:
        list_examples()
    else:
        write_new_study(file, example, result, built=built)


@app.command()
def size(
    torque: Annotated[str, Option(help="Torque that the frozen joint holds, such as '8 N.m'.")] = "",
    stiffness: Annotated[
        str,
        Option(
            help="Of the soft joint, without its damping: '1.5 N.m/rad' (20 % to either side), or '1 to 2 N.m/rad'. An "
            "eighth of the torque a radian is usual."
        ),
    ] = "",
    diameter: Annotated[str, Option(help="Largest outer diameter, 20 to 200 mm.")] = "",
    time: Annotated[str, Option(help="Time within which it gets soft, such as '60 s'.")] = "",
    supply: Annotated[str, Option(help="Voltage, and its current if limited: '24 V, 3 A'.")] = "",
    stiff_time: Annotated[str, Option(help="Time within which it gets stiff again; any unless given.")] = "",
    stroke: Annotated[str, Option(help="Angle that the soft joint turns to either side; 0.104 rad unless given.")] = "",
    process: Annotated[
        str,
        Option(
            metavar="RECORD",
            help="Process that makes the parts, such as print_pei_9085 or machine_6061; one that suits the diameter "
            "unless given.",
            autocompletion=options.processes,
        ),
    ] = "",
    file: Annotated[Path, Option("--study", help="Study file to write, and to edit afterwards.")] = Path("joint.yaml"),
    out: options.Out = None,
    overwrite: options.Overwrite = False,
    cad: options.Cad = True,
    plots: options.Plots = True,
    json: options.AsJson = False,
) -> None:
    """Size a joint from five numbers; give a verdict. Writes a study with its hardware and ranges, and runs it.

    All of --torque, --stiffness, --diameter, --time and --supply are needed.
    """
    from tvimdesign.report.run.study_files import size_study

    numbers = {
        "torque": torque, "stiffness": stiffness, "diameter": diameter, "time": time, "supply": supply,
        "stroke": stroke, "stiff_time": stiff_time, "process": process,
    }  # fmt: skip
    size_study(
        file, numbers, out or options.default_folder(file), overwrite=overwrite, cad=cad, plots=plots, as_json=json
    )


@app.command()
def schema() -> None:
    """Print the JSON Schema of studies. An editor then knows names, units and descriptions."""
    from tvimdesign.study.written_studies import schema_text

    print(schema_text(), end="")


@app.command()
def cad(
    design: Annotated[
        Path,
        Argument(
            metavar="DESIGN|STUDY",
            help="design.json of a run, or a study file.",
            autocompletion=options.designs_and_studies,
        ),
    ],
    out: options.Out = None,
    overwrite: options.Overwrite = False,
    json: options.AsJson = False,
) -> None:
    """Make parts: STEP, print files, drawings, checks. They go into a folder beside the run's, ending in -cad."""
    from tvimdesign.report.run.run_study import make_parts

    make_parts(design, out or options.default_folder(design), overwrite=overwrite, as_json=json)


for of_one in (robot, simulate, tolerate, verify):
    app.command()(of_one)


@app.command()
def fit(
    files: Annotated[
        list[Path] | None, Argument(metavar="FILE...", help="Measured data: text, CSV, Excel, TRIOS, RepTate.")
    ] = None,
    kind: Annotated[
        str,
        Option(
            "--as",
            metavar="KIND",
            help="Kind of measurement; found by its columns unless given. See --kinds.",
            autocompletion=options.kinds,
        ),
    ] = "",
    kinds: Annotated[bool, Option("--kinds", help="List the kinds: columns needed, what can be set.")] = False,
    settings: Annotated[
        list[str] | None, Option("--set", metavar="NAME=VALUE", help="Say what the files do not, such as arm='100 mm'.")
    ] = None,
    columns: Annotated[
        Path | None, Option(help="Column map (YAML): which column is what, units, decimal sign.")
    ] = None,
    record: Annotated[str, Option(help="Write what was measured as a record of this name.")] = "",
    based_on: Annotated[str, Option(help="The record that has all that was not measured.")] = "",
    catalog: Annotated[Path, Option(help="Folder of your records.")] = Path("my_records"),
    out: Annotated[Path | None, Option(help="Folder for the results; results/<first file>-fit unless given.")] = None,
    overwrite: options.Overwrite = False,
    plots: options.Plots = True,
    json: options.AsJson = False,
) -> None:
    """Fit measured data. Writes parameters with intervals, and a record for studies."""
    from tvimdesign.report.fit_files import fit_files, list_kinds

    if kinds:
        list_kinds(json)
        return
    if not files:
        raise InputError("give at least one FILE; --kinds lists what can be fitted")
    fit_files(
        files, kind, out or Path("results") / f"{files[0].stem}-fit", settings=settings or (), columns=columns,
        record=record, based_on=based_on, catalog=catalog, overwrite=overwrite, plots=plots, as_json=json,
    )  # fmt: skip


for of_several in (compare, sweep, atlas, explore):
    app.command()(of_several)


@app.command()
def paper_check(json: options.AsJson = False) -> None:
    """Recompute the numbers of the paper."""
    from tvimdesign.paper.paper_check import print_paper_check

    print_paper_check(as_json=json)


@app.command()
def rows(
    mode: Annotated[str, Option(help="Mode whose rows are listed.", autocompletion=options.modes)] = "shear",
    match: Annotated[
        str,
        Argument(
            metavar="[GROUP|WORD]",
            help="A group, or a word for what is looked for: 'stiffness', 'weight', 'power supply'.",
            autocompletion=options.rows,
        ),
    ] = "",
    json: options.AsJson = False,
) -> None:
    """List the names a study may use. Prints groups, then inputs, choices and outputs with units and limits."""
    from tvimdesign.report.rows import print_rows

    print_rows(mode, match, as_json=json)
