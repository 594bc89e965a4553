"""The manifest of a results folder: what made the results, and the digest of each file that the run wrote.

Put the files of a finished run in the place of earlier results, and leave what the user added or changed.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Callable, Collection, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any

from tvimdesign.base.atomic_files import (
    JOURNALS,
    RUN,
    digest_of,
    free_name,
    is_as_written,
    is_inside,
    link_on_the_way,
    make_folder,
    record,
    recorded,
)
from tvimdesign.base.claim import FORMAT
from tvimdesign.base.errors import InputError

MANIFEST = "manifest.json"
_SEAL = "seal"
"""Key of the digest over everything else in a manifest: one that was edited does not vouch for files."""


@dataclass(frozen=True)
class Manifest:
    """Content of a manifest; empty if there is none."""

    files: Mapping[str, str] = field(default_factory=dict)
    """Digest of each file."""
    content: Mapping[str, Any] = field(default_factory=dict)
    digest: str = ""
    """Digest of the manifest itself."""


def read_manifest(folder: Path) -> Manifest:
    """Read the manifest of a folder; an empty one where there is none.

    Raises InputError where it is not one of ours as it was written: then the folder's files are somebody else's.
    """
    path = folder / MANIFEST
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        return Manifest()
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}; name another --out") from error
    try:
        content = json.loads(data)
        files = {str(name): str(digest) for name, digest in content["files"].items()}
        is_ours = content["format"] == FORMAT and content["run"] and content[_SEAL] == _seal(content)
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        is_ours = False
    if not is_ours or path.is_symlink() or not all(map(is_inside, files)):
        raise InputError(
            f"{path}: was not written by this version of tvimdesign, or was changed since; no file beside it is "
            "touched: name another folder with --out"
        )
    return Manifest(files, content, digest_of(path))


def manifest_text(content: Mapping[str, Any]) -> str:
    """Return a manifest as it is written, sealed."""
    return json.dumps({**content, _SEAL: _seal(content)}, indent=2, allow_nan=False) + "\n"


def _seal(content: Mapping[str, Any]) -> str:
    unsealed = {name: value for name, value in content.items() if name != _SEAL}
    return "sha256:" + hashlib.sha256(json.dumps(unsealed, sort_keys=True).encode()).hexdigest()


Say = Callable[[str], None]


def refuse_links(out: Path, names: Iterable[str]) -> None:
    """Raise InputError where a name leads through a link, or through a file: before anything is changed."""
    for name in names:
        if way := link_on_the_way(out, name):
            leads = f"leads to {way.readlink()}" if way.is_symlink() else "is a file"
            raise InputError(f"{way}: {leads}, where results need a folder; remove it, or name another --out")


def replace_results(out: Path, new: Path, results: Manifest, earlier: Manifest, say: Say) -> None:
    """Move results from the folder `new` into `out`, then their manifest, and remove earlier ones that are as written.

    A file that somebody changed is renamed, not replaced: its bytes stay. It can be repeated where it was interrupted:
    the old manifest stands until the end. Raises InputError for a link in the way, before anything is moved; OSError.
    """
    refuse_links(out, [*results.files, *earlier.files])
    for name in results.files:
        if (new / name).exists() and not link_on_the_way(new, name):
            digests = {digest for results_set in (earlier, results) if (digest := results_set.files.get(name))}
            _move(new / name, out, name, digests, say)
    remove_own(out, {name: {digest} for name, digest in earlier.files.items() if name not in results.files}, say)
    if (new / MANIFEST).exists():
        _move(new / MANIFEST, out, MANIFEST, {earlier.digest}, say)


def _move(source: Path, out: Path, name: str, digests: Collection[str], say: Say) -> None:
    target = out / name
    make_folder(target.parent)
    if os.path.lexists(target) and not is_as_written(out, name, digests):
        aside = free_name(target)
        target.rename(aside)
        say(f"{target}: was changed since it was written, so it is kept as {aside.name}")
    source.replace(target)
    source.unlink(missing_ok=True)  # a rename does nothing between two links to the same file


def remove_own(folder: Path, names: Mapping[str, Collection[str]], say: Say) -> None:
    """Remove the names whose files are as they were written, and the folders that are empty then."""
    for name, digests in names.items():
        if is_as_written(folder, name, digests):
            (folder / name).unlink(missing_ok=True)
        elif os.path.lexists(folder / name) and not link_on_the_way(folder, name):
            say(f"{folder / name}: was changed since it was written, so it is kept")
    parents = {parent for name in names for parent in PurePosixPath(name).parents if parent.parts}
    for parent in sorted(parents, key=lambda folder_path: -len(folder_path.parts)):
        if not link_on_the_way(folder, f"{parent}/x"):
            with suppress(OSError):  # it is not empty, or gone
                (folder / parent).rmdir()


def discard_unfinished(folder: Path, say: Say, keep: Callable[[str], bool] = lambda _: False) -> None:
    """Remove what an unfinished run wrote but what is to be kept; anything else in its folder is moved beside it."""
    names = recorded(folder)
    kept_names = {name for name in names if keep(name)}
    remove_own(folder, {name: names[name] for name in names if name not in kept_names}, lambda _: None)
    if not kept_names:
        for journal in folder.glob(JOURNALS):
            journal.unlink()
    move_aside(folder, kept_names, say)


def move_aside(folder: Path, own: Collection[str], say: Say) -> None:
    """Move what is in an unfinished run's folder beside it, but for the files that are its own."""
    journals = {path.name for path in folder.glob(JOURNALS)}
    aside: Path | None = None
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if name in own or name in journals or name == RUN or (path.is_dir() and not path.is_symlink()):
            continue
        if link_on_the_way(folder, name):
            continue  # what a link leads to is not here
        if aside is None:
            aside = free_name(folder)
        make_folder((aside / name).parent)
        path.rename(aside / name)
    for path in sorted(
        (subfolder for subfolder in folder.rglob("*") if subfolder.is_dir() and not subfolder.is_symlink()),
        reverse=True,
    ):
        with suppress(OSError):
            path.rmdir()
    if aside:
        say(f"{aside}: holds what else was in the folder of an unfinished run; look, and remove it")


def seed(out: Path, folder: Path, files: Mapping[str, str], say: Say) -> None:
    """Give a run the files of earlier results that it continues from, where they are as they were written."""
    for name, digest in files.items():
        if not is_as_written(out, name, {digest}):
            say(f"{out / name}: was changed since it was written, so it is not used")
            continue
        make_folder((folder / name).parent)
        record(folder / name, digest)
        try:
            os.link(out / name, folder / name)
        except OSError:  # a file system without links
            shutil.copyfile(out / name, folder / name)
