"""Data of a melt on a rheometer: the product's own equations with normal noise, of one spectrum of three modes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from made_measurements.made import Array, Made, block
from tvimdesign.physics.polymers import polymer, viscoelasticity
from tvimdesign.simulation.measurement.kinds.shear_laws import carreau
from tvimdesign.simulation.measurement.reading.data_file import Block

MODES = [(0.5, 800.0), (0.05, 1.0e4), (0.004, 6.0e4)]
ENERGY, REFERENCE = 35e3, 373.15
SPECTRUM = {
    "zero_shear_viscosity": sum(tau * modulus for tau, modulus in MODES),
    "plateau_modulus": sum(modulus for _, modulus in MODES),
    **{f"time_{i}": tau for i, (tau, _) in enumerate(MODES, start=1)},
    **{f"modulus_{i}": modulus for i, (_, modulus) in enumerate(MODES, start=1)},
}
TRUTH = {"flow_activation_energy": ENERGY, **SPECTRUM}


def sweep(noise: np.random.Generator, temperature: float, omega: Array) -> Block:
    """Return a frequency sweep to 2 %."""
    shifted = omega * float(polymer.arrhenius_shift(temperature, REFERENCE, ENERGY))
    storage, loss = (
        modulus * np.exp(noise.normal(0.0, 0.02, len(omega))) for modulus in polymer.maxwell_moduli(shifted, MODES)
    )
    rows = np.full(len(omega), temperature)
    return block(angular_frequency=omega, storage_modulus=storage, loss_modulus=loss, temperature=rows)


def creeping(noise: np.random.Generator, seconds: float) -> Block:
    """Creep under 50 Pa, and as long a recovery; strains under load to 1 %, after it to 0.1 % of the largest."""
    time = np.geomspace(2e-3, seconds, 60)
    response = viscoelasticity.retardation(MODES)
    loaded = 50.0 * viscoelasticity.creep_compliance(time, response)
    free = viscoelasticity.creep_and_recovery(seconds + time, 50.0, seconds, response)
    strain = np.concatenate([
        loaded * np.exp(noise.normal(0.0, 0.01, 60)), free + noise.normal(0.0, 1e-3 * float(loaded[-1]), 60),
    ])  # fmt: skip
    stress = np.repeat([50.0, 0.0], 60)
    return block(time=np.concatenate([time, seconds + time]), strain=strain, stress=stress,
                 temperature=np.full(120, REFERENCE))  # fmt: skip


def relaxing(noise: np.random.Generator) -> Block:
    """Relaxation over three decades of time, to 2 %."""
    time = np.geomspace(1e-3, 1.5, 80)
    modulus = viscoelasticity.relaxation_modulus(time, MODES) * np.exp(noise.normal(0.0, 0.02, 80))
    return block(time=time, relaxation_modulus=modulus, temperature=np.full(80, REFERENCE))


def frequency_sweep_data(noise: np.random.Generator) -> Made:
    """Sweeps at 80, 100 and 120 degC from 0.1 to 100 rad/s."""
    omega = np.geomspace(0.1, 100.0, 16)
    return [sweep(noise, at, omega) for at in (353.15, 373.15, 393.15)], {}, TRUTH


def temperature_ramp_data(noise: np.random.Generator) -> Made:
    """Ramps from 75 to 180 degC at 1, 10 and 100 rad/s."""
    blocks = []
    for omega in (1.0, 10.0, 100.0):
        at = np.linspace(348.15, 453.15, 40)
        moduli = polymer.maxwell_moduli(omega * polymer.arrhenius_shift(at, REFERENCE, ENERGY), MODES)
        storage, loss = (modulus * np.exp(noise.normal(0.0, 0.02, 40)) for modulus in moduli)
        blocks.append(
            block(temperature=at, angular_frequency=np.full(40, omega), storage_modulus=storage, loss_modulus=loss)
        )
    return blocks, {"reference_temperature": "100 degC"}, TRUTH


def creep_data(noise: np.random.Generator) -> Made:
    """Creep and recovery for 5 s each."""
    return [creeping(noise, 5.0)], {}, SPECTRUM


def relaxation_data(noise: np.random.Generator) -> Made:
    """Return a relaxation."""
    return [relaxing(noise)], {}, SPECTRUM


def melt_data(noise: np.random.Generator) -> Made:
    """Sweeps at 80 and 100 degC, a creep and a relaxation at 100 degC, together."""
    omega = np.geomspace(0.1, 100.0, 16)
    return (
        [sweep(noise, 353.15, omega), sweep(noise, REFERENCE, omega), creeping(noise, 5.0), relaxing(noise)],
        {},
        TRUTH,
    )


def amplitude_sweep_data(noise: np.random.Generator) -> Made:
    """Return a sweep at 100 degC from 0.1 to 300 %; moduli to 1 %."""
    truth = {"linear_strain": 0.3, "drop_power": 2.0, "storage_modulus": 5e3, "loss_modulus": 1.2e4}
    strain = np.geomspace(1e-3, 3.0, 30)
    left = polymer.damping_function(strain, truth["linear_strain"])
    storage, loss = (
        truth[name] * left * np.exp(noise.normal(0.0, 0.01, 30)) for name in ("storage_modulus", "loss_modulus")
    )
    rows = np.full(30, REFERENCE)
    return [block(strain=strain, storage_modulus=storage, loss_modulus=loss, temperature=rows)], {}, truth


def flow_curve_data(noise: np.random.Generator) -> Made:
    """Flow curves at 80, 100 and 120 degC from 0.01 to 30 1/s; viscosities to 2 %."""
    truth = {"zero_shear_viscosity": 1500.0, "thinning_time": 0.4, "thinning_power": 0.4}
    rate, blocks = np.geomspace(0.01, 30.0, 15), []
    for at in (353.15, REFERENCE, 393.15):
        shift = float(polymer.arrhenius_shift(at, REFERENCE, ENERGY))
        viscosity = shift * carreau(shift * rate, truth) * np.exp(noise.normal(0.0, 0.02, 15))
        blocks.append(block(shear_rate=rate, viscosity=viscosity, temperature=np.full(15, at)))
    return blocks, {}, {**truth, "flow_activation_energy": ENERGY}


MELTS: dict[str, Callable[[np.random.Generator], Made]] = {
    "frequency_sweep": frequency_sweep_data,
    "temperature_ramp": temperature_ramp_data,
    "creep": creep_data,
    "relaxation": relaxation_data,
    "flow_curve": flow_curve_data,
    "melt": melt_data,
    "amplitude_sweep": amplitude_sweep_data,
}
