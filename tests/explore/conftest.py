"""The explorer of a small study, served by the command, and pages of it in a browser."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack

import pytest
from browsers import browser
from explored import small_study
from playwright.sync_api import Browser
from served_explorer import Explorer, Served, exploring

__all__ = ["browser"]


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """Serve one explorer of the small study for all tests of a file."""
    folder = tmp_path_factory.mktemp("explore")
    result = Served(small_study(folder), folder / "out")
    result.begin()
    yield result
    result.end()


@pytest.fixture
def explorer(browser: Browser, served: Served) -> Iterator[Explorer]:
    """Open the explorer on a usual screen, in its first state."""
    with exploring(browser, served.address) as result:
        result.reset()
        yield result


@pytest.fixture
def another(browser: Browser, served: Served) -> Iterator[Callable[..., Explorer]]:
    """Open one more page of the same explorer."""
    with ExitStack() as stack:
        yield lambda **settings: stack.enter_context(exploring(browser, served.address, **settings))
