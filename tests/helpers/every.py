"""One check of many items as one test, which names every item that fails and why; all records of a catalogue."""

from collections.abc import Callable, Iterable
from typing import TypeVar

import pytest

from tvimdesign.base.errors import CatalogError
from tvimdesign.catalog import CATEGORIES, Catalog

Item = TypeVar("Item")


def of_every(items: Iterable[Item], check: Callable[[Item], None]) -> None:
    """Run a check of each item; fail with a line for each item that fails it, and where there is no item."""
    wrong, count = [], 0
    for item in items:
        count += 1
        try:
            check(item)
        except (Exception, pytest.fail.Exception) as error:
            reason = next(iter(str(error).strip().splitlines()), "")
            wrong.append(f"{_name(item)}: {type(error).__name__}: {reason}")
    assert count, "nothing to check"
    assert not wrong, f"{len(wrong)} of {count} fail:\n  " + "\n  ".join(wrong)


def _name(item: object) -> str:
    name = getattr(item, "name", item)
    return "/".join(str(part) for part in name) if isinstance(name, tuple) else str(name)


def check_records(catalog: Catalog) -> list[str]:
    """Read every record and name everything that lacks a unit, a source, a status, or what its category requires."""
    problems: list[str] = []
    for category in CATEGORIES:
        for name in catalog.names(category):
            try:
                catalog.record(category, name)
            except CatalogError as error:
                problems += str(error).splitlines()
    return problems
