"""Screenshots for docs/pictures/report.png and explorer.png: a run's page and its explorer.

    python docs/make/screenshots.py [RUN]

RUN is the folder of a run with parts (results/elbow_printed). Needs Chromium.
"""

from __future__ import annotations

import io
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright

ROOT = Path(__file__).resolve().parents[2]
PICTURES = ROOT / "docs/pictures"
ARGUMENTS = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox"]
"""Draw 3-D without a graphics card; run as root, as in a container."""
_SIZE = {"width": 1240, "height": 1000}
_COLOURS = 256
PATIENCE = 180_000
"""Milliseconds that a page may take on a busy machine."""


def main() -> None:
    """Take both; raise FileNotFoundError without a run or a browser."""
    run = Path(sys.argv[1]) if sys.argv[1:] else ROOT / "results/elbow_printed"
    browser_path = shutil.which("chromium") or shutil.which("google-chrome")
    if browser_path is None or not (run / "report.html").exists():
        raise FileNotFoundError(
            f"needs chromium, and {run}/report.html: `make results/{run.name}/report.html` makes it"
        )
    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=browser_path, args=ARGUMENTS)
        report(browser, run)
        explorer(browser, run)
        browser.close()


def report(browser: Browser, run: Path) -> None:
    """Take the assembly of a report, exploded a little, with its parts beside it."""
    page = _page(browser, (run / "report.html").resolve().as_uri())
    figure = page.locator("#figure-solids")
    figure.scroll_into_view_if_needed()
    page.wait_for_selector("html[data-ready=all]")
    figure.get_by_role("slider", name="Apart").fill("0.35")
    figure.get_by_role("slider", name="Apart").blur()
    page.wait_for_timeout(1000)
    _keep(figure.screenshot(), "report.png")


def explorer(browser: Browser, run: Path) -> None:
    """Take the explorer at the optimum, its draft beside the controls."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "tvimdesign", "explore", str(run), "--out", f"{folder}/out", "--no-open"]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        try:
            assert process.stdout is not None
            page = _page(browser, process.stdout.readline().split()[-1])
            page.locator("#report[data-report]").wait_for()
            page.locator("#draft[data-draft]").wait_for()
            page.locator("#draft").get_by_role("combobox", name="Cut").select_option("y")
            page.wait_for_timeout(2000)
            _keep(page.screenshot(), "explorer.png")
        finally:
            process.terminate()
            process.wait()


def _page(browser: Browser, address: str) -> Page:
    page = browser.new_page(viewport=_SIZE, color_scheme="light")
    page.set_default_timeout(PATIENCE)
    page.goto(address)
    return page


def _keep(taken: bytes, name: str) -> None:
    """Write it with few colours: some 50 kB."""
    with Image.open(io.BytesIO(taken)) as shot:
        shot.convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE).save(PICTURES / name, optimize=True)


if __name__ == "__main__":
    main()
