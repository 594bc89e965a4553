"""One slider of the explorer beside the same slider in trame and in Panel, in one browser, in turns.

    python benchmarks/slider.py [STUDY] [--drags 60]

Time from the key on the slider to the new text on the page, and the processor time of all of the server's processes
for a drag. Times of the processor mean something on a busy machine, times by the clock only on a quiet one.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import psutil
from browsers import ARGUMENTS, CHROMIUM
from playwright.sync_api import Browser, Locator, Page, sync_playwright
from slider_servers import SERVERS, VARIABLE

ROOT = Path(__file__).resolve().parents[1]
COMPILED = 30.0
"""Seconds that the explorer's kernels are given to compile after its first answer."""
PATIENCE = 60_000
TEXT = """() => {
  const find = (root, wanted) => {
    const found = root.querySelector(wanted);
    if (found) return found;
    for (const one of root.querySelectorAll('*')) {
      const inner = one.shadowRoot && find(one.shadowRoot, wanted);
      if (inner) return inner;
    }
    return null;
  };
  const shown = document.documentElement.dataset.number;
  return shown === undefined ? find(document, '#answer')?.textContent ?? '' : shown;
}"""
"""What changes on a page once an answer is shown: the text, or the explorer's number of the answer."""
DRAG = f"""async (key) => {{
  const text = {TEXT};
  const before = text();
  let began = null;
  addEventListener('keydown', () => {{ began = performance.now(); }}, {{ once: true, capture: true }});
  window.answered = (async () => {{
    while (text() === before) await new Promise((resolve) => setTimeout(resolve, 1));
    return performance.now() - began;
  }})();
}}"""


@dataclass
class Contender:
    """One server with its page."""

    name: str
    process: subprocess.Popen[str]
    page: Page
    slider: Locator
    clock: list[float] = field(default_factory=list)
    processor: list[float] = field(default_factory=list)

    def drag(self, key: str) -> None:
        """Press a key on the slider, and time its answer."""
        self.slider.focus()
        before = _seconds(self.process)
        self.page.evaluate(DRAG)
        self.page.keyboard.press(key)
        self.clock.append(float(self.page.evaluate("() => window.answered")))
        time.sleep(0.15)  # what the server still does for the drag is the drag's
        self.processor.append(1e3 * (_seconds(self.process) - before))


def _seconds(process: subprocess.Popen[str]) -> float:
    """Seconds of the processor that a server and its children have taken."""
    top = psutil.Process(process.pid)
    times = [member.cpu_times() for member in (top, *top.children(recursive=True))]
    return sum(spent.user + spent.system for spent in times)


@contextmanager
def explorer(study: Path, browser: Browser) -> Iterator[Contender]:
    """Open the explorer, in the way of evaluating."""
    with tempfile.TemporaryDirectory() as folder:
        more = ["explore", str(study), "--out", f"{folder}/out", "--no-open", "--port", "0"]
        process = subprocess.Popen([sys.executable, "-m", "tvimdesign", *more], stdout=subprocess.PIPE, text=True)
        try:
            assert process.stdout is not None
            page = _page(browser, process.stdout.readline().split()[-1])
            page.get_by_role("button", name="Evaluate").click()
            slider = page.get_by_label(f"{VARIABLE}, slider")
            slider.wait_for()
            time.sleep(COMPILED)
            yield Contender("explore", process, page, slider)
        finally:
            process.terminate()
            process.wait()


@contextmanager
def rival(name: str, study: Path, browser: Browser) -> Iterator[Contender]:
    """Open a slider written with another library."""
    command = [sys.executable, str(Path(__file__).with_name("slider_servers.py")), name, str(study)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        page = _page(browser, process.stdout.readline().strip())
        slider = page.locator("input[type=range]") if name == "trame" else page.get_by_role("slider")
        slider.wait_for()
        yield Contender(name, process, page, slider)
    finally:
        process.terminate()
        process.wait()


def _page(browser: Browser, address: str) -> Page:
    page = browser.new_page()
    page.set_default_timeout(PATIENCE)
    ends = time.monotonic() + PATIENCE / 1e3
    while True:
        try:
            page.goto(address)
            break
        except Exception:
            if time.monotonic() > ends:
                raise
            time.sleep(0.3)
    while not page.evaluate(TEXT):
        time.sleep(0.1)
    return page


def main() -> None:
    """Read the arguments, drag each slider in turn, print a row for each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", nargs="?", type=Path, default=ROOT / "tests/studies/paper_shear.yaml")
    parser.add_argument("--drags", type=int, default=60)
    options = parser.parse_args()
    with sync_playwright() as play, ExitStack() as stack:
        browser = play.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        contenders = [stack.enter_context(explorer(options.study, browser))]
        contenders += [stack.enter_context(rival(name, options.study, browser)) for name in SERVERS]
        for i in range(options.drags):
            for contender in contenders:
                contender.page.bring_to_front()
                contender.drag("ArrowRight" if i % 6 < 3 else "ArrowLeft")
        for contender in contenders:
            wall, ninth = statistics.median(contender.clock), statistics.quantiles(contender.clock, n=10)[8]
            own, most = statistics.median(contender.processor), statistics.quantiles(contender.processor, n=10)[8]
            print(f"{contender.name:8} key to text: median {wall:.0f} ms, nine of ten under {ninth:.0f} ms; processor: "
                  f"median {own:.0f} ms a drag, nine of ten under {most:.0f} ms", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
