"""Picture and tables of docs/atlas.md: the atlas in a folder, beside published devices.

python docs/make/atlas.py results/atlas [KIND ...]
"""

from __future__ import annotations

import csv
import sys
from collections import Counter, defaultdict
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from tvimdesign.base.units import parse_quantity
from tvimdesign.report.figures import theme
from tvimdesign.report.figures.analysis_figures import atlas
from tvimdesign.report.sweep.atlas_page import ending_limits, figure_data, rows_of
from tvimdesign.simulation.working_cycle.device_functions import resolve_study
from tvimdesign.solve.nlp.solver_run import OPTIMAL
from tvimdesign.solve.torque_time_map import CYCLE, MASS, TORQUE
from tvimdesign.solve.uncertainty.design_uncertainty import UncertaintyModel
from tvimdesign.study.atlas_studies import Atlas
from tvimdesign.sweep.atlas import AtlasCell, cells_of, front_of, study_of

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/atlas.md"
DATA = ROOT / "docs/atlas.csv"
UNITS = {
    "torque": "N.m",
    "mass": "kg",
    "soft_after": "s",
    "stiff_after": "s",
    "cycle": "s",
    "energy": "J",
    "density": "N.m/kg",
}
MARGIN = 2.0
"""Place [s], [N*m/kg] of a mark without that axis, or beyond it."""
COLUMNS = ("ratio", *UNITS)
MARKS = {"thermal": "o", "jamming": "s", "magnetorheological": "^", "electroadhesive": "D", "motor": "P"}


def devices() -> list[dict[str, Any]]:
    """Read the published devices."""
    records: list[dict[str, Any]] = yaml.safe_load((ROOT / "docs/devices.yaml").read_text(encoding="utf-8"))
    return records


def axes_of(device: dict[str, Any]) -> tuple[float | None, float | None]:
    """Return full cycle in s and torque over mass in N.m/kg; None where the text lacks it."""
    given = {name: parse_quantity(device[name], unit) for name, unit in UNITS.items() if name in device}
    cycle = given.get("cycle")
    if "soft_after" in given and "stiff_after" in given:
        cycle = given["soft_after"] + given["stiff_after"]
    density = given["torque"] / given["mass"] if {"torque", "mass"} <= set(given) else given.get("density")
    return cycle, density


def marks() -> list[dict[str, Any]]:
    """Return the marks of devices with an axis; one that lacks the other stands at its margin, open."""
    marks = []
    for device in devices():
        cycle, density = axes_of(device)
        if cycle or density:
            fill = "full" if cycle and density else "none"
            place = max(cycle or 0.0, MARGIN), density or MARGIN
            marks.append({"place": place, "marker": MARKS[device["kind"]], "fill": fill})
    return marks


def table() -> str:
    """Return the table of the page."""
    heads = ("device", "kind", *(name.replace("_", " ") for name in COLUMNS))
    lines = [f"|{'|'.join(heads)}|", "|---" * len(heads) + "|"]
    for device in devices():
        lines.append(f"|{'|'.join(str(device.get(name, '')) for name in ('name', 'kind', *COLUMNS))}|")
    return "\n".join(lines)


def kinds_table(plan: Atlas, cells: Sequence[AtlasCell]) -> str:
    """Return what each kind reaches, what ends it, and the assumed values that move its front most."""
    heads = (
        "kind",
        "modules",
        "fastest cycle",
        "most torque a mass",
        "energy there",
        "ended by",
        "in doubt: torque; cycle",
        "mass ~ torque^n; cycle ~ thickness^n",
    )
    lines = [f"|{'|'.join(heads)}|", "|---" * len(heads) + "|"]
    for kind, entry in plan.kinds.items():
        own = [cell for cell in cells if cell.kind == kind]
        modules = [cell for cell in own if cell.status == OPTIMAL]
        if not modules:
            lines.append(f"|{entry['title']}|0||||{ending_limits(own)}|||")
            continue
        fastest, densest = min(modules, key=lambda c: c.values[CYCLE]), max(modules, key=lambda c: c.density)
        columns = (
            entry["title"], f"{len(modules)}", f"{fastest.values[CYCLE]:.3g} s at {fastest.torque:g} N·m",
            f"{densest.density:.3g} N·m/kg at {densest.torque:g} N·m", f"{densest.values['cycle_energy']:.0f} J",
            ending_limits(own), "; ".join(doubts(plan, front_of(modules))),
            scaling(modules),
        )  # fmt: skip
        lines.append(f"|{'|'.join(columns)}|")
    return "\n".join(lines)


def doubts(plan: Atlas, front: Sequence[AtlasCell]) -> list[str]:
    """Return, of torque and of cycle time, the assumed value that moves most designs of a front most."""
    first: dict[str, Counter[str]] = defaultdict(Counter)
    for cell in front:
        resolved = resolve_study(study_of(plan, cell))
        for name, interval in UncertaintyModel(resolved, (TORQUE, CYCLE)).at(resolved, 0).intervals.items():
            if interval.first and name in (TORQUE, CYCLE):
                first[name][interval.first] += 1
    return [first[name].most_common(1)[0][0].replace("_", " ") if first[name] else "none" for name in (TORQUE, CYCLE)]


def torque_table(plan: Atlas, cells: Sequence[AtlasCell], cycles: Sequence[float]) -> str:
    """Return the densest module of each torque within some cycles, with its kind."""
    heads = ("torque", *(f"within {cycle:g} s" for cycle in cycles))
    lines = [f"|{'|'.join(heads)}|", "|---" * len(heads) + "|"]
    for torque in plan.torques:
        texts = []
        for cycle in cycles:
            here = [c for c in cells if (c.torque, c.cycle) == (torque, cycle) and c.status == OPTIMAL]
            best = max(here, key=lambda c: c.density, default=None)
            texts.append(f"{best.density:.3g} N·m/kg, {best.kind}" if best else "none")
        lines.append(f"|{torque:g} N·m|{'|'.join(texts)}|")
    return "\n".join(lines)


def scaling(modules: Sequence[AtlasCell]) -> str:
    """Return exponents: of mass over torque, of the lightest modules, and of cycle time over the layer's thickness."""
    lightest: dict[float, AtlasCell] = {}
    for cell in sorted(modules, key=lambda cell: -cell.values[MASS]):
        lightest[cell.torque] = cell
    layers = [cell for cell in modules if "pcl_thickness" in cell.values]
    pairs = (
        ([cell.torque for cell in lightest.values()], [cell.values[MASS] for cell in lightest.values()]),
        ([cell.values["pcl_thickness"] for cell in layers], [cell.values[CYCLE] for cell in layers]),
    )
    return "; ".join(f"{np.polyfit(np.log(x), np.log(y), 1)[0]:.1f}" if len(set(x)) > 2 else "–" for x, y in pairs)


def write(folder: Path, kinds: tuple[str, ...]) -> None:
    """Write the picture, the data, and the tables of the page."""
    plan = Atlas.read().only(kinds)
    cells = cells_of(plan, folder)
    figure = atlas({**figure_data(plan, cells), "devices": marks()})
    (ROOT / "docs/pictures/atlas.svg").write_bytes(theme.as_file(figure, "svg"))
    rows = rows_of(cells)
    with DATA.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(dict.fromkeys(key for row in rows for key in row)), lineterminator="\n")
        writer.writeheader()
        writer.writerows({key: f"{v:.4g}" if isinstance(v, float) else v for key, v in row.items()} for row in rows)
    tables = {
        "kinds": kinds_table(plan, cells),
        "torques": torque_table(plan, cells, (60.0, 120.0, 300.0)),
        "devices": table(),
    }
    page = PAGE.read_text(encoding="utf-8")
    for name, text in tables.items():
        head, begin, after = page.partition(f"<!-- {name} -->\n")
        page = f"{head}{begin}{text}\n<!-- end -->{after.partition('<!-- end -->')[2]}"
    PAGE.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    write(Path(sys.argv[1]), tuple(sys.argv[2:]))
