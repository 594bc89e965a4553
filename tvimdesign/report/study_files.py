"""Writes the files a user starts from: a commented study, a copy of a shipped one, the schema for editors."""

from __future__ import annotations

from pathlib import Path

from tvimdesign.base.errors import InputError
from tvimdesign.study.design import read_design
from tvimdesign.study.text.source import printable
from tvimdesign.study.written_studies import (
    SCHEMA_FILE,
    example_text,
    examples,
    result_text,
    schema_text,
    template_text,
)


def list_examples() -> None:
    """Print the shipped studies, each with what it is about."""
    for name, about in examples().items():
        print(f"{name}\n    {about}")


def example_names() -> tuple[str, ...]:
    """Return names of the shipped studies."""
    return tuple(examples())


def write_new_study(file: Path | None, example: str = "", result: Path | None = None) -> None:
    """Write a commented study, a copy of a shipped one, or the module of a result as a study that evaluates it.

    Raises InputError where the file is there already, or the result is none.
    """
    if example and result:
        raise InputError("--example and --from: choose one")
    file = file or Path(f"{example or 'study'}.yaml")
    text = example_text(example) if example else template_text()
    if result:
        source = result / "design.json" if result.is_dir() else result
        text = result_text(read_design(source), printable(source), file.resolve().parent)
    try:
        with file.open("x", encoding="utf-8") as stream:
            stream.write(text)
    except FileExistsError as error:
        raise InputError(f"{file}: exists already; name another file") from error
    except OSError as error:
        raise InputError(f"{file}: cannot be written: {error.strerror}") from error
    print(f"{file} written; next: tvimdesign run {file}")
    print(f"names and units while you type: tvimdesign schema > {file.with_name(SCHEMA_FILE)}")


def print_schema() -> None:
    """Print the JSON Schema of studies."""
    print(schema_text(), end="")
