"""The FMU as a file: sources, description, and the binary where this machine has a C compiler."""

import hashlib
import os
import platform
import shlex
import shutil
import sys
import zipfile
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory

from tvimdesign.base.atomic_files import whole_file
from tvimdesign.base.errors import InputError
from tvimdesign.base.processes import CommandGroup, ProcessorTimeError
from tvimdesign.robot.joint_equations import (
    IDENTIFIER,
    JointEquations,
    Variable,
    fmu_variables,
    joint_equations,
    listed,
    model_description,
    sizes,
)
from tvimdesign.simulation.control.controller import Controller
from tvimdesign.simulation.control.sizing import controller_of
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule

COMPILERS = ("cc", "gcc", "clang")
FLAGS = ("-std=c99", "-O1", "-fPIC", "-shared", "-fvisibility=hidden", "-w")
PROCESSOR_LIMIT = 600.0  # Processor time [s] for compiling; it takes some seconds
SETTINGS = {"FIRST_STEP": 1e-3, "LONGEST_STEP": 1.0, "TOLERANCE": 1e-5}
"""Of the heat's integration: steps [s], error of a step in a state, which is of the order of one."""
_BESIDE = ".fmu-"  # Start of the name of the folder that it is built in
_MOMENT = (1980, 1, 1, 0, 0, 0)
_PLATFORMS = {"Linux": ("linux", ".so"), "Darwin": ("darwin", ".dylib"), "Windows": ("win", ".dll")}


@dataclass(frozen=True)
class WrittenFmu:
    """Outcome of writing the FMU."""

    path: Path
    platform: str  # Of its binary, as FMI names it; empty where it has none
    variables: tuple[Variable, ...]

    @property
    def summary(self) -> str:
        """A sentence for people."""
        if self.platform:
            return f"{self.path.name} holds heat and torque for co-simulation, built for {self.platform}."
        return (
            f"{self.path.name} holds heat and torque for co-simulation, as source code alone: no C compiler was found "
            f"({', '.join(COMPILERS)}, or the one that CC names). Install one and run this again."
        )


def write_fmu(resolved: ResolvedModule, path: Path, controller: Controller | None = None) -> WrittenFmu:
    """Write the FMU of a module, with its own controller or that of another. Raises InputError, OutputError."""
    controller = controller or controller_of(resolved)
    equations = joint_equations(resolved)
    variables = fmu_variables(equations, resolved)
    with TemporaryDirectory(dir=path.parent, prefix=_BESIDE) as folder:
        beside = Path(folder)
        sources = source_files(equations, variables, beside)
        sources["controller_constants.h"] = controller_constants(controller)
        sources["sizes.h"] = sources["sizes.h"].replace("@DRIVER@", repr(resolved.study.control.driver_lag))
        guid = hashlib.sha256("".join(sources.values()).encode()).hexdigest()[:32]
        sources["sizes.h"] = sources["sizes.h"].replace("@GUID@", guid)
        description = model_description(
            resolved.study.name, guid, _ABOUT, variables, [name for name in sources if name.endswith(".c")],
            stop=float(resolved.values["horizon"]),
        )  # fmt: skip
        place, suffix = binary_place()
        binary = compiled(sources, suffix, beside)
        with whole_file(path) as half, zipfile.ZipFile(half, "w", zipfile.ZIP_DEFLATED) as archive:
            _put(archive, "modelDescription.xml", description.encode())
            for name, text in sources.items():
                _put(archive, f"sources/{name}", text.encode())
            if binary:
                _put(archive, f"binaries/{place}/{IDENTIFIER}{suffix}", binary)
    return WrittenFmu(path, place if binary else "", variables)


_ABOUT = "Heat and torque of a thermo-active variable impedance joint. Written by tvimdesign robot."


def source_files(equations: JointEquations, variables: tuple[Variable, ...], beside: Path) -> dict[str, str]:
    """Return the C code by name; `sizes.h` has a place for the GUID."""
    own = files("tvimdesign.robot") / "fmu_source"
    written = {
        file.name: file.read_text(encoding="utf-8") for file in own.iterdir() if file.name.endswith((".c", ".h"))
    }
    inputs = [variable.start for variable in variables if variable.causality == "input"]
    lag = next(variable.start for variable in variables if variable.name == "thermistor_lag")
    constants = [variable.start for variable in variables if variable.constant]
    defined = {
        **SETTINGS,
        "CONSTANTS": len(constants),
        "FREQUENCY_START": repr(equations.start[2]),
        "GUID": '"@GUID@"',
        "DRIVER_LAG": "@DRIVER@",
        "THERMISTOR_LAG_START": lag,
    }
    lines = [f"#define {name} {value}" for name, value in defined.items()]
    lines += [listed("input_start", inputs), listed("constants", constants), sizes(equations)]
    head = "/* What tvimdesign knows of the module when the code is built. */\n#ifndef SIZES_H\n#define SIZES_H\n"
    return {
        **dict(sorted(written.items())),
        **equations.code(beside),
        "sizes.h": head + "\n".join(lines) + "\n#endif\n",
    }


def controller_constants(controller: Controller | None) -> str:
    """Return the header with a controller's constants, without any where there is none."""
    lines = ["#define CONTROLLED 0", "#define LAYER_CELLS 1"]
    if controller is not None:
        plain = asdict(controller)
        tables = {name: value for name, value in plain.items() if isinstance(value, tuple)}
        rows = {name: len(tables[f"{name}_{first}"]) for name, first in (("layer", "enthalpy"), ("profile", "time"))}
        lines = ["#define CONTROLLED 1"]
        lines += [f"#define {name.upper()} {value!r}" for name, value in plain.items() if name not in tables]
        lines += [f"#define {name.upper()}_ROWS {count}" for name, count in rows.items()]
        lines += [listed(name, value) for name, value in tables.items()]
    head = "/* Constants of the module's controller; SI units. */\n#ifndef CONTROLLER_CONSTANTS_H\n"
    return head + "#define CONTROLLER_CONSTANTS_H\n" + "\n".join(lines) + "\n#endif\n"


def controller_files(controller: Controller | None) -> dict[str, str]:
    """Return the controller's C code for a microcontroller by file; nothing where the module never gets soft."""
    if controller is None:
        return {}
    own = files("tvimdesign.robot") / "fmu_source"
    texts = {name: (own / name).read_text(encoding="utf-8") for name in ("controller.c", "controller.h")}
    return {**texts, "controller_constants.h": controller_constants(controller)}


def binary_place() -> tuple[str, str]:
    """Return FMI's name of this platform, and the ending of its binaries."""
    name, suffix = _PLATFORMS.get(platform.system(), ("linux", ".so"))
    return f"{name}{64 if sys.maxsize > 2**32 else 32}", suffix


def compiler() -> list[str]:
    """Return the command of the C compiler: what CC says, or the first that is there; nothing where none is."""
    named = os.environ.get("CC", "")
    if named:
        return shlex.split(named) if shutil.which(shlex.split(named)[0]) else []
    return next(([name] for name in COMPILERS if shutil.which(name)), [])


def compiled(sources: Mapping[str, str], suffix: str, folder: Path) -> bytes:
    """Build the binary in a folder; return nothing without a compiler. Raises InputError with a compiler's message."""
    command = compiler()
    if not command:
        return b""
    for file, text in sources.items():
        (folder / file).write_text(text, encoding="utf-8")
    built = folder / f"{IDENTIFIER}{suffix}"
    code = [file for file in sources if file.endswith(".c")]
    own = {name: str(folder.absolute()) for name in ("TMPDIR", "TMP", "TEMP")}  # its files stay in the folder
    choose = "choose another by CC, or none by CC=none for an FMU of sources alone"
    try:
        with CommandGroup() as commands:  # where this process ends, all that it started ends
            line = [*command, *FLAGS, "-o", built.name, *code, "-lm"]
            done = commands.run(line, PROCESSOR_LIMIT, cwd=folder, env={**os.environ, **own})
    except ProcessorTimeError as error:
        raise InputError(f"the C compiler {command[0]!r} did not build the FMU: {error}; {choose}") from error
    if done.returncode:
        raise InputError(f"the C compiler {command[0]!r} cannot build the FMU; {choose}:\n{done.stderr[-1000:]}")
    return built.read_bytes()


def _put(archive: zipfile.ZipFile, name: str, data: bytes) -> None:
    """Add a file to the archive, the same bytes whenever it is written."""
    entry = zipfile.ZipInfo(name, _MOMENT)
    entry.compress_type = zipfile.ZIP_DEFLATED
    archive.writestr(entry, data)
