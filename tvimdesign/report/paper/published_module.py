"""The paper's claims, and its module reconstructed with this package's layout where the paper gives no dimension."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, Any

from tvimdesign.base.units import to_si
from tvimdesign.base.yaml_data import plain_data

if TYPE_CHECKING:
    from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
    from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule
    from tvimdesign.study import Study


@cache
def claims() -> dict[str, Any]:
    """Return what the paper states: values with units, and the places."""
    text = resources.files("tvimdesign.report.paper").joinpath("paper_claims.yaml").read_text(encoding="utf-8")
    loaded: dict[str, Any] = plain_data(text)
    return loaded


def from_paper(name: str) -> float:
    """Return the SI value of a number the paper states."""
    entry = claims()["numbers"][name]
    return to_si(float(entry["value"]), entry["unit"])


@dataclass(frozen=True)
class Instrument:
    """Measuring instrument: its abilities with their range [SI], and where they come from."""

    value: float
    low: float
    high: float
    status: str
    source: str


def instrument(name: str) -> Instrument:
    """Return a limit of the paper's rheometer [SI]."""
    entry = claims()["instrument"][name]
    value, low, high = (to_si(float(entry[key]), entry["unit"]) for key in ("value", "low", "high"))
    return Instrument(value, low, high, entry["status"], entry["source"])


def _study() -> Study:
    from tvimdesign.study import read_study_text

    return read_study_text(claims()["study"], "the paper's module")


@cache
def published_model() -> DeviceFunctions:
    """Return the module's table and working cycle as functions."""
    return published_module().functions


@cache
def published_module() -> ResolvedModule:
    """Return the module with a value for every input, and the records it chose."""
    from tvimdesign.simulation.working_cycle.resolved_module import resolve_study

    return resolve_study(_study())


@cache
def published_values() -> dict[str, float]:
    """Return the values of the module [SI], one working cycle simulated."""
    from tvimdesign.simulation.working_cycle.cycle import Simulator

    model = published_model()
    numbers = dict(zip(model.names, model.start.tolist(), strict=True))
    return {**numbers, **model.values(model.start, Simulator(model).run(model.start).values)}


def spring_rate(wire_diameter: float, youngs_modulus: float | None = None) -> float:
    """Rate of the paper's spring by the paper's formula [N*m/rad], with another wire [m] or modulus [Pa]."""
    from tvimdesign.physics.springs import spring

    modulus = from_paper("youngs_modulus") if youngs_modulus is None else youngs_modulus
    return float(spring.rate(modulus, wire_diameter, from_paper("coil_diameter"), from_paper("coil_count")))


def published_rate() -> float:
    """Rate of the paper's spring by the paper's formula and table [N*m/rad]."""
    return spring_rate(from_paper("wire_diameter"))
