"""Progress shows where somebody sees it: a moving line in a notebook, nothing in a pipe or a thread."""

from __future__ import annotations

import sys
import threading
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

import tvimdesign as tvim
from tvimdesign.api.notebook import in_notebook, shown_progress


@pytest.fixture
def notebook(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """A kernel of which nothing is there but what progress asks for; returns what it shows."""
    said: list[str] = []

    def note(data: dict[str, str], **how: bool) -> Any:
        assert how["raw"]
        said.append(data["text/plain"])
        return SimpleNamespace(update=note)

    kernel, display = ModuleType("IPython"), ModuleType("IPython.display")
    monkeypatch.setattr(kernel, "get_ipython", lambda: SimpleNamespace(kernel=object()), raising=False)
    monkeypatch.setattr(display, "display", note, raising=False)
    monkeypatch.setitem(sys.modules, "IPython", kernel)
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    return said


def test_a_notebook_shows_one_line_that_is_empty_in_the_end(notebook: list[str]) -> None:
    assert in_notebook()
    tvim.example("paper_as_published").evaluate()
    assert "... simulating one working cycle" in notebook
    assert notebook[-1] == ""


def test_the_line_is_emptied_after_an_error_too(notebook: list[str]) -> None:
    def work() -> None:
        with shown_progress(True) as say:
            say("working")
            raise KeyError

    with pytest.raises(KeyError):
        work()
    assert notebook == ["...", "... working", ""]


def test_nothing_is_shown_where_it_is_not_wanted(notebook: list[str]) -> None:
    tvim.example("paper_as_published").evaluate(progress=False)
    assert notebook == []


def test_a_pipe_and_a_thread_see_nothing(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    study = tvim.example("paper_as_published")
    with shown_progress(True) as say:
        say("working")
    assert capfd.readouterr() == ("", "")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    failed: list[BaseException] = []

    def work() -> None:
        try:
            study.evaluate()
        except BaseException as error:
            failed.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert failed == []
