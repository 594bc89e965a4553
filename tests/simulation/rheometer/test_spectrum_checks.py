"""What is no spectrum, and what does not rise, is refused with the value and its place."""

import math

import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.rheometer.spectrum_checks import check_rising, check_spectrum

Modes = list[tuple[float, float]]


@pytest.mark.parametrize(
    ("modes", "said"),
    [
        ([], "here: the spectrum has no modes; expected at least one"),
        ([(1.0, 5.0), (0.1, -2.5)], "here: mode 2 has the modulus -2.5 Pa; expected a number greater than zero"),
        ([(0.0, 5.0)], "here: mode 1 has the relaxation time 0 s; expected a number greater than zero"),
        ([(1.0, math.nan)], "here: mode 1 has the modulus nan Pa"),
        ([(math.inf, 1.0)], "here: mode 1 has the relaxation time inf s"),
    ],
)
def test_what_is_no_spectrum_is_refused_with_the_value_and_its_place(modes: Modes, said: str) -> None:
    with pytest.raises(InputError) as caught:
        check_spectrum(modes, "here")
    assert str(caught.value).startswith(said)


def test_numbers_that_do_not_rise_are_refused_with_the_value_and_its_place() -> None:
    check_rising([1.0, 2.0, 3.0], "there", "K")
    for values in ([1.0, 3.0, 2.0], [1.0, 3.0, 3.0], [1.0, 3.0, math.nan]):
        with pytest.raises(InputError, match=r"there: value 3 is \S+ K and follows 3 K; expected rising values"):
            check_rising(values, "there", "K")
