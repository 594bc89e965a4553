"""Machine code: compiled once, then stored."""

import ctypes
import os
from pathlib import Path
from unittest import mock

import numpy as np
import pytest

from tvimdesign.base.user_cache import find_code, keep_code
from tvimdesign.cad.inspection import ray_code
from tvimdesign.cad.inspection.ray_code import MachineCode

TEXT = """
define void @sums(ptr %given, ptr %found, i64 %count) {
start:
  br label %each
each:
  %i = phi i64 [0, %start], [%next, %work]
  %s = phi double [0.0, %start], [%sum, %work]
  %more = icmp slt i64 %i, %count
  br i1 %more, label %work, label %end
work:
  %at = getelementptr double, ptr %given, i64 %i
  %x = load double, ptr %at
  %y = fmul double %x, 3.0
  %sum = fadd double %s, %y
  %next = add i64 %i, 1
  br label %each
end:
  store double %s, ptr %found
  ret void
}
"""


def told(values: np.ndarray) -> float:
    code = MachineCode(TEXT)
    call = code.function("sums", (ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64))
    result = np.empty(1)
    call(values.ctypes.data, result.ctypes.data, len(values))
    return float(result[0])


@pytest.fixture
def stored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("TVIMDESIGN_CACHE", str(tmp_path))
    return tmp_path / "code"


def compiled_again(values: np.ndarray) -> bool:
    """Return whether the compiler was called; the sum is right either way."""
    with mock.patch.object(ray_code, "_compiled", wraps=ray_code._compiled) as compiler:
        assert told(values) == pytest.approx(3.0 * values.sum(), rel=1e-14)
    return bool(compiler.called)


def test_code_is_compiled_once_for_each_processor_and_compiler(stored: Path) -> None:
    values = np.arange(1.0, 9.0)
    assert compiled_again(values)
    assert not compiled_again(values)
    (file,) = stored.iterdir()
    whole = file.read_bytes()
    for damaged in (whole[:-1], b"", b"x" * len(whole), whole[:40] + bytes([whole[40] ^ 1]) + whole[41:]):
        file.write_bytes(damaged)
        assert compiled_again(values)
        assert file.read_bytes() == whole
    told(values)
    with mock.patch.object(ray_code, "_processor", return_value="another"):
        assert compiled_again(values)
    with mock.patch.object(ray_code.llvmlite, "__version__", "0"):
        assert compiled_again(values)
    assert len(list(stored.iterdir())) == 3


def test_code_runs_where_nothing_can_be_kept(stored: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stored.parent.mkdir(exist_ok=True)
    stored.write_text("a file where the folder would be")
    assert compiled_again(np.arange(1.0, 9.0))
    monkeypatch.setenv("TVIMDESIGN_CACHE", "")
    assert compiled_again(np.arange(1.0, 9.0))


def test_of_much_code_what_was_not_used_for_longest_goes(stored: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tvimdesign.base.user_cache._MOST", 3)
    for number in range(6):
        keep_code(b"code", f"text {number}")
        latest = max(stored.iterdir(), key=lambda path: path.stat().st_mtime)
        os.utime(latest, (number, number))
    assert [find_code(f"text {number}") for number in range(6)] == [None, None, None, b"code", b"code", b"code"]
