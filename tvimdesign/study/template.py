"""The studies that `tvimdesign new` writes: a commented one to start from, and the shipped ones as examples."""

from __future__ import annotations

from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path

from tvimdesign.base.errors import InputError
from tvimdesign.study.text.mistakes import did_you_mean, one_of

SCHEMA_FILE = "study.schema.json"
"""What editors find beside a study, or above `studies/`, once `tvimdesign schema` has written it."""


def template_text() -> str:
    """Return the text of a commented study of the shear module."""
    return files("tvimdesign.study").joinpath("template.yaml").read_text(encoding="utf-8")


def examples() -> dict[str, str]:
    """Return the title line of every shipped study by name."""
    studies = sorted((file for file in _shipped().iterdir() if file.name.endswith(".yaml")), key=lambda file: file.name)
    return {
        file.name.removesuffix(".yaml"): file.read_text(encoding="utf-8").partition("\n")[0].lstrip("# ")
        for file in studies
    }


def example_text(name: str) -> str:
    """Text of a shipped study, for a schema beside it. Raises InputError where there is none of that name."""
    known = list(examples())
    if name not in known:
        raise InputError(f"no shipped study is named {name[:60]!r}; {did_you_mean(name, known) or one_of(known)}")
    text = _shipped().joinpath(f"{name}.yaml").read_text(encoding="utf-8")
    return text.replace(f"$schema=../{SCHEMA_FILE}", f"$schema={SCHEMA_FILE}")


def _shipped() -> Traversable:
    """Return the folder of studies: beside the package in a checkout, a copy made by setup.py in a wheel."""
    packaged = files("tvimdesign.study").joinpath("examples")
    return packaged if packaged.is_dir() else Path(__file__).parents[2] / "studies"
