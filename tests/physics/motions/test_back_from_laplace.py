"""The way back from a Laplace transform, against pairs of any table of transforms."""

from collections.abc import Callable

import numpy as np
import pytest

from tvimdesign.physics.motions import motion

PAIRS: dict[str, tuple[Callable[[float], float], Callable[[float], float]]] = {
    "one": (lambda s: 1.0 / s, lambda _: 1.0),
    "time": (lambda s: 1.0 / s**2, lambda t: t),
    "root": (lambda s: s**-1.5, lambda t: 2.0 * np.sqrt(t / np.pi)),
    "decay": (lambda s: 1.0 / (s + 0.7), lambda t: np.exp(-0.7 * t)),
    "approach": (lambda s: 0.7 / (s * (s + 0.7)), lambda t: 1.0 - np.exp(-0.7 * t)),
}


@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("time", [0.03, 0.4, 2.0])
def test_what_fades_or_creeps_comes_back_to_the_stated_accuracy(name: str, time: float) -> None:
    transform, expected = PAIRS[name]
    (found,) = motion.inverse(lambda s: (transform(s),), time)
    assert found == pytest.approx(expected(time), rel=4e-4)


def test_the_weights_are_those_that_stehfest_printed() -> None:
    # Communications of the ACM 13 (1970) 47: those of ten terms.
    printed = [1 / 12, -385 / 12, 1279, -46871 / 3, 505465 / 6, -473915 / 2, 1127735 / 3, -1020215 / 3, 328125 / 2,
               -65625 / 2]  # fmt: skip
    assert motion.weights(10) == pytest.approx(printed, rel=1e-12)
    assert motion.TERMS == 10
