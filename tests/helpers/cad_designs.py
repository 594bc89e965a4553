"""Designs to make parts of, in either mode: the paper's size, a wrist's, and one whose coils end at an odd angle."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import yaml
from support import ROOT, study_path

from tvimdesign import __version__
from tvimdesign.cad import CadReport
from tvimdesign.device import table_for
from tvimdesign.device.table.quantity import Event
from tvimdesign.device.table.quantity import Path as SwitchPath
from tvimdesign.study import Study, read_study, read_study_text
from tvimdesign.study import given as resolve
from tvimdesign.study.design import Design

MM = 1e-3
_MODULES = yaml.safe_load((ROOT / "tests/cases/modules_of_parts.yaml").read_text(encoding="utf-8"))


def module_of_parts(name: str) -> dict[str, Any]:
    """Return the inputs and choices of a module of tests/cases/modules_of_parts.yaml."""
    base = module_of_parts(_MODULES[name]["based_on"]) if "based_on" in _MODULES[name] else {}
    return base | _MODULES[name]["module"]


WRIST, ODD, BLOCKS, WRIST_BLOCKS, ODD_BLOCKS, BEARINGS, BEARING_BLOCKS = map(module_of_parts, list(_MODULES)[:7])
DRIVEN, DRIVEN_BLOCKS, SPRUNG, SPRUNG_BEARINGS, SPRUNG_BLOCKS = map(module_of_parts, list(_MODULES)[7:12])
TILES, VANE_TILES, VANE_TILE_ROWS = map(module_of_parts, list(_MODULES)[12:15])
CASES: dict[str, tuple[str, Mapping[str, float | str]]] = {
    "paper": ("shear", {}), "wrist": ("shear", WRIST), "odd": ("shear", ODD),
    "blocks": ("compression", BLOCKS), "wrist blocks": ("compression", WRIST_BLOCKS),
    "odd blocks": ("compression", ODD_BLOCKS),
    "bearings": ("shear", BEARINGS), "bearings among blocks": ("compression", BEARING_BLOCKS),
    "sprung": ("shear", SPRUNG), "sprung bearings": ("shear", SPRUNG_BEARINGS),
    "sprung blocks": ("compression", SPRUNG_BLOCKS), "driven": ("shear", DRIVEN),
    "driven blocks": ("compression", DRIVEN_BLOCKS), "tiles": ("shear", TILES),
    "tiles in vanes": ("compression", VANE_TILES), "on a base": ("shear", TILES | {"housing_base": "separate"}),
}  # fmt: skip


def given(overrides: Mapping[str, float | str], mode: str) -> dict[str, Any]:
    """Return the inputs and choices of a mode at their defaults, but for the overrides."""
    study = read_study_text(f"mode: {mode}\n", "a test").model_copy(update={"module": dict(overrides)})
    return resolve(study)


def design_of(name: str, overrides: Mapping[str, float | str], mode: str = "shear") -> Design:
    """Return a design with every row of the geometry."""
    return _of_the_geometry(name, given(overrides, mode), mode)


def as_it_starts(study: Study) -> Design:
    """Return the geometry of a study where its search begins: no cycle, no search."""
    return _of_the_geometry(study.name, resolve(study), study.mode)


def _of_the_geometry(name: str, known: dict[str, Any], mode: str) -> Design:
    table = table_for(mode)
    geometry = ("Layout", "Gaps", "Size and weight", "Springs")
    simple = [row for row in table.outputs if not (row.hidden or row.per_point or row.instant)]
    wanted = [row.name for row in simple if row.group in geometry and not isinstance(row, Event | SwitchPath)]
    values = {key: float(value) for key, value in known.items() if isinstance(value, int | float)}
    values |= {key: float(value) for key, value in table.evaluate(known, wanted).items()}
    choices = {row.name: getattr(known[row.name], "name", known[row.name]) for row in table.choices}
    return Design(tvimdesign="0", name=name, mode=mode, status="evaluated", choices=choices, values=values, study={})


def shipped_design(name: str) -> Design:
    """Return the module of a shipped study where its search starts, such that it can be written and read again."""
    study = read_study(study_path(name))
    return whole(as_it_starts(study), study)


def whole(design: Design, study: Study | None = None) -> Design:
    """Return the design as a run would have written it, readable again; what no part needs is infinite."""
    study = study or read_study_text(f"mode: {design.mode}\n", "a test")
    table = table_for(design.mode)
    needed = [*table.names(tuple(study.operating_points)), *(row.name for row in table.inputs if not row.per_point)]
    given_at = {f"{name}@{point}": value for point, at in study.operating_points.items() for name, value in at.items()}
    values = dict.fromkeys(needed, math.inf) | given_at | design.values
    return design.model_copy(
        update={"tvimdesign": __version__, "values": values, "study": study.model_dump(mode="json")}
    )


def broken_rules(design: Design) -> list[str]:
    """Rules of the layout that a design breaks."""
    return [
        row.name for row in table_for(design.mode).outputs
        if row.group in ("Gaps", "Layout") and row.name in design.values and row.exists(design.choices)
        for rule in row.rules
        if (design.values[row.name] - rule.value) * (1 if rule.sense == ">=" else -1) < -1e-12
    ]  # fmt: skip


class Made(NamedTuple):
    """Parts as the child process makes them, and what it said on the way."""

    design: Design
    report: CadReport
    steps: list[str]
    whole: bool
    """Whether every check on the solids was made."""


def random_blocks(seed: int) -> Design:
    """Return the first design of the compression module that keeps the rules, among random ones."""
    draw = np.random.default_rng(seed).uniform
    while True:
        inner, stroke = draw(9.0, 24.0), draw(0.03, 0.16)
        outer = inner + draw(4.0, 16.0)
        wire = draw(0.8, 2.4)
        coil = wire * draw(4.5, 9.0)
        ring = outer + draw(2.0, 8.0)
        lengths = {
            "wire_diameter": wire, "coil_diameter": coil, "placement_radius": ring + 0.5 * coil + 2.0 * wire,
            "pcl_inner_radius": inner, "pcl_outer_radius": outer, "core_radius": inner - draw(4.5, 6.0),
            "rotor_rim": draw(1.0, 6.0), "block_height": draw(2.0, 15.0), "vane_thickness": draw(2.0, 6.0),
            # Squeezed by a fifth to a half of its depth.
            "block_depth": 0.5 * (inner + outer) * stroke / draw(0.2, 0.5),
            "floor_thickness": draw(2.0, 6.0), "running_clearance": draw(0.2, 0.5), "window_ledge": draw(1.0, 2.5),
            "radial_clearance": 0.6, "pin_diameter": draw(2.0, 4.0), "wall_thickness": draw(1.5, 4.0), "hub_wall": 2.0,
        }  # fmt: skip
        numbers = {
            "stroke": stroke, "coil_count": draw(4.0, 10.0), "preload_angle": stroke + draw(0.02, 0.1),
            "pin_radius_ratio": draw(0.4, 0.6), "slot_share": draw(0.3, 0.7),
            "vane_count": float(round(draw(2.0, 8.0))), "spring_pairs": float(round(draw(1.0, 3.0))),
        }  # fmt: skip
        fastening = [name for name in WRIST if "screw" in name or name in ("notch_width", "thread_insert")]
        small = {name: WRIST[name] for name in fastening}
        overrides = small | {name: value * MM for name, value in lengths.items()} | numbers
        with np.errstate(invalid="ignore"):
            design = design_of(f"random {seed}", overrides, "compression")
        if broken_rules(design) == [] and all(np.isfinite(value) for value in design.values.values()):
            return design


def all_checks(design: Design, drawn: Mapping[str, Any]) -> list[Any]:
    """Run every check of sizes at rest, and of clearances from stop to stop."""
    from tvimdesign.cad.geometry.dimensions import dimensions
    from tvimdesign.cad.inspection.size_checks import POSITIONS, clearance_checks, rest_checks

    dims = dimensions(design)
    checks = rest_checks(design, dims, drawn)
    for share in POSITIONS:
        checks += clearance_checks(dims, drawn, share)
    return checks
