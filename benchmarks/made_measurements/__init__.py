"""Measured data made by the product's own equations, with normal noise: to compare fits of every kind with."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from made_measurements.joints import frozen_torque_data, release_data, sine_data, torque_angle_data
from made_measurements.made import Made
from made_measurements.melts import MELTS
from made_measurements.warmth import dsc_data, heating_log_data, pad_data

MADE: dict[str, Callable[[np.random.Generator], Made]] = {
    "torque_angle": torque_angle_data,
    "sine": sine_data,
    "release": release_data,
    "frozen_torque": frozen_torque_data,
    "pad": pad_data,
    **MELTS,
    "dsc": dsc_data,
    "heating_log": heating_log_data,
}
