"""The manifest of a results folder, and the replacement of earlier results by those of a finished run."""

import hashlib
import json
import os
import shutil
from collections.abc import Callable, Collection, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any

from tvimdesign.base import atomic_files
from tvimdesign.base.claim import FORMAT
from tvimdesign.base.errors import InputError

MANIFEST = "manifest.json"
_SEAL = "seal"  # Key of the digest over everything else in a manifest: one that was edited does not vouch for files


@dataclass(frozen=True)
class Manifest:
    """Content of a manifest; empty if there is none."""

    files: Mapping[str, str] = field(default_factory=dict)  # Digest of each file
    content: Mapping[str, Any] = field(default_factory=dict)
    digest: str = ""  # Digest of the manifest itself


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
    if not is_ours or path.is_symlink() or not all(map(atomic_files.is_inside, files)):
        raise InputError(
            f"{path}: was not written by this version of tvimdesign, or was changed since; no file beside it is "
            "touched: name another folder with --out"
        )
    return Manifest(files, content, atomic_files.digest_of(path))


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
        if way := atomic_files.link_on_the_way(out, name):
            leads = f"leads to {way.readlink()}" if way.is_symlink() else "is a file"
            raise InputError(f"{way}: {leads}, where results need a folder; remove it, or name another --out")


def replace_results(out: Path, new: Path, results: Manifest, earlier: Manifest, say: Say) -> None:
    """Move results from the folder `new` into `out`, then their manifest, and remove earlier ones that are as written.

    A file that somebody changed is renamed, not replaced: its bytes stay. It can be repeated where it was interrupted:
    the old manifest stands until the end. Raises InputError for a link in the way, before anything is moved; OSError.
    """
    refuse_links(out, [*results.files, *earlier.files])
    for name in results.files:
        if (new / name).exists() and not atomic_files.link_on_the_way(new, name):
            digests = {digest for results_set in (earlier, results) if (digest := results_set.files.get(name))}
            _move(new / name, out, name, digests, say)
    remove_own(out, {name: {digest} for name, digest in earlier.files.items() if name not in results.files}, say)
    if (new / MANIFEST).exists():
        _move(new / MANIFEST, out, MANIFEST, {earlier.digest}, say)


def _move(source: Path, out: Path, name: str, digests: Collection[str], say: Say) -> None:
    target = out / name
    atomic_files.make_folder(target.parent)
    if os.path.lexists(target) and not atomic_files.is_as_written(out, name, digests):
        aside = atomic_files.free_name(target)
        target.rename(aside)
        say(f"{target}: was changed since it was written, so it is kept as {aside.name}")
    source.replace(target)
    source.unlink(missing_ok=True)  # a rename does nothing between two links to the same file


def remove_own(folder: Path, names: Mapping[str, Collection[str]], say: Say) -> None:
    """Remove the names whose files are as they were written, and the folders that are empty then."""
    for name, digests in names.items():
        if atomic_files.is_as_written(folder, name, digests):
            (folder / name).unlink(missing_ok=True)
        elif os.path.lexists(folder / name) and not atomic_files.link_on_the_way(folder, name):
            say(f"{folder / name}: was changed since it was written, so it is kept")
    parents = {parent for name in names for parent in PurePosixPath(name).parents if parent.parts}
    for parent in sorted(parents, key=lambda folder_path: -len(folder_path.parts)):
        if not atomic_files.link_on_the_way(folder, f"{parent}/x"):
            with suppress(OSError):  # it is not empty, or gone
                (folder / parent).rmdir()


def discard_unfinished(folder: Path, keep: Callable[[str], bool] = lambda _: False) -> None:
    """Remove what is in the folder of an unfinished run, but for its claim and what is to be kept."""
    if folder.is_symlink():
        return
    for path in sorted(folder.rglob("*"), reverse=True):
        name = path.relative_to(folder).as_posix()
        if path.is_dir() and not path.is_symlink():
            with suppress(OSError):  # it is not empty
                path.rmdir()
        elif name != atomic_files.RUN and not keep(name):
            path.unlink(missing_ok=True)


def seed(out: Path, folder: Path, files: Mapping[str, str], say: Say) -> None:
    """Give a run the files of earlier results that it continues from, where they are as they were written."""
    for name, digest in files.items():
        if not atomic_files.is_as_written(out, name, {digest}):
            say(f"{out / name}: was changed since it was written, so it is not used")
            continue
        atomic_files.make_folder((folder / name).parent)
        try:
            os.link(out / name, folder / name)
        except OSError:  # a file system without links
            shutil.copyfile(out / name, folder / name)
