"""Cases of validation/cases: read and judged; some compared here, all in the slow test."""

import ast
import re
import shutil
from pathlib import Path

import pytest
import run
from judging.case import CASES, CaseError, read_case, read_cases
from judging.figures import figure
from judging.outcome import INSIDE, KNOWN, OUTSIDE, outcome
from judging.page import page, values_csv
from support import ROOT, cases_of

QUICK = ("spring_shigley_10_8", "heater_pc_heat", "freezing_avrami", "layer_in_series", "part_fits_iso_286")
PAGE = ROOT / "docs/validation.md"
ALL = read_cases()


def copied(name: str, folder: Path, *changes: tuple[str, str]) -> Path:
    """Copy a case to a folder of its own, with replaced texts."""
    shutil.copytree(CASES / name, folder / name)
    path = folder / name / "case.yaml"
    text = path.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)
    return path


def test_sixty_cases_are_compared():
    assert sum(not case.open for case in ALL) >= 60
    assert all(case.source and case.title for case in ALL)
    assert all("issing" in case.open or "nothing is left" in case.open for case in ALL if case.open)


def test_the_page_has_every_case_its_verdict_and_its_figure():
    text = PAGE.read_text()
    for case in ALL:
        assert f"{{#{case.name}}}" in text, case.name
        assert (ROOT / f"docs/pictures/validation/{case.name}.svg").exists() is not bool(case.open)
    shares = re.findall(r"\| ([+-][0-9]+\.[0-9]{2})(|, [a-zA-Z ]+) \|$", text, re.MULTILINE)
    assert len(shares) == sum(not case.open for case in ALL)
    assert all((abs(float(share)) <= 1.0) == (not verdict) for share, verdict in shares)
    assert {verdict for _, verdict in shares} <= {"", f", {KNOWN}"}


@pytest.mark.parametrize("name", QUICK)
def test_a_case_is_inside_its_limit(name):
    compared = outcome(read_case(CASES / name / "case.yaml"))
    assert compared.verdict == INSIDE
    assert b"<svg" in figure(compared)
    assert compared.case.source[1:] in page([compared])
    assert values_csv([compared]).count("\n") == 1 + sum(len(part.rows) for part in compared.quantities)


@cases_of("validation_cases", "wrong_numbers")
def test_a_wrong_number_fails_the_run(name, old, new, tmp_path, capsys):
    copied(name, tmp_path)
    assert run.main(["--folder", str(tmp_path), name]) == 0
    shutil.rmtree(tmp_path / name)
    copied(name, tmp_path, (old, new))
    assert run.main(["--folder", str(tmp_path), name]) == 1
    assert f"{OUTSIDE:<17}{name}" in capsys.readouterr().out


def test_a_known_page_accepts_what_it_lists_as_outside(tmp_path):
    name = "part_fits_iso_286"
    copied(name, tmp_path / "cases", ("values: [10, 15,", "values: [10, 16,"))
    known = tmp_path / "known.md"
    command = ["--folder", str(tmp_path / "cases"), name, "--known", str(known)]
    known.write_text(page([outcome(read_case(CASES / name / "case.yaml"))]))
    assert run.main(command) == 1
    known.write_text(page([outcome(read_case(tmp_path / "cases" / name / "case.yaml"))]))
    assert run.main(command) == 0


def test_a_failed_comparison_fails_the_run_and_leaves_the_page(tmp_path, capsys):
    copied("part_fits_iso_286", tmp_path / "cases", ("[H7, 3]", "[Q7, 3]"))
    copied("part_bearing", tmp_path / "cases")
    assert run.main(["--folder", str(tmp_path / "cases"), "--docs", str(tmp_path / "docs")]) == 1
    message = capsys.readouterr().out
    assert "cannot be compared: part_fits_iso_286: GeometryError: tolerance class 'Q7'" in message
    assert f"{INSIDE:<17}part_bearing" in message
    assert not (tmp_path / "docs").exists()


def test_a_known_difference_that_is_gone_or_has_grown_is_outside(tmp_path):
    name = "heater_electracool_heat"
    assert outcome(read_case(copied(name, tmp_path / "as it is"))).verdict == KNOWN
    gone = copied(name, tmp_path / "gone", ("value: 32", "value: 37.3"))
    grown = copied(name, tmp_path / "grown", ("value: 32", "value: 22"))
    assert outcome(read_case(gone)).verdict == outcome(read_case(grown)).verdict == OUTSIDE


@cases_of("validation_cases", "lacks")
def test_a_case_that_lacks_something_is_refused_by_name(old, new, message, tmp_path):
    path = copied("heater_electracool_heat", tmp_path, (old, new))
    with pytest.raises(CaseError, match=re.escape(message)) as refused:
        read_case(path)
    assert str(path) in str(refused.value)


def test_references_do_not_import_the_product():
    for path in (ROOT / "validation/references").glob("*.py"):
        nodes = list(ast.walk(ast.parse(path.read_text())))
        names = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
        names |= {node.module or "" for node in nodes if isinstance(node, ast.ImportFrom)}
        assert not [name for name in names if name.split(".")[0] in ("tvimdesign", "comparisons")], path.name


@pytest.mark.slow
def test_every_case_is_inside_or_a_known_difference(tmp_path):
    assert run.main(["--docs", str(tmp_path)]) == 0
    made, committed = ((folder / "validation.md").read_text() for folder in (tmp_path, ROOT / "docs"))
    assert sections(made) == sections(committed)


def sections(text: str) -> list[str]:
    """Return headings and sources of a page, without numbers, which round differently on another machine."""
    return [line for line in text.splitlines() if not line.startswith("|")]
