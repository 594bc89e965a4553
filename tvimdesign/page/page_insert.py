"""A section put into a page that is written already, where what it tells came later."""

from __future__ import annotations

import re

from tvimdesign.page.blocks import Section
from tvimdesign.page.page_file import template


def with_section(text: str, section: Section, before: str) -> str | None:
    """Return a page's text with one more section, before the one named `before`; it replaces one of its name.

    The section draws no figure of its own. None where the text is no page that has `before`.
    """
    text = _without(text, section.name)
    link, place = f'<li><a href="#{before}">', f'<section id="{before}"'
    if text.count(link) != 1 or text.count(place) != 1:
        return None
    made = template("section.html.jinja").module
    entry, body = str(made.entry(section)).strip(), str(made.body(section)).strip()
    return text.replace(link, f"{entry}\n    {link}").replace(place, f"{body}\n{place}")


def _without(text: str, name: str) -> str:
    """Return the text without a section and its entry in the contents."""
    text = re.sub(rf'<li><a href="#{name}">[^\n]*</li>\n\s*', "", text, count=1)
    return re.sub(rf'<section id="{name}".*?</section>\n', "", text, count=1, flags=re.DOTALL)
