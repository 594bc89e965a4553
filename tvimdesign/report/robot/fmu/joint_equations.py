"""The joint's equations as C: CasADi's code of heat, torque and what is observed, and the sizes the code is built with.

Everything is a function of the thermal state and three numbers: current [A], ambient temperature [K], frequency [Hz].
All other inputs are constants of the design.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tvimdesign.physics.heat_flow import heat
from tvimdesign.physics.motions import motion
from tvimdesign.physics.polymers import polymer
from tvimdesign.simulation.joint_tests.case import one_sided
from tvimdesign.simulation.link_motion.sampled_motion import PER_DECADE
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.curves import temperature_names
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule

MOVING = ("ambient_temperature", "frequency@hot")
"""Inputs of the table that may change in an FMU."""
INSTANT = {
    "joint_impedance": "impedance_now", "joint_stiffness": "stiffness_now", "joint_damping": "damping_now",
    "electrical_power": "electrical_power", "terminal_power": "terminal_power", "supply_voltage": "supply_voltage",
}  # fmt: skip
"""Quantities of an instant that are observed, by the name of their variable."""
FROZEN = "frozen"
DECADES = 5.0
"""To either side of the frequency, over which the structure's elements reach."""
GENERATED = ("equations.c", "equations.h")


@dataclass(frozen=True)
class JointEquations:
    """The equations of one module. All functions take (state, given), given = current, ambient, frequency."""

    functions: Sequence[Any]
    observed: tuple[str, ...]
    """What the function `observed` gives, in its order."""
    cells: int
    modes: int
    """Maxwell elements of a slice of the layer."""
    sides: int
    """2 where the PCL only pushes."""
    elements: tuple[float, ...]
    """Relaxation times of the structure's Maxwell elements [s]."""
    start: tuple[float, ...]
    """Current, ambient temperature, frequency as the design has them."""

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
    """Return the equations of a module; the layer freezes with its history and melts, whatever the current."""
    model = resolved.functions
    phase = model.either_way
    state, given = ca.SX.sym("state", phase.state_size), ca.SX.sym("given", 1 + len(MOVING))
    inputs = ca.SX(ca.DM(model.start))
    for place, name in enumerate(MOVING):
        inputs[model.index[name]] = given[1 + place]
    at = (state, given[0], inputs)
    names = temperature_names(model, model.start, phase)
    seen = phase.evaluated(tuple(INSTANT.values()), lambda *values: values)(*at)
    slices = phase.evaluated(_OF_SLICES, _slices)(*at)
    rates = phase.rates(*at)
    written = {
        "initial": [phase.initial(inputs)],
        "rates": [rates],
        "rates_and_jacobian": [rates, ca.jacobian(rates, state)],
        "observed": [ca.vertcat(phase.temperatures(*at), ca.sum1(phase.fractions(*at)) / model.cells, seen)],
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


_OF_SLICES = ("stack_profile", "pcl_rheology", "moment_now", "pcl_depth", "support_now", "spring_stiffness")
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
        "JACOBIAN_ENTRIES": jacobian.nnz(),
        **{f"WORK_{name}": int(size) + 1 for name, size in zip(_WORK, work, strict=True)},
    }  # fmt: skip
    lines = [*(f"#define {name} {count}" for name, count in counts.items())]
    lines += [listed("jacobian_columns", columns, "int"), listed("jacobian_rows", rows, "int")]
    lines += [listed("support_time", [*equations.elements, LASTS])]
    return "\n".join(lines)


_WORK = ("ARGUMENTS", "RESULTS", "INTEGERS", "NUMBERS")
LASTS = 1e12
"""Relaxation time [s] of a spring."""
