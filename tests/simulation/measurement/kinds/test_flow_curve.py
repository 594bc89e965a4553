"""Flow curves: Carreau's law by its closed form, the plateau at low rates, and what else a flow curve is not."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from measured_files import csv, holds, measured

from tvimdesign.base.errors import InputError
from tvimdesign.catalog import Catalog
from tvimdesign.simulation.measurement.record_file import write_records

RATES = np.geomspace(1e-2, 1e2, 25)


def flow_file(place: Path, viscosity: Any, rate: Any = RATES, **more: Any) -> Path:
    return csv(place / "f.csv", shear_rate__1_per_s=rate, viscosity__Pas=viscosity, **more)


def carreau_yasuda(rate: Any, zero: float, time: float, n: float, a: float) -> Any:
    """Bird, Armstrong and Hassager, Dynamics of Polymeric Liquids 1, eq. 4.1-9, without a viscosity at high rates."""
    return zero * (1.0 + (time * rate) ** a) ** ((n - 1.0) / a)


@pytest.mark.parametrize("a", [2.0, 0.8])
def test_the_law_is_the_textbook_s(tmp_path: Path, a: float) -> None:
    noise = np.exp(np.random.default_rng(4).normal(0.0, 5e-3, 25))
    path = flow_file(tmp_path, carreau_yasuda(RATES, 1.48e4, 1.04, 0.398, a) * noise, temperature__degC=[180.0] * 25)
    done = measured(path)
    assert done.kind.name == "flow_curve"
    fit = done.measurement.fit
    assert fit.value("zero_shear_viscosity") == pytest.approx(1.48e4, rel=0.03)
    assert fit.value("thinning_power") == pytest.approx(0.398, abs=0.03)
    assert ("corner" in [each.name for each in fit.parameters]) == (a != 2.0)
    assert holds(fit["zero_shear_viscosity"], 1.48e4)


def test_a_record_has_the_viscosity_at_the_temperature_of_the_curve(tmp_path: Path) -> None:
    noise = np.exp(np.random.default_rng(4).normal(0.0, 0.01, 25))
    path = flow_file(tmp_path, carreau_yasuda(RATES, 900.0, 0.3, 0.5, 2.0) * noise, temperature__degC=[90.0] * 25)
    write_records(measured(path), tmp_path / "mine", "my_melt")
    record = Catalog(tmp_path / "mine").record("polymers", "my_melt")
    assert record.value("melt_reference_temperature") == pytest.approx(363.15)
    assert record.value("zero_shear_viscosity") == pytest.approx(900.0, rel=0.02)


def test_a_melt_that_does_not_thin_has_its_viscosity_alone(tmp_path: Path) -> None:
    noise = np.exp(np.random.default_rng(5).normal(0.0, 0.01, 25))
    fit = measured(flow_file(tmp_path, 0.8 * noise)).measurement.fit
    assert [each.name for each in fit.parameters] == ["zero_shear_viscosity"]
    assert fit.value("zero_shear_viscosity") == pytest.approx(0.8, rel=0.01)


def test_a_plateau_that_no_row_reaches_is_no_record_s(tmp_path: Path) -> None:
    rate = np.geomspace(3.0, 300.0, 25)
    noise = np.exp(np.random.default_rng(5).normal(0.0, 0.003, 25))
    path = flow_file(tmp_path, carreau_yasuda(rate, 900.0, 1.0, 0.5, 2.0) * noise, rate, temperature__degC=[90.0] * 25)
    done = measured(path).measurement
    assert not done.record_values
    assert any("zero_shear_viscosity is extrapolated" in note for note in done.notes)


@pytest.mark.parametrize("kind", ["relaxation", "creep", "melt"])
def test_a_flow_curve_is_no_other_kind(tmp_path: Path, kind: str) -> None:
    path = flow_file(tmp_path, np.full(12, 300.0), RATES[:12], time__s=np.arange(12.0), stress__Pa=300.0 * RATES[:12])
    with pytest.raises(InputError, match=rf"f\.csv:2: .* are a flow curve, not {kind}; --as flow_curve fits it"):
        measured(path, kind)
    assert measured(path).kind.name == "flow_curve"
