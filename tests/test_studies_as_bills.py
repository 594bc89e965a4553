"""What the bill of each shipped study says of what is bought: a number, a standard, or how it is ordered without."""

from __future__ import annotations

import re
from pathlib import Path

import cadquery as cq
import pytest
from cad_designs import as_it_starts
from support import STUDIES

from tvimdesign.cad.assembly.bill_of_materials import Item, as_ordered, beside, bill, fixtures
from tvimdesign.cad.assembly.module_parts import MODULES
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.jobs.main import _titles
from tvimdesign.study import read_study

PAPER = ("paper_", "calibrated_")
ORDERED = [path for path in STUDIES if not path.stem.startswith(PAPER)]
STANDARDS = r"ISO \d{3,}|EN \d{5}|ASTM A\d+|JIS G \d{4}|AWG \d+|\b606\d\b"
MAKERS = (
    r"ball bearing 6[78]\d\d|\b1MA10-|\bCP30\d{3}|\b9AR\b|\b5MA3SPF|\bG4A01\d{3}C|\bT[12]0\d{3}|Capa 6\d00|DP760"
    r"|\bB57(?:540G|862S)\d+|\bAMF58B-\d+|\bILM\d\d|\bAS50\d\d|ULTEM \d+"
)
NUMBERED = re.compile(f"{STANDARDS}|{MAKERS}")
TO_SIZE = {
    "preload_spring": r"flat wire, [\d.]+ x [\d.]+ x [\d.]+ mm, .* waves, .* free, wound to order",
    "peltier_pad": r"[\d.]+ ohm each, made to the outline of its STEP file",
    "liner": r"[\d.]+ mm thick, to the outline of its STEP file",
    "cover_insert": r"M\d", "link_insert": r"M\d", "insert": r"M\d",
}  # fmt: skip
"""Kinds that are made to sizes the bill tells, as no table of a maker was to be read."""
RATED = {
    "thermal_grease", "heat_conducting_adhesive", "polyimide_film", "thread_locker", "motor_adhesive", "mould_release",
    "supply", "driver",
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
    assert {"peltier_pad", "polymer", "thermal_cutout", "spring_right", "link_screw"} <= {one.kind for one in found}
    for one in found:
        ways = (
            NUMBERED.search(one.title),
            re.search(TO_SIZE.get(one.kind, "^$"), one.title),
            FIGURE.search(one.title) if one.kind in RATED else None,
        )
        assert any(ways), f"{one.kind}: {one.title}"
