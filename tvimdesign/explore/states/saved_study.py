"""The study of a state as a file that `run` answers as the page does."""

from __future__ import annotations

import os
from pathlib import Path

from tvimdesign.explore.states.state import State, set_values, tree_of
from tvimdesign.study.text.yaml_text import Text
from tvimdesign.study.tree import StudyTree, tree_yaml


def saved_text(base: StudyTree, state: State, folder: Path) -> str:
    """YAML of a state's study, its folder of records as seen from the folder where the file will stand."""
    tree = tree_of(base, state)
    records = tree.section("catalog")
    if isinstance(records, Text) and records.value.strip():
        there = (base.folder / records.value.strip()).resolve()
        tree = set_values(tree, {"catalog": os.path.relpath(there, folder.resolve())})
    return tree_yaml(tree)
