"""Machine code from LLVM's language, compiled for the processor that it runs on.

Run as `python -m tvimdesign.base.machine_code EFFORT` it compiles what it reads: a process that can be ended in time.
"""

from __future__ import annotations

import ctypes
import struct
import subprocess
import sys
from collections.abc import Callable, Sequence
from typing import Any

import llvmlite
import llvmlite.binding as llvm

from tvimdesign.base.child_process import start_child
from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.errors import TimeOverError
from tvimdesign.base.kept_code import find_code, keep_code

_AT_WORST = 2e-5
"""Seconds that a byte of text takes to compile on a busy machine; 2e-6 to 4e-6 on one that is not."""
_MOST = 1
"""How hard the compiler tries at most: with more nothing runs faster."""


class _Effort:
    """How hard the compiler tries in this process, but for what runs often."""

    level = _MOST


def compile_quickly() -> None:
    """From now on this process compiles in half the time what runs half as fast: for code that is run a few times.

    Results are the same bit for bit.
    """
    _Effort.level = 0


def hexadecimal(value: float) -> str:
    """A number to its last bit."""
    return f"0x{struct.unpack('<Q', struct.pack('<d', value))[0]:016X}"


class Lines:
    """The body of a function while it is written: every line defines one new name."""

    def __init__(self, kind: str = "double", suffix: str = "f64") -> None:
        """Nothing is written yet; numbers are of a `kind`, which LLVM's own functions have as a suffix."""
        self.text: list[str] = []
        self._kind, self._suffix = kind, suffix

    def new(self, expression: str) -> str:
        """Write a line, return the name it defines."""
        name = f"%v{len(self.text)}"
        self.text.append(f"  {name} = {expression}")
        return name

    def two(self, operation: str, a: str, b: str) -> str:
        """An operation on two numbers."""
        return self.new(f"{operation} {self._kind} {a}, {b}")

    def intrinsic(self, name: str, *arguments: str) -> str:
        """An operation that LLVM knows."""
        given = ", ".join(f"{self._kind} {one}" for one in arguments)
        return self.new(f"call {self._kind} @llvm.{name}.{self._suffix}({given})")


class MachineCode:
    """A compiled module; its machine code lives as long as this object."""

    def __init__(self, text: str, often: bool = False, deadline: Deadline = NEVER) -> None:
        """Compile the text of a module, or take what an earlier run has kept of it. Raises TimeOverError.

        What runs `often` is compiled as well as can be, also in a process that compiles quickly.
        """
        effort = _MOST if often else _Effort.level
        machine = _machine(effort)
        compiler = (f"llvmlite {llvmlite.__version__}", _processor(), f"effort {effort}")
        code = find_code(text, *compiler)
        if code is None:
            deadline.check(_STEP)
            hurried = len(text) * _AT_WORST > deadline.remaining
            code = _compiled_in_child(text, effort, deadline) if hurried else _compiled(text, machine)
            keep_code(code, text, *compiler)
        self._engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), machine)
        self._engine.add_object_file(llvm.ObjectFileRef.from_data(code))
        self._engine.finalize_object()

    def function(self, name: str, arguments: Sequence[type]) -> Callable[..., None]:
        """One of its functions that return nothing, as ctypes calls it."""
        signature = ctypes.CFUNCTYPE(None, *arguments)
        return signature(self._engine.get_function_address(name))


def _compiled(text: str, machine: Any) -> bytes:
    module = llvm.parse_assembly(text)
    module.verify()
    passes = llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options(speed_level=1))
    passes.getModulePassManager().run(module, passes)
    return bytes(machine.emit_object(module))


def _compiled_in_child(text: str, effort: int, deadline: Deadline) -> bytes:
    """Compile in a process of its own, as nothing ends the compiler in this one. Raises TimeOverError."""
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
    with start_child("tvimdesign.base.machine_code", [str(effort)], **pipes) as child:
        try:
            code, _ = child.communicate(text.encode(), timeout=deadline.remaining)
        except BaseException as error:  # an interrupt as well
            child.kill()
            if isinstance(error, subprocess.TimeoutExpired):
                raise TimeOverError(_STEP, deadline.seconds) from None
            raise
    return code if child.returncode == 0 else _compiled(text, _machine(effort))


_STEP = "the design's equations were compiled"


def _machine(effort: int) -> Any:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    target = llvm.Target.from_default_triple()
    return target.create_target_machine(
        cpu=llvm.get_host_cpu_name(), features=llvm.get_host_cpu_features().flatten(), opt=effort, jit=True
    )


def _processor() -> str:
    """What the code runs on."""
    return " ".join((llvm.get_process_triple(), llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()))


def main() -> None:
    """Compile the text on standard input as hard as asked, and write the code to standard output."""
    sys.stdout.buffer.write(_compiled(sys.stdin.buffer.read().decode(), _machine(int(sys.argv[1]))))


if __name__ == "__main__":
    main()
