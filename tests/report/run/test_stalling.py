"""A layer that hardly warms any more is told: against a warming-up whose closed form is known."""

import numpy as np
import pytest

from tvimdesign.report.run.blocks.facts import stalling_in_words, time_over_rise


def warmed(share: np.ndarray) -> dict[str, list[float]]:
    """Two cells that warm from 20 degC by shares of 80 K, one a little behind, over 100 s."""
    return {"time": np.linspace(0.0, 100.0, len(share)).tolist(), "cell_1": (20.0 + 80.0 * share).tolist(),
            "cell_2": (20.0 + 76.0 * share).tolist()}  # fmt: skip


def test_one_per_cent_of_heat_takes_as_long_as_the_exponential_says() -> None:
    times = np.linspace(0.0, 1.0, 2001)
    assert time_over_rise(warmed(times), 60.0) == pytest.approx(1.0, rel=1e-6)
    assert time_over_rise(warmed(np.sqrt(times)), 60.0) == pytest.approx(2.0, rel=1e-3)
    # 1 - exp(-t/tau): rise over (t slope) is (exp(x) - 1)/x with x = t/tau, here 3.
    found = warmed(1.0 - np.exp(-times / 0.2))
    assert time_over_rise(found, 60.0) == pytest.approx((np.exp(3.0) - 1.0) / 3.0, rel=1e-3)
    assert stalling_in_words(found, 60.0) == "it stalls: 1 % less heat takes 6 % longer"
    assert stalling_in_words(found, 20.0) == ""


def test_a_layer_that_cools_again_or_never_softens_is_told_as_that() -> None:
    falling = warmed(np.concatenate([np.linspace(0.0, 1.0, 50), np.linspace(1.0, 0.9, 50)]))
    assert "never soft" in stalling_in_words(falling, 90.0)
    assert stalling_in_words(falling, float("inf")) == ""
    assert stalling_in_words(None, 10.0) == ""
    assert stalling_in_words(falling, 0.0) == ""  # soft from the start: nothing is waited for
