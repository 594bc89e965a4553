"""`paper-check --out` writes the designs that take the paper's time, as tables and a figure."""

import csv
import json
from pathlib import Path

import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.report.paper import level_sets
from tvimdesign.report.paper.level_sets import write_level_sets

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(level_sets, "THICKNESSES", level_sets.THICKNESSES[::3])
        patch.setattr(level_sets, "AGAINST", {"hot_contact": [100.0, 1e4], "current": [1.5, 2.0, 2.5]})
        out = tmp_path_factory.mktemp("paper") / "out"
        write_level_sets(out, overwrite=False, as_json=True)
    return out


def _rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8-sig", newline="") as stream:
        return list(csv.DictReader(stream))


def test_the_table_the_grid_and_the_figure_are_written(folder: Path) -> None:
    rows = _rows(folder / "level_sets.csv")
    assert [(row["parameter"], row["value"]) for row in rows] == [
        ("hot_contact", "100"), ("hot_contact", "10000"), ("current", "1.5"), ("current", "2"), ("current", "2.5"),
    ]  # fmt: skip
    # The same module at the same current and contact, by either way to it.
    assert list(rows[1].values())[3:] == list(rows[2].values())[3:]
    # At 1.5 A no layer has its far face at 100 degC in 70 s; at 2 A one has, at 2.5 A a thicker one.
    far = "pcl_thickness for far_face_time [mm]"
    assert rows[2][far] == ""
    assert 0.2 < float(rows[3][far]) < float(rows[4][far]) < 2.0
    times = _rows(folder / "response_times.csv")
    assert len(times) == (2 + 3) * 3
    assert all(float(row["far_face_time [s]"]) > float(row["near_face_time [s]"]) for row in times)
    assert (folder / "level_sets.png").read_bytes().startswith(b"\x89PNG")
    assert set(json.loads((folder / "manifest.json").read_text())["files"]) == {
        *(f"{name}.{ending}" for name in ("level_sets", "paper_case") for ending in ("csv", "png", "pdf", "svg")),
        "paper_case_choices.csv", "response_times.csv",
    }  # fmt: skip
    with pytest.raises(InputError, match="--overwrite"):
        write_level_sets(folder, overwrite=False, as_json=True)
