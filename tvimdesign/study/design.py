"""A design: the plain data that a solved study becomes, and from which parts and reports are made."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from tvimdesign.errors import InputError

MAX_BYTES = 10_000_000


class Design(BaseModel):
    """One module with all its numbers, in SI, by the names of the table."""

    model_config = ConfigDict(frozen=True, extra="forbid", ser_json_inf_nan="strings")

    tvimdesign: str
    """Version that wrote it."""
    name: str
    mode: str
    status: str
    """`evaluated`, `optimal`, or why not."""
    choices: dict[str, str]
    """Chosen records and options by row name."""
    values: dict[str, float]
    """Every input and output by full name (`row` or `row@point`), SI."""
    study: dict[str, Any]
    """The study it answers, resolved."""
    solution: dict[str, Any] = Field(default_factory=dict)
    """How it was found: starts, iterations, constraints with multipliers. Empty for an evaluation."""

    def value(self, name: str) -> float:
        """SI value of a row; raises InputError for a name the design does not have."""
        if name not in self.values:
            raise InputError(f"the design {self.name!r} has no value {name!r}")
        return self.values[name]


def write_design(design: Design, path: Path) -> None:
    """Write a design as JSON, whole or not at all."""
    write_whole(path, design.model_dump_json(indent=2).encode() + b"\n")


def read_design(path: Path) -> Design:
    """Read a design; raises InputError that names the file and what is wrong with it."""
    try:
        if path.stat().st_size > MAX_BYTES:
            raise InputError(f"{path}: larger than {MAX_BYTES} bytes; a design is a few tens of kilobytes")
        return Design.model_validate_json(path.read_bytes())
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"]) or "the file"
        raise InputError(f"{path}: not a design written by `tvimdesign run`: {where}: {first['msg']}") from error


def write_whole(path: Path, data: bytes) -> None:
    """Write beside, flush to disk, rename: a reader never sees half a file."""
    handle, beside = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        Path(beside).chmod(0o644)
        Path(beside).replace(path)
    except BaseException:
        Path(beside).unlink(missing_ok=True)
        raise
