"""How often a fit's interval of 95 % holds the value the data were made with: every kind, many seeds of noise.

`python benchmarks/fit_coverage.py [SEEDS]` prints, for each parameter of each kind, in how many seeds of 100 (or SEEDS)
the interval held the truth. Data are the product's own equations with normal noise; each kind's are made in `MADE`.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from tvimdesign.physics.heat_flow import peltier
from tvimdesign.physics.polymers import polymer
from tvimdesign.simulation.measurement.kind_sheet import kind_sheet
from tvimdesign.simulation.measurement.kinds import dsc, pad, release, torque_angle
from tvimdesign.simulation.measurement.kinds.calorimeter_runs import Run
from tvimdesign.simulation.measurement.reading.data_file import Block, Column

Array = NDArray[np.float64]
Made = tuple[list[Block], Mapping[str, str], Mapping[str, float]]
"""Blocks of data, settings as a user writes them, and what the data were made with [SI]."""


def block(**columns: Any) -> Block:
    """A table in SI, as a file would give it."""
    found = {name: Column(name, name, "SI", np.asarray(values, float)) for name, values in columns.items()}
    return Block("made.csv", "", (2, 1 + len(next(iter(found.values())).values)), found, (), {})


def torque_angle_data(noise: np.random.Generator) -> Made:
    """A joint loaded to 1 N.m both ways and back in steps of 0.1 N.m; angles read to 0.06 deg."""
    truth = {"stiffness": 5.0, "friction": 0.05, "backlash": 0.01, "zero_angle": 0.02}
    steps = np.linspace(0.1, 1.0, 10)
    torque = np.concatenate([steps, steps[::-1], -steps, -steps[::-1], steps])
    angle = torque_angle.angle_of(torque, truth) + noise.normal(0.0, 1e-3, len(torque))
    return [block(torque=torque, angle=angle)], {}, truth


def pad_data(noise: np.random.Generator) -> Made:
    """A pad of 40 mm at twelve currents; voltages to 3 mV, temperatures to 0.05 K."""
    truth = {"seebeck": 0.05, "resistance": 2.0, "conductance": 0.5}
    current = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.5, 1.8, 2.2, -0.4, -0.8])
    hot = 298.0 + 4.0 * np.abs(current)
    module = peltier.PeltierModule(**truth)
    cold = pad.cold_temperature(module, current, hot, 0.0, 0.0, 296.0)
    voltage = peltier.voltage(module, current, hot, cold) + noise.normal(0.0, 3e-3, len(current))
    read = [face + noise.normal(0.0, 0.05, len(current)) for face in (hot, cold)]
    return [block(current=current, voltage=voltage, hot_temperature=read[0], cold_temperature=read[1])], {}, truth


def release_data(noise: np.random.Generator) -> Made:
    """A joint of known inertia let go at 0.12 rad, sampled at 500 Hz for half a second; angles to 1 mrad."""
    truth = {"stiffness": 5.0, "damping": 3e-3, "friction": 0.01, "zero_angle": 0.01}
    moments = np.linspace(0.0, 0.5, 250)
    known = {**truth, "inertia": 4e-4, "first_angle": 0.12, "first_speed": 0.0}
    corner = 0.01 * 0.22 * np.pi / 0.0562
    angle = _numbers(release.swing(moments, known, 6, corner)) + noise.normal(0.0, 1e-3, len(moments))
    return [block(time=moments, angle=angle)], {"inertia": "4e-4 kg.m^2"}, truth


def frequency_sweep_data(noise: np.random.Generator) -> Made:
    """A melt of three modes at 80, 100 and 120 degC from 0.1 to 100 rad/s; moduli to 2 %."""
    modes = [(0.5, 800.0), (0.05, 1.0e4), (0.004, 6.0e4)]
    energy, reference = 35e3, 373.15
    truth = {
        "flow_activation_energy": energy,
        "zero_shear_viscosity": sum(tau * modulus for tau, modulus in modes),
        "plateau_modulus": sum(modulus for _, modulus in modes),
    }
    blocks = []
    omega = np.geomspace(0.1, 100.0, 16)
    for temperature in (353.15, 373.15, 393.15):
        shifted = omega * float(polymer.arrhenius_shift(temperature, reference, energy))
        storage, loss = (
            one * np.exp(noise.normal(0.0, 0.02, len(omega))) for one in polymer.maxwell_moduli(shifted, modes)
        )
        rows = np.full(len(omega), temperature)
        blocks.append(block(angular_frequency=omega, storage_modulus=storage, loss_modulus=loss, temperature=rows))
    return blocks, {}, truth


def dsc_data(noise: np.random.Generator) -> Made:
    """A polymer cooled at 2, 5, 10 and 20 K/min, held at 40 degC and heated at 10 K/min; heat flow to 1 % of a peak."""
    truth = {
        "latent_heat": 60e3, "melting_start": 323.0, "melting_width": 12.0, "crystallization_half_time": 70.0,
        "nucleation_constant": 1.03e5, "avrami_exponent": 2.8,
    }  # fmt: skip
    settings = kind_sheet("dsc").values({})
    known = {**truth, "base_0": 100.0, "slope_0": 20.0}
    courses = [("cooled", 353.0, 263.0, rate / 60.0) for rate in (2, 5, 10, 20)]
    courses += [("heated", 283.0, 363.0, 10.0 / 60.0), ("held", 313.0, 313.0, 0.0)]
    blocks = []
    for way, begin, end, rate in courses:
        seconds = np.linspace(0.0, abs(end - begin) / rate if rate else 600.0, 300)
        run = Run("made", way, seconds, np.linspace(begin, end, 300), np.zeros(300))
        heat = _numbers((dsc.melted if way == "heated" else dsc.frozen)(run, 0, settings)(known))
        heat = heat + noise.normal(0.0, 0.01 * float(np.ptp(heat)), 300)
        blocks.append(block(time=seconds, temperature=run.temperature, specific_heat_flow=heat))
    return blocks, {}, truth


def _numbers(expression: Any) -> Array:
    return np.asarray(ca.evalf(ca.MX(expression))).ravel()


MADE: dict[str, Callable[[np.random.Generator], Made]] = {
    "torque_angle": torque_angle_data,
    "pad": pad_data,
    "release": release_data,
    "frequency_sweep": frequency_sweep_data,
    "dsc": dsc_data,
}


def held(kind: str, seed: int) -> dict[str, bool]:
    """Whether the interval of each parameter holds what the data of a seed were made with."""
    blocks, given, truth = MADE[kind](np.random.default_rng(seed))
    measure = import_module(f"tvimdesign.simulation.measurement.kinds.{kind}").measure
    fit = measure(blocks, kind_sheet(kind).values(given)).fit
    found = {one.name: one for one in (*fit.parameters, *fit.derived)}
    inside = {}
    for name, value in truth.items():
        low, high = found[name].low, found[name].high
        inside[name] = (low is None or low <= value) and (high is None or value <= high)
    return inside


def main() -> None:
    """Print the table."""
    seeds = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    for kind in MADE:
        begin = time.perf_counter()
        counts: dict[str, int] = {}
        for seed in range(seeds):
            for name, inside in held(kind, seed).items():
                counts[name] = counts.get(name, 0) + inside
        told = ", ".join(f"{name} {count}" for name, count in counts.items())
        print(f"{kind} of {seeds}: {told} ({(time.perf_counter() - begin) / seeds:.2f} s a fit)", flush=True)


if __name__ == "__main__":
    main()
