"""A browser, and pages opened in it from the disk. Where there is no browser its tests are skipped, and say why."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest
import sample_pages
from playwright.sync_api import Browser, Page, sync_playwright

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
ARGUMENTS = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox"]
"""Draw 3-D without a graphics card; run as root, as in a container."""


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """Chromium of the system."""
    if CHROMIUM is None:
        pytest.skip("no browser, so no test of the page in one: install chromium (Debian: apt-get install chromium)")
    with sync_playwright() as play:
        started = play.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield started
        started.close()


@pytest.fixture(scope="session")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a run: a real answer, with a front and the parts of a small model beside it."""
    return sample_pages.run_page(tmp_path_factory.mktemp("page") / "run")


class Opened:
    """A page in the browser, with what it asked of the network and what it complained of."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.requests: list[str] = []
        self.complaints: list[str] = []
        page.on("request", lambda request: self.requests.append(request.url))
        page.on("console", lambda said: self.complaints.append(said.text) if said.type != "log" else None)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))

    def figure(self, name: str) -> Any:
        """A figure, once it is drawn."""
        figure = self.page.locator(f"#figure-{name}")
        figure.scroll_into_view_if_needed()
        self.page.wait_for_selector(f"#figure-{name}[data-state]", timeout=60_000)
        assert figure.get_attribute("data-state") == "drawn", figure.inner_text()
        return figure


@contextmanager
def opening(browser: Browser, path: Path, **settings: Any) -> Iterator[Opened]:
    """A file opened as a reader does who has it on the disk; `settings` are those of a browser's context."""
    context = browser.new_context(**{"viewport": {"width": 1280, "height": 900}, **settings})
    found = Opened(context.new_page())
    found.page.goto(path.as_uri())
    yield found
    context.close()


@pytest.fixture(scope="module")
def screen(browser: Browser, report: Path) -> Iterator[Opened]:
    """The page on a usual screen, for all tests of a file that leave it as they found it."""
    with opening(browser, report) as found:
        yield found


@pytest.fixture
def opened(browser: Browser) -> Iterator[Callable[..., Opened]]:
    """Open a file with settings of its own."""
    with ExitStack() as stack:
        yield lambda path, **settings: stack.enter_context(opening(browser, path, **settings))
