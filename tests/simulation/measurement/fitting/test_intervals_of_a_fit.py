"""Fits against textbook formulas and against lmfit: values, intervals, outliers, and what is said of the data."""

from typing import Any

import lmfit
import numpy as np
import pytest
from scipy.stats import linregress
from scipy.stats import t as student

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.fitting.fit import Fit, fitted
from tvimdesign.simulation.measurement.fitting.intervals import spread
from tvimdesign.simulation.measurement.fitting.problem import (
    Array,
    Channel,
    Derived,
    Parameter,
    Problem,
    Residuals,
    Values,
)
from tvimdesign.simulation.measurement.fitting.robust_fit import robust_fit

X = np.linspace(0.1, 5.0, 60)
NOISE = np.random.default_rng(4).normal(0.0, 0.02, len(X))
DECAY = 3.0 * np.exp(-0.7 * X) + NOISE


def problem(
    measured: Array, predicted: Any, *parameters: Parameter, derived: tuple[Derived, ...] = (), over: Array = X
) -> Problem:
    return Problem(parameters, [Channel("y", "1", measured, predicted, over, "x", "1")], derived)


def decay(values: Values) -> Any:
    return values["size"] * np.exp(-values["rate"] * X)


def decay_fit(measured: Array, **more: bool) -> Fit:
    size, rate = Parameter("size", "1", "", 1.0), Parameter("rate", "1/s", "", 2.0)
    return fitted(problem(measured, decay, size, rate), **more)


def test_a_line_has_the_intervals_of_the_textbook() -> None:
    measured = 2.0 + 0.5 * X + NOISE
    slope = Parameter("slope", "1", "", 0.1, positive=False)
    zero = Parameter("zero", "1", "", 0.0, positive=False)
    found = fitted(problem(measured, lambda values: values["zero"] + values["slope"] * X, slope, zero))
    book = linregress(X, measured)
    quantile = student.ppf(0.975, len(X) - 2)
    # Few residuals of normal noise lie where the loss is no square: within a twentieth of the interval.
    for name, value, deviation in (("slope", book.slope, book.stderr), ("zero", book.intercept, book.intercept_stderr)):
        one = found[name]
        assert one.value == pytest.approx(value, abs=0.1 * deviation)
        assert 0.5 * (one.high - one.low) == pytest.approx(quantile * deviation, rel=0.05)
    assert found.noise[0] == pytest.approx(float(np.std(measured - book.intercept - book.slope * X, ddof=2)), rel=0.05)


def test_a_decay_is_that_of_lmfit_with_its_profile() -> None:
    found = decay_fit(DECAY)
    model = lmfit.models.ExponentialModel()
    other = model.fit(DECAY, x=X, amplitude=1.0, decay=0.5)
    assert found.value("rate") == pytest.approx(1.0 / other.params["decay"].value, rel=2e-3)
    assert found.value("size") == pytest.approx(other.params["amplitude"].value, rel=2e-3)
    ends = {name: [end for _, end in other.conf_interval(sigmas=[0.95])[name]] for name in ("amplitude", "decay")}
    size, rate = found["size"], found["rate"]
    assert [size.low, size.high] == pytest.approx(ends["amplitude"][::2], rel=3e-3)
    assert [rate.low, rate.high] == pytest.approx([1.0 / end for end in ends["decay"][::-2]], rel=3e-3)


def test_an_outlier_hardly_moves_the_fit() -> None:
    spoilt = DECAY.copy()
    spoilt[[5, 30]] += [1.0, -0.8]
    before, after = decay_fit(DECAY), decay_fit(spoilt)
    square = lmfit.models.ExponentialModel().fit(spoilt, x=X, amplitude=1.0, decay=0.5)
    assert after.value("rate") == pytest.approx(before.value("rate"), rel=0.01)
    assert abs(1.0 / square.params["decay"].value - before.value("rate")) > 3.0 * abs(
        after.value("rate") - before.value("rate")
    )


def test_what_only_a_product_decides_is_said_and_has_no_interval() -> None:
    one, other = Parameter("mass", "kg", "", 1.0), Parameter("speed", "1", "", 1.0)
    product = Derived("momentum", "1", "", lambda values: values["mass"] * values["speed"])
    measured = 3.0 * X + NOISE
    found = fitted(
        problem(measured, lambda values: values["mass"] * values["speed"] * X, one, other, derived=(product,))
    )
    assert found["mass"].low is found["mass"].high is found["speed"].low is None
    assert found["momentum"].low is not None
    assert found.value("momentum") == pytest.approx(3.0, rel=0.01)
    (said,) = found.words
    assert "cannot tell mass and speed apart: they make up for one another" in said


def test_a_parameter_without_effect_is_named() -> None:
    idle = Parameter("idle", "1", "", 1.0)
    slope = Parameter("slope", "1", "", 1.0)
    found = fitted(problem(3.0 * X + NOISE, lambda values: values["slope"] * X, slope, idle))
    assert found.words == (
        "The data say nothing of idle: no prediction depends on it. Its value is the start of the fit.",
    )


def test_an_end_that_the_data_leave_open_is_open() -> None:
    # Far slower than the record is long: any longer time does as well.
    rate = Parameter("rate", "1/s", "", 0.01)
    size = Parameter("size", "1", "", 1.0)
    found = fitted(problem(1.0 + NOISE, decay, size, rate))
    assert found["rate"].low is None
    assert "The data do not bound rate from below." in found.words


def test_residuals_that_follow_one_another_widen_the_intervals() -> None:
    drift = np.cumsum(NOISE) * 0.3
    found, plain = decay_fit(3.0 * np.exp(-0.7 * X) + drift), decay_fit(DECAY)
    assert found.autocorrelation[0] > 0.5
    assert plain.autocorrelation[0] < 0.2
    assert any("Residuals follow one another" in said for said in found.words)


def test_too_few_values_are_refused() -> None:
    one, other = Parameter("a", "1", "", 1.0), Parameter("b", "1", "", 1.0)
    few = problem(X[:2], lambda values: values["a"] + values["b"] * X[:2], one, other, over=X[:2])
    with pytest.raises(InputError, match="2 values do not give 2 parameters"):
        fitted(few)


def test_a_parameter_whose_bounds_leave_it_no_room_is_refused() -> None:
    slope = Parameter("slope", "1", "", 1e5, most=1e-200)
    with pytest.raises(InputError, match=r"slope: the data suggest 1e\+05 1; look for a wrong number"):
        fitted(problem(3.0 * X, lambda values: values["slope"] * X, slope))


def test_what_is_known_to_lie_between_two_ends_adds_their_variance() -> None:
    # A mean read with an offset of which only the ends are known: GUM 4.3.7, width^2/12 beside the mean's variance.
    measured, width = 5.0 + NOISE, 0.03
    mean = Parameter("mean", "1", "", 5.0, positive=False)
    offset = Parameter("offset", "1", "", 0.0, positive=False, nuisance=True, least=-0.5 * width, most=0.5 * width)
    spreads = []
    for parameters in ([mean], [mean, offset]):
        residuals = Residuals(
            problem(
                measured, lambda values: (values["mean"] + values.get("offset", 0.0)) * np.ones(len(X)), *parameters
            )
        )
        start = np.array([one.inner(one.start) for one in parameters])
        spreads.append(spread(residuals, robust_fit(residuals, start)))
    alone, together = (float(one.covariance[0, 0]) for one in spreads)
    assert not spreads[1].free_directions
    assert together == pytest.approx(alone + width**2 / 12.0, rel=1e-3)
