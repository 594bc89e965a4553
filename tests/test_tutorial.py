"""The tutorial's notebook runs from its first cell to its last, and shows what it says it shows."""

import ast
import json
from collections.abc import Iterator
from contextlib import chdir, contextmanager
from pathlib import Path
from typing import Any

import matplotlib as mpl
import pandas as pd
import pytest
from matplotlib.figure import Figure
from support import ROOT

import tvimdesign as tvim

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
    """What cells show that are executed in a folder, then the names they leave, and the folder."""
    mpl.use("Agg")
    names: dict[str, Any] = {}
    with chdir(folder):
        yield [*executed(cells, names), names, folder]


@pytest.fixture(scope="module")
def outputs(tmp_path_factory: pytest.TempPathFactory) -> Iterator[list[Any]]:
    cells = [cell for cell in CODE if "slow" not in cell["metadata"].get("tags", ())]
    with notebook(tmp_path_factory.mktemp("tutorial"), cells) as found:
        yield found


@pytest.mark.slow
def test_its_cells_up_to_the_first_figure_show_a_study_and_its_optimum(tmp_path: Path) -> None:
    first = next(i for i, cell in enumerate(CODE) if ".plot(" in "".join(cell["source"]))
    with notebook(tmp_path, CODE[: first + 1]) as found:
        kinds = [type(output) for output in found]
        assert [kinds.count(kind) for kind in (tvim.Study, tvim.Result, pd.DataFrame, Figure)] == [1, 1, 3, 1]
        assert found[-2]["result"].status == "optimal"
        assert found[-2]["result"]["module_mass"] < found[-2]["drawn"]["module_mass"]


@pytest.mark.slow
def test_it_shows_and_saves_a_study_results_tables_and_figures(outputs: list[Any]) -> None:
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


def test_the_notebook_is_kept_without_outputs() -> None:
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in CODE)


@pytest.mark.slow
def test_its_parts_are_made(outputs: list[Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (parts,) = executed([cell for cell in CODE if "slow" in cell["metadata"].get("tags", ())], outputs[-2])
    assert any(file.suffix == ".step" and file.stat().st_size > 10_000 for file in parts.files)
    assert (parts.table()["level"] != "failure").all()
