"""History of an explorer for undo and redo, in a file that is whole at any moment."""

import hashlib
import json
import os
from pathlib import Path

from pydantic import BaseModel, ConfigDict, ValidationError

from tvimdesign.base.atomic_files import atomic_write, digest_of, free_name, is_as_written
from tvimdesign.base.errors import InputError
from tvimdesign.explore.state import Pinned, State

FILE = "explore.json"
PARTS = "parts"
"""Folder of the designs whose CAD was made, each by its own name."""
MOST_STEPS = 200
MOST_PINS = 12


class History(BaseModel):
    """All that an explorer goes on from when it is opened again."""

    model_config = ConfigDict(extra="forbid")

    study: str
    """Hash of the study's file."""
    state: State
    past: list[State] = []
    future: list[State] = []
    pins: list[Pinned] = []
    saved: dict[str, str] = {}
    """Digest of each study that was saved from the page, by its file's name."""

    def advance(self, after: State, since: State) -> None:
        """Go on to a state from the one that `since` an undo would bring back."""
        if after != since:
            self.past = [*self.past, since][-MOST_STEPS:]
            self.future = []
        self.state = after

    def undo(self) -> None:
        """Go one step back. Raises InputError if there is none."""
        if not self.past:
            raise InputError("undo: nothing was changed before")
        self.future = [self.state, *self.future]
        self.state = self.past.pop()

    def redo(self) -> None:
        """Go one step forward again. Raises InputError if there is none."""
        if not self.future:
            raise InputError("redo: nothing was undone")
        self.past = [*self.past, self.state]
        self.state = self.future.pop(0)

    def pin(self, pinned: Pinned) -> None:
        """Keep a design. Raises InputError where there are too many."""
        if len(self.pins) >= MOST_PINS:
            raise InputError(f"pin: {MOST_PINS} designs are pinned, the limit; let one go first")
        self.pins = [*self.pins, pinned]

    def pinned(self, number: int) -> Pinned:
        """Return a pinned design. Raises InputError for a number that does not exist."""
        if number >= len(self.pins):
            raise InputError(f"pin {number}: there are {len(self.pins)} pinned designs")
        return self.pins[number]

    def unpin(self, number: int) -> None:
        """Let a design go."""
        gone = self.pinned(number)
        self.pins = [pin for pin in self.pins if pin is not gone]


def hash_of(text: bytes) -> str:
    """Return the fingerprint of a study's file."""
    return "sha256:" + hashlib.sha256(text).hexdigest()


def open_history(folder: Path, study: bytes, first: State, *, overwrite: bool = False) -> History:
    """Return the history in a folder, or a new one. Raises InputError where the folder is another study's.

    With `overwrite` a new one replaces that of any study, once something is changed.
    """
    path = folder / FILE
    if not path.exists():
        if folder.is_dir() and any(folder.iterdir()):
            raise InputError(f"{folder}: holds files that are no explorer's; name another folder with --out")
        return History(study=hash_of(study), state=first)
    try:
        history = History.model_validate(json.loads(path.read_bytes()))
    except (ValueError, ValidationError) as error:
        raise InputError(f"{path}: not written by `tvimdesign explore`; name another folder with --out") from error
    if overwrite:
        return History(study=hash_of(study), state=first, saved=history.saved)
    if history.study != hash_of(study):
        raise InputError(
            f"{folder}: holds what was done with the study as it was before its file changed; --overwrite begins "
            "again, --out names another folder"
        )
    return history


def written_digest(folder: Path) -> str:
    """Return the digest of the file in a folder; empty where there is none."""
    return digest_of(folder / FILE) if (folder / FILE).is_file() else ""


def write_history(folder: Path, history: History, before: str) -> str:
    """Write the history, whole, and return its digest. Raises OutputError.

    A file that has not the digest `before` was changed by hand meanwhile: it is renamed, not replaced.
    """
    path = folder / FILE
    if os.path.lexists(path) and not is_as_written(folder, FILE, {before}):
        path.rename(free_name(path))
    atomic_write(path, history.model_dump_json(indent=1).encode() + b"\n")
    return digest_of(path)
