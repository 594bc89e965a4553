"""A joint that is let go, by one degree of freedom: its angle over time with exact derivatives, and where to start.

I theta'' + b theta' + T_f sgn(theta') + K (theta - theta_0) = 0: a spring, a dashpot and a dry friction
(physics/motions/motion.py, `kelvin_voigt_rates`); the friction's corner is rounded at a hundredth of the highest speed.
Integrated by Runge and Kutta's method of fourth order, so that every sample's derivatives are those of the integration.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from tvimdesign.physics.motions import motion
from tvimdesign.simulation.measurement.fitting.problem import Values
from tvimdesign.simulation.measurement.reading.data_file import Array
from tvimdesign.simulation.working_cycle.casadi_setup import ca

CORNER = 0.01
"""Speed, over the highest of the record, at which the friction has 0.76 of its size."""
_CONSTANTS = ("inertia", "damping", "friction", "stiffness", "zero_angle")


def swing(time: Array, values: Values, steps: int, corner: float) -> Any:
    """Angle [rad] at each time [s], from the angle and speed at the first."""
    state = ca.SX.sym("state", 2)
    step, constants = ca.SX.sym("step"), ca.SX.sym("constants", 5)
    inertia, damping, friction, stiffness, zero = ca.vertsplit(constants)

    def rates(now: Any) -> Any:
        turned = now[0] - zero
        speed, acceleration = motion.kelvin_voigt_rates(turned, now[1], inertia, damping, stiffness)
        return ca.vertcat(speed, acceleration - friction * np.tanh(now[1] / corner) / inertia)

    after = state
    for _ in range(steps):
        h = step / steps
        k1 = rates(after)
        k2 = rates(after + 0.5 * h * k1)
        k3 = rates(after + 0.5 * h * k2)
        k4 = rates(after + h * k3)
        after = after + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    one = ca.Function("one", [state, step, constants], [after])
    given = ca.vertcat(*(values[name] for name in _CONSTANTS))
    count = len(time) - 1
    first = ca.vertcat(values["first_angle"], values["first_speed"])
    course = one.mapaccum(count)(first, np.diff(time)[None, :], ca.repmat(given, 1, count))
    return ca.horzcat(first, course)[0, :].T


def period_and_decay(time: Array, angle: Array) -> tuple[float, float]:
    """Period [s] by the crossings of rest and decay [1/s] by the sizes of the halves; for a record that creeps, its
    length."""
    rest = float(np.median(angle[-max(len(angle) // 10, 3) :]))
    away = angle - rest
    noise = 0.05 * np.max(np.abs(away))
    changes = np.flatnonzero(np.diff(np.sign(away)) != 0)
    crossings = [i for i in changes if np.max(np.abs(away[i : i + max(len(away) // 50, 3)])) > noise]
    if len(crossings) < 2:
        gone = np.flatnonzero(np.abs(away) < 0.37 * np.max(np.abs(away)))
        time_gone = time[gone[0]] - time[0] if len(gone) else time[-1] - time[0]
        return 4.0 * max(float(time_gone), float(time[1] - time[0])), 1.0 / max(float(time_gone), 1e-9)
    period = 2.0 * float(np.median(np.diff(time[crossings])))
    sizes = [float(np.max(np.abs(away[a:b]))) for a, b in pairwise(crossings) if b > a]
    tops = [size for size in sizes if size > 0.0]  # a half that no sample lies in has no size
    decay = np.log(tops[0] / tops[-1]) / (0.5 * period * (len(tops) - 1)) if len(tops) > 1 else 0.1 / period
    return period, max(float(decay), 0.01 / period)
