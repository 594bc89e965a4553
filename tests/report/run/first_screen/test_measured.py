"""The block that says what measurements buy."""

from __future__ import annotations

from typing import Any

from tvimdesign.report.run.first_screen.measured import measured_lines, shrunk


def entry(value: float, now: tuple[float, float], before: tuple[float, float | None] | None) -> dict[str, Any]:
    earlier = None if before is None else {"low": before[0], "high": before[1]}
    return {"value": value, "low": now[0], "high": now[1], "unit": "s", "before": earlier}


INTERVALS = {
    "softening_time": entry(100.0, (90.0, 120.0), (40.0, 240.0)),
    "frozen_time": entry(300.0, (280.0, 330.0), (200.0, None)),
    "peak_power": entry(9.0, (8.0, 10.0), (8.0, 10.02)),
    "peak_current": entry(1.5, (1.5, 1.5), (1.5, 1.5)),
    "module_mass": entry(230.0, (229.0, 231.0), None),
}


def test_the_values_that_shrink_are_told_with_both_intervals_the_most_first() -> None:
    assert [(name, before, now) for name, before, now, _ in shrunk(INTERVALS)] == [
        ("frozen_time", "200 to never", "280 to 330 s"),
        ("softening_time", "40 to 240", "90 to 120 s"),
    ]


def test_the_screen_names_what_was_measured() -> None:
    unmeasured = [{"name": "peltier_seebeck", "status": "measured"}, {"name": "rotor_contact", "status": "handbook"}]
    (line,) = measured_lines({"intervals": INTERVALS, "unmeasured": unmeasured}, 200)
    assert line.startswith("Measured     peltier_seebeck: frozen_time 280 to 330 s, before 200 to never; softening")
    assert "rotor_contact" not in line
    assert measured_lines({"intervals": INTERVALS, "unmeasured": unmeasured[1:]}, 200) == []
