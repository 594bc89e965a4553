"""A small campaign of random folders: no byte of a user's is changed or removed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import folders
import pytest

from tvimdesign.base import atomic_files
from tvimdesign.report.output import replace_results

WRITTEN = {
    "fit": {"fit.json": b"{}", "fit.png": b"png", "residuals.csv": b"a"},
    "run_with_parts": {
        name: name.encode() for name in ("results.csv", "report.html", "plots/a.png", "cad/a.step", "cad/b.step")
    },
    "front": {"front.csv": b"a", "front/01.design.json": b"{}", "results.csv": b"b"},
    "sweep": {"shards/00001.jsonl": b"{}", "cells.csv": b"a", "sweep.json": b"{}"},
    "cells": {"cell-1/cad/a.step": b"a", "parts.csv": b"b"},
    "explorer": {"explore.json": b"{}"},
}


def losses(tmp_path: Path, count: int) -> Iterator[str]:
    """Try so many folders; yield what is lost."""
    for number in range(count):
        place = tmp_path / str(number)
        place.mkdir()
        lost, done = folders.one_folder(number, 7, WRITTEN, place, real=False)
        yield from (f"{number}: {one} ({done})" for one in lost)


def test_no_byte_of_the_user_s_is_changed_or_removed(tmp_path: Path) -> None:
    assert list(losses(tmp_path, 150)) == []


@pytest.mark.parametrize("broken", ["digest", "rename", "links"])
def test_the_campaign_sees_what_is_lost(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, broken: str) -> None:
    if broken == "digest":  # as if a file's name were enough to make it ours
        usual = atomic_files.is_as_written
        ours = {atomic_files.ANY}
        monkeypatch.setattr(replace_results, "is_as_written", lambda folder, name, _: usual(folder, name, ours))
    elif broken == "rename":
        monkeypatch.setattr(Path, "rename", lambda self, _: self.unlink() if self.is_file() else None)
    else:
        for module in (atomic_files, replace_results):
            monkeypatch.setattr(module, "link_on_the_way", lambda *_: None)
    assert next(losses(tmp_path, 200), "")
