"""Each kind on data from closed solutions or another integrator, none made by what is fitted; odd times of runs."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from measured_files import arrhenius, csv, fit_files, measured, moduli, oscillated
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from support import ROOT, cases_of

from tvimdesign.base.errors import InputError
from tvimdesign.catalog import CATEGORIES, Catalog
from tvimdesign.simulation.measurement.kinds.dsc import Run, runs_of
from tvimdesign.simulation.measurement.measure_files import kind_sheet, kind_sheets, measure_of
from tvimdesign.simulation.measurement.reading.data_file import read_data_file
from tvimdesign.simulation.measurement.reading.headings import known
from tvimdesign.simulation.measurement.record_file import record_text

CELSIUS = 273.15


def test_every_kind_is_whole():
    for sheet in kind_sheets().values():
        assert callable(measure_of(sheet))
        assert {name for need in sheet.needs for name in need} | set(sheet.takes) <= set(known()["quantities"])
        assert not sheet.category or sheet.category in CATEGORIES
        sheet.values({})


def test_calorimetry_s_defaults_are_the_shipped_record_s():
    record, values = Catalog().record("polymers", "pcl_80k"), kind_sheet("dsc").values({})
    names = {name: name for name in values} | {"reference_temperature": "crystallization_reference"}
    assert {name: record.value(there) for name, there in names.items()} == pytest.approx(values)


def test_hanging_weights_on_an_arm(tmp_path):
    # 100 g on 80 mm turn a spring of 0.5 N.m/rad by 0.1 * 9.80665 * 0.08 / 0.5 rad.
    grams = np.array([0.0, 100.0, 200.0, 300.0, 400.0, 300.0, 200.0, 100.0])
    angle = np.degrees(grams * 1e-3 * 9.80665 * 0.08 / 0.5) + np.array([1, -1, 2, -2, 1, -1, 1, -1]) * 1e-4
    fit = fit_files(csv(tmp_path / "w.csv", mass__g=grams, angle__deg=angle), arm="80 mm").fit
    assert fit.value("stiffness") == pytest.approx(0.5, rel=1e-4)
    with pytest.raises(InputError, match=r"--set arm=...: needed, as .*w.csv has a mass and no torque"):
        fit_files(tmp_path / "w.csv")


def test_the_modulus_of_a_wire_is_the_handbook_s(tmp_path):
    # E 203.4 GPa, d 2 mm, D 20 mm, n 5: 0.5085 N.m/rad in pure bending.
    torque = np.linspace(0.05, 0.5, 10)
    torque = np.concatenate([torque, torque[::-1]])
    angle = torque / 0.5085 + np.tile([1e-6, -1e-6], 10)
    path = csv(tmp_path / "w.csv", torque__N_m=torque, angle__rad=angle)
    path.write_text(path.read_text().replace("[N m]", "[N.m]"))
    sizes = {"wire_diameter": "2 mm", "coil_diameter": "20 mm", "coil_count": "5"}
    assert fit_files(path, **sizes).fit.value("youngs_modulus") == pytest.approx(203.4e9, rel=1e-4)


def test_friction_and_play_of_a_joint(tmp_path):
    # By hand: 0.2 N.m of friction shift the two ways by 2 * 0.2 / 4 rad, a play of 0.03 rad the two sides by that.
    up, down = np.linspace(1.0, 4.0, 4), np.linspace(3.0, 1.0, 3)
    torque = np.concatenate([up, down, -up, -down, up])
    way = np.array([1.0] * 4 + [-1.0] * 3 + [-1.0] * 4 + [1.0] * 3 + [1.0] * 4)
    wobble = np.resize([1e-5, -1e-5, -1e-5, 1e-5], len(torque))
    angle = 0.1 + (torque - way * 0.2) / 4.0 + 0.015 * np.sign(torque) + wobble
    path = csv(tmp_path / "j.csv", torque__mN_m=1e3 * torque, angle__rad=angle)
    path.write_text(path.read_text().replace("[mN m]", "[mN.m]"))
    fit = fit_files(path).fit
    values = [fit.value(name) for name in ("stiffness", "friction", "backlash", "zero_angle")]
    assert values == pytest.approx([4.0, 0.2, 0.03, 0.1], rel=2e-3)


def test_a_pad_from_its_data_sheet(tmp_path):
    # Steady and insulated: K dT = S I T_c - I^2 R/2 with the 12706's values; at the best current dT is the sheet's.
    seebeck, resistance, conductance, hot = 15.8 / 300.0, 15.8 * 233.0 / 1800.0, 15.8 * 6 * 233 / (2 * 300 * 67), 300.0
    current = np.array([0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    cold = (conductance * hot + 0.5 * current**2 * resistance) / (conductance + seebeck * current)
    assert cold[-1] == pytest.approx(233.0, abs=0.2)
    voltage = seebeck * (hot - cold) + current * resistance + np.resize([1e-6, -1e-6], 7)
    path = csv(tmp_path / "p.csv", current__A=current, voltage__V=voltage, hot_side__degC=np.full(7, hot - CELSIUS),
               cold_side__degC=cold - CELSIUS)  # fmt: skip
    fit = fit_files(path).fit
    values = [fit.value(name) for name in ("seebeck", "resistance", "conductance")]
    assert values == pytest.approx([seebeck, resistance, conductance], rel=1e-4)


def damped(time: Any, stiffness: float, damping: float, inertia: float, first: float) -> Any:
    """Free oscillation from rest (textbook): e^-dt (cos wt + d/w sin wt)."""
    decay = damping / (2.0 * inertia)
    omega = np.sqrt(stiffness / inertia - decay**2)
    return first * np.exp(-decay * time) * (np.cos(omega * time) + decay / omega * np.sin(omega * time))


def test_a_release_is_the_textbook_s_damped_oscillation(tmp_path):
    time = np.linspace(0.0, 0.6, 300)
    noise = np.random.default_rng(2).normal(0.0, 1e-4, 300)
    path = csv(tmp_path / "r.csv", time__s=time, angle__rad=damped(time, 5.0, 4e-3, 4e-4, 0.1) + noise)
    fit = fit_files(path, inertia="4e-4 kg.m^2").fit
    assert fit.value("stiffness") == pytest.approx(5.0, rel=1e-3)
    assert fit.value("damping") == pytest.approx(4e-3, rel=0.01)
    assert fit.value("natural_frequency") == pytest.approx(np.sqrt(5.0 / 4e-4) / (2.0 * np.pi), rel=1e-3)


def test_dry_friction_takes_the_textbook_s_four_shares_a_cycle(tmp_path):
    # Den Hartog: halves of cosines about +-T_f/K, so that the amplitude falls by 4 T_f/K a cycle.
    stiffness, inertia, friction = 5.0, 4e-4, 0.02
    omega, shift = np.sqrt(stiffness / inertia), friction / stiffness
    time = np.linspace(0.0, 0.25, 300)
    half = np.floor(time * omega / np.pi).astype(int)
    amplitude = 0.1 - shift * (2 * half + 1)
    angle = amplitude * np.cos(omega * time) + shift * np.where(half % 2, -1.0, 1.0)
    angle = angle + np.random.default_rng(3).normal(0.0, 1e-4, 300)
    fit = fit_files(csv(tmp_path / "r.csv", time__s=time, angle__rad=angle), inertia="4e-4 kg.m^2").fit
    assert fit.value("friction") == pytest.approx(friction, rel=0.03)
    assert fit.value("stiffness") == pytest.approx(stiffness, rel=2e-3)


def test_without_an_inertia_a_release_says_what_it_does_not_know(tmp_path):
    time = np.linspace(0.0, 0.6, 300)
    noise = np.random.default_rng(2).normal(0.0, 1e-4, 300)
    fit = fit_files(csv(tmp_path / "r.csv", time__s=time, angle__rad=damped(time, 5.0, 4e-3, 4e-4, 0.1) + noise)).fit
    assert fit["stiffness"].low is None
    assert fit["natural_frequency"].low is not None
    assert any(
        "cannot tell inertia, stiffness and damping apart" in sentence and "Only their ratios" in sentence
        for sentence in fit.words
    )


MODES = [(1.0, 500.0), (0.05, 1.2e4), (0.004, 9.0e4)]


def sweep(path: Path, celsius: float, seed: int, energy: float = 35e3) -> Path:
    omega, noise = np.geomspace(0.05, 200.0, 18), np.random.default_rng(seed)
    made = moduli(omega * arrhenius(celsius, energy, 100.0), MODES)
    return oscillated(path, omega, *(modulus * np.exp(noise.normal(0.0, 0.01, 18)) for modulus in made), celsius)


def test_a_spectrum_has_as_many_modes_as_made_the_data(tmp_path):
    paths = [sweep(tmp_path / f"{t}.csv", t, seed) for seed, t in enumerate((80, 100, 120))]
    fit = fit_files(paths).fit
    times = sorted(fit.value(parameter.name) for parameter in fit.parameters if parameter.name.startswith("time"))
    assert times == pytest.approx([0.004, 0.05, 1.0], rel=0.1)
    assert fit.value("flow_activation_energy") == pytest.approx(35e3, rel=0.02)
    assert fit.value("zero_shear_viscosity") == pytest.approx(500.0 + 600.0 + 360.0, rel=0.02)


def test_a_shift_that_is_not_arrhenius_gives_no_energy(tmp_path):
    paths = [sweep(tmp_path / f"{t}.csv", t, t, energy) for t, energy in ((60, 90e3), (100, 35e3), (140, 20e3))]
    result = fit_files(paths)
    assert "flow_activation_energy" not in result.record_values
    assert any("Arrhenius' law misses one by" in note for note in result.notes)


def freezing(celsius: Any, kinetics: Mapping[str, float]) -> Any:
    """Nakamura's rate constant [1/s] by Hoffman and Lauritzen, written down a second time."""
    kelvin, melting = celsius + CELSIUS, 74.0 + CELSIUS

    def exponent(t: Any) -> Any:
        correction = 2.0 * t / (t + melting)
        return -6270.0 / (8.314462618 * (t - 183.15)) - kinetics["K_g"] / (t * (melting - t) * correction)

    speed = np.exp(exponent(kelvin) - exponent(35.0 + CELSIUS))
    return np.log(2.0) ** (1.0 / kinetics["n"]) / kinetics["half_time"] * speed


def test_freezing_curves_of_another_integrator(tmp_path):
    kinetics, latent = {"half_time": 60.0, "K_g": 1.1e5, "n": 2.6}, 55e3
    paths = []
    for i, rate in enumerate((4.0, 8.0, 16.0)):
        time = np.linspace(0.0, 70.0 / rate * 60.0, 600)
        celsius = 70.0 - rate / 60.0 * time
        grown = solve_ivp(lambda t, _, r=rate: [float(freezing(70.0 - r / 60.0 * t, kinetics))], (0.0, time[-1]), [0.0],
                          t_eval=time, rtol=1e-9, atol=1e-12).y[0]  # fmt: skip
        fraction = 1.0 - np.exp(-(np.maximum(grown, 0.0) ** kinetics["n"]))
        heat = np.gradient(fraction, time) * (latent + 250.0 * (celsius - 57.5))  # Kirchhoff, about the window's middle
        capacity = fraction * 1850.0 + (1.0 - fraction) * 2100.0
        flow = heat + capacity * rate / 60.0 + np.random.default_rng(i).normal(0.0, 1.0, 600)
        milligrams = 5.0
        paths.append(csv(tmp_path / f"{rate}.csv", time__min=time / 60.0, temperature__degC=celsius,
                         heat_flow__mW=-flow * milligrams * 1e-3))  # fmt: skip
    result = fit_files(paths, sample_mass="5 mg")
    fit = result.fit
    assert fit.value("crystallization_half_time") == pytest.approx(60.0, rel=0.02)
    assert fit.value("nucleation_constant") == pytest.approx(1.1e5, rel=0.02)
    assert fit.value("avrami_exponent") == pytest.approx(2.6, rel=0.03)
    assert fit.value("latent_heat") == pytest.approx(latent, rel=0.02)
    assert "taken as negative" in result.notes[0]


def test_melting_between_two_temperatures(tmp_path):
    # A straight melting curve from 48 to 60 degC takes 70 kJ/kg over 12 K: at 10 K/min 972 W/kg.
    time = np.linspace(0.0, 480.0, 800)
    celsius = 20.0 + time / 6.0
    inside = (celsius > 48.0) & (celsius < 60.0)
    molten = np.clip((celsius - 48.0) / 12.0, 0.0, 1.0)
    flow = (1850.0 + 250.0 * molten) / 6.0 + inside * 70e3 / 12.0 / 6.0
    noise = np.random.default_rng(1).normal(0.0, 5.0, 800)
    path = csv(tmp_path / "h.csv", time__s=time, temperature__degC=celsius, dsc__W_per_g=(flow + noise) / 1e3)
    fit = fit_files(path).fit
    assert fit.value("melting_start") == pytest.approx(48.0 + CELSIUS, abs=0.1)
    assert fit.value("melting_end") == pytest.approx(60.0 + CELSIUS, abs=0.1)
    assert fit.value("latent_heat") == pytest.approx(70e3, rel=0.02)


@cases_of("kinds_against_textbooks", "lacks")
def test_a_lack_is_reported(tmp_path, kind, given, message):
    path = csv(tmp_path / "x.csv", torque__N=[1.0, 2.0, 3.0], angle__deg=[1.0, 2.0, 3.0])
    with pytest.raises(InputError, match=message.replace("?", r"\?")):
        measured(path, kind, **given)


def test_a_kind_without_a_record_says_so(tmp_path):
    time = np.linspace(0.0, 0.6, 100)
    path = csv(tmp_path / "r.csv", time__s=time, angle__rad=damped(time, 5.0, 4e-3, 4e-4, 0.1))
    with pytest.raises(InputError, match="release: nothing in it is a value of a record"):
        record_text(measured(path, inertia="4e-4 kg.m^2"), "mine", "")


def _read(folder: Path, times: NDArray[np.float64]) -> list[Run]:
    """Cooled from 353 K by 10 K/min; heat as from a peak at 300 K."""
    temperature = 353.0 - np.arange(len(times)) / 6.0
    heat = 100.0 + 1000.0 * np.exp(-(((temperature - 300.0) / 4.0) ** 2))
    rows = [f"{t:g};{kelvin:.12g};{watts:g}" for t, kelvin, watts in zip(times, temperature, heat, strict=True)]
    path = folder / "data.csv"
    path.write_text("\n".join(["time [s];temperature [K];specific_heat_flow [W/kg]", *rows, ""]))
    return runs_of(read_data_file(path).blocks, {})[0]


def test_of_rows_whose_rounded_times_are_the_same_the_first_counts(tmp_path):
    seconds = np.arange(400.0)
    (run,) = _read(tmp_path, np.floor(seconds / 2.0) * 2.0)
    assert np.all(np.diff(run.time) > 0.0)
    assert run.way == "cooled"
    assert run.rate == pytest.approx(-1.0 / 6.0, rel=1e-9)


def test_times_that_fall_are_refused(tmp_path):
    seconds = np.arange(400.0)
    seconds[390] = -1e308
    with pytest.raises(InputError, match=r"data\.csv:2: time falls from one row to the next"):
        _read(tmp_path, seconds)


def test_a_glass_does_not_freeze(tmp_path):
    """Refuse a glass transition of 1e9 K, which ended in a LinAlgError; the campaign of faults has the input."""
    stored = json.loads((ROOT / "campaigns/corpus/fits/904f44e4b289/input.json").read_text(encoding="utf-8"))
    (tmp_path / "f.csv").write_text(stored["data"], encoding="utf-8")
    with pytest.raises(InputError, match=r"glass_transition is 1e\+09 K"):
        fit_files(tmp_path / "f.csv", "dsc", **stored["settings"])
