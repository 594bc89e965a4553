"""Relaxation spectra: fits of others' sweeps, other tests that follow from them, large strains."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from judging.case import CASES

from comparisons.numbers import Array
from tvimdesign.catalog import Catalog
from tvimdesign.device.core.impedance.joint_impedance import solid_modes
from tvimdesign.physics.layers import layer
from tvimdesign.physics.motions import motion
from tvimdesign.physics.polymers import melt, polymer, transitions, viscoelasticity
from tvimdesign.physics.solids import structure
from tvimdesign.simulation.joint_tests.release import release
from tvimdesign.simulation.measurement.measure_files import Measured, measure_files
from tvimdesign.simulation.rheometer import transient
from tvimdesign.simulation.rheometer.specimen import PAPER, specimens
from tvimdesign.simulation.working_cycle.device_functions import resolve_study
from tvimdesign.study import read_study

Values = Mapping[str, Any]
CELSIUS = polymer.ZERO_CELSIUS


@cache
def _fitted(path: Path, modes: int) -> Measured:
    """Read a sweep in its maker's format without an option and fit it as the command `fit` does."""
    return measure_files([path], "frequency_sweep", {"largest_modes": str(modes)})


def _spectrum(measured: Measured) -> list[tuple[float, float]]:
    return [(row[0], row[1]) for row in measured.measurement.record_tables["melt_spectrum"].rows]


def viscosities(inputs: Values) -> Values:
    """Zero-shear viscosity [Pa*s] of fits to files; its power of the molar mass."""
    spectra = [_spectrum(_fitted(CASES / name, inputs["modes"])) for name in inputs["files"]]
    results = [viscoelasticity.zero_shear_viscosity(modes) for modes in spectra]
    power = float(np.polyfit(np.log(inputs["molar_mass"]), np.log(results), 1)[0])
    return {"viscosity": results, "power_of_molar_mass": power}


def relaxation_from_a_sweep(inputs: Values) -> Values:
    """Relaxation modulus [Pa] over time from a spectrum that was fitted to G' and G'' alone."""
    modes = _spectrum(_fitted(CASES / inputs["file"], inputs["modes"]))
    return {"modulus": viscoelasticity.relaxation_modulus(np.array(inputs["time"], float), modes)}


def relaxation_of_modes(inputs: Values) -> Values:
    """Relaxation modulus over time of given shares at given times, with what is left for ever."""
    shares, times = np.array(inputs["shares"], float), np.array(inputs["times"], float)
    whole = float(inputs["instant_modulus"])
    modes = [(1e60, whole * (1.0 - np.sum(shares))), *zip(times, whole * shares, strict=True)]
    return {"modulus": viscoelasticity.relaxation_modulus(np.array(inputs["time"], float), modes)}


def tests_of_a_spectrum(inputs: Values) -> Values:
    """Relaxation, creep and start-up over time, G' and G'' over the angular frequency, of given modes."""
    modes, time = [tuple(map(float, mode)) for mode in inputs["modes"]], np.array(inputs["time"], float)
    omega = np.array(inputs.get("frequency", [1.0]), float)
    storage, loss = polymer.maxwell_moduli(omega, modes)
    return {
        "relaxation": viscoelasticity.relaxation_modulus(time, modes),
        "creep": viscoelasticity.creep_compliance(time, viscoelasticity.retardation(modes)),
        "start_up": viscoelasticity.start_up_viscosity(time, modes),
        "storage": storage,
        "loss": loss,
    }


def large_oscillation(inputs: Values) -> Values:
    """First-harmonic moduli [Pa] by Wagner's equation over the strain's amplitude."""
    modes = [tuple(map(float, mode)) for mode in inputs["modes"]]
    limit, omega = inputs["linear_limit"], inputs["frequency"]
    moduli = [melt.wagner_moduli(strain, omega, modes, limit) for strain in inputs["strain"]]
    return {"storage": [each[0] for each in moduli], "loss": [each[1] for each in moduli]}


def back_from_laplace(inputs: Values) -> Values:
    """exp(-t), 1 - exp(-t/5) and t back from their transforms, over time."""

    def transforms(rate: Any) -> tuple[Any, ...]:
        return 1.0 / (rate + 1.0), 1.0 / rate - 1.0 / (rate + 0.2), 1.0 / rate**2

    results = [motion.inverse(transforms, float(time)) for time in inputs["time"]]
    names = ("fading", "creeping", "flowing")
    return {name: [float(each[i]) for each in results] for i, name in enumerate(names)}


def _glass(name: str) -> transitions.Glass:
    record = Catalog().record("polymers", name)
    value = record.value
    transition = transitions.GlassTransition(
        *(value(field) for field in ("glass_transition", "wlf_c1", "wlf_c2", "glass_activation_energy"))
    )
    modulus = structure.shear_modulus(value("flexural_modulus"), value("poissons_ratio"))
    return transitions.Glass(modulus, value("reference_temperature"), transition, solid_modes(record))


def modulus_across_the_transition(inputs: Values) -> Values:
    """Time [s] in which a glass relaxes to a share of its modulus at its transition, and its rubber's modulus [Pa]."""
    record = Catalog().record("polymers", inputs["polymer"])
    each, times = _glass(inputs["polymer"]), np.logspace(-3, 4, 701)

    def youngs(celsius: float, time: Array) -> Array:
        relaxed = viscoelasticity.relaxation_modulus(time, each.at(CELSIUS + celsius))
        return 2.0 * (1.0 + record.value("poissons_ratio")) * relaxed

    left = youngs(inputs["at"], times) / youngs(inputs["before"], times)
    reached = float(np.interp(-inputs["share"], -left, times))
    return {"time": reached, "rubber": float(youngs(inputs["beyond"], np.array([reached]))[0])}


def transition_of_a_sweep(inputs: Values) -> Values:
    """Temperature [degC] at which the loss modulus of a glass peaks at each frequency [Hz]."""
    celsius, each = np.linspace(40.0, 110.0, 1401), _glass(inputs["polymer"])
    spectrum = each.at(CELSIUS + celsius)
    peaks = [np.argmax(polymer.maxwell_moduli(2.0 * np.pi * f, spectrum)[1]) for f in inputs["frequency"]]
    return {"peak": celsius[peaks]}


def relaxation_of_a_glass(inputs: Values) -> Values:
    """Share of the relaxing modulus of a glass that is left at its transition, over time."""
    modes = [mode for mode in _glass(inputs["polymer"]).modes if mode[0] < 1e10]
    whole = sum(share for _, share in modes)
    return {"left": viscoelasticity.relaxation_modulus(np.array(inputs["time"], float), modes) / whole}


def frozen_in_tension(inputs: Values) -> Values:
    """Secant modulus and strength [MPa] of a study's frozen polymer, drawn at a constant rate; stress in two tests.

    Stress is 3^(1/2) times and strain 3^(-1/2) times that of the ramp in shear (von Mises). The tests are `relaxation`,
    highest stress at the paper's coldest temperature, and the cold `release`, highest stress of the layer.
    """
    resolved = resolve_study(read_study(CASES.parents[1] / inputs["study"]))
    at, coldest = specimens(resolved, [CELSIUS + inputs["temperature"], PAPER[0]])
    strain = np.linspace(0.0, 0.01 * inputs["strain"], 401)[1:]
    rise, shear = strain[-1] / inputs["rate"], np.sqrt(3.0) * strain[-1]
    stress = 1e-6 * np.sqrt(3.0) * at.nominal.step_stress(strain / inputs["rate"], float(shear), float(rise))
    secant = float(np.interp(0.01 * inputs["secant"], strain, stress / strain))
    strained = coldest.nominal.step_stress(transient.HELD, transient.STRAIN, transient.RISE)
    held = next(finding.value for finding in release(resolved).findings if finding.name == "held_torque@cold")
    traction = layer.traction(held, *(resolved.quantity(name) for name in ("layer_polar_moment", "pcl_outer_radius")))
    tests = {"relaxation": float(np.max(strained)), "release": traction}
    return {
        "modulus": secant, "strength": float(np.max(stress)),
        **{name: 1e-6 * np.sqrt(3.0) * stress_of_test for name, stress_of_test in tests.items()},
    }  # fmt: skip
