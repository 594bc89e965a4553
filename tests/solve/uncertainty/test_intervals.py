"""Intervals over unmeasured inputs, against plain loops over the table and the simulation, and closed forms."""

import math
from dataclasses import FrozenInstanceError, replace
from functools import cache

import numpy as np
import pytest
from comparable import SHEAR
from numpy.typing import NDArray
from scipy.stats import qmc

from tvimdesign.base.deadline import NEVER
from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions, ResolvedModule, resolve_study
from tvimdesign.solve.uncertainty.design_uncertainty import DesignUncertainty, UncertaintyModel
from tvimdesign.solve.uncertainty.uncertain_inputs import (
    Interval,
    UnmeasuredInput,
    draw,
    intervals,
    share_of_variance,
    unmeasured_inputs,
)
from tvimdesign.study import read_study_text, standard_tolerances

TABLE = table_for("shear")
ALGEBRAIC = "impedance_range"
OUTPUTS = (ALGEBRAIC, "module_mass", "softening_time", "stiffening_time")


def unknown(name: str, low: float, high: float, value: float = math.nan) -> UnmeasuredInput:
    return UnmeasuredInput(name, 0.5 * (low + high) if math.isnan(value) else value, low, high, "assumed")


@cache
def module() -> ResolvedModule:
    resolved = resolve_study(read_study_text(SHEAR, "a test"))
    return replace(resolved, study=resolved.study.model_copy(update={"tolerances": standard_tolerances(TABLE)}))


@cache
def model() -> UncertaintyModel:
    return UncertaintyModel(module(), OUTPUTS)


def rows(columns: NDArray[np.float64], names: list[str]) -> NDArray[np.float64]:
    """Return what the kernel computes of modules, a row an output."""
    numbers = [float(value) for value in module().values.values() if isinstance(value, int | float)]
    many = model()._model
    assert many is not None
    return model()._rows(module(), many.pace_at(np.array(numbers)), NEVER, columns, names)


@cache
def uncertainty() -> DesignUncertainty:
    return model().at(module(), 16, 512)


@cache
def simulator() -> Simulator:
    return Simulator(DeviceFunctions(TABLE, module().values, module().points, module().study.solver.cells))


def simulated(output: str, **changes: float) -> float:
    """Return one output by the simulator alone, no kernel."""
    inputs, phases = simulator().model.start.copy(), ["softening"] if output == "softening_time" else None
    for name, value in changes.items():
        inputs[simulator().model.index[name]] = value
    return float(simulator().run(inputs, phases=phases).values[output])


@pytest.mark.gate
def test_the_ends_are_those_of_a_plain_loop_through_the_same_modules():
    looped = []
    for column in draw(uncertainty().unmeasured, 512, module().study.solver.seed).T:
        moved = {assumed.name: float(value) for assumed, value in zip(uncertainty().unmeasured, column, strict=True)}
        looped.append(float(TABLE.evaluate({**module().values, **moved}, [ALGEBRAIC])[ALGEBRAIC]))
    low, high = np.quantile(looped, [0.025, 0.975], method="inverted_cdf")
    interval = uncertainty().intervals[ALGEBRAIC]
    assert (interval.low, interval.high) == pytest.approx((low, high), rel=1e-9)
    assert interval.low < interval.nominal < interval.high


@pytest.mark.slow
@pytest.mark.parametrize("output", ["softening_time", "stiffening_time"])
def test_an_interval_of_a_time_is_that_of_simulations_one_by_one(output):
    interval = uncertainty().intervals[output]
    moved = [
        assumed for assumed in unmeasured_inputs(module()) if assumed.name in {s.moved.name for s in interval.swings}
    ]
    points = qmc.LatinHypercube(len(moved), rng=3).random(48)
    looped = [
        simulated(
            output, **{assumed.name: float(assumed.ppf(share)) for assumed, share in zip(moved, point, strict=True)}
        )
        for point in points
    ]
    # Of 48, the quartiles are sure to a tenth; between the ends lie nearly all.
    drawn = draw(uncertainty().unmeasured, 512, module().study.solver.seed)
    kernel = rows(drawn, [assumed.name for assumed in uncertainty().unmeasured])[model().outputs.index(output)]
    for share in (0.25, 0.5, 0.75):
        assert np.quantile(looped, share, method="lower") == pytest.approx(np.quantile(kernel, share), rel=0.15)
    inside = np.mean([interval.low <= value <= interval.high for value in looped])
    assert inside >= 0.875


@pytest.mark.gate
@pytest.mark.parametrize("place", [0, 1, 2])
def test_one_at_a_time_is_what_a_simulation_says_at_both_ends(place):
    swing = uncertainty().intervals["softening_time"].swings[place]
    for end, expected in ((swing.moved.low, swing.at_low), (swing.moved.high, swing.at_high)):
        assert simulated("softening_time", **{swing.moved.name: end}) == pytest.approx(expected, rel=0.01)


@pytest.mark.gate
def test_to_know_what_carries_most_narrows_an_interval_most():
    interval = uncertainty().intervals["softening_time"]
    half = interval.to_halve
    assert bool(half) == (sum(interval.shares.values()) >= 0.75)  # half the width leaves a quarter of the variance
    assert not half or interval.first in half
    assert list(interval.shares.values()) == sorted(interval.shares.values(), reverse=True)
    assert interval.high - interval.low > 0.5 * interval.nominal

    def width(known: tuple[str, ...]) -> float:
        unknown_inputs = [assumed for assumed in uncertainty().unmeasured if assumed.name not in known]
        columns = draw(unknown_inputs, 512, 11)
        row = model().outputs.index("softening_time")
        low, high = np.quantile(rows(columns, [assumed.name for assumed in unknown_inputs])[row], [0.025, 0.975])
        return float(high - low)

    every = width(())
    assert not half or width(half) < 0.62 * every  # half, within what 512 draws and a bent function leave
    shares = interval.shares
    others = [name for name, share in shares.items() if share < 0.5 * shares[interval.first]]
    assert width((interval.first,)) < every
    assert width((interval.first,)) < min(width((name,)) for name in others[:3])


def test_shares_are_those_of_a_sum():
    inputs = [unknown("a", 0.0, 3.0), unknown("b", 0.0, 1.0), unknown("c", 10.0, 10.5)]
    drawn = draw(inputs, 1024, 1)
    (whole,) = intervals(lambda x: x.sum(axis=0, keepdims=True), inputs, drawn, drawn.sum(axis=0, keepdims=True), 0.0)
    # Variances of even distributions: width squared over twelve.
    for name, width in (("a", 3.0), ("b", 1.0), ("c", 0.5)):
        assert whole.shares.get(name, 0.0) == pytest.approx(width**2 / 10.25, abs=0.05)
    assert whole.first == "a"
    assert whole.to_halve == ("a",)
    assert whole.one_at_a_time == (10.75, 13.75)
    assert [swing.moved.name for swing in whole.swings] == ["a", "b", "c"]


def test_what_is_known_by_its_order_only_is_drawn_evenly_in_its_logarithm():
    contact = unknown("contact", 1e3, 1e5, 1e4)
    assert contact.logarithmic
    assert contact.ppf([0.0, 0.5, 1.0]) == pytest.approx([1e3, 1e4, 1e5])
    assert not unknown("air", 293.15, 298.15).logarithmic
    assert unknown("air", 20.0, 25.0).ppf(0.5) == pytest.approx(22.5)


def test_what_may_never_happen_has_no_upper_end():
    inputs = [unknown("a", 0.0, 1.0)]
    drawn = draw(inputs, 512, 1)

    def late(x: np.ndarray) -> np.ndarray:
        return np.where(x < 0.9, x, np.inf)

    (interval,) = intervals(late, inputs, drawn, late(drawn), 100.0)
    assert math.isinf(interval.high)
    assert interval.low == pytest.approx(0.025, abs=0.01)
    assert interval.first == "a"
    assert interval.swings[0].size == math.inf


def test_noise_has_no_share_and_even_steps_all():
    noise = np.random.default_rng(2)
    assert share_of_variance(noise.random(512), noise.random(512)) < 0.03
    assert share_of_variance(noise.random(512), np.full(512, 3.0)) == 0.0
    assert share_of_variance(noise.random(512), np.where(noise.random(512) < 0.1, 1e300, 1.0)) == 0.0
    # Variance (16^2 - 1)/12 = 21.25, between groups 21; as many groups of noise would have 7/15 of it.
    steps = np.arange(16.0)
    assert share_of_variance(steps, steps) == pytest.approx(1.0 - 0.25 / 21.25 * 15.0 / 8.0, rel=1e-12)
    inputs = [unknown(f"input_{i}", 0.0, 1.0) for i in range(57)]
    drawn = draw(inputs, 512, 1)
    shares = [share_of_variance(a, b) for i, a in enumerate(drawn) for b in drawn[:i]]
    assert max(shares) < 0.1  # Sobol points have pairs of 0.75 here


def test_a_value_that_the_study_sets_or_that_is_measured_is_not_moved():
    own = read_study_text(SHEAR.replace("module:\n", "module:\n  hot_contact: 10000 W/m^2/K\n"), "a test")
    names = {assumed.name for assumed in unmeasured_inputs(resolve_study(own))}
    assert "hot_contact" in {assumed.name for assumed in unmeasured_inputs(module())}
    assert "hot_contact" not in names
    record = module().values["heater_module"]
    ends = {"exactly": (None, None), "to its interval": (0.020, 0.022)}
    for known, (low, high) in ends.items():
        entry = replace(record.entries["seebeck"], value=0.021, status="measured", low=low, high=high)
        changed = replace(record, entries={**record.entries, "seebeck": entry})
        values = {**module().values, "heater_module": changed, "heater_seebeck": 0.021}
        moved = {assumed.name: assumed for assumed in unmeasured_inputs(replace(module(), values=values))}
        assert ("heater_seebeck" in moved) == (known == "to its interval")
    assert (moved["heater_seebeck"].low, moved["heater_seebeck"].high) == (0.020, 0.022)


def test_what_varies_and_what_is_not_known_are_never_one_yield():
    # With nothing unmeasured moved the yield is the same: it is of the parts alone.
    alone = model().at(module(), 256, 8)
    assert alone.together == model().at(module(), 256, 64).together
    assert 0.0 <= alone.holds.share <= min(alone.held.values(), default=1.0)


@pytest.mark.slow
def test_a_limit_is_held_in_the_share_of_the_range_that_keeps_it():
    # A softening limit in the middle of what the time may be is kept by about half.
    interval = uncertainty().intervals["softening_time"]
    middle = float(np.median([interval.low, interval.high]))
    text = SHEAR.replace("require:\n", f'require:\n  softening_time: "<= {middle:.4g} s"\n')
    resolved = resolve_study(read_study_text(text, "a test"))
    held = UncertaintyModel(resolved, ["softening_time"]).at(resolved, 4, 256).held
    name = next(name for name in held if name.startswith("softening_time"))
    times = [
        simulated(
            "softening_time",
            **{
                assumed.name: float(assumed.ppf(share))
                for assumed, share in zip(uncertainty().unmeasured, point, strict=True)
            },
        )
        for point in qmc.LatinHypercube(len(uncertainty().unmeasured), rng=5).random(40)
    ]
    assert held[name] == pytest.approx(np.mean(np.array(times) <= middle), abs=0.2)


def test_intervals_are_frozen_and_the_fewest_inputs_halve_them():
    (interval,) = intervals(lambda x: x, [unknown("a", 0.0, 1.0)], np.array([[0.2, 0.8]]), np.array([[0.2, 0.8]]), 1.0)
    for frozen, name in ((interval, "low"), (interval.swings[0], "at_low")):
        with pytest.raises(FrozenInstanceError):
            setattr(frozen, name, 0.0)

    def of(*shares: float) -> tuple[str, ...]:
        return Interval(0.0, 0.0, 1.0, (), dict(zip("abc", shares, strict=False))).to_halve

    assert of(0.75, 0.2) == ("a",)  # half the width is a quarter of the variance
    assert of(0.5, 0.24, 0.02) == ("a", "b", "c")
    assert of(0.5, 0.2) == ()
