"""The product's times against the two-dimensional strip, for the shear module of every shipped study as it starts.

`python validation/heat_sector/compare.py` writes `results.csv`; with names of studies it writes their rows. The numbers
of a strip are read off the device's table; its heat is `sector.py`'s alone. When the joint is soft is decided by the
polymer's own spectrum and the structure's moduli, from the strip's temperatures and solid fractions.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path
from typing import Any

import numpy as np
from sector import Case, Grid, Heating, Strip, heat

from tvimdesign.device import table_for
from tvimdesign.device.core.warm_structure import WAY_OUT, PartTemperatures, in_series
from tvimdesign.physics.polymers import polymer
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.study import given, read_study

HERE = Path(__file__).parent
RESULTS = HERE / "results.csv"
STUDIES = HERE.parents[1] / "studies"
TIMES = ("softening_time", "mean_time", "far_face_time")
LONGER = 1.3
GRID = Grid(layer=28, plate=8, across=12, beside=10)


def model_of(path: Path, **changes: float) -> DeviceFunctions:
    """The module a study starts from, with some inputs changed (SI)."""
    study = read_study(path)
    values = {**given(study), **changes}
    return DeviceFunctions(table_for(study.mode), values, tuple(study.operating_points), study.solver.cells)


def case_of(model: DeviceFunctions) -> Case:
    """The strip of a shear module: everything for a metre of its arcs' edges."""
    v = {name: float(model.start[index]) for name, index in model.index.items()}
    known = {**v, **model.words}
    wanted = ("pcl_area", "edge_length", "rotor_radius", "housing_mass", "pcl_melting", "cold_area",
              "core_and_link", "around_pads", "peltier_mass", "pcl_depth", "sink")  # fmt: skip
    found: dict[str, Any] = model.table.evaluate(known, wanted)
    area, edge, melting = found["pcl_area"], found["edge_length"], found["pcl_melting"]
    core, housing = found["core_and_link"], found["around_pads"][-1]
    cooled = {}
    if found["sink"] is not None:
        cooled = {
            "sink_conductance": found["sink"].conductance / edge, "sink_capacity": found["sink"].capacity / edge,
            "sink_surface": found["sink"].surface.area / edge, "sink_coefficient": v["sink_coefficient"],
        }  # fmt: skip
    return Case(
        half_width=area / edge, beside=(np.pi * found["rotor_radius"] ** 2 - area) / edge,
        layer_depth=found["pcl_depth"], plate_depth=v["rotor_thickness"], pad_depth=v["peltier_thickness"],
        floor_depth=v["floor_thickness"], gap=v["pcl_thickness"], conductivity_solid=v["pcl_conductivity_solid"],
        conductivity_melt=v["pcl_conductivity_melt"], density=v["pcl_density"],
        specific_heat_solid=melting.specific_heat_solid, specific_heat_melt=melting.specific_heat_melt,
        latent_heat=melting.latent_heat, melting_start=melting.start - 273.15, melting_end=melting.end - 273.15,
        structure_conductivity=v["structure_conductivity"],
        structure_heat_capacity=v["structure_density"] * v["structure_specific_heat"],
        pad_conductivity=v["pad_conductivity"], pad_edge_contact=v["pad_edge_contact"],
        pad_heat_capacity=found["peltier_mass"] * v["peltier_specific_heat"] / area, hot_contact=v["hot_contact"],
        rotor_contact=v["rotor_contact"], seebeck=v["peltier_seebeck"] / v["peltier_area"],
        resistance=v["peltier_resistance"] / v["peltier_area"],
        conductance=v["peltier_conductance"] / v["peltier_area"], window_share=found["cold_area"] / area,
        current=v["current"], ambient=v["ambient_temperature"] - 273.15, cold_coefficient=v["cold_side_coefficient"],
        rotor_coefficient=v["rotor_coefficient"], floor_coefficient=v["housing_coefficient"],
        emissivity=v["surface_emissivity"], air_conductivity=v["air_conductivity"],
        side_coefficient=v["air_conductivity"] / v["window_ledge"], core_conductance=core.conductance / edge,
        core_capacity=core.capacity / edge, housing_conductance=housing.conductance / edge,
        housing_capacity=housing.capacity / edge, housing_surface=housing.surface.area / edge, **cooled,
    )  # fmt: skip


def parts_of(strip: Strip, state: Any) -> PartTemperatures:
    """Temperatures of the structure's parts [K] in the strip."""
    kelvin, shares = strip.temperatures(state) + 273.15, strip.dx / strip.case.half_width
    cold, hot, plate = shares @ kelvin[strip.cold], shares @ kelvin[strip.hot], shares @ kelvin[strip.plate]
    core, edge = kelvin[strip.core], np.mean(kelvin[strip.beside[0]])
    return PartTemperatures(core, core + WAY_OUT * (edge - core), list(plate), 0.5 * (hot + cold), cold)


def strip_times(model: DeviceFunctions, heated: Heating) -> dict[str, float]:
    """The times of the switch by the strip: soft, mean of the layer and mean of its far face at their targets."""
    strip = heated.strip
    known = {**{name: float(model.start[index]) for name, index in model.index.items()}, **model.words}
    names = ("pcl_rheology", "pcl_moment", "pcl_depth", "spring_stiffness", "soft_threshold",
             "structure_compliances", "structure_softening", "lossless_compliance")  # fmt: skip
    found: dict[str, Any] = model.table.evaluate(known, names)
    target = float(model.start[model.index["target_temperature"]]) - 273.15
    omega = 2.0 * np.pi * float(model.start[model.index["frequency@hot"]])
    shares = strip.dx / strip.case.half_width
    compliances = found["structure_compliances"]
    law = (found["structure_softening"], known["clamped_loss_factor"], found["lossless_compliance"])
    soft, means = [], []
    for state in heated.states.T:
        celsius = strip.celsius(state[strip.layer])
        storage, loss = polymer.moduli(celsius + 273.15, strip.solid(celsius), omega, found["pcl_rheology"])
        moduli = shares @ (1.0 / np.mean(1.0 / (storage + 1j * loss), axis=1))
        support = complex(*in_series(compliances, parts_of(strip, state), *law))
        joint = found["spring_stiffness"] + 1.0 / (found["pcl_depth"] / (moduli * found["pcl_moment"]) + 1.0 / support)
        soft.append(-np.log(abs(joint)))
        means.append(shares @ np.mean(celsius, axis=1))
    return {
        "softening_time": heated.passed(np.array(soft), -np.log(found["soft_threshold"])),
        "mean_time": heated.passed(np.array(means), target),
        "far_face_time": heated.passed(heated.far_mean(), target),
    }


def compared(model: DeviceFunctions, grid: Grid = GRID) -> dict[str, tuple[float, float]]:
    """Each time by the product and by the strip [s]; those that come within an hour."""
    values = Simulator(model).run(model.start, phases=["softening"]).values
    times = {name: values[name] for name in TIMES if np.isfinite(values[name])}
    found = strip_times(model, heat(case_of(model), LONGER * max(times.values()), grid))
    return {name: (time, found[name]) for name, time in times.items()}


def studies() -> list[Path]:
    """The shipped studies in shear, but those with modules below a spreader: the strip has pads alike all over."""
    shear = [path for path in sorted(STUDIES.glob("*.yaml")) if read_study(path).mode == "shear"]
    return [path for path in shear if given(read_study(path))["heater_form"] == "flexible"]


def main(names: list[str]) -> None:
    """Compare the named studies, or all that can be, and put their rows in `results.csv`."""
    for path in studies():
        if names and path.stem not in names:
            continue
        rows = []
        for name, (ours, strip) in compared(model_of(path)).items():
            rows.append([path.stem, name, f"{ours:.2f}", f"{strip:.2f}", f"{100.0 * (ours / strip - 1.0):+.2f}"])
            print(*rows[-1], flush=True)
        _put(path.stem, rows)


def _put(study: str, rows: list[list[str]]) -> None:
    """Write a study's rows in place of those it had."""
    before = list(csv.reader(RESULTS.open()))[1:] if RESULTS.exists() else []
    with RESULTS.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("study", "time", "product [s]", "strip [s]", "difference [%]"))
        writer.writerows(sorted([row for row in before if row[0] != study] + rows, key=lambda row: row[0]))


if __name__ == "__main__":
    main(sys.argv[1:])
