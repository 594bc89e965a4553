"""The controller of a module on other modules: parts within their tolerances, assumed values anywhere in their ranges.

The constants are those of the module as drawn; all else differs, thermistor and driver too.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.simulation.control.controller import ControlledModule, Controller, Lags
from tvimdesign.simulation.control.sizing import controller_of
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule
from tvimdesign.solve.nlp import spread
from tvimdesign.solve.uncertainty.uncertain_inputs import contributors_of, unmeasured_inputs

Array = NDArray[np.float64]
LAG_RANGE = 2.5
"""Factor to either side within which a lag is assumed. TDK B57862: heat capacity 36 mJ/K, 1.7 mW/K in still air; a bead
that 0.1 to 0.5 mm of adhesive (0.2 W/(m K)) holds over 20 mm^2 has 8 to 40 mW/K, 0.9 to 4.5 s. Test: step of current,
reading against the joint's own rise."""
OVERSHOOT, LATE = 3.0, 1.1
"""What counts as controlled: hot face above its highest set-point [K], time to soft over that without controller."""
SHARE = 0.95
"""Share of modules that reported values cover."""
WATCHED = 2.0
"""How long a module is watched, in times that it takes without controller."""


@dataclass(frozen=True)
class ControlResult:
    """A controller on drawn modules; `SHARE` of them have at most these values."""

    controller: Controller
    overshoot: float
    """Of the hot face over its highest set-point [K]; below zero if it stays under it."""
    hottest_pads: float
    """Highest temperature of the pads [K]."""
    settling: float
    """Time until soft over that of the same module by the switch's current alone [1]."""
    settling_of_nominal: float
    """Time until soft over that of the module as drawn [1]."""
    controlled: spread.Yield
    """Share within `OVERSHOOT` and `LATE`."""
    stays_soft: spread.Yield
    """Share that stays soft once it is, as long as it is watched."""


def drawn_modules(resolved: ResolvedModule, count: int) -> list[tuple[Array, Lags]]:
    """Draw inputs and lags of modules, a power of two, by tolerances and ranges of assumed values at once."""
    options, parts, ranges = resolved.study.control, contributors_of(resolved), unmeasured_inputs(resolved)
    parts = [part for part in parts if part.name not in {"current", "cooling_current"}]
    points = spread.sobol_points(len(parts) + len(ranges) + 2, count, resolved.study.solver.seed)
    lags = np.array([options.thermistor_lag, options.driver_lag])
    modules = []
    for point in points:
        values: dict[str, float] = {}
        for quantity, share in zip(ranges, point[len(parts) :], strict=False):
            values[quantity.name] = float(quantity.ppf(share))
        for part, share in zip(parts, point, strict=False):
            moved = values.get(part.name, part.nominal) + float(part.ppf(share)) - part.nominal
            values[part.name] = min(max(moved, part.lower), part.upper)
        inputs = resolved.functions.start.copy()
        for name, value in values.items():
            if name in resolved.functions.index:
                inputs[resolved.functions.index[name]] = value
        modules.append((inputs, Lags(*(lags * LAG_RANGE ** (2.0 * point[-2:] - 1.0)).tolist())))
    return modules


def control_of(resolved: ResolvedModule) -> ControlResult | None:
    """Return the result of a study's controller; None if it asks for none, or the module never gets soft."""
    count = resolved.study.control.draws
    controller = controller_of(resolved) if count else None
    if controller is None:
        return None
    model = resolved.functions
    drive = resolved.current_profiles.get("softening") or Simulator(model).constant_drive("softening", model.start)
    nominal = ControlledModule(model, model.start).uncontrolled(drive)
    rows = []
    for drawn, lags in drawn_modules(resolved, spread.power_of_two(count)):
        module = ControlledModule(model, drawn)
        alone = module.uncontrolled(drive)
        course = module.switch(controller, lags, WATCHED * min(max(alone, nominal), module.horizon))
        soft, stays = course.soft_after, course.due[course.times > course.soft_after]
        over, pads = np.max(course.near) - controller.hottest, np.max(course.hot)
        rows.append((over, pads, soft / alone, soft / nominal, bool(len(stays)) and np.min(stays) >= 0.0))
    values = np.nan_to_num(np.array(rows, dtype=float), nan=np.inf, posinf=np.inf).T
    worst = np.quantile(values[:4], SHARE, axis=1, method="higher").tolist()
    good = (values[0] < OVERSHOOT) & (values[2] <= LATE)
    shares = [spread.share_kept(row) for row in (good, values[4] > 0.0)]
    return ControlResult(controller, *worst, *shares)
