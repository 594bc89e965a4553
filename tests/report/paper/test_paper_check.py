"""The ledger computes what it prints."""

from __future__ import annotations

import json

import pytest

from tvimdesign.report.paper import paper_check, paper_claims
from tvimdesign.report.paper.paper_check import findings
from tvimdesign.report.paper.paper_claims import claims


@pytest.mark.parametrize(
    ("row", "numbers"),
    [
        # Worked by hand from the paper's table, or from its text.
        (0, ["1.4023", "12.41", "8.91", "4.17"]),
        (1, ["5.61", "N·m·rad"]),
        (2, ["18.5", "4.156e-04"]),
        (3, ["0.0966"]),
        (4, ["200", "600"]),
        (5, ["1579.2", "416%"]),
        (6, ["far face", "70 s at"]),
        (7, ["70.0 s", "140.0 s"]),
        (8, ["28.5", "5.61", "22.4"]),
    ],
)
def test_a_row_gives_the_numbers_of_the_paper_s_own_formulas(row: int, numbers: list[str]) -> None:
    computed = findings()[row].computed
    for number in numbers:
        assert number in computed


def test_every_claim_has_a_place_a_computation_and_a_verdict() -> None:
    rows = findings()
    assert len(rows) == len(claims()["rows"]) == 9
    assert all(row.claim and row.where and row.computed and row.verdict for row in rows)


def test_the_numbers_follow_the_stated_inputs(monkeypatch: pytest.MonkeyPatch) -> None:
    thicker = {**claims(), "numbers": {**claims()["numbers"], "wire_diameter": {"value": 4.826, "unit": "mm"}}}
    monkeypatch.setattr(paper_claims, "claims", lambda: thicker)
    assert "22.43" in findings()[0].computed or "22.44" in findings()[0].computed  # 2^4 times 1.4023


def test_scripts_get_json(capsys: pytest.CaptureFixture[str]) -> None:
    paper_check.print_paper_check(as_json=True)
    assert len(json.loads(capsys.readouterr().out)) == 9
