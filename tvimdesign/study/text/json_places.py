"""Lines of the values in a JSON file, for messages."""

from __future__ import annotations

import json
import re

from tvimdesign.study.text.mistakes import At

_DECODER = json.JSONDecoder()
_SPACE = re.compile(r"[ \t\n\r]*")


class JsonPlaces:
    """The lines of a JSON file; none are known of one that is broken."""

    def __init__(self, data: bytes) -> None:
        """Keep the text of a file that holds whole JSON."""
        try:
            self._text = data.decode(json.detect_encoding(data), "surrogatepass")
            json.loads(self._text)
        except (ValueError, RecursionError):
            self._text = ""

    def at(self, path: str) -> At:
        """Return the place of a path such as `study.module.current`, or of the last of its steps that exists."""
        if not self._text:
            return At(0, 0)
        place = value = self._past_space(0)
        for name in re.findall(r"[^.\[\]]+", path):
            member = self._member(value, name)
            if member is None:
                break
            place, value = member
        return At(self._text.count("\n", 0, place) + 1, place - self._text.rfind("\n", 0, place))

    def _past_space(self, at: int) -> int:
        space = _SPACE.match(self._text, at)
        assert space is not None
        return space.end()

    def _member(self, at: int, name: str) -> tuple[int, int] | None:
        """Return where the key and the value of a name begin, or the item of a number twice."""
        opening = self._text[at]
        if opening not in "{[":
            return None
        number, at = 0, self._past_space(at + 1)
        while self._text[at] not in "}]":
            key, key_text = at, str(number)
            if opening == "{":
                key_text, at = _DECODER.raw_decode(self._text, at)
                at = self._past_space(self._past_space(at) + 1)  # the colon
            if key_text == name:
                return (key, at)
            at = self._past_space(_DECODER.raw_decode(self._text, at)[1])
            if self._text[at] == ",":
                at = self._past_space(at + 1)
            number += 1
        return None
