"""Laws that a record has from another material: told where they may hold, refused where they mean nothing."""

from pathlib import Path

import pytest

from tvimdesign.base.errors import CatalogError
from tvimdesign.base.record import Record
from tvimdesign.catalog import Catalog
from tvimdesign.catalog.category import inherited_law_warnings


def value(number: float, unit: str) -> str:
    return f"{{value: {number:g}, unit: {unit}, source: my bench, status: measured}}"


def record(folder: Path, base: str, words: str = "", tables: str = "", **values: tuple[float, str]) -> Record:
    (folder / "polymers").mkdir(exist_ok=True)
    lines = [f"title: Mine\nbased_on: {base}", words, "values:"]
    lines += [f"  {name}: {value(*entry)}" for name, entry in values.items()]
    (folder / "polymers/mine.yaml").write_text("\n".join([*lines, tables]) + "\n", encoding="utf-8")
    return Catalog(folder).record("polymers", "mine")


EVA = {"melting_start": (62.0, "degC"), "melting_end": (85.0, "degC"), "density_solid": (950.0, "kg/m^3"),
       "density_melt": (900.0, "kg/m^3"), "equilibrium_melting_temperature": (95.0, "degC")}  # fmt: skip
HALF_TIME = {"crystallization_half_time": (20.0, "s")}
VISCOSITY = {"zero_shear_viscosity": (200.0, "Pa*s")}


def test_laws_of_another_material_have_a_warning_each(tmp_path: Path) -> None:
    message = inherited_law_warnings(record(tmp_path, "pcl_80k", **EVA))
    assert [line.split(" are those of ")[0] for line in message] == [
        "Mine: the kinetics of freezing", "Mine: the viscosity of the melt", "Mine: the losses of the solid",
    ]  # fmt: skip
    assert all("Polycaprolactone, 80 kg/mol" in line and "melting_start" in line for line in message)
    assert "give crystallization_half_time or nucleation_constant or avrami_exponent of its own" in message[0]
    message = inherited_law_warnings(record(tmp_path, "pcl_80k", **EVA, **HALF_TIME, **VISCOSITY))
    assert len(message) == 1
    assert message[0].startswith("Mine: the losses of the solid")
    own = {"melting_start": (53.0, "degC"), "density_solid": (1150.0, "kg/m^3")}
    assert inherited_law_warnings(record(tmp_path, "pcl_80k", **own)) == []
    assert inherited_law_warnings(Catalog().record("polymers", "pcl_50k")) == []


@pytest.mark.parametrize("base", ["pcl_80k", "fields_metal"])
def test_a_wax_has_no_use_for_kinetics_and_is_refused_a_polymer_s_melt(tmp_path: Path, base: str) -> None:
    words = "words: {freezing: equilibrium}"
    own = {"density_solid": (880.0, "kg/m^3"), "density_melt": (770.0, "kg/m^3")}
    if base == "fields_metal":  # the same kind, another material
        message = inherited_law_warnings(record(tmp_path, base, words, **own))
        assert [line.partition(" are those")[0] for line in message] == [
            "Mine: the viscosity of the melt", "Mine: the losses of the solid",
        ]  # fmt: skip
        return
    with pytest.raises(CatalogError) as caught:
        record(tmp_path, base, words, **own)
    message = str(caught.value).splitlines()
    assert len(message) == 2
    assert "viscosity of the melt: those of pcl_80k mean nothing here, where freezing is equilibrium" in message[0]


def test_a_glass_needs_its_own_spectrum_and_constants(tmp_path: Path) -> None:
    words = "words: {freezing: equilibrium, softening: glass}"
    own = {"density_solid": (1250.0, "kg/m^3"), "glass_transition": (57.0, "degC"), "wlf_c1": (17.44, '"1"'),
           "wlf_c2": (51.6, "K"), "glass_activation_energy": (300.0, "kJ/mol")}  # fmt: skip
    with pytest.raises(CatalogError, match="losses of the solid: those of pcl_80k mean nothing here"):
        record(tmp_path, "pcl_80k", words, **own)
    assert inherited_law_warnings(record(tmp_path, "pla", words, **own)) == []
    with pytest.raises(CatalogError, match=r"values\.wlf_c1: missing; expected 1"):
        record(tmp_path, "pcl_80k", "words: {softening: glass}")
    with pytest.raises(CatalogError, match=r"values\.melting_end: must be above glass_transition"):
        record(tmp_path, "pla", glass_transition=(70.0, "degC"))


def test_words_that_are_left_out_are_a_polymer_s_that_melts(tmp_path: Path) -> None:
    text = Catalog().path("polymers", "pcl_80k").read_text(encoding="utf-8")
    (tmp_path / "polymers").mkdir()
    own = text.replace("words: {freezing: kinetics, softening: melting}\n", "")
    assert own != text
    (tmp_path / "polymers/mine.yaml").write_text(own, encoding="utf-8")
    assert Catalog(tmp_path).record("polymers", "mine").words == {"freezing": "kinetics", "softening": "melting"}


def test_a_resistivity_is_one(tmp_path: Path) -> None:
    with pytest.raises(CatalogError, match=r"values.resistivity.value: .*'10 mm'"):
        record(tmp_path, "pla", resistivity=(10.0, "mm"))
