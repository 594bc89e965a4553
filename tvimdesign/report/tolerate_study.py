"""The command `tolerate`, from a study or a design to a folder, a page and sentences on what to tighten.

The spread of a module as plain data and CSV, apart from what is not known of it, and the data of the figure.
"""

import math
import os
from collections.abc import Iterator, Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from tvimdesign.base.errors import InfeasibleError, InputError
from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.base.units import from_si, pretty, si_unit, to_si
from tvimdesign.report.output.command import Command, design_file
from tvimdesign.report.output.numbers import axis_label, csv_text, ends_text, finite, head, name_in_words, number
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.report.output.tables import soft_of_module
from tvimdesign.report.output.terminal import Progress
from tvimdesign.report.page.blocks import Block, Folded, Grid, Picture, Points, Section
from tvimdesign.report.run.reasons import complaint
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule, resolve_design, resolve_study
from tvimdesign.solve.result import answer
from tvimdesign.solve.uncertainty.tolerance import GOOD, Preload, Spread, Tolerancing
from tvimdesign.study import Design, Study, read_design, read_study, standard_tolerances, write_design
from tvimdesign.study.text.values import difference_unit

Row = dict[str, Any]


def _columns(spread: Spread) -> dict[str, Any]:
    """Return the numbers of the outputs (SI): as drawn, worst case, root-sum-square and Monte Carlo."""
    drawn, worst = spread.drawn, spread.worst
    return {
        "as_drawn": spread.nominal, "worst_low": worst.low, "worst_high": worst.high, "mean": drawn.mean,
        "low": drawn.low, "high": drawn.high, "deviation_rss": spread.deviation, "deviation": drawn.deviation,
    }  # fmt: skip


def output_rows(spread: Spread) -> Iterator[Row]:
    """Yield one row for each output: as drawn, worst case, root-sum-square and Monte Carlo side by side."""
    columns, table = _columns(spread), spread.study.table
    for i, name in enumerate(spread.outputs):
        unit = table.unit(name)
        units = {key: difference_unit(unit) if key.startswith("deviation") else unit for key in columns}
        shown = {key: finite(from_si(float(column[i]), units[key])) for key, column in columns.items()}
        yield {"output": name, "unit": pretty(unit), **shown, "never": float(spread.drawn.never[i])}


def limit_rows(spread: Spread) -> Iterator[Row]:
    """Yield one row for each limit: its yield with the interval of 95 %, and its C_pk."""
    for limit_yield in spread.limit_yields:
        yield {
            "limit": limit_yield.text, "output": limit_yield.limit.output,
            "origin": limit_yield.limit.origin,
            "yield": limit_yield.share.share, "yield_low": limit_yield.share.low, "yield_high": limit_yield.share.high,
            "cpk": finite(limit_yield.capability),
        }  # fmt: skip


def contributor_rows(spread: Spread) -> Iterator[Row]:
    """Yield one row for each output that spreads and each contributor: tolerance, derivative, and its shares."""
    study, table = spread.study, spread.study.table
    for i, name in enumerate(spread.outputs):
        if not spread.spreads(i):
            continue
        for j, contributor in enumerate(spread.contributors):
            of, by = difference_unit(table.unit(name)), difference_unit(table.unit(contributor.name))
            tolerance = study.tolerances[contributor.name]
            yield {
                "output": name, "contributor": contributor.name,
                "plus_minus": from_si(contributor.plus_minus, by), "unit": pretty(by),
                "distribution": contributor.distribution, "status": tolerance.status, "source": tolerance.source,
                "derivative": from_si(float(spread.derivatives[i, j]), of) * to_si(1.0, by),
                "derivative_unit": f"{pretty(of) or 1} / {pretty(by) or 1}",
                "share": float(spread.shares[i, j]), "sobol_first": float(spread.first[i, j]),
                "sobol_total": float(spread.total[i, j]),
            }  # fmt: skip


def reported(spread: Spread, preload: Preload | None) -> dict[str, Any]:
    """Return everything as plain data."""
    columns, rows = _columns(spread), list(output_rows(spread))
    for i, row in enumerate(rows):
        numbers = {key: finite(float(column[i])) for key, column in columns.items()}
        row["si"] = {**numbers, "unit": pretty(si_unit(spread.study.table.unit(spread.outputs[i])))}
    return {
        **head(),
        "samples": spread.drawn.values.shape[1],
        "yield": spread.together and asdict(spread.together),
        "outputs": rows,
        "limits": list(limit_rows(spread)),
        "contributors": list(contributor_rows(spread)),
        "corners": spread.worst.corners,
        "free_angle": None if preload is None else {
            "as_bought_deg": math.degrees(preload.as_bought),
            "adjusted_deg": math.degrees(preload.adjusted),
            "over_stroke": preload.over_stroke,
            "yield_as_bought": preload.yield_as_bought.share,
            "yield_adjusted": preload.yield_adjusted.share,
        },
        "left_out": list(spread.left_out),
    }  # fmt: skip


_PARTS = 6  # Contributors with a colour of their own; the rest is one
_PANELS = 6
_BINS = 60
_REACH = 5.0  # Half of a histogram's axis over the span of the middle half of all modules


def figure_data(spread: Spread) -> dict[str, Any]:
    """Return contributors' shares of requirements and minimised outputs, and histograms of the least satisfied."""
    shown = [i for i, name in enumerate(spread.outputs) if name in spread.requested and spread.spreads(i)]
    order = np.argsort(-np.sum(spread.shares[shown], axis=0), kind="stable")
    parts = [
        {
            "name": name_in_words(spread.contributors[j].name),
            "shares": [100.0 * float(spread.shares[i, j]) for i in shown],
        }
        for j in order[:_PARTS]
    ]
    remainder = [100.0 * float(np.sum(spread.shares[i, order[_PARTS:]])) for i in shown]
    if any(share > 0.0 for share in remainder):
        parts.append({"name": "all others", "shares": remainder})
    by_yield = sorted(spread.limit_yields, key=lambda limit_yield: limit_yield.share.share)
    rows = dict.fromkeys(spread.outputs.index(limit_yield.limit.output) for limit_yield in by_yield)
    every = dict.fromkeys([*rows, *shown])
    panels = [_panel(spread, i) for i in every if spread.spreads(i)][:_PANELS]
    return {"outputs": [name_in_words(spread.outputs[i]) for i in shown], "parts": parts, "panels": panels}


def _panel(spread: Spread, i: int) -> dict[str, Any]:
    name = spread.outputs[i]
    unit = spread.study.table.unit(name)
    values = spread.drawn.values[i]
    finite = values[np.isfinite(values)]
    # What one in a thousand modules has would press all others into one bar.
    low, quarter, middle, most, high = np.quantile(finite, [0.0005, 0.25, 0.5, 0.75, 0.9995])
    reach = _REACH * (most - quarter)
    ends = (max(low, middle - reach), min(high, middle + reach)) if reach > 0.0 else (low, high)
    counts, edges = np.histogram(finite, bins=_BINS, range=(float(ends[0]), float(ends[1])))
    limits = [k.limit.limit for k in spread.limit_yields if k.limit.output == name]
    span = (2.0 * edges[0] - edges[-1], 2.0 * edges[-1] - edges[0])
    near = [limit for limit in limits if span[0] <= limit <= span[1]]
    share = min((k.share.share for k in spread.limit_yields if k.limit.output == name), default=None)
    caption = "" if share is None else f"{100.0 * share:.3g} % of modules within limits"
    return {
        "title": caption,
        "label": axis_label(name, unit),
        "counts": [int(count) for count in counts],
        "edges": [from_si(float(edge), unit) for edge in edges],
        "limits": [from_si(limit, unit) for limit in near],
        "as_drawn": from_si(float(spread.nominal[i]), unit),
    }


def spread_table(spread: Spread, data: Mapping[str, Any]) -> Grid:
    """Return what is asked or minimised and spreads: by worst case, root-sum-square and modules drawn at random."""
    heads = ("", "as drawn", "worst case", "rss sd", "mc mean", "mc sd", "99.73 %", "unit", "most by")
    rows = [
        (row["output"], number(row["as_drawn"]), ends_text(row["worst_low"], row["worst_high"], 4),
         number(row["deviation_rss"]), number(row["mean"]), number(row["deviation"]),
         ends_text(row["low"], row["high"], 4), row["unit"], _most_by(spread, i))
        for i, row in enumerate(data["outputs"])
        if row["output"] in spread.requested and spread.spreads(i)
    ]  # fmt: skip
    return grid("What spreads from part to part", heads, rows, right=range(1, 7), code=(0, 8))


def concern_table(spread: Spread) -> Grid:
    """Tabulate limits that too many modules violate, and what carries their spread."""
    rows = [
        (limit.text, f"{100.0 * limit.share.share:.4g} %", f"{limit.capability:.2f}",
         _most_by(spread, spread.outputs.index(limit.limit.output)))
        for limit in spread.of_concern
    ]  # fmt: skip
    caption = f"Limits that fewer than {100.0 * GOOD:g} % of modules meet"
    return grid(caption, ("", "yield", "C_pk", "most by"), rows, right=(1, 2))


def _most_by(spread: Spread, i: int) -> str:
    """Return the contributor that carries most of an output's spread, with its share."""
    most = int(spread.shares[i].argmax())
    return f"{spread.contributors[most].name} {100.0 * spread.shares[i, most]:.0f} %"


FILES = {
    "outputs.csv": "spread of every output", "limits.csv": "yield of every limit",
    "contributors.csv": "who contributes",
}  # fmt: skip
_FIGURE = "spread.png"


def verdict(data: Mapping[str, Any]) -> str:
    """Return the yield with its interval."""
    share = data["yield"]
    low, high = (f"{100.0 * share[end]:.3g}" for end in ("low", "high"))
    return f"{100.0 * share['share']:.3g} % OF MODULES SATISFY ALL LIMITS ({low} to {high})"


def sections_of(folder: ResultsFolder, spread: Spread, data: Mapping[str, Any]) -> list[Section]:
    """Return what varies from part to part; `data` is that of tolerances.json."""
    grids = (spread_table(spread, data), concern_table(spread))
    varies: list[Block] = [grid for grid in grids if grid.rows]
    picture = folder.path / _FIGURE
    if picture.exists():
        says = "Who contributes how much to each output's spread, and how modules drawn at random spread"
        varies.append(Picture(picture.read_bytes(), says, says))
    varies.append(Folded("Every limit and who contributes", [_limits(data), _contributors(data)]))
    return [Section("parts", "From part to part", varies)]


def _limits(data: Mapping[str, Any]) -> Block:
    rows = [
        (limit["limit"], f"{100.0 * limit['yield']:.4g} %", "" if limit["cpk"] is None else f"{limit['cpk']:.3g}",
         limit["origin"])
        for limit in data["limits"]
    ]  # fmt: skip
    return grid("Limits", ("limit", "yield", "C_pk", "because"), rows, right=(1, 2))


def _contributors(data: Mapping[str, Any]) -> Block:
    rows = [
        (entry["output"], entry["contributor"], f"± {number(entry['plus_minus'])} {entry['unit']}".rstrip(),
         entry["distribution"], entry["status"], entry["source"])
        for entry in data["contributors"]
    ]  # fmt: skip
    heads = ("output", "contributor", "tolerance", "distribution", "status", "source")
    return grid("Contributors", heads, rows, code=(0, 1))


_ON_THE_LIMIT = 0.1  # C_pk below which no tolerance helps, only another design
_BENT = 0.1  # Difference of the two standard deviations from which an output is not linear within the tolerances
_NAMED = 3
_CARRIED = 0.2  # Share of a limit's variance from which a contributor counts as carrying it


def sentences(spread: Spread, preload: Preload | None) -> list[str]:
    """Return what people should know, the most important first."""
    violated, limits = spread.violated_at_worst, len(spread.limit_yields)
    corners = f"{violated} of {limits} limits are violated" if violated else "no limit is violated"
    angle = [] if preload is None else [free_angle(preload)]
    return [f"In the worst case {corners}.", *_what_first(spread), *angle, *_caveats(spread)]


def _what_first(spread: Spread) -> Iterator[str]:
    """Yield what to tighten, limit by limit; where the mean stands on the limit, that tightening does not help."""
    concern = spread.of_concern
    if not concern:
        yield f"Every limit is met by {100 * GOOD:g} % of the modules and more: nothing needs to be tightened."
        return
    on_limit = [limit_yield for limit_yield in concern if limit_yield.capability < _ON_THE_LIMIT]
    if on_limit:
        names = ", ".join(limit_yield.text for limit_yield in on_limit[:_NAMED])
        more = f" and {len(on_limit) - _NAMED} more" if len(on_limit) > _NAMED else ""
        yield (
            f"The mean stands on or beyond {names}{more}: no tolerance cures that. Move the design away from the "
            "limit, as a study with `robust: {sigma: 3}` does."
        )
    mendable = [limit_yield for limit_yield in concern if limit_yield not in on_limit] or concern
    lost = {contributor.name: 0.0 for contributor in spread.contributors}
    for limit_yield in mendable:
        for j, name in enumerate(lost):
            lost[name] += (1.0 - limit_yield.share.share) * spread.share(limit_yield, j)
    first = max(lost, key=lambda name: lost[name])
    j = list(lost).index(first)
    carried = [limit_yield for limit_yield in mendable if spread.share(limit_yield, j) >= _CARRIED] or mendable[:1]
    texts = []
    for limit_yield in sorted(carried, key=lambda each: spread.share(each, j), reverse=True)[:2]:
        share, able = spread.share(limit_yield, j), limit_yield.capability
        texts.append(
            f"it carries {100 * share:.0f} % of the variance behind {limit_yield.text}, which "
            f"{100 * limit_yield.share.share:.3g} % meet"
        )
        if able >= _ON_THE_LIMIT:
            halved = able / math.sqrt(1.0 - 0.75 * share)
            texts[-1] += f"; with half its tolerance C_pk would be {halved:.2f} instead of {able:.2f}"
    yield f"Tighten {first} first: {'; '.join(texts)}."


def free_angle(preload: Preload) -> str:
    """Return what the springs' free angle does to the joint, and what adjusting the preload does about it."""
    by = " by DIN 2194, grade 2" if preload.by_row else ""
    left = math.degrees(preload.adjusted)
    adjusted = f"to within ±{left:.2g}°" if left > 0.0 else "out"
    return (
        f"The free-angle tolerance of these springs (±{math.degrees(preload.as_bought):.1f}°{by}) is "
        f"{preload.over_stroke:.1f} times the stroke: as bought, {100 * preload.yield_as_bought.share:.3g} % of the "
        f"modules meet all limits that depend on the preload; with the preload adjusted {adjusted}, "
        f"{100 * preload.yield_adjusted.share:.3g} % do."
    )


def _caveats(result: Spread) -> Iterator[str]:
    rss, drawn = result.deviation, result.drawn.deviation
    spread = rss > 1e-9 * np.abs(result.nominal)
    bent = [name for i, name in enumerate(result.outputs) if spread[i] and abs(drawn[i] - rss[i]) > _BENT * rss[i]]
    if bent:
        yield f"Not linear within the tolerances, so trust Monte Carlo rather than root-sum-square: {', '.join(bent)}."
    turned = [name for i, name in enumerate(result.outputs) if spread[i] and not result.worst.by_sign[i]]
    if turned:
        names = ", ".join(turned)
        yield f"Not monotonic within the tolerances, so the worst corner is not where derivatives point: {names}."
    never = [
        f"{name} {100 * result.drawn.never[i]:.2g} %" for i, name in enumerate(result.outputs) if result.drawn.never[i]
    ]
    if never:
        yield f"Share of the modules in which it never happens: {', '.join(never)}; means leave these out."
    if result.left_out:
        yield f"Not in this, as they never happen or hang on a current profile: {', '.join(result.left_out)}."


FEWEST, MOST = 1 << 8, 1 << 22  # Modules that may be drawn


def tolerate_study(path: Path, out: Path, samples: int, *, overwrite: bool, as_json: bool) -> None:
    """Analyse a study's or a design's tolerances and write a folder. Raises InputError, InfeasibleError,
    and TvimError once all but the figure is done.
    """
    if not FEWEST <= samples <= MOST:
        raise InputError(f"--samples {samples}: must be {FEWEST} to {MOST}")
    source = design_file(path)
    study = Study.model_validate(read_design(source).study) if source.suffix == ".json" else read_study(source)
    with Command(out, overwrite=overwrite, as_json=as_json, plots=study.write.plots) as command:
        folder, progress = command.folder, command.progress
        module, optimum, notes = _module(source, study, progress)
        study = module.study
        analysis, seed = Tolerancing(module, progress, os.cpu_count() or 1), study.solver.seed
        spread, preload = analysis.analyse(samples, seed), analysis.preload(samples, seed)
        data = reported(spread, preload)
        data["notes"] = [*notes, f"Soft is {soft_of_module(module)}."]
        data["sentences"] = sentences(spread, preload)
        folder.write(f"tolerated{source.suffix}", source.read_bytes())
        if optimum is not None:
            write_design(optimum, folder.path / "design.json")
        folder.write_json("tolerances.json", data)
        folder.write("outputs.csv", csv_text(output_rows(spread), digits=6))
        folder.write("limits.csv", csv_text(limit_rows(spread), digits=6))
        folder.write("contributors.csv", csv_text(contributor_rows(spread), digits=6))
        command.begin_plots([Drawing("spread", "analysis_figures.spread", figure_data(spread))], study.name)
        command.finish_plots()
        page = command.page(
            study.name, "tolerances", verdict(data), [Points(data["sentences"]), Points(data["notes"])],
            sections_of(folder, spread, data), study=source.read_text("utf-8"), files=FILES,
        )  # fmt: skip
        command.finish("tolerated", {"tolerated": source}, study.model_dump(mode="json"), page=page)
    command.report(data, "Tables and figure are")


def _module(source: Path, study: Study, progress: Progress) -> tuple[ResolvedModule, Design | None, list[str]]:
    """Return the module to analyse, the optimum that was searched for it, if one was, and where it came from."""
    notes = []
    if not study.tolerances:
        study = study.model_copy(update={"tolerances": standard_tolerances(study.table)})
        notes.append("The study gives no tolerances: the standard ones are taken.")
    if source.suffix == ".json":
        design = read_design(source)
        resolved = resolve_design(design)
        module = replace(resolved, study=resolved.study.model_copy(update={"tolerances": study.tolerances}))
        return module, None, [f"Module: the design {source}.", *design.rating_notes, *notes]
    if not study.vary:
        return resolve_study(study), None, [f"Module: {source}.", *notes]
    progress("searching for the optimum")
    result = answer(study, progress)
    if not result.has_design:
        raise InfeasibleError(complaint(result))
    robust = ", robust as it asks" if study.robust else ""
    notes = [f"Module: the optimum of {source}{robust}.", *result.design.rating_notes, *notes]
    return resolve_design(result.design), result.design, notes
