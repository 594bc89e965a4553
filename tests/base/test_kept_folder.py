"""Where things are kept from one run to the next, and where they are not: a folder of others is not trusted."""

import os
from pathlib import Path

import pytest

from tvimdesign.base.kept_folder import kept_folder


def test_things_are_kept_where_the_user_says_and_nowhere_if_that_cannot_be(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TVIMDESIGN_CACHE", str(tmp_path / "here"))
    assert kept_folder("cad") == tmp_path / "here/cad"
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("TVIMDESIGN_CACHE", str(tmp_path / "file/below"))
    assert kept_folder("cad") is None
    monkeypatch.setenv("TVIMDESIGN_CACHE", "")
    assert kept_folder("cad") is None
    (tmp_path / "link").symlink_to(tmp_path / "here")
    monkeypatch.setenv("TVIMDESIGN_CACHE", str(tmp_path / "link"))
    assert kept_folder("cad") is None
    monkeypatch.setenv("TVIMDESIGN_CACHE", str(tmp_path / "here"))
    (tmp_path / "here/linked").symlink_to(tmp_path / "here/cad")
    assert kept_folder("linked") is None
    (tmp_path / "here").chmod(0o777)
    (tmp_path / "here/cad").chmod(0o777)
    assert kept_folder("cad") == tmp_path / "here/cad"
    assert (tmp_path / "here").stat().st_mode & 0o777 == 0o700
    assert (tmp_path / "here/cad").stat().st_mode & 0o777 == 0o700
    monkeypatch.setattr(os, "getuid", lambda: 12345)
    assert kept_folder("cad") is None
    monkeypatch.undo()
    monkeypatch.delenv("TVIMDESIGN_CACHE", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert kept_folder("cad") == tmp_path / "tvimdesign/cad"
