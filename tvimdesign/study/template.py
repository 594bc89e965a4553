"""The commented study that `tvimdesign new` writes."""

from __future__ import annotations

from importlib.resources import files


def template_text() -> str:
    """Return the text of a commented study of the shear module."""
    return files("tvimdesign.study").joinpath("template.yaml").read_text(encoding="utf-8")
