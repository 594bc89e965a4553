"""A machine without a browser: its tests are skipped, and the last line of all says so."""

from __future__ import annotations

import sys

import pytest
from support import ROOT, environment, run_process


@pytest.mark.slow
def test_the_last_line_says_how_many_tests_no_browser_has_run() -> None:
    words = ["tests/page/test_page_in_a_browser.py", "-q", "-k", "sorts or filtered", "-p", "no:cacheprovider"]
    command = [sys.executable, "-m", "pytest", *words]
    found = run_process(command, cwd=ROOT, env={**environment(), "PATH": ""}, text=True)
    last = found.stdout.rstrip().splitlines()[-1]
    assert last == "NO BROWSER: 2 tests of the pages were not run; install chromium and run them again", found.stdout
