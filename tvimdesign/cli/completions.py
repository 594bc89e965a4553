"""Completions that a shell offers on Tab: study files, tests, examples, names of rows and of what is set."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

_STUDIES = (".yaml", ".yml")


def study_files(incomplete: str) -> list[str]:
    """Complete study files and folders that begin so; hidden ones are left out."""
    return _files(incomplete, _STUDIES)


def designs_and_studies(incomplete: str) -> list[str]:
    """Complete names of designs and studies."""
    return _files(incomplete, (*_STUDIES, ".json"))


def tests(incomplete: str) -> list[str]:
    """Complete virtual tests."""
    from tvimdesign.report.virtual_tests import TESTS

    return _beginning(TESTS, incomplete)


def kinds(incomplete: str) -> list[str]:
    """Complete kinds of measurement."""
    from tvimdesign.report.fit import kind_sheets

    return _beginning(kind_sheets(), incomplete)


def examples(incomplete: str) -> list[str]:
    """Complete shipped studies."""
    from tvimdesign.report.study_files import example_names

    return _beginning(example_names(), incomplete)


def modes(incomplete: str) -> list[str]:
    """Complete modes of a module."""
    from tvimdesign.report.rows import mode_names

    return _beginning(mode_names(), incomplete)


def rows(incomplete: str) -> list[str]:
    """Complete names of rows of either mode."""
    from tvimdesign.report.rows import row_names

    return _beginning(row_names(), incomplete)


def settings(incomplete: str) -> list[str]:
    """Complete inputs and choices, and outputs after `require.`, each with the `=` of a setting."""
    from tvimdesign.report.rows import setting_names

    return _beginning(setting_names(), incomplete)


def _beginning(names: Iterable[str], incomplete: str) -> list[str]:
    return [name for name in names if name.startswith(incomplete)]


def _files(incomplete: str, endings: tuple[str, ...]) -> list[str]:
    start = Path(incomplete or ".")
    folder, begin = (start, "") if not incomplete or incomplete.endswith("/") else (start.parent, start.name)
    prefix = incomplete[: len(incomplete) - len(begin)] if begin else incomplete
    try:
        paths = sorted(folder.iterdir())
    except OSError:
        return []
    shown = [path for path in paths if path.name.startswith(begin) and not path.name.startswith(".")]
    folders = [f"{prefix}{path.name}/" for path in shown if path.is_dir()]
    return [f"{prefix}{path.name}" for path in shown if path.suffix in endings] + folders
