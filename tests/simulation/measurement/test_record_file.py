"""Records of measured values: a study names them, and the intervals that depend on them shrink."""

import hashlib
from pathlib import Path

import numpy as np
import pytest
from every import check_records
from measured_files import csv, holds, moduli, oscillated

import tvimdesign as tvim
from tvimdesign.base.errors import CatalogError, InputError
from tvimdesign.catalog import Catalog
from tvimdesign.simulation.working_cycle.device_functions import resolve_study
from tvimdesign.solve.uncertainty.uncertain_inputs import UnmeasuredInput, unmeasured_inputs


def pad_file(place: Path) -> Path:
    """Steady states of a pad of 21 mV/K, 3.4 ohm and 0.15 W/K, insulated on its cold side.

    The currents go up and down: a drift of the thermocouples would look like the pad otherwise.
    """
    seebeck, resistance, conductance = 21e-3, 3.4, 0.15
    noise = np.random.default_rng(5)
    current = np.array([0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.5])
    current = np.concatenate([current, current[::-1], current])
    hot = 299.0 + 3.0 * current
    cold = (conductance * hot + 0.5 * current**2 * resistance) / (conductance + seebeck * current)
    voltage = seebeck * (hot - cold) + resistance * current + noise.normal(0.0, 2e-3, 21)
    hot, cold = (face - 273.15 + noise.normal(0.0, 0.05, 21) for face in (hot, cold))
    return csv(place / "pad.csv", current__A=current, voltage__V=voltage, hot_side__degC=hot, cold_side__degC=cold)


def joint(place: Path, **module: str) -> tvim.Study:
    return tvim.example("paper_reconstructed").set({"catalog": str(place / "my_records"), **module})


def ranges(study: tvim.Study) -> dict[str, UnmeasuredInput]:
    return {assumed.name: assumed for assumed in unmeasured_inputs(resolve_study(study.resolved))}


def test_a_record_says_value_interval_and_file(tmp_path):
    path = pad_file(tmp_path)
    written = tvim.fit(path).record("my_pad", catalog=tmp_path / "my_records")
    assert written == tmp_path / "my_records/heaters/my_pad.yaml"
    catalog = Catalog(tmp_path / "my_records")
    assert check_records(catalog) == []
    record = catalog.record("heaters", "my_pad")
    for name, value in (("seebeck", 21e-3), ("resistance", 3.4), ("conductance", 0.15)):
        entry = record.entry(name)
        assert entry.status == "measured"
        assert holds(entry, value)
        assert np.ptp([entry.low, entry.high]) < 0.1 * value
        assert f"pad.csv (sha256 {hashlib.sha256(path.read_bytes()).hexdigest()})" in entry.source
    assert record.value("area") == Catalog().record("heaters", "flexible_1600").value("area")


def test_a_measured_value_counts_with_its_own_interval(tmp_path):
    tvim.fit(pad_file(tmp_path)).record("my_pad", catalog=tmp_path / "my_records")
    before, after = ranges(joint(tmp_path)), ranges(joint(tmp_path, heater_module="my_pad"))
    for name in ("heater_seebeck", "heater_resistance", "heater_conductance"):
        assert after[name].status == "measured"
        assert after[name].high - after[name].low < 0.2 * (before[name].high - before[name].low)
    assert before["pcl_latent_heat"] == after["pcl_latent_heat"]


@pytest.mark.slow
def test_the_interval_of_a_headline_shrinks(tmp_path):
    tvim.fit(pad_file(tmp_path)).record("my_pad", catalog=tmp_path / "my_records")
    width = {}
    for name in ("flexible_1600", "my_pad"):
        table = joint(tmp_path, heater_module=name).evaluate(progress=False).intervals()
        low, high, value = (table.loc["softening_time", column] for column in ("low", "high", "value"))
        width[name] = (high - low) / value
    assert width["my_pad"] < 0.7 * width["flexible_1600"]


def test_a_spectrum_is_a_table_that_the_catalogue_takes(tmp_path):
    omega, modes, noise = np.geomspace(0.1, 300.0, 20), [(0.05, 4e3), (0.004, 6e4)], np.random.default_rng(6)
    both = (modulus * np.exp(noise.normal(0.0, 0.01, 20)) for modulus in moduli(omega, modes))
    fitted = tvim.fit(oscillated(tmp_path / "melt.csv", omega, *both))
    fitted.record("my_melt", catalog=tmp_path / "my_records")
    record = Catalog(tmp_path / "my_records").record("polymers", "my_melt")
    spectrum = record.table("melt_spectrum")
    assert len(spectrum) == len(record.table("solid_spectrum"))
    assert sum(row["modulus"] * row["relaxation_time"] for row in spectrum) == pytest.approx(
        sum(tau * modulus for tau, modulus in modes), rel=0.03
    )
    assert record.entry("zero_shear_viscosity").status == "measured"
    assert record.value("melt_reference_temperature") == pytest.approx(373.15)


def test_an_existing_record_stays_unless_overwriting_is_requested(tmp_path):
    fitted = tvim.fit(pad_file(tmp_path))
    place = tmp_path / "my_records"
    written = fitted.record("my_pad", catalog=place)
    before = written.read_bytes()
    with pytest.raises(InputError, match="there is such a record already"):
        fitted.record("my_pad", catalog=place)
    fitted.record("my_pad", catalog=place, overwrite=True)
    assert written.read_bytes() == before
    with pytest.raises(InputError, match="a record's name is small letters"):
        fitted.record("../my_pad", catalog=place)


def test_what_contradicts_the_base_leaves_no_record(tmp_path):
    with pytest.raises(CatalogError, match="does not go with no_such_pad"):
        tvim.fit(pad_file(tmp_path)).record("my_pad", based_on="no_such_pad", catalog=tmp_path / "my_records")
    assert not list((tmp_path / "my_records").rglob("*.yaml"))


def test_data_that_the_equations_do_not_describe_write_no_record(tmp_path):
    # A spring that stiffens as its coils touch: no one modulus is its wire's.
    angle = np.linspace(0.02, 1.0, 40)
    path = csv(tmp_path / "stiff.csv", torque__Nm=5.0 * angle + 4.0 * angle**3, angle__rad=angle)
    fitted = tvim.fit(path, wire_diameter="2 mm", coil_diameter="20 mm", coil_count="5")
    assert "The equations do not describe angle of" in fitted.data["misfit"]
    with pytest.raises(InputError, match=r"No record is written\. The figure and residuals\.csv show"):
        fitted.record("my_wire", catalog=tmp_path / "my_records")


def test_the_door_for_python_users(tmp_path):
    fitted = tvim.fit(str(pad_file(tmp_path)), "pad", leak="0.001 W/K")
    table = fitted.table()
    assert list(table.columns) == ["value", "low", "high", "unit", "meaning"]
    assert table.loc["seebeck", "value"] == pytest.approx(21.0, rel=0.03)
    assert fitted["seebeck"].to("V/K").magnitude == pytest.approx(0.021, rel=0.03)
    assert fitted.data["kind"] == fitted.kind == "pad"
    assert any("hot_temperature: 'hot side [degC]' in °C" in line for line in fitted.read)
    assert len(fitted.plot().axes) == 4
    with pytest.raises(KeyError, match="'nothing'; there are seebeck"):
        fitted["nothing"]
