"""Intervals hold what the data were made with (many seeds: `benchmarks/fit_coverage.py`), without any option."""

import json
from pathlib import Path

import numpy as np
import pytest
import yaml
from fit_coverage import MADE, Estimate, code, counted, fit_of, kept_in, table, width_over_scatter
from made_measurements.faults import FAULTS
from measured_files import holds, measured
from scipy.stats import chi2, norm
from support import cases_of

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.measure_files import kind_sheet, kind_sheets, measure_of
from tvimdesign.simulation.measurement.record_file import as_recorded

QUICK = ["torque_angle", "pad", "frozen_torque", "amplitude_sweep", "relaxation", "flow_curve"]
RARE = 1e-3


def kinds(*quick: str) -> list[object]:
    """Return all kinds, with the mark `slow` for those that are not quick."""
    return [pytest.param(kind, marks=[] if kind in quick else pytest.mark.slow) for kind in MADE]


def pull(estimate: Estimate) -> float:
    """Error over the deviation that the interval's end on its side stands for: normal, of deviation one."""
    end = estimate.high if estimate.truth > estimate.value else estimate.low
    return float(norm.ppf(0.975)) * (estimate.truth - estimate.value) / abs(end - estimate.value)


def test_every_kind_has_data_made_for_it():
    assert set(MADE) == set(kind_sheets())


@pytest.mark.gate
@pytest.mark.parametrize("kind", kinds(*QUICK))
def test_intervals_are_as_wide_as_the_errors(kind):
    """Mean squares of each parameter's pulls against chi-squared: intervals of half or twice the width are outside."""
    seeds = 20 if kind in QUICK else 10
    fits = [fit_of(kind, seed) for seed in range(seeds)]
    low, high = chi2.ppf([RARE, 1.0 - RARE], seeds) / seeds
    assert high < 4.0  # of intervals of half the width
    for name in fits[0]:
        square = float(np.mean([pull(fit[name]) ** 2 for fit in fits]))
        assert low < square < high, f"{name}: errors are {square**0.5:.2f} of what its interval says"


@pytest.mark.parametrize("kind", kinds(*MADE.keys() - {"heating_log"}))
def test_all_that_is_reported_is_counted(kind):
    blocks, given, truth = MADE[kind](np.random.default_rng(0))
    fit = measure_of(kind_sheet(kind))(blocks, kind_sheet(kind).values(given), profiles=False).fit
    assert {parameter.name for parameter in (*fit.parameters, *fit.derived)} == set(truth)


def test_a_count_goes_on_where_it_was_left(tmp_path):
    file = tmp_path / "kept.jsonl"
    values = {"seebeck": [0.05, 0.051, 0.049, 0.052], "resistance": [2.0, 1.9, 1.8, 1.95]}
    whole = json.dumps({"code": code(), "kind": "pad", "seed": 0, "found": values})
    older = whole.replace(code(), "0").replace('"seed": 0', '"seed": 2')
    file.write_text("\n".join([whole, older, whole.replace('"seed": 0', '"seed": 1')[:-4]]))  # the last was cut short
    fits = kept_in(file)
    assert list(fits) == [("pad", 0)]
    assert list(table(fits))[2:] == ["| `pad` | 1 | seebeck 100.0 (nan), resistance 0.0 (nan) |"]
    assert counted(["pad"], 1, 1, file) == fits


def test_the_width_is_held_against_the_scatter():
    values = np.random.default_rng(3).normal(7.0, 0.5, 4000)
    exact = [Estimate(7.0, value, value - 0.98, value + 0.98) for value in values]
    assert width_over_scatter(exact) == pytest.approx(1.0, abs=0.03)
    assert sum(count.held for count in exact) / len(exact) == pytest.approx(0.95, abs=0.01)
    assert Estimate(7.0, 9.0, None, None).held


@pytest.mark.gate
@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("kind", ["flow_curve", "frozen_torque", "relaxation", "creep", "melt"])
def test_records_of_faulty_data_hold_the_truth(kind, fault):
    fits = [fit_of(f"{kind}+{fault}", seed) for seed in range(4)]
    for name in {name for fit in fits for name in fit}:
        assert sum(fit[name].held for fit in fits if name in fit) >= sum(name in fit for fit in fits) - 1, name


FILES = Path(__file__).with_name("instrument_files")
TRUTH = [
    pytest.param(path, truth, id=path.relative_to(FILES).as_posix())
    for pattern, truth in yaml.safe_load((FILES / "truth.yaml").read_text()).items()
    for path in sorted(FILES.glob(pattern))
]
WITH_MASS = ("netzsch", "ta_universal", "trios_dsc")


@pytest.mark.parametrize(("path", "truth"), TRUTH)
def test_rheometers(path, truth):
    if "refusal" in truth:
        with pytest.raises(InputError, match=truth["refusal"]):
            measured(path)
        return
    case = measured(path)
    done = case.measurement
    assert case.kind.name == truth["kind"]
    assert not done.fit.misfit
    held = {name: holds(as_recorded(done.record_values[name]), value) for name, value in truth["values"].items()}
    assert held == dict.fromkeys(truth["values"], True)
    flagged = "3 of 30 rows are flagged by the instrument (ME- 3)"
    assert any(flagged in note for note in done.notes) == path.match("amplitude/rheocompass.txt")


@pytest.mark.parametrize("path", sorted(FILES.glob("dsc/*")), ids=lambda path: path.stem)
def test_calorimeters(path):
    done = measured(path)
    assert done.kind.name == "dsc"
    assert not done.measurement.fit.misfit
    values = done.measurement.record_values
    assert values["melting_start"].value - 273.15 == pytest.approx(50.0, abs=0.3)
    assert values["melting_end"].value - 273.15 == pytest.approx(62.0, abs=0.3)
    assert ("latent_heat" in values) == (path.stem in WITH_MASS)
    if path.stem in WITH_MASS:
        assert values["latent_heat"].value == pytest.approx(60e3, rel=0.03)
    else:
        assert "--set sample_mass='5.2 mg' gives it" in done.measurement.notes[-1]
    if path.stem == "setaram":
        assert any("not used: Index, Furnace Temperature (°C)" in line for line in done.read())


@cases_of("coverage", "not_used")
def test_a_refusal_says_what_was_not_used(tmp_path, head, row, message):
    path = tmp_path / "x.csv"
    path.write_text("\n".join([head, *(row.format(i) for i in range(1, 9))]) + "\n")
    with pytest.raises(InputError, match=message):
        measured(path)


def test_columns_decide_for_a_kind(tmp_path):
    path = tmp_path / "stand.csv"
    rows = "\n".join(f"{i};{i % 5};{i / 10};{i}" for i in range(12))
    path.write_text(f"cycle;time [s];angle [deg];torque [N.m]\n{rows}\n")
    with pytest.raises(InputError, match="time does not rise"):  # taken as sine, by the cycles
        measured(path)
