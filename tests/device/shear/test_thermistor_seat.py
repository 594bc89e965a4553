"""The seat of a thermistor at the end of a pad: what it takes from the floor, by counting, and when it breaks out."""

from math import cos, pi, sin

import numpy as np
import pytest
from device_values import inputs_of

from tvimdesign.device import table_for

MM = 1e-3
TABLE = table_for("shear")
GAPS = ["thermistor_window_gap", "thermistor_arc_gap"]


def test_the_floor_lacks_the_half_beside_the_pad_and_all_of_it_below() -> None:
    names = [
        "housing_volume",
        "housing_inertia",
        "thermistor_seat_diameter",
        "thermistor_seat_radius",
        "pad_depth",
        "floor_web",
    ]
    bare, known = (inputs_of(thermistor_diameter=diameter) for diameter in (0.0, 1.8 * MM))
    without, has = (TABLE.evaluate(inputs, names) for inputs in (bare, known))
    side = np.linspace(-1.0, 1.0, 2001) * 0.5 * has["thermistor_seat_diameter"]
    x, y = np.meshgrid(side, side)  # y along the arc, beyond the pocket's end where it is above zero
    inside = np.hypot(x, y) < 0.5 * has["thermistor_seat_diameter"]
    r2, cell = (has["thermistor_seat_radius"] + x) ** 2 + y**2, (side[1] - side[0]) ** 2
    depth = np.where(y > 0.0, has["pad_depth"] + has["floor_web"], has["floor_web"]) * inside * cell
    assert without["housing_volume"] - has["housing_volume"] == pytest.approx(depth.sum(), rel=1e-3)
    taken = known["structure_density"] * (depth * r2).sum()
    assert without["housing_inertia"] - has["housing_inertia"] == pytest.approx(taken, rel=1e-3)


def test_webs_and_tiles_beside_a_thermistor() -> None:
    tight = inputs_of(window_ledge=0.5 * MM, arc_span=1.57, minimum_wall=3.0 * MM)
    assert all(TABLE.evaluate(tight, GAPS)[name] >= 0.0 for name in GAPS)
    known = inputs_of(thermistor_diameter=1.0 * MM, window_ledge=2.2 * MM)
    seat = TABLE.evaluate(known, ["thermistor_seat_radius", "thermistor_seat_diameter", *GAPS])
    pad = 0.5 * known["arc_span"]
    end = pad + known["slip_clearance"] / known["pcl_inner_radius"]  # the pocket's, on which the seat has its middle
    middle = seat["thermistor_seat_radius"] * np.array([cos(end), sin(end)])
    edge = pad - known["window_ledge"] / known["pcl_inner_radius"]  # the window's end points to the axis as well
    web = abs(middle @ np.array([-sin(edge), cos(edge)])) - 0.5 * seat["thermistor_seat_diameter"]
    assert seat["thermistor_window_gap"] == pytest.approx(web - known["minimum_wall"] - 0.15 * MM, rel=1e-9)
    next_end = 2.0 * pi / known["arc_count"] - end
    web = abs(middle @ np.array([-sin(next_end), cos(next_end)])) - 0.5 * seat["thermistor_seat_diameter"]
    assert seat["thermistor_arc_gap"] == pytest.approx(web - known["minimum_wall"] - 0.15 * MM, rel=1e-9)
    known = inputs_of(
        peltier_module="ma10_063_05_1", arc_count=3.0, thermistor_diameter=1.8 * MM, floor_thickness=6.5 * MM
    )
    found = TABLE.evaluate(known, ["thermistor_count", "thermistor_seat_diameter", "thermistor_volume"])
    assert (found["thermistor_count"], found["thermistor_seat_diameter"]) == (3.0, 0.0)
    assert found["thermistor_volume"] == pytest.approx(3.0 * 0.25 * pi * 1.8**2 * 4.0 * 1e-9)
