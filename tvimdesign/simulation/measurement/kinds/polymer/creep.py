"""Creep of a melt under a constant stress, and its recovery: the compliance over time.

J(t) = t/eta + what is recoverable, which has the Laplace transform 1/(s Q(s)) - 1/(s^2 eta), Q(s) = sum G s tau/(1 + s
tau), and comes back by Stehfest's weights (physics/motions/laplace.py): as exact as the retardation spectrum
(`viscoelasticity.retardation`) to 4e-4, and with derivatives. After the stress is off J(t) - J(t - t_1) is left.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.physics.motions import laplace
from tvimdesign.physics.polymers import viscoelasticity
from tvimdesign.physics.polymers.polymer import Modes
from tvimdesign.simulation.measurement.fitting.problem import Parameter
from tvimdesign.simulation.measurement.kinds.measurement import LEAST_ROWS, Measurement, Settings, required, rows_of
from tvimdesign.simulation.measurement.kinds.polymer.melt_spectrum import measured
from tvimdesign.simulation.measurement.kinds.polymer.melt_test import (
    Curve,
    MeltTest,
    temperature_of,
    thinned,
    title_of,
)
from tvimdesign.simulation.measurement.reading.data_file import Array, Block
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.symbols import symbols

_ALMOST = 0.99
_OFF = 0.1
"""Share of the largest stress below which it is taken off."""


def measure(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit creep tests, together. Raises InputError for what lacks."""
    return measured([test for block in blocks for test in tests_of(block, settings)], settings, profiles=profiles)


def compliance(time: Any, modes: Modes) -> Any:
    """Strain over stress [1/Pa], a column of expressions, at times [s] after the stress came on."""
    count = time.shape[0]
    moment, constants = symbols(ca.SX.sym("t"))[0], ca.SX.sym("modes", 2 * len(modes))
    entries = symbols(constants)
    spectrum = [(entries[2 * i], entries[2 * i + 1]) for i in range(len(modes))]
    viscosity = viscoelasticity.zero_shear_viscosity(spectrum)

    def transform(s: Any) -> tuple[Any]:
        # 1/(s Q) - 1/(s^2 eta) as one fraction, for the difference cancels at small s
        flow = sum(modulus * tau / (1.0 + s * tau) for tau, modulus in spectrum)
        elastic = sum(modulus * tau**2 / (1.0 + s * tau) for tau, modulus in spectrum)
        return (elastic / (s * flow * viscosity),)

    (recoverable,) = laplace.inverse(transform, moment)
    one = ca.Function("compliance", [ca.SX(moment), constants], [ca.SX(recoverable + moment / viscosity)])
    given = ca.vertcat(*(ca.vertcat(tau, modulus) for tau, modulus in modes))
    return one.map(count)(ca.MX(time).T, ca.repmat(given, 1, count)).T


_NONE = np.finfo(float).tiny
"""Compliance [1/Pa] that is none: one over it is no number."""


def tests_of(block: Block, settings: Settings) -> list[MeltTest]:
    """The creep of a table, and the recovery in it where there is one: compliance above zero."""
    if block.settings.get("recovery", "0").strip() not in {"", "0"}:
        raise InputError(
            f"{block.file}:{block.lines[0]}: the file says that this is a recovery (rec); it can be fitted only in one "
            "table with the creep before it, with the stress in a column"
        )
    time, found, loaded = _compliance(block, settings)
    good = (time > 0.0) & ((found > _NONE) | ~loaded)
    time, found, loaded = time[good], found[good], loaded[good]
    if np.sum(loaded) < LEAST_ROWS:
        raise InputError(f"{block.file}:{block.lines[0]}: no three rows under load with a compliance above zero")
    temperature = temperature_of(block, settings)
    where = title_of(block, temperature)
    creeping = _under_load(where, time[loaded], found[loaded])
    curves = [creeping]
    if np.sum(~loaded) >= LEAST_ROWS:
        curves.append(_recovery(where, float(time[loaded][-1]), time[~loaded], found[~loaded]))
    return [MeltTest(where, temperature, None, curves, 1.0 / creeping.at, 1.0 / creeping.measured)]


def _under_load(where: str, time: Array, found: Array) -> Curve:
    used = thinned(time)

    def predicted(modes: Modes, shift: Any) -> Any:
        return compliance(ca.DM(time[used]) / shift, modes)

    return Curve(f"compliance of {where}", "1/Pa", found[used], predicted, time[used], "time", "s")


def _recovery(where: str, last: float, time: Array, found: Array) -> Curve:
    """The rows after the last one under load; the moment of the release lies between, and is an unknown."""
    used = thinned(time - last)
    time, found = time[used], found[used]
    gap = float(time[0]) - last
    release = Parameter(
        f"release of {where}", "s", "Moment at which the stress goes", last + 0.5 * gap, positive=False, scale=gap,
        least=last, most=last + _ALMOST * gap, nuisance=True,
    )  # fmt: skip

    def predicted(modes: Modes, shift: Any, released: Any) -> Any:
        return compliance(ca.DM(time) / shift, modes) - compliance((ca.DM(time) - released) / shift, modes)

    return Curve(f"recovery of {where}", "1/Pa", found, predicted, time, "time", "s", relative=False, own=release)


def _compliance(block: Block, settings: Settings) -> tuple[Array, Array, Any]:
    """Time, compliance and whether the stress is on: by columns, or by a stress that is set."""
    value = "compliance" if "compliance" in block.columns else "strain"
    if "stress" in block.columns:
        time, found, stress = rows_of(block, ["time", value, "stress"])
        most = float(np.median(np.abs(stress[np.abs(stress) > 0.5 * np.max(np.abs(stress))])))
        loaded = np.abs(stress) > _OFF * most
        last = int(np.flatnonzero(loaded)[-1])
        loaded[: last + 1] = True  # a sample or two while the stress comes on
        return time, found if value == "compliance" else np.abs(found) / most, loaded
    time, found = rows_of(block, ["time", value])
    if value == "strain":
        said = block.number("stress")
        stress_set = (
            said
            if said and "stress" not in settings
            else required(settings, "stress", f"as {block.file} has a strain and neither stress nor compliance")
        )
        found = found / stress_set
    return time, found, np.ones(len(time), bool)
