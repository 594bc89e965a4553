"""Mean and standard deviation of algebraic outputs whose inputs spread, as expressions the optimiser can differentiate.

For independent, symmetric inputs of standard deviation s_j about their values x_j, to second order in s:
mean = f + 1/2 sum f_jj s_j^2, variance = sum (f_j s_j)^2; all derivatives are exact.
Source: Taylor series of moments, e.g. JCGM 100:2008 (GUM), 5.1.2 with its note.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.nlp.spread import deviation_of
from tvimdesign.study import Tolerance

_NOTHING = 1e-12
"""Share of its size that is added to a deviation inside the root, which has no slope at zero."""


def moments(
    model: DeviceFunctions, tolerances: Mapping[str, Tolerance], outputs: Sequence[str], sizes: Sequence[float]
) -> Any:
    """Return the function inputs -> (shift of the mean, standard deviation) of each output; one column each.

    `sizes` are the outputs' orders of magnitude. The outputs must not depend on a simulation.
    """
    inputs = ca.SX.sym("inputs", len(model.names))
    spreading = [name for name in tolerances if name in model.index]
    values = ca.densify(_of(model, outputs, inputs))
    variance, shift = ca.SX.zeros(len(outputs)), ca.SX.zeros(len(outputs))
    for name in spreading:
        x = inputs[model.index[name]]
        deviation = _deviation(model, tolerances[name], x, inputs)
        slope = ca.jacobian(values, x)
        variance += (slope * deviation) ** 2
        shift += 0.5 * ca.jacobian(slope, x) * deviation**2
    roots = [
        ca.sqrt(variance[i] + (_NOTHING * size) ** 2) if not variance[i].is_zero() else ca.SX(0.0)
        for i, size in enumerate(sizes)
    ]
    return ca.Function("moments", [inputs], [ca.densify(shift), ca.vertcat(*roots)], {"cse": True})


def _of(model: DeviceFunctions, outputs: Sequence[str], inputs: Any) -> Any:
    cycle = ca.DM(np.full(len(model.switch_names), np.nan))
    return model.outputs(outputs).call([inputs, cycle], True, False)[0]


def _deviation(model: DeviceFunctions, tolerance: Tolerance, value: Any, inputs: Any) -> Any:
    """Standard deviation of an input at this design; what is adjusted is no wider than what adjusting leaves."""
    if tolerance.row is not None:
        size = _of(model, [tolerance.row], inputs)
    elif tolerance.share is not None:
        size = tolerance.share * ca.fabs(value)
    else:
        size = ca.SX(tolerance.plus_minus or 0.0)
    if tolerance.adjustable:
        size = ca.fmin(size, tolerance.adjusted_to or 0.0)
    return deviation_of(size, tolerance.distribution, tolerance.sigma)


def moments_at(
    model: DeviceFunctions, tolerances: Mapping[str, Tolerance], outputs: Sequence[str], sizes: Sequence[float],
    inputs: Any,
) -> tuple[Any, Any]:  # fmt: skip
    """Return the shifts of the means and the standard deviations of outputs at a design's inputs."""
    shift, deviation = moments(model, tolerances, outputs, sizes)(inputs)
    return np.asarray(shift).ravel(), np.asarray(deviation).ravel()
