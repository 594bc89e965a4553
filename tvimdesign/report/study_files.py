"""Writes the files a user starts from: a commented study, a copy of a shipped one, the schema for editors."""

from __future__ import annotations

from pathlib import Path

from tvimdesign.base.errors import InputError
from tvimdesign.study.schema import schema_text
from tvimdesign.study.template import example_text, examples, template_text


def list_examples() -> None:
    """Print the shipped studies, each with what it is about."""
    for name, about in examples().items():
        print(f"{name}\n    {about}")


def example_names() -> tuple[str, ...]:
    """Names of the shipped studies."""
    return tuple(examples())


def write_new_study(file: Path | None, example: str = "") -> None:
    """Write a commented study, or a copy of a shipped one. Raises InputError where the file is there already."""
    text = example_text(example) if example else template_text()
    file = file or Path(f"{example or 'study'}.yaml")
    try:
        with file.open("x", encoding="utf-8") as stream:
            stream.write(text)
    except FileExistsError as error:
        raise InputError(f"{file}: exists already; name another file") from error
    except OSError as error:
        raise InputError(f"{file}: cannot be written: {error.strerror}") from error
    print(f"{file} written; next: tvimdesign run {file}")


def print_schema() -> None:
    """Print the JSON Schema of studies."""
    print(schema_text(), end="")
