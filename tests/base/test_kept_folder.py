"""Folders of the user's cache, and groups of commands."""

import os
import sys
import time
from pathlib import Path
from threading import Thread
from types import SimpleNamespace
from typing import Any

import pytest
from support import are_gone

from tvimdesign.base.processes import CommandGroup, ProcessorTimeError
from tvimdesign.base.user_cache import cache_folder, find_code, is_own_folder, keep_code


def test_things_are_kept_where_the_user_says_and_nowhere_if_that_cannot_be(tmp_path, monkeypatch):
    monkeypatch.setenv("TVIMDESIGN_CACHE", str(tmp_path / "here"))
    assert cache_folder("cad") == tmp_path / "here/cad"
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("TVIMDESIGN_CACHE", str(tmp_path / "file/below"))
    assert cache_folder("cad") is None
    monkeypatch.setenv("TVIMDESIGN_CACHE", "")
    assert cache_folder("cad") is None
    (tmp_path / "link").symlink_to(tmp_path / "here")
    monkeypatch.setenv("TVIMDESIGN_CACHE", str(tmp_path / "link"))
    assert cache_folder("cad") is None
    monkeypatch.setenv("TVIMDESIGN_CACHE", str(tmp_path / "here"))
    (tmp_path / "here/linked").symlink_to(tmp_path / "here/cad")
    assert cache_folder("linked") is None
    (tmp_path / "here").chmod(0o777)
    (tmp_path / "here/cad").chmod(0o777)
    assert cache_folder("cad") == tmp_path / "here/cad"
    assert (tmp_path / "here").stat().st_mode & 0o777 == 0o700
    assert (tmp_path / "here/cad").stat().st_mode & 0o777 == 0o700
    monkeypatch.setattr(os, "getuid", lambda: 12345)
    assert cache_folder("cad") is None
    monkeypatch.undo()
    monkeypatch.delenv("TVIMDESIGN_CACHE", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert cache_folder("cad") == tmp_path / "tvimdesign/cad"


AS_ROOT = pytest.mark.skipif(not hasattr(os, "getuid") or os.getuid() != 0, reason="only root gives files away")
STRANGER = 12345


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("TVIMDESIGN_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


def give_away(path: Path) -> None:
    os.chown(path, STRANGER, STRANGER)


def make_pipe(path: Path) -> None:
    path.unlink()
    os.mkfifo(path)


def make_link(path: Path) -> None:
    path.rename(path.with_name("other"))
    path.symlink_to("other")


CHANGES: list[Any] = [
    pytest.param(give_away, id="another user's", marks=AS_ROOT),
    pytest.param(lambda path: path.chmod(0o646), id="writable by all"),
    pytest.param(lambda path: path.with_name("second").hardlink_to(path), id="two names"),
    pytest.param(make_link, id="a link"),
    pytest.param(make_pipe, id="a pipe"),
    pytest.param(lambda path: path.write_bytes(path.read_bytes()[:-1]), id="cut short"),
]


@pytest.mark.parametrize("change", CHANGES)
def test_code_that_others_could_change_is_not_loaded(cache, change):
    keep_code(b"ours", "text")
    (file,) = (cache / "code").iterdir()
    (cache / "code").chmod(0o777)  # anybody could write here once
    change(file)
    assert find_code("text") is None
    assert (cache / "code").stat().st_mode & 0o777 == 0o700
    keep_code(b"ours", "text")
    (cache / "code/second").unlink(missing_ok=True)
    assert find_code("text") == b"ours"


def test_code_under_another_name_is_not_loaded(cache):
    keep_code(b"ours", "text")
    (first,) = (cache / "code").iterdir()
    keep_code(b"others", "other text")
    (other,) = set((cache / "code").iterdir()) - {first}
    other.replace(first)
    assert find_code("text") is None


@pytest.mark.usefixtures("cache")
def test_a_cache_below_a_folder_of_others_is_not_used(tmp_path):
    for mode, used in ((0o777, False), (0o1777, True), (0o757, False), (0o755, True)):
        tmp_path.chmod(mode)
        assert (cache_folder("code") is not None) == used
    tmp_path.chmod(0o700)


@AS_ROOT
def test_a_cache_below_or_in_a_folder_of_another_user_is_not_used(cache, tmp_path):
    for folder in (tmp_path, cache, cache / "code"):
        assert cache_folder("code") == cache / "code"
        give_away(folder)
        assert cache_folder("code") is None
        os.chown(folder, 0, 0)


def test_new_folders_of_a_cache_are_private(cache, monkeypatch):
    monkeypatch.setenv("TVIMDESIGN_CACHE", str(cache / "below"))
    before = os.umask(0)
    try:
        assert cache_folder("code") == cache / "below/code"
    finally:
        os.umask(before)
    assert {path.stat().st_mode & 0o777 for path in (cache, cache / "below", cache / "below/code")} == {0o700}


def test_a_group_without_other_members_has_no_others(tmp_path, monkeypatch):
    user = SimpleNamespace(pw_gid=os.getgid(), pw_name="me")
    monkeypatch.setattr("pwd.getpwuid", lambda _: user)
    tmp_path.chmod(0o770)
    for name, members, own in (("me", [], True), ("me", ["me"], True), ("me", ["you"], False), ("staff", [], False)):
        group = SimpleNamespace(gr_name=name, gr_mem=members)
        monkeypatch.setattr("grp.getgrgid", lambda _, group=group: group)
        assert is_own_folder(tmp_path) == own
    tmp_path.chmod(0o700)


def test_damaged_code_is_not_used_and_the_oldest_goes(cache, monkeypatch):
    keep_code(b"code", "text")
    (file,) = (cache / "code").iterdir()
    whole = file.read_bytes()
    for damaged in (whole[:-1], b"", b"x" * len(whole), whole[:-1] + bytes([whole[-1] ^ 1])):
        file.write_bytes(damaged)
        assert find_code("text") is None
    file.unlink()
    monkeypatch.setattr("tvimdesign.base.user_cache._MOST", 3)
    for number in range(6):
        keep_code(b"code", f"text {number}")
        latest = max(file.parent.iterdir(), key=lambda path: path.stat().st_mtime)
        os.utime(latest, (number, number))
    assert [find_code(f"text {number}") for number in range(6)] == [None, None, None, b"code", b"code", b"code"]


STARTS_ANOTHER = """
import os, subprocess, sys, time
other = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
open(sys.argv[1] + ".part", "w").write(f"{os.getpid()} {other.pid}")
os.rename(sys.argv[1] + ".part", sys.argv[1])
time.sleep(600)
"""


def test_what_a_command_says_and_its_code_are_given_back():
    code = "import sys; print('out'); sys.stderr.write('err'); sys.exit(3)"
    with CommandGroup() as commands:
        done = commands.run([sys.executable, "-c", code], 60.0)
    assert (done.returncode, done.stdout.strip(), done.stderr) == (3, "out", "err")


def test_commands_of_other_threads_end_with_the_group(tmp_path):
    reported, ended = tmp_path / "told", []
    with CommandGroup() as commands:
        command = [sys.executable, "-c", STARTS_ANOTHER, str(reported)]
        waits = Thread(target=lambda: ended.append(commands.run(command, 60.0)))
        waits.start()
        while not reported.exists():
            time.sleep(0.02)
    waits.join(60.0)
    assert [item.returncode < 0 for item in ended] == [True]
    _gone(reported)
    assert commands.run([sys.executable, "-c", "print(1)"], 60.0).returncode < 0


def test_a_command_that_takes_too_long_is_ended(tmp_path):
    reported = tmp_path / "told"
    starts_a_burner = STARTS_ANOTHER.replace("import time; time.sleep(600)", "while True: pass")
    with CommandGroup() as commands, pytest.raises(ProcessorTimeError):
        commands.run([sys.executable, "-c", starts_a_burner, str(reported)], 0.5)
    _gone(reported)


def _gone(reported: Path) -> None:
    numbers = [int(number) for number in reported.read_text().split()]
    assert are_gone(numbers)
