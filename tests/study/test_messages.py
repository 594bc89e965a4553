"""Messages about bad studies, compared with the snapshots in messages/: a study's text, then what is reported of it.

UPDATE_MESSAGES=1 rewrites the snapshots; read the difference before you commit it.
"""

import os
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from tvimdesign.study import StudyError, read_study_text

FOLDER = Path(__file__).with_name("messages")
SNAPSHOTS = {
    "small_table.txt": "small table and catalogue of these tests",
    "shipped_tables.txt": "shipped tables and records",
}
_MANY = re.compile(r"one of [^;]*, \.\.\. \(\d+ in all\)")
"""A list of names that grows with the table."""


def cases(text: str) -> list[str]:
    """Return the studies of a snapshot, without their messages."""
    return [case.strip("\n") for case in re.split(r"(?m)(?:^> .*\n)+", text) if case.strip()]


@pytest.mark.parametrize("name", SNAPSHOTS)
def test_messages_are_those_of_the_snapshot(problems: Callable[..., list[str]], name: str) -> None:
    path = FOLDER / name
    expected = path.read_text(encoding="utf-8")
    result = ""
    for text in cases(expected):
        lines = problems(text) if name == "small_table.txt" else _of_shipped_tables(text)
        messages = "".join(f"> {_MANY.sub('one of ...', line.removeprefix('x.yaml:'))}\n" for line in lines)
        result += f"{text}\n{messages}\n"
    if os.environ.get("UPDATE_MESSAGES"):
        path.write_text(result, encoding="utf-8")
    assert result == expected


def _of_shipped_tables(text: str) -> list[str]:
    with pytest.raises(StudyError) as refused:
        read_study_text(text, "x.yaml")
    return str(refused.value).splitlines()
