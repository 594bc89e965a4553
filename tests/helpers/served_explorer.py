"""The explorer served by the command, and a page of it in a browser."""

import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from opened_page import PATIENCE
from playwright.sync_api import Browser, Page
from support import environment


@dataclass
class Served:
    """A command that serves, to be ended and started again at the same address."""

    study: Path
    folder: Path
    port: int = 0
    token: str = ""
    address: str = ""
    process: subprocess.Popen[str] | None = field(default=None, repr=False)

    def begin(self) -> None:
        """Start the command, and read where it serves."""
        command = [sys.executable, "-m", "tvimdesign", "explore", str(self.study), "--out", str(self.folder)]
        more = ["--no-open", "--port", str(self.port), *(["--token", self.token] if self.token else [])]
        self.process = subprocess.Popen([*command, *more], stdout=subprocess.PIPE, text=True, env=environment())
        self.address = self.process.stdout.readline().split()[-1]
        self.port = int(self.address.split(":")[2].split("/")[0])
        self.token = self.address.split("/")[3]

    def end(self) -> None:
        """Kill it, as a power cut does."""
        self.process.kill()
        self.process.communicate()


class Explorer:
    """A page of the explorer in the browser, with what it complained of."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.complaints: list[str] = []
        page.on("console", lambda message: self.complaints.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.set_default_timeout(PATIENCE)

    @property
    def number(self) -> int:
        """Number of the last answer that is shown."""
        return int(self.page.evaluate("document.documentElement.dataset.number ?? 0"))

    def until(self, true: str, argument: Any = None) -> None:
        """Wait until an expression is true; the page's own rules forbid Playwright's way of waiting for one."""
        ends = time.monotonic() + PATIENCE / 1e3
        while not self.page.evaluate(true, argument):
            assert time.monotonic() < ends, true
            self.page.wait_for_timeout(50)

    def answered(self, after: int, stage: str = "") -> None:
        """Wait for an answer to what was asked after a number."""
        shown = "const { number, stage } = document.documentElement.dataset"
        self.until(
            f"([after, wanted]) => {{ {shown}; return Number(number ?? 0) > after && (!wanted || stage === wanted); }}",
            [after, stage],
        )

    def shows(self, label: str, text: str) -> None:
        """Wait until the field of a control holds a text."""
        ends = time.monotonic() + PATIENCE / 1e3
        while (value := self.knob(label).get_by_role("textbox").first.input_value()) != text:
            assert time.monotonic() < ends, (label, value, text)
            self.page.wait_for_timeout(50)

    def knob(self, label: str) -> Any:
        """Return the row of a control, by its label."""
        return self.page.locator(".knob").filter(has=self.page.get_by_text(label, exact=True))

    def reset(self) -> None:
        """Return the study's start."""
        before = self.number
        self.page.get_by_role("button", name="Start again").click()
        self.answered(before)


@contextmanager
def exploring(browser: Browser, address: str, **settings: Any) -> Iterator[Explorer]:
    """Open a page at an address, once it shows an answer."""
    context = browser.new_context(**{"viewport": {"width": 1280, "height": 900}, **settings})
    explorer = Explorer(context.new_page())
    explorer.page.goto(address)
    explorer.answered(0)
    yield explorer
    context.close()


@contextmanager
def serving(browser: Browser, study: Path, out: Path) -> Iterator[Explorer]:
    """Serve one explorer, with its page open."""
    served = Served(study, out)
    served.begin()
    try:
        with exploring(browser, served.address) as explorer:
            yield explorer
            assert explorer.complaints == []
    finally:
        served.end()
