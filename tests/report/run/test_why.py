"""Why this design: what the page says is what the account found, in words a reader can hold against the numbers."""

import csv
import io
from dataclasses import replace

import pytest
from small_studies import FOUR_SIZES_IN_SHEAR

from tvimdesign.device import table_for
from tvimdesign.report.run.blocks.requirements import requirements
from tvimdesign.report.run.blocks.tables import checks_grid
from tvimdesign.report.run.reasons import active, sentences, slack, why_csv, why_rows
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import read_study_text

TABLE = table_for("shear")
STUDY = f"""{FOUR_SIZES_IN_SHEAR}
require: {{spring_stiffness: [">= 5 N.m/rad", "<= 8 N.m/rad"], peak_power: "<= 9 W"}}
minimize: {{module_mass: 1, response_time: 1}}
solver: {{starts: 1}}
"""


@pytest.fixture(scope="module")
def found() -> StudyResult:
    return answer(read_study_text(STUDY, "a test"))


def test_more_stiffness_costs_mass_and_less_power_time(found: StudyResult) -> None:
    held = next(held for held in active(found) if held.name == "spring_stiffness_full_stroke >=")  # the least
    cost = held.sensitivity["module_mass"]
    assert 0.0 < cost < 1.0
    begin = "1 % more spring_stiffness_full_stroke (now >= 5 N·m/rad) costs"
    said = next(one for one in sentences(found) if one.startswith(begin))
    assert f"{cost:.2g} % module_mass" in said
    said = next(one for one in sentences(found) if "peak_power" in one)
    assert said.startswith("1 % less peak_power (now <= 9 W) costs")
    assert "response_time" in said


def test_each_limit_is_active_touches_or_has_room_in_its_order(found: StudyResult) -> None:
    rows = why_rows(found, TABLE)
    assert len(rows) == len(found.solution.held)
    by_text = {row["limit"]: row for row in rows}
    assert by_text["spring_stiffness_full_stroke >= 5 N·m/rad"]["stands"] == "active"
    assert by_text["spring_stiffness >= 5 N·m/rad"]["stands"] == "slack"  # at rest the springs are stiffer
    upper = by_text["spring_stiffness <= 8 N·m/rad"]
    assert upper["stands"] == "slack"
    assert upper["margin"] == pytest.approx(1.0 - found.design.value("spring_stiffness") / 8.0, rel=1e-3)
    for row in rows:
        assert (row["stands"] == "slack") == (row["margin"] > 0.0 and row["shadow_price"] < 1e-3) or row[
            "stands"
        ] == "touches"
    rooms = [held.margin for held in slack(found)]
    assert rooms == sorted(rooms)
    room = found.design.value("spring_stiffness_seven_tenths_stroke") / 5.0 - 1.0
    assert by_text["spring_stiffness_seven_tenths_stroke >= 5 N·m/rad"]["margin"] == pytest.approx(room, rel=1e-3)
    rows = list(csv.DictReader(io.StringIO(why_csv(found, TABLE))))
    first = active(found)[0]
    assert rows[0]["limit"] == first.text
    for name, saving in first.sensitivity.items():
        assert float(rows[0][f"sensitivity of {name} [%]"]) == pytest.approx(saving, rel=1e-5, abs=1e-12)


def test_a_limit_active_at_its_tolerance_margin_is_so_everywhere(found: StudyResult) -> None:
    costly = {held.text for held in active(found)}
    assert "peak_power <= 9 W" in costly
    checks = tuple(replace(each, margin=0.05, worst=0.05) for each in found.checks if each.text in costly)
    with_margins = replace(found, checks=checks)
    (row,) = [row for row in requirements(with_margins, {}) if row.name == "peak_power"]
    assert row.stands == "5 %, active"
    table = checks_grid(with_margins)
    assert len(table.rows) == len(checks) >= 2
    assert {row[0].text for row in table.rows} == {"active"}
