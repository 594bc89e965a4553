"""Peltier modules from their ratings: heat, voltage and resistance elsewhere than at the ratings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from tvimdesign.base.record import Record
from tvimdesign.catalog import Catalog
from tvimdesign.physics.heat_flow import peltier

Values = Mapping[str, Any]


def _record(name: str) -> Record:
    return Catalog().record("heaters", name)


def _module(record: Record) -> peltier.PeltierModule:
    return peltier.PeltierModule(*(record.value(name) for name in ("seebeck", "resistance", "conductance")))


def at_the_ratings(inputs: Values) -> Values:
    """Voltage [V] at I_max and dT_max, and heat drawn there over K dT, of records with ratings."""
    voltages, heats = [], []
    for name in inputs["modules"]:
        record = _record(name)
        module, hot = _module(record), record.value("hot_side_temperature")
        cold, current = hot - record.value("max_temperature_difference"), record.value("max_current")
        voltages.append(peltier.voltage(module, current, hot, cold))
        heats.append(peltier.cold_side_heat(module, current, hot, cold) / (module.conductance * (hot - cold)))
    return {"voltage": voltages, "heat": heats}


def resistances(inputs: Values) -> Values:
    """Resistance [ohm] of records, which their ratings give."""
    return {"resistance": [_module(_record(name)).resistance for name in inputs["modules"]]}


def largest_heat(inputs: Values) -> Values:
    """Heat [W] drawn without a difference at I_max, and the most any current draws."""
    rated, most = [], []
    for name in inputs["modules"]:
        record = _record(name)
        module, hot = _module(record), record.value("hot_side_temperature")
        rated.append(peltier.cold_side_heat(module, record.value("max_current"), hot, hot))
        most.append(peltier.max_cooling_power(module, hot))
    return {"at_rated_current": rated, "most": most}


def warmer_hot_side(inputs: Values) -> Values:
    """Return the gains of dT_max [K] and of the largest heat with a warmer hot side, of records."""
    gained, share = [], []
    for name in inputs["modules"]:
        record = _record(name)
        module, rated = _module(record), record.value("hot_side_temperature")
        differences = [hot - _coldest(module, hot) for hot in (rated, inputs["hot"])]
        gained.append(differences[1] - differences[0])
        heats = [peltier.max_cooling_power(module, hot) for hot in (rated, inputs["hot"])]
        share.append(heats[1] / heats[0])
    return {"difference_gained": gained, "heat_gained": share}


def _coldest(module: peltier.PeltierModule, hot: float) -> float:
    """Lowest cold side [K] over all currents: the heat drawn is none there."""

    def cold(current: float) -> float:
        heating = 0.5 * current**2 * module.resistance + module.conductance * hot
        return float(heating / (module.seebeck * current + module.conductance))

    return float(minimize_scalar(cold, bounds=(1e-3, 100.0), method="bounded", options={"xatol": 1e-9}).fun)


def point_of_a_curve(inputs: Values) -> Values:
    """Heat [W] at a current and difference of a module known by its ratings alone, as a maker reads off a graph.

    The ratings become a module by the record's own formulas: S = V/T_h, R = V T_c/(I T_h), K = V I T_c/(2 T_h dT).
    """
    volts, amperes, difference, hot = (inputs[name] for name in ("max_voltage", "max_current", "max_difference", "hot"))
    cold = hot - difference
    module = peltier.PeltierModule(
        volts / hot, volts * cold / (amperes * hot), volts * amperes * cold / (2.0 * hot * difference)
    )
    at = hot - inputs["difference"]
    return {"heat": peltier.cold_side_heat(module, inputs["share_of_current"] * amperes, hot, at)}


def best_performance(inputs: Values) -> Values:
    """Largest coefficient of performance over the difference [K], by search over the current."""
    module = peltier.PeltierModule(inputs["seebeck"], inputs["resistance"], inputs["conductance"])
    hot, results = inputs["hot"], []
    for difference in inputs["difference"]:
        cold = hot - difference

        def performance(current: float, cold: float = cold) -> float:
            power = current * peltier.voltage(module, current, hot, cold)
            return float(-peltier.cold_side_heat(module, current, hot, cold) / power)

        best = minimize_scalar(performance, bounds=(0.02, 6.0), method="bounded", options={"xatol": 1e-10})
        results.append(-best.fun)
    return {"performance": results}


def wired_modules(inputs: Values) -> Values:
    """Heat [W] and voltage of modules in strings against one of them times their number."""
    each = peltier.PeltierModule(inputs["seebeck"], inputs["resistance"], inputs["conductance"])
    together = peltier.wired(each, inputs["count"], inputs["strings"])
    current, hot, cold = inputs["current"], inputs["hot"], inputs["cold"]
    return {
        "heat": peltier.hot_side_heat(together, current, hot, cold),
        "voltage": peltier.voltage(together, current, hot, cold),
        "figure_of_merit": np.prod([together.seebeck**2, 1.0 / together.resistance, 1.0 / together.conductance]),
    }


def currents_at_a_voltage(inputs: Values) -> Values:
    """Current [A] at a constant voltage over the faces' temperatures, of modules with no other known curves.

    Each curve gives the Seebeck coefficient and the resistance that suit V = S (T_h - T_c) + I R best; the currents
    follow from them. The coefficients are reported over that of the first curve of the same module.
    """
    currents, seebecks = [], []
    for curve in inputs["curves"]:
        hot, cold, measured = (np.array(curve[name]) for name in ("hot", "cold", "current"))
        each = peltier.PeltierModule(1.0, 0.0, 0.0), peltier.PeltierModule(0.0, 1.0, 0.0)
        table = np.column_stack([peltier.voltage(module, measured, hot, cold) for module in each])
        seebeck, resistance = np.linalg.lstsq(table, np.full(len(hot), curve["voltage"]), rcond=None)[0]
        open_voltage = peltier.voltage(peltier.PeltierModule(seebeck, resistance, 0.0), 0.0, hot, cold)
        currents += [float(each) for each in (curve["voltage"] - open_voltage) / resistance]
        seebecks.append(float(seebeck))
    first = {module: seebecks[inputs["modules"].index(module)] for module in inputs["modules"]}
    over = [seebeck / first[module] for seebeck, module in zip(seebecks, inputs["modules"], strict=True)]
    return {"current": currents, "seebeck_over_the_first": over}
