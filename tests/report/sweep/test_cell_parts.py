"""Parts of chosen cells of a sweep: each in a folder of its own, whoever makes them."""

from __future__ import annotations

import csv
import json
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from local_cluster import LocalCluster, answered_on
from small_sweeps import swept
from support import Command

from tvimdesign.base.errors import InputError
from tvimdesign.base.journal import UNFINISHED
from tvimdesign.cad.cad_report import CadReport
from tvimdesign.report.output import shared_folder
from tvimdesign.report.output.shared_folder import CellsAsked, answered_cells, own_half_made
from tvimdesign.report.sweep import cell_parts
from tvimdesign.report.sweep.cell_parts import PartsWork, chosen_cells, make_parts_of_cells, parts_asked
from tvimdesign.report.sweep.swept_cells import open_cells
from tvimdesign.study.design import read_design
from tvimdesign.sweep.run_sweep import SweepDone, Where
from tvimdesign.sweep.work import Cell

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
            parts_asked(cells, chosen_cells(words, cells), sweep)
    with pytest.raises(InputError, match="cell 3: it has no answer, so no parts"):
        parts_asked(cells, [3], sweep)


def test_a_cells_files_come_with_its_answer(sweep: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The design is the cell's own; parts are not made here."""
    seen: list[Any] = []

    def made(design: Path, out: Path, _: Any) -> CadReport:
        assert (
            design.parent.parent == (sweep / UNFINISHED).resolve()
        )  # what a worker that is killed leaves is found there
        assert design.parent.name.startswith(".cells-")
        seen.append(read_design(design))
        (out / "step").mkdir(parents=True)
        (out / "step/link.step").write_bytes(b"link")
        (out / ".half.part").write_bytes(b"none")
        return CadReport(out, (), (), {}, (), ())

    monkeypatch.setattr(cell_parts, "make_parts_of", made)
    asked = parts_asked(open_cells(sweep), [2], sweep)
    assert isinstance(asked.work, PartsWork)
    (sweep / UNFINISHED).mkdir()
    answered = asked.work.answer(Cell(asked.keys[0], asked.texts(0)))
    assert (answered.status, answered.reason) == ("made", "")
    assert [name for name, _ in answered.files] == ["cell-2/cad/step/link.step", "cell-2/design.json"]
    assert json.loads(str(answered.values[2])) == [name for name, _ in answered.files]
    assert seen[0].values["pcl_inner_radius"] == pytest.approx(21e-3, rel=1e-12)
    with (sweep / "cells.csv").open(encoding="utf-8-sig", newline="") as stream:
        mass = float(list(csv.DictReader(stream))[1]["module_mass"])
    assert seen[0].values["module_mass"] * 1e3 == pytest.approx(mass, rel=1e-10)


@pytest.mark.parametrize("array", [False, True])
def test_what_killed_workers_leave_goes_with_the_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, array: bool
) -> None:
    """Another job of the array may be at work in the same folder: what is its own stays."""
    folder = tmp_path / UNFINISHED
    own, other = folder / f"{own_half_made('.cells-')}x", folder / ".cells-elsewhere-7-x"

    def interrupted(*_: Any) -> SweepDone:
        (own / "cad").mkdir(parents=True)
        (other / "cad").mkdir(parents=True)
        raise KeyboardInterrupt

    asked = CellsAsked(PartsWork(()), [], lambda _: (), half_made=".cells-")
    monkeypatch.setattr(shared_folder, "run_cells", interrupted)
    where = Where(part=(1, 2) if array else (1, 1))
    with pytest.raises(KeyboardInterrupt), ExitStack() as stack:
        answered_cells(stack, tmp_path, asked, where, lambda _: None, overwrite=False, resume=False)
    assert not own.exists()
    assert other.exists() == array


def test_options_of_shared_work_without_cells_are_refused(tvimdesign: Command, sweep: Path) -> None:
    done = tvimdesign("cad", sweep / "study.yaml", "--shard", "1/2")
    assert done.returncode == 2
    assert "are for cells of a sweep: name some by --cells" in done.stderr


@pytest.mark.slow
def test_parts_by_an_array_and_by_a_cluster_are_those_of_one_process(
    tvimdesign: Command, sweep: Path, tmp_path: Path
) -> None:
    make_parts_of_cells(sweep, tmp_path / "one", "1,2", Where(workers=1), overwrite=False, resume=False, as_json=True)
    expected = _files(tmp_path / "one")
    assert len([name for name in expected if name.startswith("cell-2/cad/step/")]) > 5
    for part in (2, 1):
        words = ["--cells", "1,2", "--workers", 1, "--shard", f"{part}/2", "--out", tmp_path / "array"]
        done = tvimdesign("cad", sweep, *words)
        assert done.returncode == 0, done.stderr
        assert (tmp_path / "array/parts.csv").exists() == (part == 1)
    assert _files(tmp_path / "array") == expected
    with LocalCluster(tmp_path) as cluster:
        asked = parts_asked(open_cells(sweep), [1, 2], tmp_path / "cluster")
        answered_on(cluster, asked, tmp_path / "cluster", {0: lambda: cluster.kill_worker(1)})
    done = tvimdesign("cad", sweep, "--cells", "1,2", "--resume", "--out", tmp_path / "cluster")
    assert done.returncode == 0, done.stderr
    assert "parts of cell 1 of" not in done.stderr
    assert _files(tmp_path / "cluster") == expected
    (tmp_path / "cluster/cell-1/design.json").unlink()
    gone = tvimdesign("cad", sweep, "--cells", "1,2", "--resume", "--out", tmp_path / "cluster")
    assert gone.returncode == 2
    assert "design.json: is gone since it was made" in gone.stderr


def _files(out: Path) -> dict[str, bytes]:
    """Parts and table; the manifest has times, the shards too."""
    paths = [path for path in out.rglob("*") if path.is_file() and path.parent.name != "shards"]
    return {str(path.relative_to(out)): path.read_bytes() for path in paths if path.name != "manifest.json"}
