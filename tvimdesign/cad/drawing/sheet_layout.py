"""How a part's views lie on a sheet: which sheet, at which scale, and where each view's origin is."""

from __future__ import annotations

from dataclasses import dataclass

from tvimdesign.cad.drawing.drawing_sheet import MARGIN, SIZES, TITLE_WIDTH
from tvimdesign.cad.drawing.feature_table import OVER_TITLE
from tvimdesign.cad.drawing.projection import View

_SCALES = (20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1)
"""Of ISO 5455."""
_LARGE = 2.0
"""Scale from which the smaller sheet will do."""
FIRST, NEXT = 8.0, 6.5
"""Height of the first dimension over a section, and of each further one over that [mm]."""
_LEFT, _LEVELS, _BETWEEN, _BELOW = 24.0, 36.0, 24.0, 18.0
"""Room left of the views, right of a section for its heights, between section and plan, and below the plan [mm]."""
_NOTES = 44.0
"""Height that notes take over the tables [mm]."""


@dataclass(frozen=True)
class Layout:
    """Places of the views' origins on a sheet [mm]."""

    form: str
    scale: float
    plan: tuple[float, float]
    front: tuple[float, float]
    half: tuple[float, float]
    """Of the half section beside the front view."""
    room: tuple[float, float, float, float]
    """Where numbers may stand around the plan: least and largest x, then y."""


def layout(plan: View, front: View, half: View | None, diameters: int, table: float) -> Layout:
    """The largest standard scale on the smallest sheet that shows the part doubled, or on the larger sheet."""
    over = FIRST + NEXT * (diameters + 1)
    best = [(_scale_on(size, plan, front, half, over, table), name) for name, size in SIZES.items()]
    scale, form = next((one for one in best if one[0] >= _LARGE), max(best, key=lambda one: one[0]))
    scale = scale or _SCALES[-1]
    wide, high = _needed(plan, front, half, over, scale)
    right, top = SIZES[form][0] - MARGIN - TITLE_WIDTH - 6.0, SIZES[form][1] - MARGIN
    start = MARGIN + 0.5 * max(right - MARGIN - wide, 0.0) + _LEFT
    level = MARGIN + 0.5 * max(top - MARGIN - high, 0.0) + _BELOW
    x = start - min(plan.bounds[0], front.bounds[0]) * scale
    plan_at = (x, level - plan.bounds[2] * scale)
    front_at = (x, plan_at[1] + plan.bounds[3] * scale + _BETWEEN - front.bounds[2] * scale)
    half_x = x + front.bounds[1] * scale + _LEVELS - (min(half.bounds[0], 0.0) * scale if half else 0.0)
    bottom_of_front = front_at[1] + front.bounds[2] * scale
    room = (MARGIN + 4.0, right - 2.0, MARGIN + 4.0, bottom_of_front - 10.0)
    return Layout(form, scale, plan_at, front_at, (half_x, front_at[1]), room)


def _needed(plan: View, front: View, half: View | None, over: float, scale: float) -> tuple[float, float]:
    """Width and height on paper of all views with their dimensions."""
    section = (front.bounds[1] - front.bounds[0] + (half.bounds[1] if half else 0.0)) * scale + _LEVELS
    wide = _LEFT + max(section, (plan.bounds[1] - plan.bounds[0]) * scale + _LEFT)
    high = (plan.bounds[3] - plan.bounds[2] + front.bounds[3] - front.bounds[2]) * scale
    return wide, high + _BELOW + _BETWEEN + over


def _scale_on(
    size: tuple[float, float], plan: View, front: View, half: View | None, over: float, table: float
) -> float:
    """The largest scale at which a sheet has room for views and table; 0 where it has none."""
    width, height = size[0] - 2.0 * MARGIN - TITLE_WIDTH - 6.0, size[1] - 2.0 * MARGIN
    if OVER_TITLE - MARGIN + table + _NOTES > height:
        return 0.0
    for scale in _SCALES:
        wide, high = _needed(plan, front, half, over, scale)
        if wide <= width and high <= height:
            return scale
    return 0.0
