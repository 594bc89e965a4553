"""The tutorial and the how-to pages: their files are written and their commands run, in the order of the page."""

import json
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import python_page
from support import ROOT, Command

import tvimdesign as tvim

DOCS = ROOT / "docs"
PAGES = ["tutorial.md", *(f"how-to/{path.name}" for path in sorted((DOCS / "how-to").glob("*.md")))]
QUICK = ["how-to/own-peltier.md", "how-to/my-printer.md", "how-to/scripts.md"]
"""Pages that every run of the tests goes through, without parts, plots and long virtual tests."""
LONG = {"cad", "simulate", "tolerate", "compare"}
_BLOCK = re.compile(r'^```(\w+)(?: title="([^"]+)")?\n(.*?)^```', re.M | re.S)


def _steps(page: str) -> Iterator[tuple[str, str]]:
    """What a page has one do, in order: ("FILE:name", text) or ("command", line)."""
    for language, title, text in _BLOCK.findall((DOCS / page).read_text()):
        if title:
            yield f"FILE:{title}", text
        elif language == "sh":
            yield from (("command", line) for line in text.splitlines() if line.strip())


def _place(tmp_path: Path) -> None:
    """A place like the repository: commands name studies and released parts by their path in it."""
    for name in ("studies", "cad"):
        (tmp_path / name).symlink_to(ROOT / name)


def _do(page: str, tvimdesign: Command, place: Path, more: list[str], skipped: set[str]) -> None:
    for kind, text in _steps(page):
        if kind != "command":
            file = place / kind.removeprefix("FILE:")
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
            continue
        program, *words = shlex.split(text, comments=True)
        if words[0] in skipped:
            continue
        if program == "python":
            done = subprocess.run([sys.executable, *words], cwd=place, capture_output=True, text=True, check=False)
        else:
            assert program == "tvimdesign", text
            done = tvimdesign(*words, *(more if words[0] == "run" else []), cwd=place)
        assert done.returncode == 0, f"{page}: {text}\n{done.stderr}\n{done.stdout}"


def _records(page: str, place: Path) -> None:
    """The record that the page on Peltier modules takes from the catalogue's page."""
    if "peltier" in page:
        for kind, text in _steps("catalogue.md"):
            file = place / kind.removeprefix("FILE:")
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)


@pytest.mark.gate
@pytest.mark.parametrize("page", QUICK)
def test_commands_of_a_page(page: str, tvimdesign: Command, tmp_path: Path) -> None:
    _place(tmp_path)
    _records(page, tmp_path)
    _do(page, tvimdesign, tmp_path, ["--no-plots"] if page != "how-to/scripts.md" else [], LONG)


@pytest.mark.slow
def test_measurements_of_the_page_become_records(tvimdesign: Command, tmp_path: Path) -> None:
    _do("how-to/measure.md", tvimdesign, tmp_path, [], LONG | {"run"})
    written = {path.stem for path in (tmp_path / "my_records").rglob("*.yaml")}
    assert written == {"my_wire", "my_pad", "my_melt", "my_module"}


def test_check_accepts_the_tutorial_s_study(tvimdesign: Command, tmp_path: Path) -> None:
    _do("tutorial.md", tvimdesign, tmp_path, [], LONG | {"run"})


def _check_the_tutorial_s_table(results: Path) -> None:
    values = {name: entry["value"] for name, entry in json.loads(results.read_text())["values"].items()}
    expected = {
        "hot stiffness": f"{values['joint_stiffness@hot']:.1f} N·m/rad",
        "torque held when frozen": f"{values['holding_torque']:.0f} N·m",
        "diameter": f"{values['envelope_diameter']:.0f} mm",
        "joint soft": f"{values['softening_time']:.0f} s",
        "mass": f"{values['module_mass']:.0f} g",
    }
    lines = (DOCS / "tutorial.md").read_text().splitlines()
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines if line.startswith("|")]
    assert {row[0]: row[2] for row in rows if row[0] in expected} == expected


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES)
def test_all_commands_of_a_page(page: str, process: Command, tmp_path: Path) -> None:
    _place(tmp_path)
    _records(page, tmp_path)
    _do(page, process, tmp_path, [], set())
    if page == "tutorial.md":
        _check_the_tutorial_s_table(tmp_path / "results/elbow/results.json")


@pytest.mark.parametrize("page", [page for page in PAGES if not page.endswith("index.md")])
def test_a_page_starts_with_its_command(page: str) -> None:
    start = (DOCS / page).read_text().split("\n\n")[1]
    assert re.search(r"(?:`|^|\n)(?:tvimdesign|make) \w", start), start


PAGE_CALLS = re.compile(r"(?<=`)(?:study|result)\b[.\[][^`]*")
WRITES = ("parts(", "robot(", "save(", "show(", "run(", "sweep(")


@pytest.mark.gate
def test_the_code_of_the_python_page_prints_the_numbers_beside_it(tmp_path: Path) -> None:
    page = python_page.PAGE.read_text()
    now, names = python_page.executed(page, tmp_path)
    assert now == page  # docs/make/python_page.py writes the numbers anew
    assert len(re.findall("# -> .*[0-9]", page)) >= 10
    assert (tmp_path / "results/thickness/cells.csv").exists()
    assert (tmp_path / "my_records/spring_materials/my_wire.yaml").exists()
    calls = {call for row in re.findall(r"^\| (.*?) \|", page, re.M) for call in PAGE_CALLS.findall(row)}
    tried = sorted(call for call in calls if not any(word in call for word in WRITES))
    assert len(tried) > 20
    for call in tried:
        value = eval(call, names)
        _ = value.resolved if isinstance(value, tvim.Study) else value
