"""Searches for the cheapest module among records, and what a limit on its cost says."""

from pathlib import Path

import pytest
from support import sample_text

from tvimdesign.base.errors import InfeasibleError, InputError
from tvimdesign.solve.infeasibility.early_checks import refuse_what_cannot_be
from tvimdesign.solve.search import optimize
from tvimdesign.study import Study, read_study
from tvimdesign.study.resolve import record_checks

STUDY = sample_text("cheapest")
HEATER = 'title: "{name} heater"\nbased_on: flexible_1600\n'
PRICE = 'values:\n  price: {{value: {price}, unit: USD, status: datasheet, source: "a quote"}}\n'


def _study(folder: Path, text: str = STUDY, **prices: float) -> Study:
    records = folder / "records" / "heaters"
    records.mkdir(parents=True, exist_ok=True)
    for name, price in prices.items():
        words = HEATER.format(name=name) + (PRICE.format(price=price) if price else "")
        (records / f"{name}.yaml").write_text(words, encoding="utf-8")
    (folder / "study.yaml").write_text(text, encoding="utf-8")
    return read_study(folder / "study.yaml")


@pytest.mark.gate
def test_the_cheaper_of_two_equal_heaters_is_chosen(tmp_path):
    study = _study(tmp_path, dear=25.0, cheap=15.0)
    solution = optimize(study)
    assert solution.status == "optimal"
    cheap, dear = solution.choosing.best
    assert (cheap.choices["heater_module"], dear.choices["heater_module"]) == ("cheap", "dear")
    of_dear = float(solution.values["cost"]) + 10.0 * float(solution.values["heater_count"])
    assert dear.objective / cheap.objective == pytest.approx(of_dear / float(solution.values["cost"]), rel=1e-6)


@pytest.mark.gate
def test_a_limit_on_the_cost_rules_out_the_dear_heater(tmp_path):
    text = STUDY.replace('rad"}', 'rad", cost: "<= 200 USD"}').replace("minimize: cost", "minimize: springs_mass")
    solution = optimize(_study(tmp_path, text, dear=25.0, cheap=15.0))
    assert solution.status == "optimal"
    assert solution.choosing.best[0].choices["heater_module"] == "cheap"
    assert len(solution.choosing.best) == 1


@pytest.mark.gate
def test_a_limit_below_every_cost_names_the_least_one(tmp_path):
    shelf = STUDY.replace("{choose: [dear, cheap]}", "{choose: [cheap]}")
    least = float(optimize(_study(tmp_path, shelf, cheap=15.0)).values["cost"])
    study = _study(tmp_path, shelf.replace('rad"}', 'rad", cost: "<= 60 USD"}'), cheap=15.0)
    with pytest.raises(InfeasibleError, match=rf"cost <= 60 USD cannot hold .* to <= {least:.4g} USD"):
        refuse_what_cannot_be(study)


def test_no_price_is_no_bargain(tmp_path):
    study = _study(tmp_path, dear=25.0, cheap=0.0)
    with pytest.raises(InputError, match=r"vary\.heater_module: cost cannot compare .* without a price: cheap\."):
        optimize(study)
    (warning,) = (line for line in record_checks(study) if "no price" in line)
    assert "no price: spring, thermal cutout, pcl; ask" in warning
    study = _study(tmp_path, STUDY.replace("minimize: cost", "minimize: springs_mass"))
    assert not [line for line in record_checks(study) if "no price" in line]
    assert optimize(study).status == "optimal"
