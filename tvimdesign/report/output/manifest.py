"""The manifest of a results folder: what made the results, and the digest of each file that the run wrote."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tvimdesign.base.atomic_files import digest_of, is_inside
from tvimdesign.base.errors import InputError
from tvimdesign.report.output.claim import FORMAT

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
