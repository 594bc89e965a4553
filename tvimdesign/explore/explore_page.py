"""The page of the explorer: the report's styles and code, served as files, and a panel of controls."""

from __future__ import annotations

import json
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import tvimdesign.page

STATIC = {
    "page": Path(str(resources.files(tvimdesign.page))) / "static",
    "explore": Path(__file__).parent / "static",
}
"""Folders of code and styles by the names they are imported by."""
_STYLES = ("page/theme.css", "page/page.css", "page/figures.css", "explore/explore.css")


def explore_page(nonce: str) -> str:
    """The page, empty: what it shows comes over the socket."""
    imports = json.dumps({"imports": {f"{room}/": f"./static/{room}/" for room in STATIC}})
    text: str = _template().render(styles=_STYLES, imports=imports, nonce=nonce)
    return text


def content_policy(nonce: str) -> str:
    """Nothing from any other host; inline code only with the nonce."""
    return (
        f"default-src 'none'; script-src 'self' 'nonce-{nonce}'; style-src 'self' 'unsafe-inline'; "
        "img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )


@cache
def _template() -> Any:
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("tvimdesign.explore"), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True,
    )  # fmt: skip
    return environment.get_template("explore.html.jinja")
