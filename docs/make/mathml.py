"""Writes equations as MathML: LaTeX between the marks that Markdown's arithmatex extension leaves."""

from __future__ import annotations

import html
import re

from latex2mathml.converter import convert

_MARKED = re.compile(r'<(span|div) class="arithmatex">\\([(\[])(.*?)\\[)\]]</\1>', re.S)


def with_mathml(page: str) -> str:
    """Return the page's HTML with each marked equation as MathML; `\\[` ones stand on a line of their own.

    Raises ValueError that names an equation which is no LaTeX.
    """

    def converted(match: re.Match[str]) -> str:
        tag, opening, latex = match.groups()
        equation = html.unescape(latex).strip()
        try:
            written = convert(equation, display="block" if opening == "[" else "inline")
        except Exception as error:  # the converter raises a dozen classes, and none names the equation
            raise ValueError(f"{equation}: cannot be written as MathML ({type(error).__name__})") from error
        return f'<{tag} class="equation">{written}</{tag}>'

    return _MARKED.sub(converted, page)
