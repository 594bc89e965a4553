"""Places of keys in a study's file, for messages about a study that has been read."""

from __future__ import annotations

from pathlib import Path

from tvimdesign.study.text.mistakes import At, Mistakes
from tvimdesign.study.text.named_file import printable
from tvimdesign.study.text.source import read_text
from tvimdesign.study.text.yaml_text import Mapping, compose


class Places:
    """The places of a study's keys; raises what `read_study` raises where the file is no study."""

    def __init__(self, path: Path) -> None:
        """Read the file once more, for its lines and columns alone."""
        self.file = printable(path)
        problems = Mistakes(self.file)
        self._root = compose(read_text(path, problems), problems)

    def at(self, path: str) -> At:
        """Place of a key such as `module.current`; where it is not written, of the section it would stand in."""
        node, place = self._root, At(self._root.line, self._root.column)
        for word in path.split("."):
            if not isinstance(node, Mapping) or word not in node.entries:
                break
            key, node = node.entries[word]
            place = At(key.line, key.column)
        return place

    def text(self, path: str) -> str:
        """Return the place of a key as `file:line:column`."""
        at = self.at(path)
        return f"{self.file}:{at.line}:{at.column}"
