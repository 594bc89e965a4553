"""Some commands ended at some moments; and that the campaign sees what it looks for."""

from __future__ import annotations

import json
import signal
from pathlib import Path

import kills
import pytest
from explorer_talk import Conversation, not_kept
from kills import Try

from tvimdesign.explore.states.history import open_kept, write_kept
from tvimdesign.explore.states.source import open_source


@pytest.mark.parametrize(
    ("command", "number", "after"),
    [
        ("run", signal.SIGKILL, 1.0),
        *(
            pytest.param(command, number, after, marks=pytest.mark.slow)
            for command, after in (("run", 2.5), ("front", 4.0), ("sweep", 5.0), ("parts", 6.0), ("explorer", 6.0))
            for number in kills.SIGNALS
        ),
    ],
)
def test_a_command_that_is_ended_leaves_nothing_behind(
    command: str, number: signal.Signals, after: float, tmp_path: Path
) -> None:
    assert kills.faults_after(Try(command, number, after), tmp_path) == []


def test_the_campaign_refuses_a_command_that_fails_by_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(kills.COMMANDS, "run", ["run", "there_is_none.yaml"])
    with pytest.raises(SystemExit, match="run ends with 2 where nobody ends it"):
        kills.run_through("run", tmp_path)


def test_the_campaign_sees_broken_files(tmp_path: Path) -> None:
    (tmp_path / "manifest.json").write_text(json.dumps({"status": "running"}))
    (tmp_path / "results.json").write_text('{"a": ')
    (tmp_path / "cycle.png").write_bytes(b"\x89PNG")
    (tmp_path / ".why.csv.x.part").write_text("a")
    found = kills.broken_files(tmp_path, Try("run", signal.SIGTERM, 1.0), ended=False)
    assert found == [
        ".why.csv.x.part is left half written", "cycle.png is broken", "results.json is broken",
        "the manifest says running, not interrupted",
    ]  # fmt: skip


def test_the_campaign_sees_what_an_explorer_has_lost(tmp_path: Path) -> None:
    source, talk = open_source(kills.SMALL), Conversation(1)
    kept = open_kept(tmp_path, source.text, source.first)
    kept.state = kept.state.model_copy(update={"at": {**source.first.at, "current": "1.1 A"}})
    write_kept(tmp_path, kept)
    talk.kept = talk.asked = {"current": "1.2 A"}
    assert not_kept(talk, kills.SMALL, tmp_path)[0].startswith("kept {")
    talk.asked = {"current": "1.1 A"}  # it was under way when the explorer was ended
    assert not_kept(talk, kills.SMALL, tmp_path) == []
    (tmp_path / "explore.json").write_text("{")
    assert not_kept(talk, kills.SMALL, tmp_path)[0].startswith("cannot be opened again: ")
