"""A page opened in a browser from the disk, with what it asked of the network and what it complained of."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import axe_playwright_python
from playwright.sync_api import Browser, Page

PATIENCE = 300_000
"""Milliseconds that a page may take on a busy machine."""


AXE = (Path(axe_playwright_python.__file__).parent / "axe.min.js").read_text("utf-8")


def serious_faults(page: Page, **options: Any) -> list[tuple[str, list[str]]]:
    """Return the serious faults that axe finds in a page, each with the first places."""
    page.evaluate(AXE)
    run = "(asked) => axe.run(document, { resultTypes: ['violations'], ...asked }).then(({ violations }) => violations)"
    serious = [fault for fault in page.evaluate(run, options) if fault["impact"] in {"serious", "critical"}]
    return [(fault["id"], [node["html"][:120] for node in fault["nodes"][:3]]) for fault in serious]


class Opened:
    """A page in the browser, with what it asked of the network and what it complained of."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.requests: list[str] = []
        self.complaints: list[str] = []
        page.on("request", lambda request: self.requests.append(request.url))
        page.on("console", lambda message: self.complaints.append(message.text) if message.type != "log" else None)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.set_default_timeout(PATIENCE)

    def figure(self, name: str) -> Any:
        """Return a figure, once it is drawn."""
        figure = self.page.locator(f"#figure-{name}")
        figure.scroll_into_view_if_needed()
        self.page.wait_for_selector(f"#figure-{name}[data-state]")
        assert figure.get_attribute("data-state") == "drawn", figure.inner_text()
        return figure


@contextmanager
def opening(browser: Browser, path: Path, **settings: Any) -> Iterator[Opened]:
    """Open a file as a reader does who has it on the disk; `settings` are those of a browser's context."""
    context = browser.new_context(**{"viewport": {"width": 1280, "height": 900}, **settings})
    page = Opened(context.new_page())
    page.page.goto(path.as_uri())
    yield page
    context.close()
