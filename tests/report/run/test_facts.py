"""Facts of a result: what was chosen of what is listed, and a layer that stalls."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from tvimdesign.report.run.blocks.facts import (
    chosen_fact,
    heater_voltage,
    stalling_in_words,
    time_over_rise,
)
from tvimdesign.solve.nlp.solution import Choosing, SolverEffort, Standard
from tvimdesign.solve.result import StudyResult
from tvimdesign.study.design import Design


def entry(value: float, now: tuple[float, float], before: tuple[float, float | None] | None) -> dict[str, Any]:
    earlier = None if before is None else {"low": before[0], "high": before[1]}
    return {"value": value, "low": now[0], "high": now[1], "unit": "s", "before": earlier}


RANKED = ((1.0e-3, 0.6339), (1.1e-3, 0.6426), (1.2e-3, 0.6541))
"""Wires and objectives of the printed elbow's search."""


def chosen(own: float, robust: dict[str, Any] | None, spring: str = "none") -> str:
    """What is said of a design with this wire [m], whose study asks for margins or not."""
    best = tuple(Standard({"wire_diameter": wire, "stock_spring": "none"}, objective, {}) for wire, objective in RANKED)
    none = SolverEffort()
    choosing = Choosing(
        20, 20, 0, 0, best=best, between=None, proven=False, improved=0.0, work=none, proof=none, inside=0.0
    )
    design = SimpleNamespace(
        mode="shear", values={"wire_diameter": own}, choices={"stock_spring": spring}, study={"robust": robust}
    )
    answer = SimpleNamespace(solution=SimpleNamespace(choosing=choosing), design=design)
    return chosen_fact(cast(StudyResult, answer))[0].text


def test_a_design_s_own_choices_are_told_beside_the_ranking() -> None:
    text = chosen(1.0e-3, None)
    assert text == "wire diameter 1 mm · stock spring none · best of 20 combinations"
    robust = {"share": 0.95, "sigma": None}
    assert "the best is stock spring none" in chosen(1.0e-3, robust, "central_t10160")
    assert "best of 20 combinations, ranked without margins" in chosen(1.0e-3, robust)
    text = chosen(1.1e-3 * (1 + 1e-12), {"share": None, "sigma": 2.0})
    assert "ranked without margins, the best is wire diameter 1 mm" in text


def warmed(share: np.ndarray) -> dict[str, list[float]]:
    """Two cells that warm from 20 degC by shares of 80 K, one a little behind, over 100 s."""
    return {"time": np.linspace(0.0, 100.0, len(share)).tolist(), "cell_1": (20.0 + 80.0 * share).tolist(),
            "cell_2": (20.0 + 76.0 * share).tolist()}  # fmt: skip


def test_a_layer_that_stalls_cools_again_or_never_softens() -> None:
    times = np.linspace(0.0, 1.0, 2001)
    assert time_over_rise(warmed(times), 60.0) == pytest.approx(1.0, rel=1e-6)
    assert time_over_rise(warmed(np.sqrt(times)), 60.0) == pytest.approx(2.0, rel=1e-3)
    # 1 - exp(-t/tau): rise over (t slope) is (exp(x) - 1)/x with x = t/tau, here 3.
    found = warmed(1.0 - np.exp(-times / 0.2))
    assert time_over_rise(found, 60.0) == pytest.approx((np.exp(3.0) - 1.0) / 3.0, rel=1e-3)
    assert stalling_in_words(found, 60.0) == "it stalls: 1 % less heat takes 6 % longer"
    assert stalling_in_words(found, 20.0) == ""
    falling = warmed(np.concatenate([np.linspace(0.0, 1.0, 50), np.linspace(1.0, 0.9, 50)]))
    assert "never soft" in stalling_in_words(falling, 90.0)
    assert stalling_in_words(falling, float("inf")) == ""
    assert stalling_in_words(None, 10.0) == ""
    assert stalling_in_words(falling, 0.0) == ""  # soft from the start: nothing is waited for


@pytest.mark.parametrize(
    ("volts", "words"), [(7.151, "7.15 V (7 to 8) from 24"), (22.0, "22 V (7 to 8)"), (24.0, "24 V (7 to 8)")]
)
def test_a_heater_that_needs_far_less_than_the_supply_is_stepped_down(volts: float, words: str) -> None:
    limits = [{"output": "peak_voltage", "sense": "<=", "limit": 24.0}]
    values = {"peak_voltage": volts, "stiffening_peak_voltage": 1.0}
    design = Design.model_construct(mode="shear", values=values, study={"require": limits})
    answered = cast(StudyResult, SimpleNamespace(design=design))
    assert heater_voltage(answered, {"intervals": {"peak_voltage": entry(volts, (7.0, 8.0), None)}}) == words
    design.study["require"] = []
    assert heater_voltage(answered, {}) == f"{volts:.3g} V"
