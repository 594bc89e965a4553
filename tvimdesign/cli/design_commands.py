"""The commands that test, analyse, compare and explore modules."""

from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from tvimdesign.cli import options
from tvimdesign.simulation.virtual_tests import TESTS


def robot(
    result: options.ResultOfRun,
    timestep: Annotated[
        str, Option(metavar="TIME", help="Time step of the simulation, such as '0.5 ms'; chosen unless given.")
    ] = "",
    out: options.Out = None,
    overwrite: options.Overwrite = False,
    json: options.AsJson = False,
) -> None:
    """Write the joint for simulators: MJCF, URDF, SDF, FMU. The folder is results/<name>-robot."""
    from tvimdesign.base.units import parse_quantity
    from tvimdesign.report.robot_files import write_robot

    folder = out or options.results(result, "robot")
    step = parse_quantity(timestep, "s") if timestep else None
    write_robot(result, folder, step, overwrite=overwrite, as_json=json)


def simulate(
    study: options.StudyOrDesign,
    test: Annotated[str, Option(help=f"Virtual test: {', '.join(TESTS)}.", autocompletion=options.tests)] = "",
    out: options.Out = None,
    overwrite: options.Overwrite = False,
    settings: options.Settings = None,
    json: options.AsJson = False,
) -> None:
    """Simulate creep, relaxation, release or a sine. Writes curves and a figure into results/<study>-<test>."""
    from tvimdesign.report.simulate_study import simulate_study

    folder = out or options.results(study, test)
    simulate_study(study, test, folder, overwrite=overwrite, as_json=json, settings=settings or ())


def verify(
    result: options.ResultOfRun,
    fe_python: options.FePython = "",
    out: options.Out = None,
    overwrite: options.Overwrite = False,
    json: options.AsJson = False,
) -> None:
    """Check a design against finite elements of its parts. The folder is results/<name>-verified."""
    from tvimdesign.report.verify_design import verify_design

    folder = out or options.results(result, "verified")
    verify_design(result, folder, fe_python, overwrite=overwrite, as_json=json)


def tolerate(
    study: options.StudyOrDesign,
    samples: Annotated[int, Option(help="Modules drawn; the next power of two.")] = 65536,
    out: options.Out = None,
    overwrite: options.Overwrite = False,
    json: options.AsJson = False,
) -> None:
    """Analyse tolerances and yield. Worst case, RSS and Monte Carlo; the folder is results/<study>-tolerances."""
    from tvimdesign.report.tolerate_study import tolerate_study

    folder = out or options.results(study, "tolerances")
    tolerate_study(study, folder, samples, overwrite=overwrite, as_json=json)


def compare(
    studies: Annotated[
        list[Path],
        Argument(
            metavar="STUDY|RESULT...",
            help="Study files of any modes, or folders (or design.json) of finished runs.",
            autocompletion=options.designs_and_studies,
        ),
    ],
    out: Annotated[
        Path | None, Option(help="Folder for the results; results/<first>-vs-<second> unless given.")
    ] = None,
    points: Annotated[int, Option(min=0, help="Points of each front; no fronts unless given.")] = 0,
    overwrite: options.Overwrite = False,
    plots: options.Plots = True,
    settings: options.Settings = None,
    json: options.AsJson = False,
) -> None:
    """Compare studies, or results of finished runs. Studies have the same requirements, optimised and as drawn."""
    from tvimdesign.report.compare.compare_studies import compare_studies

    compare_studies(
        studies, out or Path("results") / "-vs-".join(study.stem for study in studies), points=points,
        overwrite=overwrite, plots=plots, as_json=json, settings=settings or (),
    )  # fmt: skip


def sweep(
    study: options.StudyFile,
    out: options.Out = None,
    overwrite: options.Overwrite = False,
    resume: options.Resume = False,
    workers: options.Workers = 0,
    shard: options.Shard = "",
    plots: options.Plots = True,
    time_limit: options.TimeLimit = "",
    settings: options.Settings = None,
    json: options.AsJson = False,
) -> None:
    """Run every cell of a study's sweep; gather a table. The folder is results/<study>-sweep."""
    from tvimdesign.report.sweep.sweep_study import sweep_study
    from tvimdesign.sweep.run_sweep import Executor

    sweep_study(
        study, out or options.results(study, "sweep"), Executor.of(workers, shard),
        overwrite=overwrite, resume=resume, plots=plots, as_json=json,
        settings=options.changes(settings, time_limit),
    )  # fmt: skip


def atlas(
    plan: Annotated[Path | None, Argument(metavar="[PLAN]", help="Plan; the shipped one unless given.")] = None,
    kinds: Annotated[list[str] | None, Option("--kind", help="Kind of module; repeat it. All unless given.")] = None,
    out: options.Out = None,
    overwrite: options.Overwrite = False,
    resume: options.Resume = False,
    reuse: Annotated[
        list[Path] | None, Option(metavar="FOLDER", help="Atlas whose families are taken, too; repeat it.")
    ] = None,
    workers: options.Workers = 0,
    plots: options.Plots = True,
    json: options.AsJson = False,
) -> None:
    """Map the lightest modules over torque and time. The folder is results/atlas."""
    from tvimdesign.report.sweep.atlas_page import make_atlas

    make_atlas(
        plan, out or Path("results/atlas"), kinds=tuple(kinds or ()), workers=workers, overwrite=overwrite,
        resume=resume, plots=plots, as_json=json, reuse=tuple(reuse or ()),
    )  # fmt: skip


def explore(
    source: Annotated[
        Path,
        Argument(
            metavar="STUDY|RESULT|SWEEP|ATLAS",
            help="Study file, folder or design.json of a run, or folder of a sweep or an atlas.",
            autocompletion=options.designs_and_studies,
        ),
    ],
    out: Annotated[Path | None, Option(help="Folder of what is done; results/<name>-explore unless given.")] = None,
    port: Annotated[int, Option(min=0, max=65535, help="Port; a free one unless given.")] = 0,
    token: Annotated[str, Option(help="Secret in the address, for one that stays; drawn unless given.")] = "",
    browse: Annotated[bool, Option("--open/--no-open", help="Open the page in the browser.")] = True,
    overwrite: Annotated[bool, Option("--overwrite", help="Begin again, without what was done before.")] = False,
    settings: options.Settings = None,
) -> None:
    """Evaluate and optimise with sliders in a browser. This machine serves the page."""
    from tvimdesign.explore.server import serve

    folder = out or options.results(source, "explore")
    serve(source, folder, port, token, overwrite=overwrite, browse=browse, settings=settings or ())
