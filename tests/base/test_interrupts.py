"""Interrupts are raised, also where a library swallows them; parts of a command share one deadline."""

import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from importlib import import_module

import pytest

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.errors import TimeOverError
from tvimdesign.base.interrupts import exit_code, interrupt_handler, raise_pending


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_an_interrupt_that_was_swallowed_is_raised_again_until_all_is_over(number):
    before = signal.getsignal(number)
    with interrupt_handler():
        with interrupt_handler(), suppress(KeyboardInterrupt):
            os.kill(os.getpid(), number)
        with pytest.raises(KeyboardInterrupt):
            raise_pending()
        assert exit_code() == 128 + number
    raise_pending()
    assert signal.getsignal(number) is before


def test_a_library_s_warning_of_an_interrupt_is_not_printed(capsys):
    with interrupt_handler():
        with suppress(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGTERM)
        sys.stderr.write("CasADi - 2026-11-30 00:57:16 ")
        sys.stderr.write('WARNING("KeyboardInterruptException")')
        sys.stderr.write(" [ipopt_nlp.cpp:114]\n")
        print("kept", file=sys.stderr)
    print("CasADi - after it", file=sys.stderr)
    assert capsys.readouterr().err == "kept\nCasADi - after it\n"


def test_signals_received_twice_or_ignored_do_not_disturb():
    cleaned = False
    with interrupt_handler():
        try:
            os.kill(os.getpid(), signal.SIGTERM)
        except KeyboardInterrupt:
            os.kill(os.getpid(), signal.SIGTERM)
            cleaned = True
    assert cleaned
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with interrupt_handler():
            os.kill(os.getpid(), signal.SIGHUP)
            raise_pending()
    finally:
        signal.signal(signal.SIGHUP, before)


def test_an_interrupt_that_cannot_be_raised_stays_pending(capsys):
    class Ends:
        def __del__(self) -> None:
            signal.raise_signal(signal.SIGTERM)  # as in a function of SciPy's that cannot hand an exception on

    with interrupt_handler():
        item = Ends()
        del item
        with pytest.raises(KeyboardInterrupt):
            raise_pending()
    assert not capsys.readouterr().err


def test_an_import_is_whole_before_an_interrupt_is_raised(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "outer_module.py").write_text("import inner_module\nthrough = True\n")
    (tmp_path / "inner_module.py").write_text("import os, signal\nos.kill(os.getpid(), signal.SIGTERM)\n")
    with interrupt_handler(), suppress(KeyboardInterrupt):
        import_module("outer_module")
        time.sleep(10.0)
        pytest.fail("no interrupt came")
    assert sys.modules["outer_module"].through


def test_a_script_that_is_imported_is_interrupted_at_once(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "imported_script.py").write_text(
        "import os, signal\n"
        "from tvimdesign.base.interrupts import interrupt_handler\n"
        "with interrupt_handler():\n"
        "    os.kill(os.getpid(), signal.SIGTERM)\n"
        "    raise ValueError('it went on')\n"
    )
    with pytest.raises(KeyboardInterrupt):
        import_module("imported_script")


IN_CYTHON = """
import os, signal, zipfile
from scipy.stats import qmc
from tvimdesign.base.interrupts import interrupt_handler, raise_pending
usual = zipfile.crc32
def crc32(*arguments):  # as SciPy reads the numbers of its sequence
    zipfile.crc32 = usual
    os.kill(os.getpid(), signal.SIGINT)
    return usual(*arguments)
zipfile.crc32 = crc32
try:
    with interrupt_handler():
        qmc.Sobol(3)
        raise_pending()
        print("it went on")
except KeyboardInterrupt:
    print("interrupted")
"""


def test_an_interrupt_in_what_cython_cannot_raise_is_not_printed():
    done = subprocess.run([sys.executable, "-c", IN_CYTHON], capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("interrupted\n", "")


IMPORTS = """
import sys
from tvimdesign.base.interrupts import interrupt_handler
try:
    with interrupt_handler():
        print("begins", flush=True)
        import vtk
        import time
        time.sleep(600.0)
except KeyboardInterrupt:
    sys.exit(130 if "vtk" in sys.modules else 1)
"""


@pytest.mark.slow
def test_an_interrupt_while_vtk_is_imported_is_no_fault():
    codes = []
    for share in range(24):
        process = subprocess.Popen([sys.executable, "-c", IMPORTS], stdout=subprocess.PIPE)
        assert process.stdout.readline()
        time.sleep(0.02 * share)
        process.send_signal(signal.SIGINT)
        codes.append(process.wait())
        process.stdout.close()
    assert codes == [130] * len(codes)


class Clock:
    """A clock that is set."""

    now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


def test_parts_leave_time_to_what_follows(clock):
    whole = Deadline(20.0, clock)
    part = whole.leaving(4.0)
    assert (part.remaining, part.late.remaining, whole.remaining) == (16.0, 18.0, 20.0)
    clock.now = 17.0
    assert (part.passed, part.late.passed, whole.passed) == (True, False, False)
    assert part.whole is whole
    part = NEVER.leaving(4.0)
    assert not part.passed
    assert not part.late.passed


def test_a_part_leaves_half_of_the_time_at_most(clock):
    part = Deadline(5.0, clock).leaving(30.0)
    assert part.remaining == 2.5
    clock.now = 2.0
    part.leave(1.0)
    assert part.remaining == 0.5  # once left, time is not taken back


def test_steps_without_time_are_noted_and_named(clock):
    whole = Deadline(5.0, clock)
    part, done = whole.leaving(1.0), list[str]()
    assert part.attempt("the first", lambda: done.append("first") or 1) == 1
    clock.now = 4.5
    assert part.attempt("the second", lambda: done.append("second") or 2) is None
    assert (done, whole.left_out, part.met, whole.met) == (["first"], ["the second"], True, False)
    clock.now = 1.0
    limit = Deadline(20.0, clock)
    clock.now = 21.0
    with pytest.raises(TimeOverError, match=r"limit of 20 s was over before all was done: raise .*--time-limit"):
        limit.check("all was done")


def test_a_step_that_runs_out_of_time_is_noted_once(clock):
    whole = Deadline(5.0, clock)

    def late() -> None:
        clock.now = 6.0
        whole.check("it was done")

    whole.attempt("it", late)
    whole.attempt("it", late)
    assert whole.left_out == ["it"]
