"""Writes equations as MathML: LaTeX between the marks that Markdown's arithmatex extension leaves."""

from __future__ import annotations

import html
import re

from latex2mathml.converter import convert

_MARKED = re.compile(r'<(span|div) class="arithmatex">\\([(\[])(.*?)\\[)\]]</\1>', re.S)


def with_mathml(page: str) -> str:
    """Return the page's HTML with each marked equation as MathML; `\\[` ones stand on a line of their own."""

    def converted(match: re.Match[str]) -> str:
        tag, opening, latex = match.groups()
        display = "block" if opening == "[" else "inline"
        return f'<{tag} class="equation">{convert(html.unescape(latex).strip(), display=display)}</{tag}>'

    return _MARKED.sub(converted, page)
