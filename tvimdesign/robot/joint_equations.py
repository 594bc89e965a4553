"""The joint's equations as C, and the description of its FMU.

Everything is a function of the thermal state and three numbers: current [A], ambient temperature [K], frequency [Hz].
All other inputs are constants of the design.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from tvimdesign.base.record import own_data
from tvimdesign.physics.heat_flow import heat
from tvimdesign.physics.motions import motion
from tvimdesign.physics.polymers import polymer
from tvimdesign.robot.model_files import document
from tvimdesign.simulation.joint_tests.case import one_sided
from tvimdesign.simulation.link_motion.sampled_motion import PER_DECADE
from tvimdesign.simulation.working_cycle.curves import MEMORY, PHASE_UNITS, temperature_names
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule
from tvimdesign.simulation.working_cycle.phase_functions import FRACTIONS
from tvimdesign.simulation.working_cycle.symbols import ca

MOVING = ("ambient_temperature", "frequency@hot")  # Inputs of the table that may change in an FMU
INSTANT = {
    "joint_impedance": "impedance_now", "joint_stiffness": "stiffness_now", "joint_damping": "damping_now",
    "electrical_power": "electrical_power", "terminal_power": "terminal_power", "supply_voltage": "supply_voltage",
}  # fmt: skip
"""Quantities of an instant that are observed, by the name of their variable."""
FROZEN = "frozen"
DECADES = 5.0  # To either side of the frequency, over which the structure's elements reach
GENERATED = ("equations.c", "equations.h")


@dataclass(frozen=True)
class JointEquations:
    """The equations of one module. All functions take (state, given), given = current, ambient, frequency."""

    functions: Sequence[Any]
    observed: tuple[str, ...]  # Results of the function `observed`, in its order
    cells: int
    modes: int  # Maxwell elements of a slice of the layer
    sides: int  # 2 where the PCL only pushes
    elements: tuple[float, ...]  # Relaxation times of the structure's Maxwell elements [s]
    start: tuple[float, ...]  # Current, ambient temperature, frequency as the design has them

    def of(self, name: str) -> Any:
        """Return one function by name."""
        return next(function for function in self.functions if function.name() == name)

    def code(self, folder: Path) -> dict[str, str]:
        """Return the generated files by name; they are generated in a folder."""
        generator = ca.CodeGenerator("equations.c", {"with_header": True})
        for function in self.functions:
            generator.add(function)
        generator.generate(f"{folder}/")
        return {name: _HIDDEN + (folder / name).read_text(encoding="utf-8") for name in GENERATED}


def joint_equations(resolved: ResolvedModule) -> JointEquations:
    """Return the equations of a module; the layer freezes with its history and melts, whatever the current.

    Its melt has a memory of its crystals while the current heats, as in the run's softening, and none otherwise.
    """
    model = resolved.functions
    phase = model.either_way
    state, given = ca.SX.sym("state", phase.state_size), ca.SX.sym("given", 1 + len(MOVING))
    inputs = ca.SX(ca.DM(model.start))
    for place, name in enumerate(MOVING):
        inputs[model.index[name]] = given[1 + place]
    if MEMORY in model.index:
        inputs[model.index[MEMORY]] = ca.if_else(given[0] > 0.0, model.start[model.index[MEMORY]], 1.0)
    at = (state, given[0], inputs)
    names = temperature_names(model, model.start, "softening")
    seen = phase.evaluated(tuple(INSTANT.values()), lambda *values: values)(*at)
    slices = phase.evaluated(_OF_SLICES, _slices)(*at)
    rates = phase.rates(*at)
    written = {
        "initial": [phase.initial(inputs)],
        "rates": [rates],
        "rates_and_jacobian": [rates, ca.jacobian(rates, state)],
        "observed": [ca.vertcat(phase.temperatures(*at), ca.sum1(phase.watch([FRACTIONS])(*at)) / model.cells, seen)],
        "mechanics": [slices],
    }
    start: tuple[float, ...] = (0.0, *(float(model.start[model.index[name]]) for name in MOVING))
    return JointEquations(
        functions=[ca.Function(name, [state, given], outputs) for name, outputs in written.items()],
        observed=(*(f"temperature_{name}" for name in names), FROZEN, *INSTANT),
        cells=model.cells,
        modes=(slices.numel() - _BESIDE) // (2 * model.cells),
        sides=2 if one_sided(resolved) else 1,
        elements=_element_times(start[2]),
        start=start,
    )


def _element_times(frequency: float) -> tuple[float, ...]:
    """Return times of elements with a constant loss factor around a frequency [Hz], the quickest last."""
    count = round(2 * DECADES * PER_DECADE) + 1
    decades = np.linspace(DECADES, -DECADES, count)
    return tuple((10.0**decades / (2.0 * np.pi * frequency)).tolist())


_OF_SLICES = ("stack_profile", "rheology_now", "moment_now", "pcl_depth", "support_now", "spring_stiffness")
_BESIDE = 3  # numbers after those of the elements
_HIDDEN = "#define CASADI_SYMBOL_EXPORT  /* two joints may be loaded at once */\n"


def _slices(
    profile: heat.Profile,
    rheology: polymer.AnyRheology,
    moment: Any,
    depth: Any,
    support: tuple[Any, Any],
    springs: Any,
) -> list[Any]:
    """Return each slice's elements' stiffness [N*m/rad], slice after slice; their times [s]; structure; springs."""
    count = len(profile.cells)
    stiffnesses, times = [], []
    for cell in range(count):
        spectrum = polymer.spectrum(profile.cells[cell], profile.fractions[cell], rheology)
        modes = motion.layer_modes(spectrum, moment, depth)
        times += [time for time, _ in modes]
        stiffnesses += [count * stiffness for _, stiffness in modes]
    return [*stiffnesses, *times, *support, springs]


def listed(name: str, numbers: Sequence[float] | Any, kind: str = "double") -> str:
    """Return a C array of constants, to the last digit."""
    whole = kind == "int"
    texts = [str(int(number)) if whole else repr(float(number)) for number in np.asarray(numbers).ravel()]
    return f"static const {kind} {name}[] = {{{', '.join(texts) or '0'}}};"


def sizes(equations: JointEquations) -> str:
    """Return what the C code must know of the equations when it is built: counts, places of the Jacobian, elements."""
    jacobian = equations.of("rates_and_jacobian").sparsity_out(1)
    columns, rows = jacobian.get_ccs()
    work = np.max([[f.sz_arg(), f.sz_res(), f.sz_iw(), f.sz_w()] for f in equations.functions], axis=0)
    counts = {
        "STATES": jacobian.size1(), "OBSERVED": len(equations.observed), "CELLS": equations.cells,
        "MODES": equations.modes, "SIDES": equations.sides, "ELEMENTS": len(equations.elements),
        "JACOBIAN_ENTRIES": jacobian.nnz(), "NEAR_FACE": equations.observed.index("temperature_near_face"),
        **{f"WORK_{name}": int(size) + 1 for name, size in zip(_WORK, work, strict=True)},
    }  # fmt: skip
    lines = [*(f"#define {name} {count}" for name, count in counts.items())]
    lines += [listed("jacobian_columns", columns, "int"), listed("jacobian_rows", rows, "int")]
    lines += [listed("support_time", [*equations.elements, LASTS])]
    return "\n".join(lines)


_WORK = ("ARGUMENTS", "RESULTS", "INTEGERS", "NUMBERS")
LASTS = 1e12  # Relaxation time [s] of a spring


UNITS = {
    "s": {"s": 1}, "A": {"A": 1}, "rad": {"rad": 1}, "K": {"K": 1}, "Hz": {"s": -1}, "1": {},
    "W": {"kg": 1, "m": 2, "s": -3},
    "V": {"kg": 1, "m": 2, "s": -3, "A": -1}, "N*m": {"kg": 1, "m": 2, "s": -2},
    "N*m/rad": {"kg": 1, "m": 2, "s": -2, "rad": -1}, "N*m*s/rad": {"kg": 1, "m": 2, "s": -1, "rad": -1},
}  # fmt: skip
"""Exponents of SI's base units of every unit that a variable has."""
OBSERVED_UNITS = {**PHASE_UNITS, "terminal_power": "W", "supply_voltage": "V"}

Causality = Literal["input", "parameter", "output", "local"]


@dataclass(frozen=True)
class Variable:
    """A real number of the FMU; its place in the list is its value reference."""

    name: str
    causality: Causality
    unit: str
    meaning: str
    start: float | None = None  # Of inputs, parameters and constants
    constant: bool = False


def fmu_variables(equations: JointEquations, resolved: ResolvedModule) -> tuple[Variable, ...]:
    """Return all variables, in the order of the value references that the C code has."""
    _, ambient, frequency = equations.start
    starts = {"current": 0.0, "angle": 0.0, "ambient_temperature": ambient, "impedance_command": 0.0,
              "frequency": frequency, "thermistor_lag": resolved.study.control.thermistor_lag}  # fmt: skip
    listed = own_data(__file__, "fmu_variables.yaml")
    return (
        *(Variable(name, kind, unit, meaning, starts[name]) for name, (kind, unit, meaning) in listed["given"].items()),
        *(Variable(name, "output", unit, meaning) for name, (unit, meaning) in listed["torque"].items()),
        *(_observed(name, listed["observed"]) for name in equations.observed),
        *(Variable(name, "output", unit, meaning) for name, (unit, meaning) in listed["control"].items()),
        *(
            Variable(name, "local", unit, f"The design's {quantity.replace('_', ' ')}.",
                     float(resolved.quantity(quantity)), constant=True)
            for name, (quantity, unit) in listed["constants"].items()
        ),
    )  # fmt: skip


def _observed(name: str, meanings: Mapping[str, str]) -> Variable:
    meaning = meanings.get(name) or f"Temperature: {name.removeprefix('temperature_').replace('_', ' ')}."
    return Variable(name, "output", OBSERVED_UNITS.get(name, "K"), meaning)


IDENTIFIER = "joint"  # Of the model: the binary's name
STEP = 0.1
"""Communication step that a client proposes [s]: for heat; a moving joint wants steps that resolve its motion."""


def model_description(
    name: str, guid: str, description: str, variables: Sequence[Variable], sources: Sequence[str], stop: float
) -> str:
    """Return the file; `stop` [s] is the end of the experiment that a client proposes."""
    return document(
        "model_description", name=name, guid=guid, description=description, variables=variables, sources=sources,
        stop=stop, step=STEP, identifier=IDENTIFIER, units=UNITS,
    )  # fmt: skip
