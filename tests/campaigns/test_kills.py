"""Some commands ended at some moments; and that the campaign sees what it looks for."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import kills
import pytest
from explorer_talk import Conversation, not_kept
from kills import Try

from tvimdesign.explore.states.history import open_history, write_history, written_digest
from tvimdesign.explore.states.source import open_source


@pytest.mark.gate
@pytest.mark.parametrize(
    ("command", "number", "after"),
    [
        ("run", signal.SIGKILL, 1.0),
        ("simulate", signal.SIGTERM, 1.2),
        ("explorer", signal.SIGINT, 2.5),
        *(
            pytest.param(command, number, after, marks=pytest.mark.slow)
            for command, after in (
                ("run", 2.5),
                ("run_with_parts", 12.0),
                ("front", 4.0),
                ("sweep", 5.0),
                ("parts", 6.0),
                ("explorer", 6.0),
                ("tolerate", 6.0),
                ("robot", 6.5),
                ("prove", 6.0),
            )
            for number in kills.SIGNALS
        ),
    ],
)
def test_a_command_that_is_ended_leaves_nothing_behind(
    command: str, number: signal.Signals, after: float, tmp_path: Path
) -> None:
    kills.prepare(command, tmp_path)
    own = tmp_path / "one"
    own.mkdir()
    assert kills.faults_after(Try(command, number, after), own) == []


def test_the_campaign_refuses_a_command_that_fails_by_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(kills.COMMANDS, "run", ["run", "there_is_none.yaml"])
    with pytest.raises(SystemExit, match="run ends with 2 where nobody ends it"):
        kills.run_through("run", tmp_path)


@pytest.mark.gate
def test_a_command_that_goes_on_as_if_nothing_had_come_is_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    goes_on = (
        "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN)\nwhile time.process_time() < 3.0: pass"
    )

    def start(_: list[str], own: Path) -> subprocess.Popen[bytes]:
        (own / "said.txt").write_text("")
        return subprocess.Popen([sys.executable, "-S", "-c", goes_on], cwd=own, env=kills.environment(own))

    monkeypatch.setattr(kills, "start", start)
    (fault,) = kills.faults_after(Try("run", signal.SIGTERM, 0.2), tmp_path)
    assert fault.startswith("went on for 2.")


def test_signals_that_a_shell_has_ignored_are_followed() -> None:
    asks = "import signal, shell_signals; shell_signals.follow_signals(); print(signal.getsignal(signal.SIGINT))"
    command = ["sh", "-c", f"trap '' INT; exec {sys.executable} -c '{asks}'"]
    environment = {**os.environ, "PYTHONPATH": str(Path(kills.__file__).parent)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert "default_int_handler" in done.stdout


def test_the_campaign_sees_broken_files(tmp_path: Path) -> None:
    (tmp_path / "manifest.json").write_text(json.dumps({"status": "running"}))
    (tmp_path / "results.json").write_text('{"a": ')
    (tmp_path / "cycle.png").write_bytes(b"\x89PNG")
    (tmp_path / ".why.csv.x.part").write_text("a")
    found = kills.broken_files(tmp_path, Try("run", signal.SIGTERM, 1.0), through=False)
    assert found == [
        ".why.csv.x.part is left half written", "cycle.png is broken", "results.json is broken",
        "the folder says running, not interrupted",
    ]  # fmt: skip
    (tmp_path / "manifest.json").write_text('{"status": ')
    assert "manifest.json is broken" in kills.broken_files(tmp_path, Try("run", signal.SIGTERM, 1.0), through=False)
    (tmp_path / "joint.fmu").write_bytes(b"PK")
    assert "joint.fmu is broken" in kills.broken_files(tmp_path, Try("robot", signal.SIGKILL, 1.0), through=False)


def test_the_campaign_sees_what_an_explorer_has_lost(tmp_path: Path) -> None:
    source, talk = open_source(kills.SMALL), Conversation(1)
    kept = open_history(tmp_path, source.text, source.first)
    kept.state = kept.state.model_copy(update={"at": {**source.first.at, "current": "1.1 A"}})
    write_history(tmp_path, kept, written_digest(tmp_path))
    talk.kept = talk.asked = {"current": "1.2 A"}
    assert not_kept(talk, kills.SMALL, tmp_path)[0].startswith("kept {")
    talk.asked = {"current": "1.1 A"}  # it was under way when the explorer was ended
    assert not_kept(talk, kills.SMALL, tmp_path) == []
    (tmp_path / "explore.json").write_text("{")
    assert not_kept(talk, kills.SMALL, tmp_path)[0].startswith("cannot be opened again: ")
