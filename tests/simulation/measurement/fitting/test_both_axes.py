"""Where both axes err, against odrpack: a pad's voltages and faces, each read with an error of its own."""

from pathlib import Path
from typing import Any

import numpy as np
import odrpack
import pytest
from measured_files import csv, found

SEEBECK, RESISTANCE, CONDUCTANCE = 0.05, 2.0, 0.5
VOLTS, KELVIN = 3e-3, 0.3


def faces(hot: Any, current: Any, beta: Any) -> Any:
    """Voltage and cold face's temperature of an insulated pad, by hand from S I T_c - I^2 R/2 = K (T_h - T_c)."""
    seebeck, resistance, conductance = beta
    cold = (conductance * hot + 0.5 * current**2 * resistance) / (conductance + seebeck * current)
    return np.array([seebeck * (hot - cold) + current * resistance, cold])


def test_a_pad_is_that_of_orthogonal_distance_regression(tmp_path: Path) -> None:
    noise = np.random.default_rng(6)
    current = np.linspace(0.1, 3.0, 30)
    true = 298.0 + 4.0 * current
    voltage, cold = faces(true, current, (SEEBECK, RESISTANCE, CONDUCTANCE))
    voltage = voltage + noise.normal(0.0, VOLTS, 30)
    hot, cold = (one + noise.normal(0.0, KELVIN, 30) for one in (true, cold))
    other = odrpack.odr_fit(
        lambda x, beta: faces(x, current, beta), hot, np.array([voltage, cold]), np.array([0.04, 1.5, 0.4]),
        weight_x=1.0 / KELVIN**2, weight_y=np.array([1.0 / VOLTS**2, 1.0 / KELVIN**2]),
    )  # fmt: skip
    assert other.success
    path = csv(tmp_path / "p.csv", current__A=current, voltage__V=voltage, hot_side__degC=hot - 273.15,
               cold_side__degC=cold - 273.15)  # fmt: skip
    fit = found(path).fit
    # odrpack scales by the squares over rows less parameters, though a row has two values here; weights are known.
    deviations = other.sd_beta / np.sqrt(other.res_var)
    for name, value, deviation in zip(("seebeck", "resistance", "conductance"), other.beta, deviations, strict=True):
        mine = fit[name]
        # Noise is read off the residuals here and given there; an outlier pulls less here.
        assert mine.value == pytest.approx(value, abs=0.5 * deviation), name
        assert mine.low < value < (mine.high or 0.0), name
        assert (mine.high - mine.low) / (2.0 * 2.05 * deviation) == pytest.approx(1.0, abs=0.2), name
