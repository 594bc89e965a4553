"""Machine code: compiled with more or less effort, it gives the same numbers."""

from __future__ import annotations

import ctypes
import subprocess
import sys

import numpy as np

from tvimdesign.base.machine_code import MachineCode

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
    found = np.empty(1)
    call(values.ctypes.data, found.ctypes.data, len(values))
    return float(found[0])


def test_code_that_is_compiled_quickly_gives_the_same_numbers() -> None:
    values = np.random.default_rng(3).normal(size=1000)
    expected = 0.0
    for value in values:
        expected += 3.0 * float(value)
    assert told(values) == expected
    quickly = (
        "import sys\nimport numpy as np\nfrom tvimdesign.base import machine_code\n"
        "from test_machine_code import told\nmachine_code.compile_quickly()\n"
        "print(repr(told(np.random.default_rng(3).normal(size=1000))))"
    )
    said = subprocess.run(
        [sys.executable, "-c", f"import sys; sys.path.insert(0, {str(__file__).rsplit('/', 1)[0]!r})\n{quickly}"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert float(said.stdout) == expected
