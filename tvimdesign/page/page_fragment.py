"""The blocks of a page without the page around them, for a page that is open already."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import Any

from tvimdesign.page.blocks import Page
from tvimdesign.page.page_file import figures, packed, template


def page_fragment(page: Page, left_out: Collection[str] = ()) -> dict[str, Any]:
    """Return status, first screen and sections but those `left_out`, as HTML, with the data of their figures."""
    shown = replace(page, sections=[one for one in page.sections if one.name not in left_out])
    macros = template("blocks.html.jinja").module
    drawn = list(figures(shown))
    return {
        "status": page.status,
        "tone": page.tone,
        "first": str(macros.each(page.first)),
        "sections": [
            {"name": one.name, "title": one.title, "html": str(macros.each(one.blocks))} for one in shown.sections
        ],
        "data": {one.name: dict(one.data) for one in drawn},
        "binaries": {one.name: packed(one.binary) for one in drawn if one.binary},
    }
