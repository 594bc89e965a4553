"""Every shipped study but the paper's own is a module that somebody can order: read off file and answer."""

import re
from pathlib import Path

import cadquery as cq
import pytest
from answers import shipped_answer
from cad_designs import as_it_starts
from support import STUDIES, study_path

from tvimdesign.cad.assembly.assembly import MODULES
from tvimdesign.cad.assembly.bill_of_materials import Item, as_ordered, beside, bill, fixtures
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.jobs.main import _titles
from tvimdesign.study import Study, read_study
from tvimdesign.study.conditions import Case, refuse_unequal
from tvimdesign.study.sections.tolerances import standard_tolerances
from tvimdesign.study.study import Options

PAPER = "paper_"
"""How the names of the paper's own modules begin: they stay as it has them, advice and all."""
ORDERED = [path for path in STUDIES if not path.stem.startswith(PAPER)]
to_order = pytest.mark.parametrize("path", ORDERED, ids=lambda path: str(path.stem))
PAIR = ("wrist_joint", "wrist_compression")
"""Studies of the two modes that are asked the same."""


def _pair() -> list[Study]:
    return [read_study(study_path(name)) for name in PAIR]


@to_order
def test_a_study_requires_a_yield_of_parts_one_can_buy(path: Path) -> None:
    study = read_study(path)
    assert not study.accept
    assert study.robust is not None
    assert study.robust.share == pytest.approx(0.95)
    assert set(standard_tolerances(study.table)) <= set(study.tolerances), "`standard: true`, and what differs from it"
    free = study.vary.get("peltier_module")
    heaters = free.values if isinstance(free, Options) else [study.module.get("peltier_module", "flexible_1600")]
    assert "flexible_1600" not in heaters, "no maker's table has it"
    assert study.module.get("process", "print_petg") != "print_petg"
    assert study.tolerances["preload_angle"].adjustable == (study.module.get("preload_adjuster") == "rotary")


def test_both_of_the_pair_may_be_compared() -> None:
    shear, compression = pair = _pair()
    refuse_unequal([Case(study_path(name), study) for name, study in zip(PAIR, pair, strict=True)])
    both = (shear.module.keys() & compression.module.keys()) - shear.vary.keys() - compression.vary.keys()
    assert {one: shear.module[one] for one in both} == {one: compression.module[one] for one in both}


def test_both_modes_of_the_pair_are_asked_the_same() -> None:
    shear, compression = _pair()
    only_compression = {row.name for row in compression.table.outputs} - {row.name for row in shear.table.outputs}
    asked = {
        (limit.output, limit.sense, limit.limit)
        for limit in compression.require
        if limit.output not in only_compression
    }
    assert asked == {(limit.output, limit.sense, limit.limit) for limit in shear.require}
    for what in ("minimize", "operating_points", "robust"):
        assert getattr(shear, what) == getattr(compression, what), what
    both = shear.tolerances.keys() & compression.tolerances.keys()
    assert {one: shear.tolerances[one] for one in both} == {one: compression.tolerances[one] for one in both}
    assert shear.module["process"] == compression.module["process"]


@pytest.mark.slow
@to_order
def test_a_study_comes_to_an_optimum_that_95_percent_of_the_modules_keep(path: Path) -> None:
    found = shipped_answer(path.stem)
    assert found.design.status == "optimal"
    assert found.design.accepting == ()
    assert found.feasible
    assert found.solution is not None
    assert found.solution.yield_reached is not None
    assert found.solution.yield_reached.together >= 0.95


STANDARDS = r"ISO \d{3,}|EN \d{5}|ASTM A\d+|JIS G \d{4}|AWG \d+|\b606\d\b"
MAKERS = (
    r"ball bearing 6[78]\d\d|\b1MA10-|\bCP30\d{3}|\b9AR\b|\b5MA3SPF|\bG4A01\d{3}C|\bT[12]0\d{3}|Capa 6\d00|DP760"
    r"|\bB57(?:540G|862S)\d+|\bAMF58B-\d+|\bILM\d\d|\bAS50\d\d|ULTEM \d+"
)
NUMBERED = re.compile(f"{STANDARDS}|{MAKERS}")
TO_SIZE = {
    "preload_spring": r"flat wire, [\d.]+ x [\d.]+ x [\d.]+ mm, .* waves, .* free, wound to order",
    "heater": r"to the outline of its STEP file; resistance [\d.]+ ohm each, .* W each, at [\d.]+ V",
    "liner": r"[\d.]+ mm thick, to the outline of its STEP file",
    "cover_insert": r"M\d", "link_insert": r"M\d", "insert": r"M\d",
}  # fmt: skip
"""Kinds that are made to sizes the bill tells, as no table of a maker was to be read."""
RATED = {
    "thermal_grease", "heat_conducting_adhesive", "polyimide_film", "thread_locker", "motor_adhesive", "mould_release",
    "supply", "driver", "controller", "controller_supply", "wire_sleeve", "crimp_splice", "grease",
    "divider_resistor",
}  # fmt: skip
"""Kinds that any shop has, by a rating that the bill tells."""
FIGURE = re.compile(r"\d+(\.\d+)? (°C|V|A)\b")


def bought(path: Path) -> list[Item]:
    """The lines of the bill that are bought, of a study as it starts, as if it had been through its cycle."""
    design = as_it_starts(read_study(path))
    design.values.update(peak_peltier_temperature=356.0, peak_cold_side_temperature=340.0, peak_current=2.0)
    design.values.update(stiffening_peak_current=0.5, peak_voltage=9.0, stiffening_peak_voltage=1.0)
    titles = _titles(design)
    kinds = MODULES[design.mode].kinds(dimensions(design))
    parts = bill(design, titles, {f"{kind}_1": cq.Solid.makeBox(1.0, 1.0, 1.0) for kind in kinds})
    return [one for one in as_ordered([*parts, *beside(design, titles), *fixtures(design, titles)]) if not one.made]


@pytest.mark.parametrize("path", ORDERED, ids=lambda path: str(path.stem))
def test_bought_items_have_a_number_a_standard_or_sizes_to_order_by(path: Path) -> None:
    found = bought(path)
    assert {"heater", "polymer", "thermal_cutout", "spring_right", "link_screw"} <= {one.kind for one in found}
    for one in found:
        ways = (
            NUMBERED.search(one.title),
            re.search(TO_SIZE.get(one.kind, "^$"), one.title),
            FIGURE.search(one.title) if one.kind in RATED else None,
        )
        assert any(ways), f"{one.kind}: {one.title}"
