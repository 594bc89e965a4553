"""By which number, revision and date a sheet is known: the same shape, asked the same, has the same number."""

from __future__ import annotations

from collections.abc import Iterable
from hashlib import sha256

from tvimdesign.cad.drawing.drawing_sheet import Field

REVISION = "A"
"""Of every sheet: what is drawn anew in another shape has another number, and no later revision of this one."""
_DIGITS = 8
_RELEASED = "of approval"
"""A sheet has no date of its own: the same design gives the same bytes on any day."""


def sheet_number(kind: str, told: Iterable[str]) -> str:
    """The kind of part, and a mark of all that its sheet tells."""
    mark = sha256("\n".join(told).encode()).hexdigest()[:_DIGITS]
    return f"{kind.replace('_', '-')}-{mark}"


def issue_fields(signed: str, number: str) -> list[Field]:
    """The row of the title block that tells which sheet this is; `signed` is the label of the field left for a name."""
    return [
        Field(signed, "", 0.24), Field("Number", number, 0.4), Field("Revision", REVISION, 0.12),
        Field("Date", _RELEASED, 0.24),
    ]  # fmt: skip
