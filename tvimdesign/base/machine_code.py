"""Machine code from LLVM's language, compiled for the processor that it runs on."""

from __future__ import annotations

import ctypes
import struct
from collections.abc import Callable, Sequence
from typing import Any

import llvmlite
import llvmlite.binding as llvm

from tvimdesign.base.compile_cache import find_code, keep_code


def hexadecimal(value: float) -> str:
    """Write a number to its last bit."""
    return f"0x{struct.unpack('<Q', struct.pack('<d', value))[0]:016X}"


class Lines:
    """The body of a function while it is written: every line defines one new name."""

    def __init__(self, kind: str = "double", suffix: str = "f64") -> None:
        """Start an empty body for numbers of a `kind`, which LLVM's own functions have as a suffix."""
        self.text: list[str] = []
        self._kind, self._suffix = kind, suffix

    def new(self, expression: str) -> str:
        """Write a line, return the name it defines."""
        name = f"%v{len(self.text)}"
        self.text.append(f"  {name} = {expression}")
        return name

    def two(self, operation: str, a: str, b: str) -> str:
        """Write an operation on two numbers."""
        return self.new(f"{operation} {self._kind} {a}, {b}")

    def intrinsic(self, name: str, *arguments: str) -> str:
        """Write a call of one of LLVM's functions."""
        given = ", ".join(f"{self._kind} {argument}" for argument in arguments)
        return self.new(f"call {self._kind} @llvm.{name}.{self._suffix}({given})")


class MachineCode:
    """A compiled module; its machine code lives as long as this object."""

    def __init__(self, text: str) -> None:
        """Compile the text of a module, or take what an earlier run has kept of it."""
        machine = _machine()
        compiler = (f"llvmlite {llvmlite.__version__}", _processor())
        code = find_code(text, *compiler)
        if code is None:
            code = _compiled(text, machine)
            keep_code(code, text, *compiler)
        self._engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), machine)
        self._engine.add_object_file(llvm.ObjectFileRef.from_data(code))
        self._engine.finalize_object()

    def function(self, name: str, arguments: Sequence[type]) -> Callable[..., None]:
        """Return one of its functions without a result, for ctypes to call."""
        signature = ctypes.CFUNCTYPE(None, *arguments)
        return signature(self._engine.get_function_address(name))


def _compiled(text: str, machine: Any) -> bytes:
    module = llvm.parse_assembly(text)
    module.verify()
    passes = llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options(speed_level=1))
    passes.getModulePassManager().run(module, passes)
    return bytes(machine.emit_object(module))


def _machine() -> Any:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    target = llvm.Target.from_default_triple()
    return target.create_target_machine(
        cpu=llvm.get_host_cpu_name(), features=llvm.get_host_cpu_features().flatten(), opt=1, jit=True
    )


def _processor() -> str:
    """Return the triple, the processor and its features."""
    return " ".join((llvm.get_process_triple(), llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()))
