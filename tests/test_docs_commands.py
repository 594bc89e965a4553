"""The tutorial, its notebook and the how-to pages: their commands and cells run in order."""

import ast
import json
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from contextlib import chdir, contextmanager
from pathlib import Path
from typing import Any

import matplotlib as mpl
import pandas as pd
import pytest
import python_page
from matplotlib.figure import Figure
from support import ROOT, Command

import tvimdesign as tvim

DOCS = ROOT / "docs"
PAGES = ["tutorial.md", *(f"how-to/{path.name}" for path in sorted((DOCS / "how-to").glob("*.md")))]
QUICK = ["how-to/own-peltier.md", "how-to/my-printer.md", "how-to/scripts.md"]
"""Pages that every run of the tests goes through, without parts, plots and long virtual tests."""
LONG = {"cad", "simulate", "tolerate", "compare"}
_BLOCK = re.compile(r'^```(\w+)(?: title="([^"]+)")?\n(.*?)^```', re.M | re.S)


def _steps(page: str) -> Iterator[tuple[str, str]]:
    """Return the steps of a page in order: ("FILE:name", text) or ("command", line)."""
    for language, title, text in _BLOCK.findall((DOCS / page).read_text()):
        if title:
            yield f"FILE:{title}", text
        elif language == "sh":
            yield from (("command", line) for line in text.splitlines() if line.strip())


def _place(tmp_path: Path) -> None:
    """Make a folder like the repository: commands name studies and released parts by their path in it."""
    for name in ("studies", "cad"):
        (tmp_path / name).symlink_to(ROOT / name)


def _write(place: Path, kind: str, text: str) -> None:
    file = place / kind.removeprefix("FILE:")
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)


def _do(page: str, tvimdesign: Command, place: Path, more: list[str], skipped: set[str]) -> None:
    for kind, text in _steps(page):
        if kind != "command":
            _write(place, kind, text)
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
    """Return the record that the page on Peltier modules takes from the catalogue's page."""
    if "peltier" in page:
        for kind, text in _steps("catalogue.md"):
            _write(place, kind, text)


@pytest.mark.gate
@pytest.mark.parametrize("page", QUICK)
def test_commands_of_a_page(page, tvimdesign, tmp_path):
    _place(tmp_path)
    _records(page, tmp_path)
    _do(page, tvimdesign, tmp_path, ["--no-plots"] if page != "how-to/scripts.md" else [], LONG)


@pytest.mark.slow
def test_measurements_of_the_page_become_records(tvimdesign, tmp_path):
    _do("how-to/measure.md", tvimdesign, tmp_path, [], LONG | {"run"})
    written = {path.stem for path in (tmp_path / "my_records").rglob("*.yaml")}
    assert written == {"my_wire", "my_pad", "my_melt", "my_module"}


@pytest.mark.gate
def test_check_accepts_the_tutorial_s_study(tvimdesign, tmp_path):
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
def test_all_commands_of_a_page(page, process, tmp_path):
    _place(tmp_path)
    _records(page, tmp_path)
    _do(page, process, tmp_path, [], set())
    if page == "tutorial.md":
        _check_the_tutorial_s_table(tmp_path / "results/elbow/results.json")


PAGE_CALLS = re.compile(r"(?<=`)(?:study|result)\b[.\[][^`]*")
WRITES = ("parts(", "robot(", "save(", "show(", "run(", "sweep(")


@pytest.mark.gate
def test_the_code_of_the_python_page_prints_the_numbers_beside_it(tmp_path):
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


NOTEBOOK = json.loads((ROOT / "docs/tutorial.ipynb").read_text(encoding="utf-8"))
CODE = [cell for cell in NOTEBOOK["cells"] if cell["cell_type"] == "code"]


def shown(source: str, names: dict[str, Any]) -> Any:
    """Execute a cell; returns what its last line shows, as a notebook would."""
    tree = ast.parse(source)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), names)
    return eval(compile(ast.Expression(last.value), "cell", "eval"), names) if isinstance(last, ast.Expr) else None


def executed(cells: list[dict[str, Any]], names: dict[str, Any]) -> Iterator[Any]:
    for cell in cells:
        yield shown("".join(cell["source"]), names)


@contextmanager
def notebook(folder: Path, cells: list[dict[str, Any]]) -> Iterator[list[Any]]:
    """Execute cells in a folder; return what they show, then the names they leave, and the folder."""
    mpl.use("Agg")
    names: dict[str, Any] = {}
    with chdir(folder):
        yield [*executed(cells, names), names, folder]


@pytest.fixture(scope="module")
def outputs(tmp_path_factory: pytest.TempPathFactory) -> Iterator[list[Any]]:
    cells = [cell for cell in CODE if "slow" not in cell["metadata"].get("tags", ())]
    with notebook(tmp_path_factory.mktemp("tutorial"), cells) as ran:
        yield ran


@pytest.mark.slow
def test_it_shows_and_saves_a_study_results_tables_and_figures(outputs):
    kinds = [type(output) for output in outputs]
    assert kinds.count(tvim.Study) == 1
    assert kinds.count(tvim.Result) == 1
    assert kinds.count(pd.DataFrame) == 4
    assert kinds.count(Figure) == 2
    for output in outputs:
        if isinstance(output, pd.DataFrame):
            assert len(output) > 2
        if isinstance(output, Figure):
            assert output._repr_png_()[:4] == b"\x89PNG"  # what a notebook asks for
            assert any(line.get_xydata().size > 6 for axes in output.axes for line in axes.lines)
    names = outputs[-2]
    assert names["result"].status == "optimal"
    assert names["result"]["module_mass"] < names["drawn"]["module_mass"]
    swept = names["sweep"].table("response_time")
    assert list(swept.status) == ["evaluated"] * 4
    assert swept["response_time"].is_monotonic_increasing
    folder = outputs[-1] / "tutorial_results"
    assert {"manifest.json", "results.json", "design.json", "study.yaml", "plots"} <= {p.name for p in folder.iterdir()}


def test_the_notebook_is_kept_without_outputs():
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in CODE)


@pytest.mark.slow
def test_its_parts_are_made(outputs, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (parts,) = executed([cell for cell in CODE if "slow" in cell["metadata"].get("tags", ())], outputs[-2])
    assert any(file.suffix == ".step" and file.stat().st_size > 10_000 for file in parts.files)
    assert (parts.table()["level"] != "failure").all()
