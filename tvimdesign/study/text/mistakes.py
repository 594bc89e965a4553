"""Mistakes in a study: each with its place in the file, and all of them as one error."""

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cache
from typing import Protocol

from tvimdesign.base.errors import InputError
from tvimdesign.base.yaml_data import own_data

MOST_SHOWN = 50
"""How many problems an error prints; the rest is counted."""
_MOST_NAMES = 12
_LONGEST_WORD = 64
_CLOSE, _NEAR = 0.8, 0.6
"""Likeness of a misspelt name, and the least of one that is proposed if nothing else is."""


class Place(Protocol):
    """Anything with a line and a column, counted from 1."""

    @property
    def line(self) -> int:
        """Line in the file, from 1; 0 where the file as a whole is meant."""

    @property
    def column(self) -> int:
        """Column in the line, from 1."""

    @property
    def file(self) -> str:
        """Option or call that holds it; empty for the study's own file."""


@dataclass(frozen=True, slots=True)
class At:
    """A place in the file, counted from 1; line 0 is the file as a whole."""

    line: int
    column: int
    file: str = ""


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

    def add(self, place: Place, path: str, message: str, expected: str = "", hint: str = "") -> None:
        """Note one problem."""
        one_line = "; ".join(message.splitlines())
        self.items.append(Mistake(place.file or self.file, place.line, place.column, path, one_line, expected, hint))

    def unknown(self, place: Place, path: str, what: str, word: str, known: Iterable[str], hint: str = "") -> None:
        """Note a word that is none of the known ones, with the nearest of them, or with those that are used most."""
        names = list(known)
        hint = hint or (did_you_mean(word, names) if len(self.items) < MOST_SHOWN else "")
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
