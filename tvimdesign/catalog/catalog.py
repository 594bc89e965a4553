"""Finds records by category and name, the user's folder before the shipped one, and reads them when asked."""

import stat
import warnings
from collections.abc import Sequence
from dataclasses import replace
from difflib import get_close_matches
from functools import cache
from pathlib import Path

from tvimdesign.base import user_cache
from tvimdesign.base.errors import CatalogError, FolderWarning
from tvimdesign.base.record import Record
from tvimdesign.catalog.category import CATEGORIES, meaningless_laws
from tvimdesign.catalog.validate import Tree, build_record, read_tree

_SHIPPED = Path(__file__).with_name("data")
_MOST_PROBLEMS = 50


class Catalog:
    """The shipped records, and those of a user's folder `<category>/<name>.yaml`, which add to them or replace them."""

    def __init__(self, extra_folder: Path | None = None) -> None:
        """Note the folders; no record is read yet.

        Raises CatalogError where `extra_folder` is no folder of categories, or one of another user that anybody writes.
        """
        self._folders = [_SHIPPED] if extra_folder is None else [extra_folder, _SHIPPED]
        self._records: dict[tuple[str, str], Record] = {}
        if extra_folder is None:
            return
        try:
            folders = [item.name for item in extra_folder.iterdir() if item.is_dir()]
            _check_owner(extra_folder, [folder for folder in folders if folder in CATEGORIES])
        except (OSError, ValueError):
            raise CatalogError(
                f"{str(extra_folder)[:200]}: the catalogue folder is not there or cannot be read"
            ) from None
        for folder in folders:
            close = get_close_matches(folder, CATEGORIES, n=1)
            if close and folder not in CATEGORIES:
                raise CatalogError(f"{extra_folder / folder}: this is no category; did you mean {close[0]}?")

    def names(self, category: str) -> list[str]:
        """Return the names of a category's records, sorted; raises CatalogError for an unknown category."""
        if category not in CATEGORIES:
            raise CatalogError(f"no category is named {category[:60]!r}; {_nearest(category, list(CATEGORIES))}")
        try:
            return sorted({path.stem for folder in self._folders for path in (folder / category).glob("*.yaml")})
        except OSError as error:
            raise CatalogError(f"category {category}: its folder cannot be read ({type(error).__name__})") from None

    def path(self, category: str, name: str) -> Path:
        """Return the file of a record; raises CatalogError with the nearest names where there is none."""
        names = self.names(category)
        # Only a listed name is made into a path, so no name can leave the category.
        if name not in names:
            raise CatalogError(f"{category} has no record {name[:60]!r}; {_nearest(name, names)}")
        candidates = (folder / category / f"{name}.yaml" for folder in self._folders)
        return next((path for path in candidates if path.exists()), self._folders[0] / category / f"{name}.yaml")

    def record(self, category: str, name: str) -> Record:
        """Return a record, read once; raises CatalogError naming every problem of its file."""
        if (category, name) not in self._records:
            path = self.path(category, name)
            shipped = path.is_relative_to(_SHIPPED)
            self._records[category, name] = (_read_shipped if shipped else self._read)(category, name, path)
        return self._records[category, name]

    def _read(self, category: str, name: str, path: Path) -> Record:
        tree = self._tree(category, path, ())
        record = _built(category, name, path, tree)
        if "based_on" not in tree:
            return record
        other = self._base(category, path, str(tree["based_on"]))
        record = replace(record, based_on=self._read(category, other.stem, other))
        if problems := meaningless_laws(record):
            raise CatalogError("\n".join(problems))
        return record

    def _tree(self, category: str, path: Path, before: tuple[Path, ...]) -> dict[str, Tree]:
        """Return a record's tree, completed from the records it is based on; raises CatalogError for a circle."""
        tree = read_tree(path)
        base = tree.get("based_on")
        if base is None:
            return tree
        if not isinstance(base, str):
            raise CatalogError(f"{_shown(path)}: based_on: expected the name of one record of {category}")
        chain, other = (*before, path), self._base(category, path, base)
        if other in chain:
            names = " -> ".join(path_in_circle.stem for path_in_circle in (*chain, other))
            raise CatalogError(f"{_shown(path)}: based_on: {names} goes in a circle; one of them must say all itself")
        return _over(tree, self._tree(category, other, chain))

    def _base(self, category: str, path: Path, base: str) -> Path:
        """Return the file of a record's base; a user's record may be based on the shipped one of its own name."""
        shipped = _SHIPPED / category / path.name
        if base == path.stem and path != shipped and shipped.exists():
            return shipped
        try:
            return self.path(category, base)
        except CatalogError as error:
            raise CatalogError(f"{_shown(path)}: based_on: {error}") from None


_SECTIONS = ("values", "tables", "words")


def _over(tree: dict[str, Tree], base: dict[str, Tree]) -> dict[str, Tree]:
    """Return a record's tree, completed from its base value by value, with source and status."""
    merged = dict(tree)
    for section in _SECTIONS:
        own, inherited = tree.get(section, {}), base.get(section, {})
        if isinstance(own, dict) and isinstance(inherited, dict):
            merged[section] = {**inherited, **own}
    return merged


def _built(category: str, name: str, path: Path, tree: dict[str, Tree]) -> Record:
    record, problems = build_record(category, name, _shown(path), tree)
    if len(problems) > _MOST_PROBLEMS:
        problems[_MOST_PROBLEMS:] = [f"{_shown(path)}: and {len(problems) - _MOST_PROBLEMS} more"]
    if problems:
        raise CatalogError("\n".join(problems))
    return record


@cache
def _read_shipped(category: str, name: str, path: Path) -> Record:
    """Shipped records do not change while the program runs, and are based on none but shipped ones."""
    return Catalog()._read(category, name, path)


def _shown(path: Path) -> str:
    """Name a user's file by its path, a shipped one by its place in the catalogue, the same on every machine."""
    return f"catalog/{path.relative_to(_SHIPPED).as_posix()}" if path.is_relative_to(_SHIPPED) else str(path)


def _nearest(name: str, names: list[str]) -> str:
    close = get_close_matches(name.lower(), names, n=1)
    listed = f"there are: {', '.join(names)}" if names else "it is empty"
    return f"did you mean {close[0]}? {listed}" if close else listed


# --- who owns the user's records ---


def _check_owner(folder: Path, categories: Sequence[str]) -> None:
    """Warn of a folder of records, or one of its categories, that is a link or another user's.

    Raises OSError, and CatalogError for one of another user that anybody may write.
    """
    for path in (folder, *(folder / category for category in categories)):
        owner = _other_owner(path)
        leads = f"leads to {path.resolve()}" if path.is_symlink() else ""
        belongs = f"belongs to another user, {owner}" if owner else ""
        if message := " and ".join(filter(None, (leads, belongs))):
            warnings.warn(f"{path}: the folder of records {message}", FolderWarning, stacklevel=3)


def _other_owner(folder: Path) -> str:
    """Return the owner of a folder; empty for this user and root. Raises CatalogError if anybody may write to it."""
    status = folder.stat()
    if user_cache.is_own(status):
        return ""
    if status.st_mode & stat.S_IWOTH:
        raise CatalogError(
            f"{str(folder)[:200]}: the folder of records belongs to another user, {_owner_name(folder)}, and anybody "
            "may write to it; copy it, or have its owner run chmod o-w on it"
        )
    return "" if status.st_uid == user_cache.ROOT else _owner_name(folder)


def _owner_name(folder: Path) -> str:
    try:
        return folder.owner()
    except KeyError:  # it has a number alone
        return str(folder.stat().st_uid)
