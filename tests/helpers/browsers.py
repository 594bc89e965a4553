"""Chromium of the system, for pages in a browser. Where there is none, tests in one are skipped, and say why."""

import shutil
from collections.abc import Iterator, Sequence

import pytest
from playwright.sync_api import Browser, sync_playwright

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
ARGUMENTS = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox"]
"""Draw 3-D without a graphics card; run as root, as in a container."""

MISSING = "install chromium"


def no_browser_message(skipped: Sequence[pytest.TestReport]) -> str:
    """Return what is to be said last of all where tests were skipped for want of a browser; else nothing."""
    count = sum(isinstance(report.longrepr, tuple) and MISSING in report.longrepr[-1] for report in skipped)
    return f"NO BROWSER: {count} tests of the pages were not run; {MISSING} and run them again" if count else ""


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """Chromium of the system; ended with each module, as its event loop stands in the way of the server's tests."""
    if CHROMIUM is None:
        pytest.skip(MISSING)  # no wheel brings a browser; .ci/run installs one and fails without
    with sync_playwright() as play:
        started = play.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield started
        started.close()
