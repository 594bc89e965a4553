"""One run, from a study file to a finished folder: the order of things, and what the terminal says meanwhile."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, cast

from tvimdesign.base.errors import GeometryError, InfeasibleError, InputError, TvimError
from tvimdesign.base.whole_files import write_whole
from tvimdesign.catalog import Catalog
from tvimdesign.device import Choice, Table, table_for
from tvimdesign.report.output.progress import Progress, progress_output, wide_console
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.run.record_checks import record_checks
from tvimdesign.study import Study, read_study
from tvimdesign.study.design import Design, read_design, write_design

if TYPE_CHECKING:
    from tvimdesign.report.figures.plot_process import Drawing
    from tvimdesign.report.output.results_format import Parts, RunResults
    from tvimdesign.report.run.front_report import FrontOfRun
    from tvimdesign.solve.result import StudyResult

CAD_TIME_LIMIT = 300.0  # s


def check_study(path: Path, *, proof: bool = True) -> Study:
    """Read a study and everything it names. Raises InputError with all that is wrong with it.

    Limits that arithmetic alone cannot keep are looked for as well, which takes half a second, unless `proof` is not
    asked.
    """
    from tvimdesign.report.run.refusal import refuse_unfit
    from tvimdesign.solve.nlp.constraints import refuse_impossible

    study = read_study(path)
    catalog, table = catalog_of(study), table_for(study.mode)
    (refuse_unfit if proof else refuse_impossible)(study, catalog, table)
    return study


def describe(study: Study) -> str:
    """One line on what a valid study asks, then one for each of its records that contradicts itself."""
    what = f"optimises {len(study.vary)} variables" if study.task == "optimize" else "evaluates one module"
    asked = f"{study.name}: valid; {what}, {len(study.require)} requirements ({study.mode} mode)."
    return "\n".join([asked, *record_checks(study, catalog_of(study), table_for(study.mode))])


def run_study(
    path: Path, out: Path, *, overwrite: bool, cad: bool, plots: bool, as_json: bool, sensitivities: bool = False,
    resume: bool = False, prove: bool = False, full: bool = False,
) -> None:  # fmt: skip
    """Answer a study and write its folder. Raises InputError, InfeasibleError, and TvimError for what is not done."""
    from tvimdesign.report.figures.plot_process import PlotProcess
    from tvimdesign.report.run.first_screen.run_screen import RunScreen, look_first, show
    from tvimdesign.report.run.front_report import FrontOfRun
    from tvimdesign.report.run.infeasible_report import complaint
    from tvimdesign.report.run.run_plot_data import drawings

    study = _proving(read_study(path)) if prove else read_study(path)
    table, catalog = table_for(study.mode), catalog_of(study)
    troubles: list[TvimError] = []
    with ExitStack() as stack:
        folder = stack.enter_context(ResultsFolder(out, overwrite, resume))
        progress = stack.enter_context(progress_output())
        screen = stack.enter_context(RunScreen(study))
        drawing = stack.enter_context(PlotProcess()) if plots and study.write.plots else None
        front = FrontOfRun(study, table, folder)
        found = _answered(path, study, catalog, table, folder, progress, front, as_json=as_json)
        screen.ask(found)
        parts = cad and study.write.cad and found.found
        plotted = drawings(found, table) if drawing and found.found else []
        reported = _told(found, table, record_checks(study, catalog, table))
        if found.found and (sensitivities or study.write.sensitivities):
            progress("differentiating the outputs")
            with _noting(troubles):
                plotted += _sensitivities(folder, found, catalog, table, reported)
        plotted += front.seek(found, progress, reported, troubles)
        if drawing and found.found:
            drawing.begin(folder.path / "plots", plotted, study.name, vector=parts or study.write.vector)
        design = _write(folder, path, study, found, reported, table)
        progress("")
        screen.tell(found, table, reported, front, folder, None if as_json else wide_console(), full=full)
        if parts:
            with _noting(troubles):
                reported["cad"] = _parts(design, folder.path / "cad", progress, as_json, in_full=full)
        if drawing and found.found:
            progress("drawing the plots")
            folder.look_up_versions()
            with _noting(troubles):
                drawing.finish()
        inputs = {"study": path, **_records(found.design, catalog, table)}
        folder.finish(found.design.status, inputs, found.design.study, found.seconds)
    if as_json:
        more = {"folder": str(folder.path), "not_done": [str(trouble) for trouble in troubles]}
        print(json.dumps({**reported, **more}, indent=2, allow_nan=False))
    else:
        show(look_first(folder, str(folder.path), wide_console().width), wide_console())
    if not found.found:
        raise InfeasibleError(complaint(found, table))
    if troubles:
        raise _partly(troubles)


def _proving(study: Study) -> Study:
    """The study with every combination of listed choices solved."""
    return study.model_copy(update={"solver": study.solver.model_copy(update={"prove": True})})


def _answered(
    path: Path, study: Study, catalog: Catalog, table: Table, folder: ResultsFolder, progress: Progress,
    front: FrontOfRun, *, as_json: bool,
) -> StudyResult:  # fmt: skip
    """The answer, if bounds do not prove that there is none; where there is none the folder says why."""
    from tvimdesign.report.run.refusal import leaving_the_reason, refuse_unfit
    from tvimdesign.solve.result import answer

    with leaving_the_reason(folder, path, study, as_json=as_json):
        refuse_unfit(study, catalog, table, progress)
        return answer(study, catalog, table, progress, keep=front.keep, objectives=front.outputs)


def _told(found: StudyResult, table: Table, doubts: list[str]) -> RunResults:
    """Everything a script wants to know of an answer."""
    from tvimdesign.report.output.tables import results
    from tvimdesign.report.run.infeasible_report import conflicts_reported, starts_reported
    from tvimdesign.report.run.why import why

    reported = cast("RunResults", results(found, table))
    reported["why"], reported["doubts"] = why(found, table), doubts
    if found.solution:
        reported["starts"] = starts_reported(found)
        reported["conflict_set"] = conflicts_reported(found.solution.conflict_set)
    return reported


def _write(
    folder: ResultsFolder, path: Path, study: Study, found: StudyResult, reported: RunResults, table: Table
) -> Path:
    """Write everything but pictures and parts; returns the design's file."""
    from tvimdesign.report.output.tables import curves_csv, results_csv
    from tvimdesign.report.run.why import why_csv
    from tvimdesign.simulation.curves import PHASE_UNITS

    folder.write("study.yaml", path.read_bytes())
    folder.write("study.resolved.json", study.model_dump_json(indent=2) + "\n")
    folder.write_json("results.json", reported)
    folder.write("results.csv", results_csv(reported["values"]))
    if found.solution and found.found:
        folder.write("why.csv", why_csv(found, table))
    for phase, history in found.histories.items():
        folder.write(f"{phase}.csv", curves_csv(history, PHASE_UNITS, "degC"))
    units = {name: table.unit(name.removesuffix("_low").removesuffix("_high")) for name in found.sweep}
    folder.write("impedance.csv", curves_csv(found.sweep, units, "1"))
    return write_design(found.design, folder.path / "design.json")


def _sensitivities(
    folder: ResultsFolder, found: StudyResult, catalog: Catalog, table: Table, reported: RunResults
) -> list[Drawing]:
    """Write the table of sensitivities, tell what is not in it; returns the heat map. Raises SimulationError."""
    from tvimdesign.report.figures.plot_process import Drawing
    from tvimdesign.report.run.sensitivities import heat_map, sensitivities, sensitivities_csv

    derivatives, resolved = sensitivities(found, catalog, table)
    folder.write("sensitivities.csv", sensitivities_csv(derivatives, resolved))
    reported["sensitivities_left_out"] = list(derivatives.left_out)
    data = heat_map(derivatives, resolved)
    return [Drawing("sensitivities", "sensitivity_figure.sensitivities", data)] if data["values"] else []


def make_parts(source: Path, out: Path, *, overwrite: bool, as_json: bool) -> None:
    """Make the parts of a design.json, or of a study, which is answered first."""
    if source.suffix != ".json":
        run_study(source, out, overwrite=overwrite, cad=True, plots=False, as_json=as_json)
        return
    design = read_design(source)
    troubles: list[TvimError] = []
    with ResultsFolder(out, overwrite) as folder:
        kept = write_design(design, folder.path / "design.json")
        with progress_output() as progress, _noting(troubles):
            report = _parts(kept, folder.path, progress, as_json)
            if as_json:
                print(json.dumps(report, indent=2))
            else:
                wide_console().print(f"Parts are in [bold]{out}[/bold]", soft_wrap=True)
        folder.finish("parts failed" if troubles else design.status, {"design": source}, design.study)
    if troubles:
        raise _partly(troubles)


def _parts(design: Path, out: Path, progress: Progress, as_json: bool, *, in_full: bool = True) -> Parts:
    """Make the parts beside their checks.json, and tell what was found. Raises GeometryError where a check fails."""
    from tvimdesign.cad import make_cad
    from tvimdesign.report.run.first_screen.layout import block
    from tvimdesign.report.run.first_screen.run_screen import show
    from tvimdesign.report.run.solid_checks import in_short, print_solid_checks

    progress("parts: starting the CAD kernel")
    report = make_cad(design, out, CAD_TIME_LIMIT, lambda text: progress(f"parts: {text}"))
    reported: Parts = {
        "checks": [check.plain() for check in report.checks], "files": list(report.files), "notes": list(report.notes)
    }  # fmt: skip
    write_whole(out / "checks.json", (json.dumps(reported, indent=2) + "\n").encode())
    progress("")
    console = wide_console()
    if not as_json and in_full:
        print_solid_checks(report.checks, console)
    elif not as_json:
        show(block("Parts", in_short(report.checks), console.width), console)
    if report.failed:
        worst = sorted(report.failed, key=lambda check: -abs(check.value))[:3]
        lines = [
            f"  {check.text}: {check.value:.4g}{check.unit and ' '}{check.unit}, limit {check.limit:.4g}"
            for check in worst
        ]
        raise GeometryError(
            f"the parts are written, but {len(report.failed)} of {len(report.checks)} checks fail, the worst:\n"
            + "\n".join(lines)
            + f"\nSee {out / 'checks.json'}, and which rules the design breaks."
        )
    return reported


def catalog_of(study: Study) -> Catalog:
    """The catalogue a study uses: the shipped records and those of the folder it names."""
    return Catalog(Path(study.catalog_folder) if study.catalog_folder else None)


def _records(design: Design, catalog: Catalog, table: Table) -> dict[str, Path]:
    """Files of the catalogue records a design uses."""
    return {
        f"{row.category}/{design.choices[row.name]}": catalog.path(row.category, design.choices[row.name])
        for row in table.quantities
        if isinstance(row, Choice) and row.category and design.choices[row.name] not in row.options
    }


@contextmanager
def _noting(troubles: list[TvimError]) -> Iterator[None]:
    """Keep a failure for the end, so that what else can be done is done; wrong input stays an error of its own."""
    try:
        yield
    except InputError:
        raise
    except TvimError as error:
        troubles.append(error)


def _partly(troubles: list[TvimError]) -> TvimError:
    error = TvimError("done in part: " + "; ".join(str(trouble) for trouble in troubles))
    error.exit_code = 4
    return error
