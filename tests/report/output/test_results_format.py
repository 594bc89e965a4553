"""results.json and results.csv: what each number is, in which units, how well it is known, and from where."""

import csv
import io
import json
from typing import Any

import jsonschema
import pytest
import yaml
from support import ROOT, cases_of, sample_text

from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.base.units import si_unit, to_si
from tvimdesign.device import Choice, table_for
from tvimdesign.report.output.numbers import FORMAT, curves_csv, number_entry, with_unit
from tvimdesign.report.output.tables import meaning, results, results_csv, results_schema, soft_in_words, stiff_in_words
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import read_study_text

TABLE = table_for("shear")
STUDY = sample_text("reported_results")


@pytest.mark.parametrize(
    ("metres", "words"),
    [(5.18e-5, "0.052 mm"), (7.799e-4, "0.78 mm"), (6.197e-3, "6.2 mm"), (2.5694e-2, "25.69 mm"), (0.1095, "109.5 mm"),
     (-5.783e-5, "-0.058 mm"), (3e-7, "0.0003 mm"), (0.0, "0 mm")],
)  # fmt: skip
def test_lengths_are_no_finer_than_a_workshop_measures(metres, words):
    assert with_unit(metres, "mm") == words


@pytest.fixture(scope="module")
def result() -> StudyResult:
    return answer(read_study_text(STUDY, "a test"))


@pytest.fixture(scope="module")
def reported(result: StudyResult) -> dict[str, Any]:
    plain: dict[str, Any] = json.loads(json.dumps(results(result), allow_nan=False))
    return plain


@pytest.fixture(scope="module")
def rows(result: StudyResult) -> dict[str, dict[str, str]]:
    text = results_csv(results(result)["values"])
    return {row["name"]: row for row in csv.DictReader(io.StringIO(text))}


def _record(name: str) -> dict[str, Any]:
    """Return a record as its file has it."""
    folder = ROOT / "tvimdesign/catalog/data/polymers"
    values: dict[str, Any] = yaml.safe_load((folder / f"{name}.yaml").read_text())["values"]
    return values


@pytest.mark.gate
def test_the_results_say_their_format_and_are_of_the_schema(reported):
    jsonschema.Draft202012Validator.check_schema(results_schema())
    jsonschema.validate(reported, results_schema())
    assert reported["format"] == FORMAT == 1
    assert reported["units"] == "SI"


@pytest.mark.gate
@pytest.mark.parametrize("wrong", ["format", "values", "unit", "more"])
def test_the_schema_refuses_what_is_not_of_the_format(reported, wrong):
    spoilt = json.loads(json.dumps(reported))
    if wrong == "format":
        spoilt["format"] = 2
    elif wrong == "values":
        del spoilt["values"]
    elif wrong == "unit":
        spoilt["values"]["module_mass"]["si"]["unit"] = 3
    else:
        spoilt["quarrel"] = {}
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.Draft202012Validator(results_schema()).validate(spoilt)


@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_the_si_unit_of_every_unit_is_si(mode):
    for unit in {row.unit for row in table_for(mode).quantities if not isinstance(row, Choice)}:
        assert to_si(1.0, si_unit(unit)) == pytest.approx(1.0, rel=1e-12), unit


def test_numbers_stand_in_their_unit_and_in_si_and_soft_has_its_meaning(reported, result):
    mass, target = (reported["values"][name] for name in ("module_mass", "target_temperature"))
    assert mass["value"] == pytest.approx(1e3 * result.design.values["module_mass"])
    assert (mass["unit"], mass["si"]["unit"]) == ("g", "kg")
    assert mass["si"]["value"] == result.design.values["module_mass"]
    assert (target["value"], target["si"]["value"]) == (pytest.approx(100.0), 373.15)
    assert (target["unit"], target["si"]["unit"]) == ("°C", "K")
    assert number_entry(float("inf"), "s")["value"] is None
    hot = result.design.values["joint_impedance@hot"]
    expected = f"soft: dynamic stiffness <= {2.0 * hot:.3g} N·m/rad at 1 Hz, twice that at the hot point"
    for name in ("softening_time", "response_time"):  # the switch ends when the joint is soft
        assert reported["values"][name]["note"] == expected
    assert reported["values"]["mean_time"]["note"] == ""


def test_values_have_status_range_and_source(rows, reported):
    assert rows.keys() == reported["values"].keys()
    assert float(rows["module_mass"]["value"]) == pytest.approx(reported["values"]["module_mass"]["value"])
    # What `based_on` takes from pcl_80k has that record's own words.
    written = {**_record("pcl_80k"), **_record("pcl_50k")}
    for name, field in {"pcl_conductivity_melt": "conductivity_melt", "pcl_melting_start": "melting_start"}.items():
        row, entry = rows[name], written[field]
        assert row["status"] == entry["status"]
        assert float(row["low"]) == pytest.approx(entry["low"])
        assert float(row["high"]) == pytest.approx(entry["high"])
        assert float(row["value"]) == pytest.approx(entry["value"])
        assert row["source"] == f"polymers/pcl_50k: {entry['source']}"
    assert (rows["pcl_latent_heat"]["status"], rows["pcl_latent_heat"]["source"]) == ("study", "set by the study")
    assert rows["current"]["status"] == "optimized"
    assert rows["temperature@hot"]["status"] == "study"
    assert rows["module_mass"]["status"] == "computed"
    # As inputs.yaml has it: the default's status, and its source apart from that.
    assert rows["softening_band"]["status"] == "chosen"
    assert rows["softening_band"]["source"] == "half to twice is what a hand tells apart"
    assert list(rows["module_mass"])[:7] == ["name", "value", "unit", "status", "low", "high", "source"]
    for name, row in rows.items():
        assert row["status"], name
        assert row["source"], name
        assert not row["source"].startswith("record: "), name


def test_tables_begin_with_the_mark_that_lets_excel_show_units(tmp_path):
    with ResultsFolder(tmp_path / "out") as folder:
        folder.write("curves.csv", curves_csv({"stiffness": [1.0]}, {"stiffness": "N*m/rad"}, "1"))
        folder.write("summary.txt", "N·m")
        folder.finish("done", {}, {})
    curves, other = (tmp_path / "out" / name for name in ("curves.csv", "summary.txt"))
    assert curves.read_bytes().startswith(b"\xef\xbb\xbf")
    assert curves.read_text("utf-8-sig").splitlines()[0] == "stiffness [N·m/rad]"
    assert not other.read_bytes().startswith(b"\xef\xbb\xbf")


@pytest.mark.gate
@cases_of("results_format", "stated_impedances")
def test_soft_and_stiff_are_shown_as_impedances(bands, soft, stiff):
    """By hand: band times 40, and 300 over the band."""
    stated = f"impedance_targets: stated, soft_impedance: 40 N.m/rad, stiff_impedance: 300 N.m/rad{bands}"
    study = read_study_text(f"mode: shear\nmodule: {{{stated}}}\n", "a test")
    answered = answer(study)
    assert soft_in_words(answered.design) == soft
    assert stiff_in_words(answered.design) == stiff
    assert meaning("softening_time", answered.design).endswith(f"(soft: {soft})")
    assert meaning("stiffening_time", answered.design).endswith(f"(stiff: {stiff})")
