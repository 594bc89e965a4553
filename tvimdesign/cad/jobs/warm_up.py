"""What many pieces of work need, loaded once before the first is begun: each is a fork of the process that has it."""

from __future__ import annotations

from importlib import import_module

from tvimdesign.cad.assembly import assembly_note
from tvimdesign.cad.drawing import drawing_requirements, iso_286
from tvimdesign.cad.drawing.drawing_sheet import DrawingSheet
from tvimdesign.cad.inspection import ray_code
from tvimdesign.cad.jobs.cache import code_digest
from tvimdesign.device import table_for

_PICTURES = ("preview", "exploded", "section")
_LETTERS = "abcdefghijklmnopqrstuvwxyz 0123456789.,-() ABCDEFGHIJKLMNOPQRSTUVWXYZ"


def warm_up(mode: str = "") -> None:
    """Compile, read data files and the table of a mode that is known, find font and letters, load what renders."""
    if mode:
        table_for(mode)
    for read in (drawing_requirements.told, iso_286.told, assembly_note.told, ray_code.first_hits, code_digest):
        read()
    sheet = DrawingSheet(1.0)
    sheet.text(_LETTERS, (20.0, 20.0))
    sheet.pdf()
    for name in _PICTURES:
        import_module(f"tvimdesign.cad.render.{name}")
