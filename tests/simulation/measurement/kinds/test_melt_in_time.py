"""Melts in time and flow curves, by their closed forms."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from measured_files import arrhenius, csv, fit_files, holds, measured, moduli, oscillated
from scipy.integrate import solve_ivp

from tvimdesign.base.errors import InputError
from tvimdesign.catalog import Catalog
from tvimdesign.simulation.measurement.record_file import write_records

CELSIUS = 273.15
MODES = ((0.8, 600.0), (0.03, 2.0e4))
VISCOSITY = sum(tau * modulus for tau, modulus in MODES)


def crept(time: Any, stress: float, release: float) -> Any:
    """Strain of two Maxwell elements side by side under a stress taken off at `release`, by Radau's method.

    Dashpots' strains q_i' = (gamma - q_i)/tau_i, and sum G_i (gamma - q_i) = sigma(t).
    """
    taus, moduli = np.array(MODES).T

    def strain(t: float, q: Any) -> float:
        return float(((stress if t < release else 0.0) + moduli @ q) / moduli.sum())

    def rates(t: float, q: Any) -> Any:
        return (strain(t, q) - q) / taus

    strains = []
    start = np.zeros(2)
    for part in filter(len, (time[time < release], time[time >= release])):
        begin = 0.0 if part[0] < release else release
        done = solve_ivp(rates, (begin, max(part[-1], release) if begin == 0.0 else part[-1]), start, "Radau",
                         dense_output=True, rtol=1e-9, atol=1e-14)  # fmt: skip
        strains += [strain(t, done.sol(t)) for t in part]
        start = done.y[:, -1]
    return np.array(strains)


def test_creep_and_recovery_of_another_integrator(tmp_path):
    time = np.concatenate([np.geomspace(1e-3, 7.9, 70), 8.0 + np.geomspace(1e-3, 8.0, 60)])
    strain = crept(time, 40.0, 8.0)
    noise = np.random.default_rng(1)
    strain = strain * np.exp(noise.normal(0.0, 3e-3, 130))
    path = csv(tmp_path / "c.csv", time__s=time, strain__1=strain, stress__Pa=np.where(time < 8.0, 40.0, 0.0),
               temperature__degC=np.full(130, 90.0))  # fmt: skip
    result = measured(path)
    assert result.kind.name == "creep"
    fit = result.measurement.fit
    assert fit.value("zero_shear_viscosity") == pytest.approx(VISCOSITY, rel=5e-3)
    assert sorted(
        fit.value(parameter.name) for parameter in fit.parameters if "time" in parameter.name
    ) == pytest.approx([0.03, 0.8], rel=0.1)
    assert result.measurement.record_conditions["melt_reference_temperature"][0] == pytest.approx(90.0 + CELSIUS)


def test_a_creep_with_hardly_more_rows_than_its_recovery_is_a_creep(tmp_path):
    time = np.concatenate([np.geomspace(1e-3, 7.9, 32), 8.0 + np.geomspace(1e-3, 8.0, 30)])
    noise = np.random.default_rng(1).normal(0.0, 3e-3, 62)
    path = csv(tmp_path / "c.csv", time__s=time, strain__1=crept(time, 40.0, 8.0) * np.exp(noise),
               stress__Pa=np.where(time < 8.0, 40.0, 0.0), temperature__degC=np.full(62, 90.0))  # fmt: skip
    done = fit_files(path, "melt")
    assert done.notes[0].endswith(" as creep.")
    assert done.fit.value("zero_shear_viscosity") == pytest.approx(VISCOSITY, rel=0.01)


@pytest.mark.parametrize("rise", [0.0, 0.02])
def test_relaxation_after_a_step_and_after_a_ramp(tmp_path, rise):
    # After a ramp of length r each mode has had (1 - exp(-r/tau)) tau/r of its strain.
    time = np.geomspace(rise + 1e-3, 4.0, 90)
    whole = [(np.expm1(rise / tau) * tau / rise if rise else 1.0) for tau, _ in MODES]
    stress = sum(
        0.1 * modulus * np.exp(-time / tau) * share for (tau, modulus), share in zip(MODES, whole, strict=True)
    )
    noise = np.exp(np.random.default_rng(2).normal(0.0, 5e-3, 90))
    path = csv(tmp_path / "r.csv", time__s=time, stress__Pa=stress * noise, strain__1=np.full(90, 0.1))
    given = {"temperature": "90 degC"} | ({"rise_time": f"{rise} s"} if rise else {})
    fit = fit_files(path, "relaxation", **given).fit
    assert fit.value("zero_shear_viscosity") == pytest.approx(VISCOSITY, rel=0.01)
    assert fit.value("plateau_modulus") == pytest.approx(20600.0, rel=0.02)


def test_a_ramp_has_the_energy_that_made_it_and_leaves_out_what_is_frozen(tmp_path):
    celsius = np.linspace(40.0, 170.0, 90)
    noise, melt = np.random.default_rng(3), moduli(10.0 * arrhenius(celsius, 30e3, 100.0), MODES)
    both = (np.where(celsius < 62.0, 1e8, modulus) * np.exp(noise.normal(0.0, 0.01, 90)) for modulus in melt)
    path = oscillated(tmp_path / "t.csv", np.full(90, 10.0), *both, celsius)
    result = measured(path, reference_temperature="100 degC")
    assert result.kind.name == "temperature_ramp"
    fit = result.measurement.fit
    assert fit.value("flow_activation_energy") == pytest.approx(30e3, rel=0.02)
    assert fit.value("zero_shear_viscosity") == pytest.approx(VISCOSITY, rel=0.02)
    with pytest.raises(InputError, match="0 rows of the melt, from 200 degC on"):
        measured(path, least_temperature="200 degC")


LAWS: dict[str, Any] = {
    "square": lambda x: 1.0 / (1.0 + 0.05 / 0.95 * x**2),
    "linear": lambda x: 1.0 / (1.0 + 0.05 / 0.95 * x),
    "steep": lambda x: 1.0 / (1.0 + 0.05 / 0.95 * x**3),
    "slipping": lambda x: 1.0 / (1.0 + 0.05 / 0.95 * np.minimum(x, 2.1) ** 2) * np.minimum(1.0, 2.1 / x) ** 3,
    "flat tail": lambda x: 1.0 / (1.0 + 0.05 / 0.95 * np.minimum(x, 2.1) ** 2) * np.minimum(1.0, 2.1 / x) ** 0.5,
}


def strained(path: Path, law: str, noise: float, celsius: float = 100.0) -> Path:
    """Write a sweep that has lost 5 % of its storage modulus at a strain of 0.029; the loss modulus overshoots."""
    strain, draw = np.geomspace(1e-4, 1.0, 45), np.random.default_rng(4)
    x = strain / 0.029
    moduli = 3e3 * LAWS[law](x), 9e3 * (1.0 + 0.3 * (x / 2.0) ** 2 / (1.0 + (x / 2.0) ** 4))
    storage, loss = (modulus * np.exp(draw.normal(0.0, noise, 45)) for modulus in moduli)
    return csv(path, **{"strain__%": 100.0 * strain, "G'__Pa": storage, "G''__Pa": loss},
               temperature__degC=np.full(45, celsius))  # fmt: skip


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("noise", [0.0, 5e-3])
def test_the_linear_range_ends_where_five_percent_are_gone(tmp_path, law, noise):
    result = measured(strained(tmp_path / "a.csv", law, noise))
    assert result.kind.name == "amplitude_sweep"
    limit = result.measurement.record_values["linear_strain_melt"]
    assert limit.value == pytest.approx(0.029, rel=20.0 * noise + 1e-3)
    assert (limit.low or 1.0) * (1.0 - 1e-3) < 0.029 < (limit.high or 0.0) * (1.0 + 1e-3)
    assert result.measurement.fit.value("loss_modulus") == pytest.approx(9e3, rel=2.0 * noise + 1e-3)
    assert not result.measurement.fit.misfit


def test_a_limit_of_neither_phase_or_hardly_seen_is_no_record_s(tmp_path):
    between = fit_files(strained(tmp_path / "b.csv", "square", 5e-3, 58.0), "amplitude_sweep")
    assert not between.record_values
    path = strained(tmp_path / "s.csv", "square", 5e-3)
    path.write_text("\n".join(path.read_text().splitlines()[:25]))
    short = fit_files(path, "amplitude_sweep")
    assert any("hardly seen" in note for note in short.notes)
    assert not short.record_values


def test_a_known_energy_is_not_fitted(tmp_path):
    omega = np.geomspace(0.1, 100.0, 20)
    paths = []
    for celsius in (90.0, 110.0):
        storage, loss = moduli(omega * arrhenius(celsius, 30e3, 90.0), MODES)
        noise = np.exp(np.random.default_rng(int(celsius)).normal(0.0, 0.01, 20))
        paths.append(oscillated(tmp_path / f"{celsius:.0f}.csv", omega, storage * noise, loss * noise, celsius))
    result = fit_files(paths, flow_activation_energy="30 kJ/mol", reference_temperature="90 degC")
    assert "flow_activation_energy" not in result.record_values
    assert result.fit.value("zero_shear_viscosity") == pytest.approx(VISCOSITY, rel=0.01)


def test_a_modulus_that_the_instrument_cuts_off_is_left_out(tmp_path):
    omega = np.geomspace(1e-3, 100.0, 24)
    storage, loss = moduli(omega, MODES)
    cut = storage < loss / 100.0
    result = fit_files(oscillated(tmp_path / "s.csv", omega, np.where(cut, loss / 100.0, storage), loss, 90.0))
    assert result.fit.value("zero_shear_viscosity") == pytest.approx(VISCOSITY, rel=1e-3)
    assert any(f"G''/G' stays at 100 in {np.sum(cut)} of 24 rows" in note for note in result.notes)
    with pytest.raises(InputError, match=r"Too few rows remain\. G''/omega is 0\.8 Pa\.s there"):
        measured(oscillated(tmp_path / "o.csv", omega, 8e-3 * omega, 0.8 * omega))


@pytest.mark.parametrize("end", [0.02, 0.5, 5.0])
def test_no_time_lies_far_outside_what_a_creep_sees(tmp_path, end):
    # Up to long before the melt flows; without noise any slower mode would better the fit a little.
    time = np.geomspace(1e-3 * end, end, 60)
    path = csv(tmp_path / "c.csv", time__s=time, strain__1=crept(time, 40.0, 8.0), stress__Pa=np.full(60, 40.0),
               temperature__degC=np.full(60, 90.0))  # fmt: skip
    result = fit_files(path, "creep")
    times = [parameter.value for parameter in result.fit.parameters if parameter.name.startswith("time")]
    assert 1e-4 * end * (1.0 - 1e-9) <= min(times)
    assert max(times) <= 10.0 * end * (1.0 + 1e-9)
    assert result.fit.value("plateau_modulus") == pytest.approx(20600.0, rel=1e-3)
    assert bool(result.record_values) == (end > MODES[0][0])
    assert any("the viscosity is extrapolated" in note for note in result.notes) == (end < MODES[0][0])


RATES = np.geomspace(1e-2, 1e2, 25)


def flow_file(place: Path, viscosity: Any, rate: Any = RATES, **more: Any) -> Path:
    return csv(place / "f.csv", shear_rate__1_per_s=rate, viscosity__Pas=viscosity, **more)


def carreau_yasuda(rate: Any, zero: float, time: float, n: float, a: float) -> Any:
    """Bird, Armstrong and Hassager, Dynamics of Polymeric Liquids 1, eq. 4.1-9, without a viscosity at high rates."""
    return zero * (1.0 + (time * rate) ** a) ** ((n - 1.0) / a)


@pytest.mark.parametrize("a", [2.0, 0.8])
def test_the_law_is_the_textbook_s(tmp_path, a):
    noise = np.exp(np.random.default_rng(4).normal(0.0, 5e-3, 25))
    path = flow_file(tmp_path, carreau_yasuda(RATES, 1.48e4, 1.04, 0.398, a) * noise, temperature__degC=[180.0] * 25)
    done = measured(path)
    assert done.kind.name == "flow_curve"
    fit = done.measurement.fit
    assert fit.value("zero_shear_viscosity") == pytest.approx(1.48e4, rel=0.03)
    assert fit.value("thinning_power") == pytest.approx(0.398, abs=0.03)
    assert ("corner" in [each.name for each in fit.parameters]) == (a != 2.0)
    assert holds(fit["zero_shear_viscosity"], 1.48e4)


def test_a_record_has_the_viscosity_at_the_temperature_of_the_curve(tmp_path):
    noise = np.exp(np.random.default_rng(4).normal(0.0, 0.01, 25))
    path = flow_file(tmp_path, carreau_yasuda(RATES, 900.0, 0.3, 0.5, 2.0) * noise, temperature__degC=[90.0] * 25)
    write_records(measured(path), tmp_path / "mine", "my_melt")
    record = Catalog(tmp_path / "mine").record("polymers", "my_melt")
    assert record.value("melt_reference_temperature") == pytest.approx(363.15)
    assert record.value("zero_shear_viscosity") == pytest.approx(900.0, rel=0.02)


def test_a_melt_that_does_not_thin_has_its_viscosity_alone(tmp_path):
    noise = np.exp(np.random.default_rng(5).normal(0.0, 0.01, 25))
    fit = measured(flow_file(tmp_path, 0.8 * noise)).measurement.fit
    assert [each.name for each in fit.parameters] == ["zero_shear_viscosity"]
    assert fit.value("zero_shear_viscosity") == pytest.approx(0.8, rel=0.01)


def test_a_plateau_that_no_row_reaches_is_no_record_s(tmp_path):
    rate = np.geomspace(3.0, 300.0, 25)
    noise = np.exp(np.random.default_rng(5).normal(0.0, 0.003, 25))
    path = flow_file(tmp_path, carreau_yasuda(rate, 900.0, 1.0, 0.5, 2.0) * noise, rate, temperature__degC=[90.0] * 25)
    done = measured(path).measurement
    assert not done.record_values
    assert any("zero_shear_viscosity is extrapolated" in note for note in done.notes)


@pytest.mark.parametrize("kind", ["relaxation", "creep", "melt"])
def test_a_flow_curve_is_no_other_kind(tmp_path, kind):
    path = flow_file(tmp_path, np.full(12, 300.0), RATES[:12], time__s=np.arange(12.0), stress__Pa=300.0 * RATES[:12])
    with pytest.raises(InputError, match=rf"f\.csv:2: .* are a flow curve, not {kind}; --as flow_curve fits it"):
        measured(path, kind)
    assert measured(path).kind.name == "flow_curve"
