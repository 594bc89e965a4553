"""The paper's claims, its module reconstructed, and a pair calibrated to its 70 s in shear and 140 s in compression.

The reconstruction has this package's layout where the paper gives no dimension. The pair is in `paper_case.yaml`; its
times are simulated when they are asked for.
"""

from __future__ import annotations

from functools import cache, partial
from typing import TYPE_CHECKING, Any

from tvimdesign.base.record import Entry, own_data
from tvimdesign.base.units import to_si
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.study import read_study_text

if TYPE_CHECKING:
    from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule

Values = dict[str, Any]  # Numbers of a row, by their names in its sentence
PLACES = {"mean_time": "mean", "near_face_time": "near face", "far_face_time": "far face"}
"""Places of a thermometer in the PCL, by the time that it tells."""


case = partial(own_data, __file__, "paper_case.yaml")
claims = partial(own_data, __file__, "paper_claims.yaml")  # Statements of the paper: values with units, places


@cache
def pair_times(**choices: str) -> tuple[dict[str, float], dict[str, float]]:
    """Return the times [s] of the shear and the compression module by place; `choices` changes words of both."""
    from tvimdesign.simulation.working_cycle.cycle import Simulator
    from tvimdesign.simulation.working_cycle.device_functions import resolve_study

    times = []
    for mode, text in case()["studies"].items():
        study = read_study_text(text, f"the calibrated {mode} module")
        model = resolve_study(study.model_copy(update={"module": {**study.module, **choices}})).functions
        times.append(Simulator(model).run(model.start, phases=["softening"], wanted=tuple(PLACES)).values)
    return times[0], times[1]


def _case() -> Values:
    """Return the numbers of the paper check's row: what the pair takes, and what else it could be read as."""
    calibrated, metal = pair_times(), pair_times(structure_material=case()["material"])
    shear, compression = (times["mean_time"] for times in calibrated)
    others = [f"with a thermometer at the {PLACES[name]}: {_both(name, calibrated)}" for name in list(PLACES)[1:]]
    return {
        "shear": shear, "compression": compression, "ratio": compression / shear, "others": "; ".join(others),
        "stated": from_paper("response_time_compression") / from_paper("response_time"),
        "metal": _both("mean_time", metal),
    }  # fmt: skip


def _both(name: str, times: tuple[dict[str, float], dict[str, float]]) -> str:
    shear, compression = (each[name] for each in times)
    return f"{shear:.0f} and {compression:.0f} s ({compression / shear:.2f})"


def from_paper(name: str) -> float:
    """Return the SI value of a number the paper states."""
    entry = claims()["numbers"][name]
    return to_si(float(entry["value"]), entry["unit"])


def instrument(name: str) -> Entry:
    """Return a limit of the paper's rheometer, assumed with a range [SI]."""
    entry = claims()["instrument"][name]
    value, low, high = (to_si(float(entry[key]), entry["unit"]) for key in ("value", "low", "high"))
    return Entry(value, entry["unit"], entry["source"], entry["status"], low, high)


def ends(entry: Entry) -> tuple[float, float, float]:
    """Return a value, its least and its largest value [SI]."""
    return entry.value, entry.low or entry.value, entry.high or entry.value


@cache
def published_module() -> ResolvedModule:
    """Return the module with a value for every input, and the records it chose."""
    from tvimdesign.simulation.working_cycle.device_functions import resolve_study

    return resolve_study(read_study_text(claims()["study"], "the paper's module"))


@cache
def published_values() -> dict[str, float]:
    """Return the values of the module [SI], one working cycle simulated."""
    return cycle_values(published_module().functions)


def cycle_values(model: DeviceFunctions) -> dict[str, float]:
    """Return inputs and values of a module [SI], one working cycle simulated."""
    from tvimdesign.simulation.working_cycle.cycle import Simulator

    numbers = dict(zip(model.names, model.start.tolist(), strict=True))
    return {**numbers, **model.values(model.start, Simulator(model).run(model.start).values)}


def spring_rate(wire_diameter: float, youngs_modulus: float | None = None) -> float:
    """Rate of the paper's spring by the paper's formula [N*m/rad], with another wire [m] or modulus [Pa]."""
    from tvimdesign.physics import spring

    modulus = from_paper("youngs_modulus") if youngs_modulus is None else youngs_modulus
    return float(spring.rate(modulus, wire_diameter, from_paper("coil_diameter"), from_paper("coil_count")))


def published_rate() -> float:
    """Rate of the paper's spring by the paper's formula and table [N*m/rad]."""
    return spring_rate(from_paper("wire_diameter"))
