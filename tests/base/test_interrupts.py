"""An interrupt is raised, and raised again where a library swallows it."""

import os
import signal
from contextlib import suppress

import pytest

from tvimdesign.base.interrupts import exit_code, heeding_interrupts, raise_pending


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_an_interrupt_that_was_swallowed_is_raised_again_until_all_is_over(number: signal.Signals) -> None:
    before = signal.getsignal(number)
    with heeding_interrupts():
        with heeding_interrupts(), suppress(KeyboardInterrupt):
            os.kill(os.getpid(), number)
        with pytest.raises(KeyboardInterrupt):
            raise_pending()
        assert exit_code() == 128 + number
    raise_pending()
    assert signal.getsignal(number) is before


def test_a_signal_that_comes_twice_at_once_does_not_disturb_the_cleaning_up() -> None:
    cleaned = False
    with heeding_interrupts():
        try:
            os.kill(os.getpid(), signal.SIGTERM)
        except KeyboardInterrupt:
            os.kill(os.getpid(), signal.SIGTERM)
            cleaned = True
    assert cleaned


def test_a_signal_that_is_ignored_stays_ignored() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with heeding_interrupts():
            os.kill(os.getpid(), signal.SIGHUP)
            raise_pending()
    finally:
        signal.signal(signal.SIGHUP, before)


def test_an_interrupt_that_cannot_be_raised_where_it_comes_is_kept_without_a_word(
    capsys: pytest.CaptureFixture[str],
) -> None:
    class Ends:
        def __del__(self) -> None:
            signal.raise_signal(signal.SIGTERM)  # as in a function of SciPy's that cannot hand an exception on

    with heeding_interrupts():
        one = Ends()
        del one
        with pytest.raises(KeyboardInterrupt):
            raise_pending()
    assert not capsys.readouterr().err
