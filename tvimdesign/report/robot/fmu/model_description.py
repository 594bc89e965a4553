"""modelDescription.xml of the FMU: FMI 2.0 for co-simulation.

Source: Functional Mock-up Interface for Model Exchange and Co-Simulation 2.0.4, sec. 2.2 and 4.3.
"""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree as Xml

from tvimdesign.report.robot.fmu.fmu_variables import UNITS, Variable
from tvimdesign.report.robot.xml_text import document, numbers

IDENTIFIER = "joint"
"""Of the model: the binary's name."""
CELSIUS = {"name": "degC", "offset": "-273.15"}


def model_description(
    name: str, guid: str, description: str, variables: Sequence[Variable], sources: Sequence[str], stop: float
) -> str:
    """The file; `stop` [s] is the end of the experiment that a client proposes."""
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
