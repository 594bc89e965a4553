"""The description of an FMU, modelDescription.xml, and the variables that it lists."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal
from xml.etree import ElementTree as Xml

from tvimdesign.report.robot.fmu.joint_equations import FROZEN, INSTANT, JointEquations
from tvimdesign.report.robot.model_files import document, numbers
from tvimdesign.simulation.working_cycle.curves import PHASE_UNITS
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule

UNITS = {
    "A": {"A": 1}, "rad": {"rad": 1}, "K": {"K": 1}, "Hz": {"s": -1}, "1": {}, "W": {"kg": 1, "m": 2, "s": -3},
    "V": {"kg": 1, "m": 2, "s": -3, "A": -1}, "N*m": {"kg": 1, "m": 2, "s": -2},
    "N*m/rad": {"kg": 1, "m": 2, "s": -2, "rad": -1}, "N*m*s/rad": {"kg": 1, "m": 2, "s": -1, "rad": -1},
}  # fmt: skip
"""Exponents of SI's base units of every unit that a variable has."""
OBSERVED_UNITS = {**PHASE_UNITS, "terminal_power": "W", "supply_voltage": "V"}
CONSTANTS = {
    "heating_current": "current", "cooling_current": "cooling_current", "stroke": "stroke",
    "holding_torque": "holding_torque", "pin_friction_torque": "pin_friction_torque",
}  # fmt: skip
"""Numbers of the design that a client may want, by the quantity they are."""
CONSTANT_UNITS = {"heating_current": "A", "cooling_current": "A", "stroke": "rad"}

Causality = Literal["input", "parameter", "output", "local"]


@dataclass(frozen=True)
class Variable:
    """A real number of the FMU; its place in the list is its value reference."""

    name: str
    causality: Causality
    unit: str
    meaning: str
    start: float | None = None
    """Of inputs, parameters and constants."""
    constant: bool = False


def fmu_variables(equations: JointEquations, resolved: ResolvedModule) -> tuple[Variable, ...]:
    """Return all variables, in the order of the value references that the C code has."""
    _, ambient, frequency = equations.start
    return (
        Variable("current", "input", "A", "Current through the pads; above zero heats the PCL, below cools it.", 0.0),
        Variable("angle", "input", "rad", "Angle of the joint at the end of the step; 0 where it was made.", 0.0),
        Variable(
            "ambient_temperature", "input", "K", "Temperature of the air, and of all parts at the start.", ambient
        ),
        Variable("frequency", "parameter", "Hz", "Frequency of joint_stiffness and joint_damping.", frequency),
        Variable("torque", "output", "N*m", "Torque of the joint on what moves; springs, PCL and structure."),
        *_observed(equations.observed),
        *(_constant(name, float(resolved.quantity(quantity))) for name, quantity in CONSTANTS.items()),
    )


def _observed(names: Sequence[str]) -> list[Variable]:
    variables = []
    for name in names:
        meaning = _MEANINGS.get(name) or f"Temperature: {name.removeprefix('temperature_').replace('_', ' ')}."
        variables.append(Variable(name, "output", OBSERVED_UNITS.get(name, "K"), meaning))
    return variables


_MEANINGS = {
    FROZEN: "Share of the PCL that is frozen.",
    **dict.fromkeys(INSTANT, ""),
    "joint_impedance": "Magnitude of the joint's dynamic stiffness at the frequency.",
    "joint_stiffness": "Stiffness of the joint at the frequency.",
    "joint_damping": "Damping of the joint at the frequency.",
    "electrical_power": "Power the supply gives; what the pads generate is not recovered.",
    "terminal_power": "Electrical power at the pads' terminals, negative where they generate.",
    "supply_voltage": "Voltage over all pads as they are wired, in size.",
}


def _constant(name: str, value: float) -> Variable:
    meaning = f"The design's {CONSTANTS[name].replace('_', ' ')}."
    return Variable(name, "local", CONSTANT_UNITS.get(name, "N*m"), meaning, value, constant=True)


IDENTIFIER = "joint"
"""Of the model: the binary's name."""
CELSIUS = {"name": "degC", "offset": "-273.15"}


def model_description(
    name: str, guid: str, description: str, variables: Sequence[Variable], sources: Sequence[str], stop: float
) -> str:
    """Return the file; `stop` [s] is the end of the experiment that a client proposes."""
    root = Xml.Element(
        "fmiModelDescription", fmiVersion="2.0", modelName=name, guid=guid, description=description,
        generationTool="tvimdesign", variableNamingConvention="flat",
    )  # fmt: skip
    simulation = Xml.SubElement(
        root, "CoSimulation", modelIdentifier=IDENTIFIER, canHandleVariableCommunicationStepSize="true",
        canInterpolateInputs="true", canGetAndSetFMUstate="true", canSerializeFMUstate="true",
    )  # fmt: skip
    files = Xml.SubElement(simulation, "SourceFiles")
    for source in sources:
        Xml.SubElement(files, "File", name=source)
    _units(root, {variable.unit for variable in variables})
    Xml.SubElement(root, "DefaultExperiment", startTime="0", stopTime=numbers(stop), stepSize=numbers(STEP))
    listed = Xml.SubElement(root, "ModelVariables")
    for reference, variable in enumerate(variables):
        _variable(listed, reference, variable)
    _structure(root, variables)
    return document(root)


STEP = 0.1
"""Communication step that a client proposes [s]: for heat; a moving joint wants steps that resolve its motion."""


def _units(root: Xml.Element, used: set[str]) -> None:
    defined = Xml.SubElement(root, "UnitDefinitions")
    for name in sorted(used):
        unit = Xml.SubElement(defined, "Unit", name=name)
        Xml.SubElement(unit, "BaseUnit", {base: str(power) for base, power in UNITS[name].items()})
        if name == "K":
            Xml.SubElement(unit, "DisplayUnit", CELSIUS)


def _variable(listed: Xml.Element, reference: int, variable: Variable) -> None:
    variability = "constant" if variable.constant else "tunable" if variable.causality == "parameter" else "continuous"
    kind = {"name": variable.name, "valueReference": str(reference), "description": variable.meaning,
            "causality": variable.causality, "variability": variability}  # fmt: skip
    if variable.causality in ("parameter", "local"):
        kind["initial"] = "exact"
    if variable.causality == "output":
        kind["initial"] = "calculated"
    real = {"unit": variable.unit}
    if variable.unit == "K":
        real["displayUnit"] = CELSIUS["name"]
    if variable.start is not None:
        real["start"] = numbers(variable.start)
    Xml.SubElement(Xml.SubElement(listed, "ScalarVariable", kind), "Real", real)


def _structure(root: Xml.Element, variables: Sequence[Variable]) -> None:
    structure = Xml.SubElement(root, "ModelStructure")
    for group in ("Outputs", "InitialUnknowns"):
        unknowns = Xml.SubElement(structure, group)
        for place, variable in enumerate(variables, start=1):
            if variable.causality == "output":
                Xml.SubElement(unknowns, "Unknown", index=str(place))
