"""A run's page: the verdict and the requirements first, then facts, warnings and the sections that the run has.

Writes a study into its folder: answered, with tables, curves and the design, or refused, with the reason.
"""

import json
from bisect import bisect_left
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tvimdesign.base.errors import InfeasibleError
from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.base.units import from_si
from tvimdesign.cad.cad_report import PREVIEW
from tvimdesign.report.output.command import record_files
from tvimdesign.report.output.numbers import axis_label, curves_csv, head, name_in_words
from tvimdesign.report.output.page_sections import made_by_words, study_section, there, versions_section, write_page
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.report.output.tables import results_csv
from tvimdesign.report.output.terminal import DOT, Progress
from tvimdesign.report.page.blocks import Block, Drawn, Facts, Folded, Page, Points, Section, Warned
from tvimdesign.report.run import parts_of_design as parts
from tvimdesign.report.run.answered_study import AnsweredStudy
from tvimdesign.report.run.blocks import sections
from tvimdesign.report.run.blocks.facts import Fact, main_facts, study_fact
from tvimdesign.report.run.blocks.more_facts import more_facts
from tvimdesign.report.run.blocks.requirements import HEADS, requirements, requirements_grid
from tvimdesign.report.run.blocks.verdict import refused, starts_in_words
from tvimdesign.report.run.first_screen import verdict_of
from tvimdesign.report.run.front_report import points_shown
from tvimdesign.report.run.reasons import why_csv
from tvimdesign.simulation.working_cycle.curves import LOOP_SAMPLES, PHASE_UNITS, Curves, torque_loop
from tvimdesign.solve.result import StudyResult
from tvimdesign.study import Design, Study, StudyTree, study_file, study_text, write_design

PLACES = {
    "hot_side": "pads, inner side", "near_face": "layer, near face", "far_face": "layer, far face",
    "cold_side": "pads, outer side",
}  # fmt: skip
"""Columns of temperatures that are drawn, and what a figure calls them."""
_PROFILES = 5


def drawings(answer: StudyResult) -> list[Drawing]:
    """Return every figure of a run, with its data."""
    return [Drawing(name, f"design_figures.{name}", data) for name, data in plot_data(answer).items()]


def plot_data(answer: StudyResult) -> dict[str, dict[str, Any]]:
    """Return data of every figure by the figure's name."""
    design = answer.design

    def shown(name: str) -> float:
        return from_si(design.value(name), answer.design.table.unit(name))

    phases = {phase: _history(curves) for phase, curves in answer.histories.items()}
    labels = {name: axis_label(name, unit) for name, unit in PHASE_UNITS.items()}
    melting = [shown("pcl_melting_start"), shown("pcl_melting_end")]
    return {
        "cycle": {
            **phases,
            "labels": labels,
            "places": PLACES,
            "melting": melting,
            "soft": shown("soft_threshold"),
            "stiff": shown("stiff_threshold"),
            "target": shown("target_temperature"),
            "depths": depths(answer),
        },
        "stiffness_and_damping": {
            **phases,
            "labels": labels,
            "springs": shown("spring_stiffness"),
            "title": f"Heating at {shown('frequency@hot'):g} Hz, cooling at {shown('frequency@cold'):g} Hz",
        },
        "power_and_energy": {**phases, "labels": labels},
        "impedance": {
            "sweep": answer.sweep,
            "labels": {kind: axis_label(kind, PHASE_UNITS[f"joint_{kind}"]) for kind in ("stiffness", "damping")},
            "melting": melting,
            "frequency": shown("frequency@hot"),
            "springs": shown("spring_stiffness"),
        },
        "torque": _torque(design, shown),
    }


def _history(curves: Curves) -> dict[str, Any]:
    """Return columns of a phase over its time, and the temperatures through the polymer at some moments."""
    time, through = curves["time"], through_the_layer(curves)
    moments = [min(bisect_left(time, time[-1] * i / (_PROFILES - 1)), len(time) - 1) for i in range(_PROFILES)]
    profiles = [{"time": time[at], "temperatures": [curves[name][at] for name in through]} for at in moments]
    return {name: curves[name] for name in (*PLACES, *PHASE_UNITS)} | {"profiles": profiles}


def through_the_layer(curves: Curves) -> list[str]:
    """Return columns with the temperatures through the polymer, from the pads on."""
    return ["near_face", *(name for name in curves if name.startswith("cell_")), "far_face"]


def depths(answer: StudyResult) -> list[float]:
    """Return the depths [mm] from the Peltier side at which a profile has its temperatures."""
    depth = from_si(answer.design.table.evaluate(answer.design.values, ["pcl_depth"])["pcl_depth"], "mm")
    cells = sum(name.startswith("cell_") for name in answer.histories["softening"])
    return [0.0, *((i + 0.5) / cells * depth for i in range(cells)), depth]


def _torque(design: Design, shown: Callable[[str], float]) -> dict[str, Any]:
    """Return torque over angle at every operating point, of the joint for small motions, and of its springs."""
    loops, springs = [], _spring_torque(design)
    for point in design.study["operating_points"]:
        frequency = design.value(f"frequency@{point}")
        stiffness, damping = (design.value(f"joint_{kind}@{point}") for kind in ("stiffness", "damping"))
        swing = min(design.value("stroke"), design.value("holding_torque") / stiffness)
        angle, torque = torque_loop(stiffness, damping, frequency, swing)
        title = f"{name_in_words(point)}: {shown(f'temperature@{point}'):.0f} °C, {frequency:g} Hz"
        loops.append({"title": title, "angle": angle.tolist(), "torque": torque.tolist(), **springs})
    contact = ", while the PCL is in contact" if design.value("parting_share") > 0.0 else ""
    return {
        "title": f"Torque that turns the joint through its stroke, at most by what it holds frozen{contact}",
        "stop_angle": design.value("stop_angle"),
        "labels": {"angle": axis_label("angle", "rad"), "torque": axis_label("torque", "N*m")},
        "loops": loops,
    }


def _spring_torque(design: Design) -> dict[str, list[float]]:
    """Return the torque of all springs over the whole stroke to both sides; empty without springs."""
    if _SPRINGS not in design.values:
        return {}
    angle = np.linspace(-design.value("stroke"), design.value("stroke"), LOOP_SAMPLES)
    known = {**design.choices, **design.values, "stroke": np.abs(angle)}
    del known[_SPRINGS]
    torque = np.sign(angle) * design.table.evaluate(known, [_SPRINGS])[_SPRINGS]
    return {"spring_angle": angle.tolist(), "springs": torque.tolist()}


_SPRINGS = "spring_torque_full_stroke"
_FILES = {
    "summary.pdf": "this screen as one page", "summary.txt": "tables as text", "results.csv": "every value",
    "why.csv": "shadow prices", "front.csv": "the front",
    "cad/assembly.step": "the assembly as STEP", "cad/bom.csv": "bill of materials",
    "cad/springs/spring.pdf": "spring sheet", "cad/checks.json": "checks on the solids",
    "design.json": "the design as data",
}  # fmt: skip
_PHASES = ("softening", "stiffening")
WARNINGS = 3  # Warnings that are shown; others are behind a line
LISTED = 3  # Parts of a listing that are shown of many
_COLUMNS = ("current", "electrical_power", "joint_impedance", "joint_stiffness", "joint_damping")


def run_page(folder: ResultsFolder, answered: AnsweredStudy) -> Page:
    """Return the page of an answered study beside the files that the folder has by then."""
    answer, cad, says = answered.result, folder.path / parts.FOLDER, verdict_of(answered)
    module = folded(sections.module_section(answered))
    shown = [module]
    if answer.has_design:
        values = answered.reported["values"]
        every = Folded(f"All {len(values)} inputs and outputs, with their sources", [sections.values_grid(values)])
        shown = _of_a_design(cad, answered, replace(module, blocks=[*module.blocks, every]))
    return Page(
        answer.design.name, f"{answer.design.mode} module", says.text, says.tone, glance(answered), parts.preview(cad),
        [*shown, *_last(folder, answered.tree)], made_by_words(folder), there(folder, _FILES), parts.carried_files(cad),
    )  # fmt: skip


def summary_sheet(folder: ResultsFolder, answered: AnsweredStudy) -> Drawing:
    """Return the page's first screen as a drawing for one sheet of paper."""
    answer, says, picture = answered.result, verdict_of(answered), folder.path / parts.FOLDER / PREVIEW
    data = {
        "title": answer.design.name, "kind": f"{answer.design.mode} module", "status": says.text, "tone": says.tone,
        "heads": ["requirement", *HEADS[1:]],
        "rows": [row.cells for row in requirements(answer, answered.uncertainty)],
        "facts": [(fact.label, _in_short(fact)) for fact in main_facts(answer, answered.uncertainty)],
        "warnings": [warning[:2] for warning in answered.warnings[:WARNINGS]],
        "picture": str(picture.resolve()) if picture.exists() else "",
        "made_by": f"{made_by_words(folder)} All tables and the module in 3-D: report.html.",
    }  # fmt: skip
    return Drawing("summary", "design_figures.summary", data)


def glance(answered: AnsweredStudy) -> list[Block]:
    """Return the first screen: requirements, facts and warnings, and behind a line what a reader may ask next."""
    answer, uncertainty = answered.result, answered.uncertainty
    rows = requirements(answer, uncertainty)
    first: list[Block] = [requirements_grid(rows)] if rows else []
    if not answer.has_design:
        return [*first, Points([warning.text for warning in answered.warnings]), sections.conflict_points(answered)]
    facts = [(fact.label, _in_short(fact)) for fact in (*main_facts(answer, uncertainty), *study_fact(answer))]
    more = [(fact.label, fact.text) for fact in more_facts(answer, uncertainty, answered.front.front)]
    more += [("Starts", text) for text in starts_in_words(answer)]
    warnings = [warning[:2] for warning in answered.warnings]
    warned: list[Block] = [Warned(warnings[:WARNINGS])] if warnings else []
    if others := warnings[WARNINGS:]:
        warned.append(Folded(f"{len(others)} more warnings", [Warned(others)]))
    return [*first, Facts(facts), *warned, Folded("Thresholds, cooling, margins and assumed values", [Facts(more)])]


def _in_short(fact: Fact) -> str:
    """Return a fact in one text; of a listing the first parts, and how many more there are."""
    more = len(fact.parts) - LISTED
    if not fact.listing or more < 2:
        return fact.text
    return DOT.join([*fact.parts[:LISTED], f"{more} more"])


def folded(section: Section) -> Section:
    """Return a section that shows its heading alone until a reader opens it."""
    return replace(section, folded=True)


def _of_a_design(cad: Path, answered: AnsweredStudy, of_the_module: Section) -> list[Section]:
    """Return figures, front and active constraints, then folded what there is to look up, of the parts if any."""
    path, front = answered.tree.path, answered.reported.get("front")
    to_look_up = [
        sections.assumptions_section(answered), *sections.search_section(answered), *parts.checks_section(cad),
        *parts.materials_section(cad), *parts.steps_section(cad), *parts.spring_section(cad),
    ]  # fmt: skip
    return [
        parts.solids_section(cad, path.name if path else "STUDY"),
        cycle_section(answered.result),
        *([drawn_front(answered.result, front)] if front else []),
        sections.reasons_section(answered),
        of_the_module,
        *map(folded, to_look_up),
    ]


def cycle_section(answer: StudyResult) -> Section:
    """Return the working cycle: softening, then stiffening, on one axis of time."""
    says = (
        "The working cycle, simulated: temperatures, current and power, impedance, and the temperatures through the "
        "layer at the cursor. Softening first, then stiffening."
    )
    beside = plot_data(answer)["cycle"]
    data = {
        "phases": [_phase(name, answer.histories[name]) for name in _PHASES if name in answer.histories],
        "labels": beside["labels"],
        "depths": _rounded(beside["depths"]),
        **{name: beside[name] for name in ("places", "melting", "soft", "stiff")},
    }
    return Section("cycle", "Cycle", [Drawn(parts.CYCLE, "cycle.js", says, data, libraries=["echarts"])])


def _phase(name: str, curves: Curves) -> dict[str, Any]:
    """Return a phase: `through` has the temperatures through the layer, a row for each moment."""
    through = zip(*(curves[column] for column in through_the_layer(curves)), strict=True)
    columns = {column: _rounded(curves[column]) for column in (*PLACES, *_COLUMNS)}
    return {"name": name, "time": _rounded(curves["time"]), **columns, "through": [_rounded(row) for row in through]}


def _rounded(values: Any) -> list[float]:
    """Return numbers in as many digits as a screen shows."""
    return [float(f"{value:.5g}") for value in values]


def drawn_front(answer: StudyResult, front: dict[str, Any]) -> Section:
    """Return the front: its points as curves to brush, and as a table with the file of each design."""
    says = (
        "The front: each point, and each line, is a whole design. Drag along an axis of the lower figure, or set "
        "its ends below, to keep only the designs within."
    )
    drawn = Drawn("front", "front.js", says, points_shown(front, answer.design.table), libraries=["echarts"])
    return sections.front_section(front, list(front["units_of_values"]), drawn)


def _last(folder: ResultsFolder, tree: StudyTree) -> list[Section]:
    return [folded(study_section(study_text(tree))), folded(versions_section(folder))]


def write_answer(folder: ResultsFolder, answered: AnsweredStudy) -> Path:
    """Write everything but pictures and parts; returns the design's file."""
    result, table = answered.result, answered.study.table
    write_study(folder, answered.tree, answered.study)
    write_results(folder, answered)
    if result.solution and result.has_design:
        folder.write("why.csv", why_csv(result))
    for phase, history in result.histories.items():
        folder.write(f"{phase}.csv", curves_csv(history, PHASE_UNITS, "degC"))
    units = {name: table.unit(name.removesuffix("_low").removesuffix("_high")) for name in result.sweep}
    folder.write("impedance.csv", curves_csv(result.sweep, units, "1"))
    answered.front.write(folder)
    return write_design(result.design, folder.path / "design.json")


def write_study(folder: ResultsFolder, tree: StudyTree, study: Study) -> None:
    """Write the study as it was given, and with every default."""
    folder.write("study.yaml", study_file(tree))
    folder.write("study.resolved.json", study.model_dump_json(indent=2) + "\n")


def write_results(folder: ResultsFolder, answered: AnsweredStudy) -> None:
    """Write results.json and results.csv; again once the uncertainty is known."""
    reported = answered.reported
    folder.write_json("results.json", reported)
    intervals = reported["uncertainty"]["intervals"] if "uncertainty" in reported else None
    folder.write("results.csv", results_csv(reported["values"], intervals))


def finish(folder: ResultsFolder, answered: AnsweredStudy) -> None:
    """Write the page, and the manifest with the study's file, if it has one, and those of the records in use."""
    result, path = answered.result, answered.tree.path
    write_page(folder, run_page(folder, answered))
    records = record_files(answered.study, result.design.choices)
    inputs = {"study": path, **records} if path else records
    folder.finish(result.design.status, inputs, result.design.study, result.seconds)


def refused_run(study: Study, error: InfeasibleError) -> dict[str, Any]:
    """Return the content of results.json for a study that was refused."""
    return {
        **head(), "name": study.name, "mode": study.mode,
        "status": "infeasible", "feasible": False, "reason": str(error),
    }  # fmt: skip


@contextmanager
def write_failure(
    folder: ResultsFolder, tree: StudyTree, study: Study, progress: Progress, *, as_json: bool
) -> Iterator[None]:
    """Write a study and why it has no design, if it has none, before the error goes on."""
    try:
        yield
    except InfeasibleError as error:
        progress("")  # raises KeyboardInterrupt where a solver swallowed one, and its failure looks like a conflict
        results, says = refused_run(study, error), refused(str(error))
        write_study(folder, tree, study)
        folder.write_json("results.json", results)
        folder.write("summary.txt", f"{study.name}: no design.\n{error}\n")
        write_page(folder, Page(
            study.name, f"{study.mode} module", says.text, says.tone, [Points(str(error).splitlines())], None,
            _last(folder, tree), made_by_words(folder), there(folder, _FILES),
        ))  # fmt: skip
        folder.finish("infeasible", {"study": tree.path} if tree.path else {}, study.model_dump(mode="json"))
        if as_json:
            print(json.dumps({**results, "folder": str(folder.out)}, indent=2))
        raise
