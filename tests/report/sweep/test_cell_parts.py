"""Parts of chosen cells of a sweep: each in a folder of its own."""

import csv
import json
from pathlib import Path
from typing import Any

import pytest
from small_sweeps import swept
from support import Command

from tvimdesign.base.atomic_files import atomic_write, make_folder
from tvimdesign.base.errors import GeometryError, InputError
from tvimdesign.cad.cad_report import CadReport
from tvimdesign.report.sweep import sweep_study as cell_parts
from tvimdesign.report.sweep.sweep_study import chosen_cells, make_parts_of_cells
from tvimdesign.study.design import read_design
from tvimdesign.sweep.swept_cells import open_cells

STUDY = """
mode: shear
name: small
solver: {cells: 6}
sweep: {over: {pcl_inner_radius: [20 mm, 21 mm, 70 mm]}}
"""
"""The last cell is no module."""


@pytest.fixture(scope="module")
def sweep(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("cells")
    (folder / "small.yaml").write_text(STUDY)
    swept(folder / "small.yaml", folder / "out", workers=1)
    return folder / "out"


def test_cells_are_named_by_numbers_ranges_and_as_the_best(sweep: Path) -> None:
    cells = open_cells(sweep)
    assert chosen_cells("2, 1-2,3", cells) == [2, 1, 3]
    assert chosen_cells("best", cells) == list(cells.best)
    wrong = {"x": "'x' is no cell", "2-1": "'2-1' is no cell", "0": "cell 0", "2-4": "the cells 1 to 3"}
    for words, said in wrong.items():
        with pytest.raises(InputError, match=said):
            cells.cell(chosen_cells(words, cells)[0])
    with pytest.raises(InputError, match="cell 3: it has no answer, so no parts"):
        make_parts_of_cells(sweep, sweep.parent / "parts", "1-3", overwrite=False, as_json=True)


def test_each_cell_has_the_parts_of_its_own_module(
    sweep: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The design is the cell's own; parts are not made here."""
    seen: list[Any] = []

    def made(design: Path, out: Path, _: Any) -> CadReport:
        seen.append(read_design(design))
        make_folder(out)
        atomic_write(out / "link.step", b"link")
        if len(seen) == 2:
            raise GeometryError("link: cannot be drawn")
        return CadReport(out, (), (), {}, (), ())

    monkeypatch.setattr(cell_parts, "make_parts_of", made)
    with pytest.raises(GeometryError, match="cell 1: not made: link: cannot be drawn"):
        make_parts_of_cells(sweep, tmp_path / "out", "2,1", overwrite=False, as_json=True)
    assert seen[0].values["pcl_inner_radius"] == pytest.approx(21e-3, rel=1e-12)
    with (sweep / "cells.csv").open(encoding="utf-8-sig", newline="") as stream:
        mass = float(list(csv.DictReader(stream))[1]["module_mass"])
    assert seen[0].values["module_mass"] * 1e3 == pytest.approx(mass, rel=1e-10)
    rows = json.loads((tmp_path / "out/parts.json").read_text())["cells"]
    assert [(row["cell"], row["status"]) for row in rows] == [(2, "made"), (1, "not_made")]
    assert (tmp_path / "out/cell-2/cad/link.step").read_bytes() == b"link"


@pytest.mark.slow
def test_parts_of_cells_are_whole(tvimdesign: Command, sweep: Path, tmp_path: Path) -> None:
    done = tvimdesign("cad", sweep, "--cells", "1,2", "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert len(list((tmp_path / "out/cell-2/cad/step").iterdir())) > 5
