"""A page as one HTML file that opens offline: templates, styles, code, data; its blocks alone."""

import base64
import gzip
import json
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial
from html import escape
from importlib import resources
from pathlib import PurePosixPath
from typing import Any

from tvimdesign.base.record import own_template
from tvimdesign.report.page.blocks import Block, Drawn, Folded, Page

FILE = "report.html"
MOST = 4_000_000  # Bytes that a page may have, so that a mail takes it
_RESERVE = 100_000  # Bytes of them that no carried file takes
_STYLES = ("theme.css", "page.css", "figures.css", "print.css")
_ALWAYS = ("main.js", "tables.js", "data.js", "figures.js", "files.js")  # Code of every page; a figure brings its own


def page_html(page: Page) -> bytes:
    """Return the page as UTF-8. The same page gives the same bytes."""
    drawn = list(figures(page))
    text: str = _template("page.html.jinja").render(
        page=page,
        style="\n".join(_static(name) for name in _STYLES),
        code=_modules(drawn),
        loader=_static("loader.js"),
        data=_json({figure.name: dict(figure.data) for figure in drawn}),
        drawn=drawn,
    )
    return _with_files(text.rstrip() + "\n", page.carried).encode()


def _with_files(text: str, files: Mapping[str, bytes]) -> str:
    """Return a page's text with the files that it carries, as many as it has room for."""
    begin, code, end = text.rpartition('<script type="application/gzip" id="page-code">')
    room = MOST - len(text.encode()) - _RESERVE
    for address, data in files.items():
        held = f'<script type="application/gzip" data-file="{escape(address)}">{packed(data)}</script>\n'
        if len(held) <= room:
            begin, room = begin + held, room - len(held)
    return begin + code + end


def figures(page: Page) -> Iterator[Drawn]:
    """Yield every figure of a page that its code draws, in order."""
    yield from _figures([*page.first, *(block for section in page.sections for block in section.blocks)])


def _figures(blocks: Sequence[Block]) -> Iterator[Drawn]:
    for block in blocks:
        if isinstance(block, Drawn):
            yield block
        elif isinstance(block, Folded):
            yield from _figures(block.blocks)


def _modules(drawn: Sequence[Drawn]) -> str:
    """Return the page's code packed: texts by the names they are imported by; libraries only where a figure needs them.

    `loader.js` unpacks it: a page that was opened from a disk cannot import other files.
    """
    libraries = {name for figure in drawn for name in figure.libraries}
    own = [path for path in _own_modules() if path in _ALWAYS or drawn]
    return _packed_code((*own, *(f"vendor/{name}.js" for name in sorted(libraries))))


@cache
def _packed_code(names: tuple[str, ...]) -> str:
    return packed(_json({f"page/{name}": _static(name) for name in names}).encode())


@cache
def _own_modules() -> tuple[str, ...]:
    """Return modules of static/ and its folders, but no libraries."""
    names = []
    folders = [PurePosixPath()]
    while folders:
        folder = folders.pop()
        for entry in resources.files(__package__).joinpath("static", *folder.parts).iterdir():
            if entry.is_dir() and entry.name != "vendor":
                folders.append(folder / entry.name)
            elif entry.name.endswith(".js") and entry.name != "loader.js":
                names.append((folder / entry.name).as_posix())
    return tuple(sorted(names))


@cache
def _static(name: str) -> str:
    return resources.files(__package__).joinpath("static", *name.split("/")).read_text(encoding="utf-8")


def _json(data: Any) -> str:
    """Return JSON that can stand in a script element. Raises ValueError for what JSON has no number for."""
    return json.dumps(data, allow_nan=False, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")


def packed(data: bytes) -> str:
    """Return bytes as the page's code reads them: gzip in base64; the same bytes every time."""
    return _base64(gzip.compress(data, 6, mtime=0))


def _base64(data: bytes) -> str:
    return base64.b64encode(data).decode()


_template = partial(own_template, __file__, packed=packed, base64=_base64)


def page_fragment(page: Page, left_out: Collection[str] = ()) -> dict[str, Any]:
    """Return status, first screen and sections but those `left_out`, as HTML, with the data of their figures."""
    shown = replace(page, sections=[section for section in page.sections if section.name not in left_out])
    macros = _template("blocks.html.jinja").module
    drawn = list(figures(shown))
    return {
        "status": page.status,
        "tone": page.tone,
        "first": str(macros.each(page.first)),
        "sections": [
            {"name": part.name, "title": part.title, "html": str(macros.each(part.blocks)), "folded": part.folded}
            for part in shown.sections
        ],
        "data": {figure.name: dict(figure.data) for figure in drawn},
        "binaries": {figure.name: packed(figure.binary) for figure in drawn if figure.binary},
    }
