"""Mistakes in a study: each with its place in the file, and all of them as one error.

From a path to text that is safe to read: an ordinary file of a study's size, UTF-8, without control characters.
"""

import re
import stat
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import NoReturn

from tvimdesign.base.errors import InputError
from tvimdesign.base.record import own_data

MOST_SHOWN = 50  # How many problems an error prints; the rest is counted
_MOST_NAMES = 12
_LONGEST_WORD = 64
_CLOSE, _NEAR = 0.8, 0.6  # Likeness of a misspelt name, and the least of one that is proposed if nothing else is


@dataclass(frozen=True, slots=True)
class At:
    """A place in the file, counted from 1; line 0 is the file as a whole.

    It may name the option or the call that it comes from as its `file`: none is the study's own file.
    """

    line: int
    column: int
    file: str = field(default="", kw_only=True)


@dataclass(frozen=True)
class Mistake:
    """One thing that is wrong: where, what, what was expected instead, and what may help."""

    file: str
    line: int
    column: int
    path: str
    message: str
    expected: str = ""
    hint: str = ""

    def __str__(self) -> str:
        """Format as one line: `file:line:column: path: message; expected ...; hint`."""
        place = f"{self.file}:{self.line}:{self.column}" if self.line else self.file
        what = f"{self.path}: {self.message}" if self.path else self.message
        expected = f"expected {self.expected}" if self.expected else ""
        return f"{place}: " + "; ".join(part for part in (what, expected, self.hint) if part)


class RefusedError(Exception):
    """A value cannot be used; why is noted."""


class StudyError(InputError):
    """A study cannot be used; holds every problem found, in the order of the file."""

    def __init__(self, problems: Iterable[Mistake]) -> None:
        """Sort the problems by their place in the file."""
        self.problems = tuple(sorted(problems, key=lambda problem: (problem.file, problem.line, problem.column)))
        super().__init__(self.problems)

    def __str__(self) -> str:
        """List the problems, one a line, at most MOST_SHOWN of them."""
        lines = [str(problem) for problem in self.problems[:MOST_SHOWN]]
        if len(self.problems) > MOST_SHOWN:
            lines.append(f"... and {len(self.problems) - MOST_SHOWN} more")
        return "\n".join(lines)


@dataclass
class Mistakes:
    """The list that grows while a study is read."""

    file: str
    items: list[Mistake] = field(default_factory=list)

    def add(self, place: At, path: str, message: str, expected: str = "", hint: str = "") -> None:
        """Note one problem."""
        one_line = "; ".join(message.splitlines())
        self.items.append(Mistake(place.file or self.file, place.line, place.column, path, one_line, expected, hint))

    def refuse(self, place: At, path: str, message: str, expected: str = "", hint: str = "") -> NoReturn:
        """Note one problem of a value that cannot be used. Raises RefusedError."""
        self.add(place, path, message, expected, hint)
        raise RefusedError

    @property
    def full(self) -> bool:
        """True where there are as many as are shown."""
        return len(self.items) >= MOST_SHOWN

    def unknown(self, place: At, path: str, what: str, word: str, known: Iterable[str], hint: str = "") -> None:
        """Note a word that is none of the known ones, with the nearest of them, or with those that are used most."""
        names = list(known)
        hint = hint or ("" if self.full else did_you_mean(word, names))
        many = len(names) > _MOST_NAMES
        shown = f"one of {len(names)} names" if many and hint else one_of(often_first(names) if many else names)
        self.add(place, path, f"no such {what}", shown, hint)

    def stop(self) -> None:
        """Raise what was found, if anything was."""
        if self.items:
            raise StudyError(self.items)


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return `did you mean 'x'?` for the known name that a word means, or nothing where none is near."""
    name = nearest(word, known)
    return f"did you mean {name!r}?" if name else ""


def nearest(word: str, known: Iterable[str]) -> str:
    """Return the known name that a word means; empty if none is near.

    A synonym comes first, then a misspelt name, a misspelt synonym, and a name with the word in it.
    """
    if len(word) > _LONGEST_WORD:
        return ""
    names, spelt = list(known), word.lower().replace(" ", "_").replace("-", "_")
    meant = {key.replace(" ", "_"): [term for term in terms if term in names] for key, terms in synonyms().items()}
    meant = {key: terms for key, terms in meant.items() if terms and key not in names}
    near = meant.get(spelt) or get_close_matches(spelt, names, n=1, cutoff=_CLOSE)
    near = near or [meant[key][0] for key in get_close_matches(spelt, meant, n=1, cutoff=_CLOSE)]
    if not near and len(spelt) > 2:
        near = often_first(name for name in names if spelt in name)
    return (near or get_close_matches(spelt, names, n=1, cutoff=_NEAR) or [""])[0]


def often_first(names: Iterable[str]) -> list[str]:
    """Return names with those first that synonyms name."""
    often = dict.fromkeys(term for terms in synonyms().values() for term in terms)
    listed = list(names)
    return [*(name for name in often if name in listed), *(name for name in listed if name not in often)]


@cache
def synonyms() -> dict[str, tuple[str, ...]]:
    """Return words that people write, each with the quantities and terms that it means."""
    return {word: tuple(terms) for word, terms in own_data(__file__, "synonyms.yaml").items()}


def one_of(names: list[str]) -> str:
    """Write the names as `one of a, b, c`, shortened where there are many."""
    if not names:
        return "none: there are no names to choose from"
    if len(names) == 1:
        return repr(names[0])
    more = f", ... ({len(names)} in all)" if len(names) > _MOST_NAMES else ""
    return "one of " + ", ".join(names[:_MOST_NAMES]) + more


def quoted(text: str) -> str:
    """Write a piece of the user's text in quotes, on one line, shortened; `repr` escapes what a terminal would obey."""
    return repr(text if len(text) <= _LONGEST_WORD else text[: _LONGEST_WORD - 3] + "...")


def step(path: str, word: str) -> str:
    """Append a key to a path; a key that is not a plain word is quoted."""
    shown = word if re.fullmatch(r"[A-Za-z0-9_@-]{1,64}", word) else quoted(word)
    return f"{path}.{shown}" if path else shown


MOST_BYTES = 1_000_000
CONTROL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff\ufffe\uffff\ufeff]")
_TAB_INDENT = re.compile(r"^ *\t", re.MULTILINE)


def read_text(path: Path, problems: Mistakes) -> str:
    """Return the text of a file; raises InputError, in words, where it is no file that could be a study.

    It is a StudyError if it is too large, not UTF-8 or has control characters.
    """
    shown, whole = printable(path), At(0, 0)
    try:
        raw = ordinary_bytes(
            path, MOST_BYTES, "a study file (YAML)", lambda size: StudyError([Mistake(shown, 0, 0, "", _too_big(size))])
        )
    except FileNotFoundError:
        raise InputError(f"{shown}: no such file; {_similar(path) or '`tvimdesign new` writes a study'}") from None
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


def _similar(path: Path) -> str:
    try:
        return did_you_mean(path.name, [file.name for file in path.parent.glob("*.y*ml")])
    except (OSError, ValueError):
        return ""


def _place(text: str, index: int) -> At:
    start = text.rfind("\n", 0, index) + 1
    return At(text.count("\n", 0, index) + 1, index - start + 1)


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
