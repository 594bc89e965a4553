"""Progress of a run: elapsed time and time left, a line every few seconds, a user's text as it stands."""

import io
import itertools
import os
import re
import signal
import time
from contextlib import suppress

import pytest
from rich.markup import escape
from rich.table import Table
from support import wait_until

from tvimdesign.base.errors import InputError
from tvimdesign.report.output import terminal
from tvimdesign.report.output.terminal import OwnMarkupConsole, RemainingTime, clock, duration


def test_time_left_is_the_mean_of_the_steps_of_a_series() -> None:
    left = RemainingTime()
    left.heard("start 1 of 4", 10.0)
    assert left.left(12.0) is None
    left.heard("start 2 of 4", 14.0)
    assert left.left(14.0) == pytest.approx(12.0)
    left.heard("a word between", 15.0)
    assert left.left(15.0) == pytest.approx(11.0)
    left.heard("start 4 of 4", 30.0)
    assert left.left(30.0) == pytest.approx(20.0 / 3.0)
    left.heard("drawing the plots", 36.0)
    assert left.left(36.0) is None
    left = RemainingTime()
    left.heard("start 1 of 2", 0.0)
    left.heard("start 2 of 2", 5.0)
    left.heard("point 1 of 9", 10.0)
    assert left.left(10.0) is None
    left.heard("point 3 of 9", 14.0)
    assert left.left(14.0) == pytest.approx(14.0)
    assert [duration(seconds) for seconds in (8.2, 59.4, 125.0, 4320.0)] == ["8 s", "59 s", "2 min 05 s", "1 h 12 min"]
    assert clock(0.4, 9.0) == ""
    assert clock(3.0, None) == "3 s"
    assert clock(3.0, 0.2) == "3 s"
    assert clock(3.0, 90.0) == "3 s, about 1 min 30 s left"


def read_on(capsys: pytest.CaptureFixture[str], lines: list[str]) -> list[str]:
    """Add what was printed since to lines, and return them."""
    lines += capsys.readouterr().err.splitlines()
    return lines


def test_plain_lines_come_every_few_seconds(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(terminal, "PLAIN_EVERY", 1.2)
    with terminal.progress_output() as say:
        for i in range(10):
            say(f"start {i + 1} of 40")
        lines = list[str]()
        assert wait_until(lambda: len(read_on(capsys, lines)) == 3)  # a thread prints the last, then that it goes on
        say("")
    assert len(read_on(capsys, lines)) == 3
    assert lines[0].startswith("... start 1 of 40 · ░")
    assert re.fullmatch(r"\.\.\. start 10 of 40 · █{4}░{16} 22% · \d+ s(, about .* left)?", lines[1])
    assert re.fullmatch(r"\.\.\. still start 10 of 40 · █{4}░{16} 22% · \d+ s(, about .* left)?", lines[2])


def test_what_goes_on_is_shown_again_without_its_figures(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(terminal, "PLAIN_EVERY", 0.0)
    with terminal.progress_output() as say:
        for _ in range(3):
            say("adding margins: 3 % so far")
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "... adding margins: 3 % so far"
    assert {line.partition(" · ")[0] for line in lines[1:]} == {"... still adding margins"}


def test_silence_never_lasts_three_seconds(capsys: pytest.CaptureFixture[str]) -> None:
    lines, times = list[str](), [time.monotonic()]
    with terminal.progress_output() as say:
        say("searching")
        for _ in range(2):
            before = len(lines)
            assert wait_until(lambda count=before: len(read_on(capsys, lines)) > count)
            times.append(time.monotonic())
    assert max(b - a for a, b in itertools.pairwise(times)) < 3.0
    assert len(set(lines)) == len(lines)


@pytest.mark.parametrize("error", [SystemError, RuntimeError, InputError])
def test_what_a_library_raises_after_an_interrupt_is_the_interrupt(error: type[Exception]) -> None:
    def fail(*, interrupted: bool) -> None:
        with terminal.progress_output():
            if interrupted:
                with suppress(KeyboardInterrupt):
                    os.kill(os.getpid(), signal.SIGINT)
            raise error("a result with an exception set")

    with pytest.raises(KeyboardInterrupt):
        fail(interrupted=True)
    with pytest.raises(error):
        fail(interrupted=False)


TEXTS = ["[/bold]", "a [/] b", "[link=http://x]u[/link]", "x[1, 2]", "[[", "]", "[bold", "[/red] [/bold]", ":key:"]


def shown(what: object) -> str:
    stream = io.StringIO()
    OwnMarkupConsole(file=stream, width=80, color_system=None, highlight=False).print(what)
    return stream.getvalue()


@pytest.mark.parametrize("text", TEXTS)
def test_a_user_s_text_is_shown_as_it_stands(text: str) -> None:
    assert text in shown(f"Results are in [bold]{escape(text)}[/bold]")
    assert text in shown(f"Results are in {text}")
    table = Table()
    table.add_column(text)
    table.add_row(text, text)
    assert shown(table).count(text) == 3
    assert shown("[bold]a[/bold] [dim]b[/dim] [red]c[/]") == "a b c\n"
