"""Data of heat: pads and calorimetry, the product's own equations with normal noise."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

from made_measurements.made import Array, Made, block, numbers
from tvimdesign.physics.heat_flow import peltier
from tvimdesign.simulation.measurement.kinds import dsc, pad
from tvimdesign.simulation.measurement.kinds.dsc import Run
from tvimdesign.simulation.measurement.kinds.heating_log import Course, LoggedModule
from tvimdesign.simulation.measurement.measure_files import kind_sheet
from tvimdesign.simulation.working_cycle.device_functions import resolve_study
from tvimdesign.study import read_study

STUDY = Path(__file__).parents[2] / "studies" / "paper_reconstructed.yaml"
LOGGED = {"rotor_contact": 2000.0, "rotor_coefficient": 8.0, "cold_side_coefficient": 12.0}
AIR = {"ambient_temperature": 295.0}


@cache
def _logged() -> dict[str, Array]:
    """Return the log of the paper's module heated for 250 s and left to the air for 500 s, without noise."""
    resolved = resolve_study(read_study(STUDY))
    time = np.concatenate([np.arange(0.0, 250.0, 5.0), np.arange(250.0, 751.0, 10.0)])
    current = np.where(time < 250.0, 1.5, 0.0)
    module = LoggedModule(resolved, [*LOGGED, *AIR])
    temperatures = module.temperatures(Course(time, current[:-1], 50), {**LOGGED, **AIR})
    places = ("cold_temperature", "hot_temperature", "far_face_temperature", "rotor_temperature")
    return {"time": time, "current": current, **{name: numbers(temperatures[name]) for name in places}}


def heating_log_data(noise: np.random.Generator) -> Made:
    """Return the paper's module with thermocouples at four places, read to 0.3 K."""
    columns = {
        name: values + (noise.normal(0.0, 0.3, len(values)) if name.endswith("temperature") else 0.0)
        for name, values in _logged().items()
    }
    return [block(**columns)], {"study": str(STUDY), "fitted": " ".join(LOGGED)}, {**LOGGED, **AIR}


def pad_data(noise: np.random.Generator) -> Made:
    """Return a pad of 40 mm at twelve currents; voltages to 3 mV, temperatures to 0.05 K."""
    truth = {"seebeck": 0.05, "resistance": 2.0, "conductance": 0.5}
    current = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.5, 1.8, 2.2, -0.4, -0.8])
    hot = 298.0 + 4.0 * np.abs(current)
    module = peltier.PeltierModule(**truth)
    cold = pad.cold_temperature(module, current, hot, 0.0, 0.0, 296.0)
    voltage = peltier.voltage(module, current, hot, cold) + noise.normal(0.0, 3e-3, len(current))
    read = [face + noise.normal(0.0, 0.05, len(current)) for face in (hot, cold)]
    return [block(current=current, voltage=voltage, hot_temperature=read[0], cold_temperature=read[1])], {}, truth


def dsc_data(noise: np.random.Generator) -> Made:
    """Cool a polymer at 2, 5, 10 and 20 K/min, hold at 40 degC, heat at 10 K/min; heat flow to 1 % of a peak."""
    truth = {
        "latent_heat": 60e3, "melting_start": 323.0, "melting_width": 12.0, "crystallization_half_time": 70.0,
        "nucleation_constant": 1.03e5, "avrami_exponent": 2.8,
    }  # fmt: skip
    settings = kind_sheet("dsc").values({})
    known = {**truth, "base_0": 100.0, "slope_0": 20.0, "blur_start": 1.5, "blur_end": 0.6}
    courses = [("cooled", 353.0, 263.0, rate / 60.0) for rate in (2, 5, 10, 20)]
    courses += [("heated", 283.0, 363.0, 10.0 / 60.0), ("held", 313.0, 313.0, 0.0)]
    blocks = []
    for way, begin, end, rate in courses:
        seconds = np.linspace(0.0, abs(end - begin) / rate if rate else 600.0, 300)
        run = Run("made", way, seconds, np.linspace(begin, end, 300), np.zeros(300))
        heat = numbers((dsc.melted if way == "heated" else dsc.frozen)(run, 0, settings)(known))
        heat = heat + noise.normal(0.0, 0.01 * float(np.ptp(heat)), 300)
        blocks.append(block(time=seconds, temperature=run.temperature, specific_heat_flow=heat))
    return blocks, {}, {**truth, "melting_end": 335.0}
