"""A console that obeys the markup this package writes and shows every other bracket as it stands."""

from __future__ import annotations

import re
from typing import Any

from rich.console import Console
from rich.errors import MarkupError
from rich.text import Text

_OTHER_TAG = re.compile(r"(?<!\\)(\\\\)*\[(?!/?(?:bold|dim|red|yellow|green)\]|/\])")


class OwnMarkupConsole(Console):
    """A rich console on which names, paths and sentences of a user never are markup, and never an error."""

    def render_str(self, text: str, **options: Any) -> Text:
        """A text with this package's own tags obeyed; without any where they do not match, as in a file's name."""
        markup = options.pop("markup", None)
        options |= {"emoji": False}  # or `:key:` would be a picture
        if not (markup or (markup is None and self._markup)):
            return super().render_str(text, markup=False, **options)
        try:
            return super().render_str(_OTHER_TAG.sub(r"\1\\[", text), markup=True, **options)
        except MarkupError:
            return super().render_str(text, markup=False, **options)
