"""A browser, and pages opened in it from the disk. Where there is no browser its tests are skipped, and say why."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
import sample_pages
from browsers import browser
from opened_page import Opened, opening
from playwright.sync_api import Browser

__all__ = ["browser"]


@pytest.fixture(scope="session")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the page of a run: a real answer, with a front and the parts of a small model beside it."""
    return sample_pages.run_page(tmp_path_factory.mktemp("page") / "run")


@pytest.fixture(scope="module")
def screen(browser: Browser, report: Path) -> Iterator[Opened]:
    """Open the page on a usual screen, for all tests of a file that do not change it."""
    with opening(browser, report) as page:
        yield page


@pytest.fixture
def opened(browser: Browser) -> Iterator[Callable[..., Opened]]:
    """Open a file with settings of its own."""
    with ExitStack() as stack:
        yield lambda path, **settings: stack.enter_context(opening(browser, path, **settings))
