"""From a path to text that is safe to read: an ordinary file of a study's size, UTF-8, without control characters."""

import re
import stat
from collections.abc import Callable
from pathlib import Path

from tvimdesign.base.errors import InputError
from tvimdesign.study.text.mistakes import At, Mistake, Mistakes, StudyError, did_you_mean

MOST_BYTES = 1_000_000
CONTROL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff\ufffe\uffff\ufeff]")
_TAB_INDENT = re.compile(r"^ *\t", re.MULTILINE)


def read_text(path: Path, problems: Mistakes) -> str:
    """Return the text of a file; raises InputError, in words, where it is no file that could be a study."""
    return _decode(_bytes(path), problems)


def _decode(raw: bytes, problems: Mistakes) -> str:
    """Return the text of the bytes; raises StudyError where they are too many, not UTF-8 or hold control characters."""
    whole = At(0, 0)
    if len(raw) > MOST_BYTES:
        problems.add(whole, "", _too_big(len(raw)))
        problems.stop()
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = raw[: error.start]
        place = At(before.count(b"\n") + 1, error.start - (before.rfind(b"\n") + 1) + 1)
        kind = "UTF-16 text" if raw[:2] in {b"\xff\xfe", b"\xfe\xff"} else f"byte 0x{raw[error.start]:02x} is no text"
        problems.add(place, "", f"the file is not UTF-8 text ({kind})", "a study in YAML", "save it as UTF-8")
        problems.stop()
    return check_characters(text, problems)


def _too_big(size: int) -> str:
    """Say that a file of this size [bytes] is too large for a study."""
    return f"the file has {size / 1e6:.3g} MB, a study at most {MOST_BYTES / 1e6:.0f} MB; give the path of a study"


def check_characters(text: str, problems: Mistakes, place: At | None = None) -> str:
    """Return the text; raises StudyError, at a `place` if given, for one that is too long or has control characters."""
    if len(text) > MOST_BYTES:
        problems.add(At(0, 0), "", _too_big(len(text)))
    elif odd := CONTROL.search(text):
        problems.add(
            place or _place(text, odd.start()), "", f"control character U+{ord(odd[0]):04X}", "plain text", "remove it"
        )
    elif tab := _TAB_INDENT.search(text):
        problems.add(
            place or _place(text, tab.end() - 1), "", "a tab at the start of a line", "spaces: YAML indents with spaces"
        )
    problems.stop()
    return text


def _bytes(path: Path) -> bytes:
    """Return the bytes of an ordinary file of a study's size; raises InputError, in words, for anything else."""
    shown = printable(path)
    try:
        return ordinary_bytes(
            path, MOST_BYTES, "a study file (YAML)", lambda size: StudyError([Mistake(shown, 0, 0, "", _too_big(size))])
        )
    except FileNotFoundError:
        raise InputError(f"{shown}: no such file; {_similar(path) or '`tvimdesign new` writes a study'}") from None


def _similar(path: Path) -> str:
    try:
        return did_you_mean(path.name, [file.name for file in path.parent.glob("*.y*ml")])
    except (OSError, ValueError):
        return ""


def _place(text: str, index: int) -> At:
    start = text.rfind("\n", 0, index) + 1
    return At(text.count("\n", 0, index) + 1, index - start + 1)


# --- files a user names ---


def printable(path: Path) -> str:
    """Write a path so that a terminal shows it and obeys nothing in it."""
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in str(path))


def is_folder(path: Path) -> bool:
    """Return whether a path is a folder; one that is too long to be a path is none."""
    try:
        return path.is_dir()
    except (OSError, ValueError):  # no permission, a name too long
        return False


def ordinary_bytes(path: Path, most: int, wanted: str, too_big: Callable[[int], Exception]) -> bytes:
    """Return at most `most` + 1 bytes of an ordinary file; `wanted` says what should have been given.

    Raises FileNotFoundError as it is, what `too_big` makes of a size above `most`, and InputError for the rest: a
    folder, a pipe or a device, which might never end.
    """
    shown = printable(path)
    try:
        status = path.stat()
        if stat.S_ISDIR(status.st_mode):
            raise InputError(f"{shown} is a folder; give the path of {wanted}")
        if not stat.S_ISREG(status.st_mode):
            raise InputError(f"{shown} is no ordinary file; give the path of {wanted}")
        if status.st_size > most:
            raise too_big(status.st_size)
        with path.open("rb") as file:
            return file.read(most + 1)
    except FileNotFoundError:
        raise
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise InputError(f"{shown} cannot be read: {reason}") from None
