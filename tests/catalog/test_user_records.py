"""A user's folder adds and replaces records; broken files and misplaced laws are errors in words."""

import os
import time
from contextlib import nullcontext
from pathlib import Path

import pytest
from every import check_records
from support import ROOT, cases_of, refused, sample_text

from tvimdesign.base.errors import CatalogError, FolderWarning
from tvimdesign.base.record import Record
from tvimdesign.catalog import Catalog
from tvimdesign.catalog.category import inherited_law_warnings
from tvimdesign.device.core.impedance.joint_impedance import melt_modes

GOOD = sample_text("user_polymer")


def put(folder: Path, text: str | bytes, category: str = "heaters", name: str = "mine") -> Catalog:
    """Write one user record and return the catalogue that sees it."""
    (folder / category).mkdir(exist_ok=True)
    (folder / category / f"{name}.yaml").write_bytes(text.encode() if isinstance(text, str) else text)
    return Catalog(folder)


def refusal(folder: Path, text: str | bytes, category: str = "heaters") -> str:
    """Return the error of a record that is no good; it names the file, and `check_records` names it as well."""
    catalog = put(folder, text, category)
    with pytest.raises(CatalogError) as caught:
        catalog.record(category, "mine")
    assert str(folder / category / "mine.yaml") in str(caught.value)
    assert any("mine.yaml" in problem for problem in check_records(catalog))
    return str(caught.value)


def test_a_user_record_adds_to_the_shelf_or_replaces(tmp_path):
    catalog = put(tmp_path, GOOD)
    assert catalog.names("heaters") == sorted([*Catalog().names("heaters"), "mine"])
    record = catalog.record("heaters", "mine")
    assert record.value("conductance") == pytest.approx(0.11)
    assert record.value("thickness") == pytest.approx(1.524e-3)
    assert record.entry("max_temperature").value == pytest.approx(383.15)
    assert record.word("form") == "flexible"
    assert record.file == str(tmp_path / "heaters" / "mine.yaml")
    assert check_records(catalog) == []
    catalog = put(tmp_path, GOOD, name="flexible_1600")
    assert catalog.record("heaters", "flexible_1600").title == "A module I measured"
    assert catalog.record("heaters", "qc_17").title == "QC-17-1.0-2.5AS"


@pytest.mark.parametrize(("good", "bad", "message"), refused("records"))
def test_a_broken_record_is_named(tmp_path, good, bad, message):
    assert good in GOOD
    assert message in refusal(tmp_path, GOOD.replace(good, bad, 1))


def test_all_problems_are_named_at_once(tmp_path):
    text = GOOD.replace(", unit: mV/K", "").replace("source: scale", "sauce: scale").replace("flexible", "floppy")
    problems = check_records(put(tmp_path, text))
    assert len(problems) == 4
    assert all(str(tmp_path) in problem for problem in problems)


WIRE = "title: w\ntables:\n  sizes: {{columns: {columns}, rows: {rows}, source: s, status: {status}}}\n"


@pytest.mark.parametrize(("columns", "rows", "status", "message"), refused("record_tables"))
def test_a_broken_table_is_named(tmp_path, columns, rows, status, message):
    assert message in refusal(tmp_path, WIRE.format(columns=columns, rows=rows, status=status), "wires")


DATA = ROOT / "tvimdesign/catalog/data"
PCL = (DATA / "polymers/pcl_80k.yaml").read_text(encoding="utf-8")


OWN_SPECTRUM = sample_text("user_spectrum")
"""The sum of modulus times time is 3491 Pa s, that of the moduli 1.000 MPa."""


def test_spectra_agree_with_viscosity_and_plateau(tmp_path):
    record = put(tmp_path, OWN_SPECTRUM, category="polymers").record("polymers", "mine")
    assert melt_modes(record) == [(1e-2, 2.5e5), (4e-3, 2.4e5), (1e-4, 3e5), (1e-5, 1e5), (1e-6, 6e4), (1e-7, 5e4)]
    lines = [line for line in OWN_SPECTRUM.splitlines() if "zero_shear" not in line]
    record = put(tmp_path, "\n".join(lines), category="polymers").record("polymers", "mine")
    assert record.value("zero_shear_viscosity") == pytest.approx(3491.07, rel=1e-5)
    text = "title: thin\nbased_on: pcl_80k\nvalues:\n" + "\n".join(
        f"  {name}: {{value: {value}, unit: Pa{unit}, source: ours, status: measured}}"
        for name, value, unit in (("zero_shear_viscosity", 42.002095, "*s"), ("plateau_modulus", 9500, ""))
    )
    catalog = put(tmp_path, text, category="polymers")
    shipped, thin = (melt_modes(catalog.record("polymers", name)) for name in ("pcl_80k", "mine"))
    for (slow, modulus), (own_slow, own_modulus) in zip(shipped, thin, strict=True):
        assert own_slow == pytest.approx(slow)
        assert own_modulus == pytest.approx(0.01 * modulus)


@cases_of("user_records", "laws")
def test_a_spectrum_or_strength_that_cannot_be_is_named_in_a_line(tmp_path, base, good, bad, message):
    category = "spring_materials" if base == "music_wire" else "polymers"
    text = OWN_SPECTRUM if base == "spectrum" else (DATA / category / f"{base}.yaml").read_text(encoding="utf-8")
    assert good in text
    refused = refusal(tmp_path, text.replace(good, bad, 1), category)
    assert message in refused
    assert bad == "" or len(refused.splitlines()) == 1  # without a mode the sums are other ones, too


def test_a_based_record_keeps_what_its_base_has(tmp_path):
    own = {
        "first": ("petg", "density: {value: 1300, unit: kg/m^3"),
        "second": ("first", "youngs_modulus: {value: 3, unit: GPa"),
    }
    for name, (base, value) in own.items():
        text = f"title: {name}\nbased_on: {base}\nvalues:\n  {value}, source: scale, status: measured}}\n"
        catalog = put(tmp_path, text, "structure_materials", name)
    petg, result = (catalog.record("structure_materials", name) for name in ("petg", "second"))
    assert result.title == "second"
    assert (result.value("density"), result.entry("density").source) == (1300.0, "scale")
    assert result.value("youngs_modulus") == pytest.approx(3e9)
    assert result.entry("specific_heat") == petg.entry("specific_heat")
    assert set(result.entries) == set(petg.entries)
    text = "title: mine\nbased_on: qc_17\nvalues: {mass: {value: 9, unit: g, source: scale, status: measured}}"
    result = put(tmp_path, text, name="qc_17").record("heaters", "qc_17")
    assert result.value("mass") == pytest.approx(9e-3)
    assert result.entry("area") == Catalog().record("heaters", "qc_17").entry("area")


@cases_of("user_records", "bases")
def test_what_a_record_cannot_be_based_on_is_named(tmp_path, bases, message):
    for name, base in bases.items():
        catalog = put(tmp_path, f"title: {name}\nbased_on: {base}\n", name=name)
    with pytest.raises(CatalogError) as caught:
        catalog.record("heaters", "a")
    assert message in str(caught.value)
    assert str(tmp_path) in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        b"",
        b"\x00\x01\xff\xfe binary",
        b"just words",
        b"title: [",
        b"title: !!python/object/apply:os.system ['true']",
        b"a: &a [1]\nb: *a",
        b"[" * 900_000,
        b"a: " * 200_000,
        b"".join(b"k%d: 1\n" % number for number in range(20_000)),
        b"<<: {a: b}",
        b"title: x\nvalues: 5\ntables: x\nwords: [a]",
        b"title: x\nvalues: {a: {value: 1, unit: " + b"m" * 5000 + b"}}",
        b"a: b\n---\nc: d",
        b"\xef\xbb\xbftitle: 1:30",
    ],
    ids=lambda text: repr(text[:20]),
)
def test_rubbish_is_a_short_error_within_a_second(tmp_path, text):
    start = time.process_time()
    refused = refusal(tmp_path, text)
    assert time.process_time() - start < 1.0  # though it is read twice
    assert len(refused) < 20_000


def test_pipes_folders_and_wrong_shelves_are_named(tmp_path):
    (tmp_path / "wires" / "folder.yaml").mkdir(parents=True)
    os.mkfifo(tmp_path / "wires" / "pipe.yaml")
    (tmp_path / "wires" / "gone.yaml").symlink_to(tmp_path / "nowhere")
    for name in ("folder", "pipe", "gone"):
        with pytest.raises(CatalogError, match="no file"):
            Catalog(tmp_path).record("wires", name)
    with pytest.raises(CatalogError, match="not there"):
        Catalog(tmp_path / "nowhere")
    (tmp_path / "heater").mkdir()
    with pytest.raises(CatalogError, match="did you mean heaters"):
        Catalog(tmp_path)


OURS = "title: ours\nbased_on: pcl_80k\nvalues:\n  %s\n"


@pytest.mark.parametrize(("molar_mass", "viscosity"), [(50, 660.0), (80, 4200.0), (120, 20750.0)])
def test_viscosity_of_a_melt_follows_from_its_molar_mass(tmp_path, molar_mass, viscosity):
    # Published for melts at 100 degC: up to 660 Pa s at 50, 4.2 kPa s at 80 and 21 kPa s at 120 kg/mol.
    text = OURS % f"molar_mass: {{value: {molar_mass}, unit: kg/mol, source: our GPC, status: measured}}"
    entry = put(tmp_path, text, category="polymers").record("polymers", "mine").entry("zero_shear_viscosity")
    assert entry.value == pytest.approx(viscosity, rel=2e-3)
    assert entry.low < 0.7 * entry.value < 1.1 * entry.value < entry.high
    assert "molar_mass" in entry.source


def test_molar_masses_give_viscosities_where_none_was_measured(tmp_path):
    mass = "molar_mass: {value: 60, unit: kg/mol, source: our GPC, status: measured}"
    text = OURS % f"{mass}\n  zero_shear_viscosity: {{value: 1, unit: kPa*s, source: ours, status: measured}}"
    entry = put(tmp_path, text, category="polymers").record("polymers", "mine").entry("zero_shear_viscosity")
    assert (entry.value, entry.status) == (1000.0, "measured")
    assert "values.molar_mass" in refusal(tmp_path, OURS % mass.replace("kg/mol", "kg"), "polymers")


def test_a_folder_that_is_a_link_is_reported_with_its_target(tmp_path):
    (tmp_path / "kept").mkdir()
    put(tmp_path / "kept", GOOD)
    (tmp_path / "records").symlink_to(tmp_path / "kept")
    with pytest.warns(FolderWarning) as reported:
        catalog = Catalog(tmp_path / "records")
    assert [str(item.message) for item in reported] == [
        f"{tmp_path / 'records'}: the folder of records leads to {tmp_path / 'kept'}"
    ]
    assert catalog.record("heaters", "mine").title == "A module I measured"
    (tmp_path / "own").mkdir()
    (tmp_path / "own/heaters").symlink_to(tmp_path / "kept/heaters")
    with pytest.warns(FolderWarning, match="own/heaters: the folder of records leads to"):
        Catalog(tmp_path / "own")


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="Windows: no folder has a numbered owner that could be another")
@pytest.mark.parametrize("folder", [".", "heaters"])
def test_another_user_s_folder_is_reported_and_refused_if_all_may_write(folder, tmp_path, monkeypatch):
    put(tmp_path, GOOD)
    (tmp_path / folder).chmod(0o777)
    Catalog(tmp_path)  # one's own stays one's own
    theirs = (tmp_path / folder).stat().st_uid
    monkeypatch.setattr("tvimdesign.base.user_cache.os.getuid", lambda: theirs + 1)
    monkeypatch.setattr("tvimdesign.base.user_cache.ROOT", -1)  # who runs this may be root
    refused = pytest.raises(CatalogError, match=r"belongs to another user, .*anybody may write to it; copy it")
    with pytest.warns(FolderWarning) if folder == "heaters" else nullcontext(), refused as result:
        Catalog(tmp_path)
    assert "\n" not in str(result.value)
    (tmp_path / folder).chmod(0o755)
    with pytest.warns(FolderWarning, match="belongs to another user, "):
        Catalog(tmp_path)
    monkeypatch.setattr("tvimdesign.base.user_cache.ROOT", theirs)
    Catalog(tmp_path)  # what is the machine's is as good as the program


def test_the_commands_report_such_a_folder_in_one_line(tmp_path, tvimdesign):
    (tmp_path / "kept").mkdir()
    (tmp_path / "records").symlink_to(tmp_path / "kept")
    (tmp_path / "study.yaml").write_text("mode: shear\ncatalog: records\nmodule: {coil_cuont: 3}\n")  # refused: quick
    done = tvimdesign("check", str(tmp_path / "study.yaml"))
    message = f"Warning: {tmp_path / 'records'}: the folder of records leads to {tmp_path / 'kept'}"
    assert [line for line in done.stderr.splitlines() if "records" in line] == [message]


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


def test_laws_of_another_material_have_a_warning_each(tmp_path):
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
def test_a_wax_has_no_use_for_kinetics_and_is_refused_a_polymer_s_melt(tmp_path, base):
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


def test_a_glass_needs_its_own_spectrum_and_constants(tmp_path):
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


def test_words_that_are_left_out_are_a_polymer_s_that_melts(tmp_path):
    text = Catalog().path("polymers", "pcl_80k").read_text(encoding="utf-8")
    (tmp_path / "polymers").mkdir()
    own = text.replace("words: {freezing: kinetics, softening: melting}\n", "")
    assert own != text
    (tmp_path / "polymers/mine.yaml").write_text(own, encoding="utf-8")
    assert Catalog(tmp_path).record("polymers", "mine").words == {"freezing": "kinetics", "softening": "melting"}


def test_a_resistivity_is_one(tmp_path):
    with pytest.raises(CatalogError, match=r"values.resistivity.value: .*'10 mm'"):
        record(tmp_path, "pla", resistivity=(10.0, "mm"))
