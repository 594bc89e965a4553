"""Records that contradict themselves are named where people look: in `check` and at the end of a run."""

from pathlib import Path

import pytest
from support import study_path

from tvimdesign.catalog import Catalog
from tvimdesign.report.run.check_study import describe
from tvimdesign.study import Study, read_study
from tvimdesign.study.resolve import record_checks

STUDY = "tvimdesign: 1\nname: Doubt\nmode: shear\ncatalog: records\nmodule: {peltier_module: bench}\n"


@pytest.fixture
def shipped() -> Path:
    return Path(str(Catalog().path("peltiers", "teci_12706")))


def _cut_to_size(sheet: Path) -> str:
    """Return the sheet of a module that is cut to the PCL."""
    bulk = "values:\n  bulk_modulus: {value: 1, unit: GPa, status: datasheet, source: a test}\n"
    text = sheet.read_text(encoding="utf-8").replace("form: rigid", "form: flexible")
    return text.replace("values:\n", bulk, 1)


def _study(folder: Path, record: str) -> Study:
    (folder / "records" / "peltiers").mkdir(parents=True, exist_ok=True)
    (folder / "records" / "peltiers" / "bench.yaml").write_text(record, encoding="utf-8")
    (folder / "study.yaml").write_text(STUDY, encoding="utf-8")
    return read_study(folder / "study.yaml")


def test_only_sheets_that_contradict_themselves_are_reported(shipped: Path, tmp_path: Path) -> None:
    study = _study(tmp_path, _cut_to_size(shipped))
    (message,) = record_checks(study)
    # S^2 T^2/(2 R) is V_max^2/(2 R) at the sheet's own 27 degC: 15.8^2/(2 * 2.0455) = 61.0 W.
    assert "61 W, the sheet says 51 W" in message
    assert message in describe(study).splitlines()
    text = _cut_to_size(shipped)
    study = _study(tmp_path, text.replace("value: 51, unit: W", "value: 58, unit: W"))
    assert record_checks(study) == []
    study = read_study(study_path("paper_shear"))
    assert record_checks(study) == []


def test_another_material_with_the_polymer_s_laws_is_reported_on_the_page(tmp_path: Path) -> None:
    """Describe a metal by a few numbers of its own, based on a polymer."""
    folder = tmp_path / "records/polymers"
    folder.mkdir(parents=True)
    own = "{value: 7900, unit: kg/m^3, source: a scale, status: measured}"
    (folder / "metal.yaml").write_text(
        f"title: My metal\nbased_on: pcl_80k\nvalues: {{density_solid: {own}}}\n", encoding="utf-8"
    )
    (tmp_path / "study.yaml").write_text(
        "mode: shear\ncatalog: records\nmodule: {pcl_grade: metal}\n", encoding="utf-8"
    )
    study = read_study(tmp_path / "study.yaml")
    message = record_checks(study)
    assert [line.partition(" are those")[0].removeprefix("My metal: the ") for line in message] == [
        "kinetics of freezing", "viscosity of the melt", "losses of the solid",
    ]  # fmt: skip
    assert message[0] in describe(study).splitlines()
