"""Reads this package's own YAML, by the C library where there is one: a tenth of the time."""

from typing import Any

import yaml

_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def plain_data(text: str) -> Any:
    """Return the mappings, lists, texts and numbers of a text."""
    return yaml.load(text, Loader=_LOADER)
