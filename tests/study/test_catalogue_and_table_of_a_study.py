"""A study knows its catalogue and its table, and copies and pickles of it know theirs."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import pytest

from tvimdesign.base.errors import CatalogError
from tvimdesign.device import table_for
from tvimdesign.study import Study, given, read_study_text

ROOT = Path(__file__).parents[2]


@pytest.fixture
def study() -> Study:
    return read_study_text("mode: shear\nmodule: {pcl_thickness: 1 mm}\n", "a test")


@pytest.fixture
def mine(tmp_path: Path) -> str:
    shipped = ROOT / "tvimdesign/catalog/data/structure_materials/petg.yaml"
    (tmp_path / "structure_materials").mkdir()
    (tmp_path / "structure_materials/mine.yaml").write_text(shipped.read_text(encoding="utf-8"), encoding="utf-8")
    return str(tmp_path)


def test_the_catalogue_is_opened_once_and_the_table_is_the_mode_s(study: Study) -> None:
    assert study.catalog is study.catalog
    assert study.table is table_for("shear")


def test_a_copy_keeps_them_where_it_may(study: Study) -> None:
    stored = study.model_copy(update={"module": {}})
    assert stored.catalog is study.catalog
    assert stored.table is study.table


def test_a_copy_of_another_mode_has_that_table(study: Study) -> None:
    _ = study.table, study.catalog
    other = study.model_copy(update={"mode": "compression"})
    assert other.table is table_for("compression")
    assert other.catalog is study.catalog
    assert "block_depth" in given(other)


def test_a_copy_with_another_folder_reads_the_records_there(study: Study, mine: str) -> None:
    with pytest.raises(CatalogError, match="no record 'mine'"):
        study.catalog.record("structure_materials", "mine")
    other = study.model_copy(update={"catalog_folder": mine, "module": {"structure_material": "mine"}})
    assert given(other)["structure_material"].name == "mine"
    assert "mine" not in other.model_copy(update={"catalog_folder": None}).catalog.names("structure_materials")


def test_what_it_has_opened_is_no_part_of_it(study: Study, mine: str) -> None:
    fresh = Study.model_validate(study.model_dump())
    assert not {"catalog", "table"} & fresh.__dict__.keys()
    _ = fresh.catalog.record("structure_materials", "petg"), fresh.table
    assert fresh == Study.model_validate(study.model_dump())
    assert fresh.model_dump_json() == study.model_dump_json()
    stored = study.model_copy(update={"catalog_folder": mine})
    result = pickle.loads(pickle.dumps(stored))
    assert not {"catalog", "table"} & result.__dict__.keys()
    assert result == stored
    assert "mine" in result.catalog.names("structure_materials")
    assert copy.deepcopy(stored) == stored
