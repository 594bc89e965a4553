"""Finite-element results of a design, as a section of its run's page, read from the folder of the verification."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from tvimdesign.base.atomic_files import digest_of
from tvimdesign.page.blocks import Block, Picture, Section, Words
from tvimdesign.page.page_file import FILE, MOST, with_section
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.output.results_folder import made_from, rewrite
from tvimdesign.report.output.tables import number

NAME, DATA, DESIGN = "verification", "verify.json", "design.json"
_BEFORE = "study"
"""The section of a run's page that it stands before."""
_HEADS = ("", "model", "FE", "unit", "model / FE", "mesh", "what")
_SHOWN = {
    "joint": "Stress in the frozen joint", "spring": "Stress in one spring",
    "screws": "Stress in link and core under the link screws", "link": "Stress in the link", "heat": "Temperature",
}  # fmt: skip
_BASE64 = 4.0 / 3.0
"""Bytes that a byte of a picture takes in a page."""
_AROUND = 1000
"""Bytes at most of what stands around a picture."""


def folder_of_verification(run: Path) -> Path:
    """Return the default folder of a run's verification."""
    return run.with_name(f"{run.resolve().name}-verified")


def verification_sections(run: Path) -> list[Section]:
    """Return the section of a run's page where there is a verification of this very design; none otherwise."""
    folder = folder_of_verification(run)
    if not _is_of(folder, run):
        return []
    return [verification_section(folder, run)]


def verification_section(folder: Path, run: Path, room: float = MOST) -> Section:
    """Return rows worst first, a conclusion, and those fields for which there is `room` in the page [bytes]."""
    verification: dict[str, Any] = json.loads((folder / DATA).read_text("utf-8"))
    cells = [
        (row["name"], number(row["model"]), number(row["fe"]), row["unit"], f"{row['ratio']:.3f}",
         f"{100.0 * row['mesh_change']:+.1f} %", row["meaning"])
        for row in verification["rows"]
    ]  # fmt: skip
    sentences = [verification["summary"], f"Solvers and versions: {os.path.relpath(folder, run)}/{FILE}."]
    table = grid("The model against finite elements on the drawn parts", _HEADS, cells, right=(1, 2, 4, 5))
    blocks: list[Block] = [Words(sentences), table]
    for name, words in _SHOWN.items():
        picture = folder / f"{name}.png"
        taken = _AROUND + _BASE64 * picture.stat().st_size if picture.exists() else float("inf")
        if taken < room:
            blocks.append(Picture(picture.read_bytes(), words, words))
            room -= taken
    return Section(NAME, "Finite elements", blocks, folded=True)


def put_on_page(folder: Path, run: Path) -> bool:
    """Put a finished verification on the page of its run; returns whether there is such a page, as it was written.

    Of the fields it takes as many as the page has room for: it is to go into a mail.
    """
    page = run / FILE
    if not _is_of(folder, run) or not page.exists():
        return False
    text = page.read_text("utf-8")
    alone = with_section(text, verification_section(folder, run, 0.0), _BEFORE)
    if alone is None:
        return False
    room = MOST - len(alone.encode())
    data = (with_section(text, verification_section(folder, run, room), _BEFORE) or alone).encode()
    return rewrite(run, FILE, data)


def _is_of(folder: Path, run: Path) -> bool:
    """Return whether a folder has the verification of a run's design, as it is now."""
    design = run / DESIGN
    return (folder / DATA).exists() and design.exists() and made_from(folder, "design") == digest_of(design)
