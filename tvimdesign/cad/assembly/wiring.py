"""The wiring diagram of a module: supply, driver, cut-out and heaters as they are wired, and the thermistors."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from tvimdesign.cad.assembly.bill_of_materials import Item
from tvimdesign.cad.assembly.heater_leads import pad_count
from tvimdesign.study.design import Design

_BOX, _HIGH, _GAP, _LEFT = 130, 44, 40, 20
_RED, _BLACK, _GREY = "#c62828", "#222222", "#607d8b"
_ALL_PARALLEL = "all_parallel"
_SERIES = "series"


def strings(design: Design) -> list[list[int]]:
    """Return the numbers of the heaters in each string; strings are in parallel, the heaters of each in series."""
    heaters = list(range(1, pad_count(design) + 1))
    wiring = design.choices.get("heater_wiring", _SERIES)
    if wiring == _SERIES:
        return [heaters]
    if wiring == _ALL_PARALLEL:
        return [[heater] for heater in heaters]
    groups = design.value("arc_count" if design.mode == "shear" else "vane_count")
    each = max(len(heaters) // max(round(groups), 1), 1)
    return [heaters[start : start + each] for start in range(0, len(heaters), each)]


def wiring_svg(design: Design, extra: Sequence[Item]) -> bytes:
    """Return the diagram as SVG; `extra` are the lines of the list of parts that name supply and driver."""
    rows = strings(design)
    ordered = {
        item.kind: item.offer.number if item.offer else "" for item in extra if item.kind in ("supply", "driver")
    }
    feed = [("DC supply", ordered.get("supply", "")), ("driver", ordered.get("driver", ""))]
    if design.values.get("cutout_diameter", 0.0) > 0.0:
        feed.append(("thermal cut-out", ""))
    step = _BOX + _GAP
    first = _LEFT + len(feed) * step
    width = first + max(map(len, rows)) * step + _GAP
    sensors = round(design.values.get("thermistor_count", 1.0))
    height = 70 + max(len(rows), 1) * (_HIGH + 30) + 90
    top, back = 40, 70 + len(rows) * (_HIGH + 30)
    shapes = []
    for index, (name, number) in enumerate(feed):
        shapes += _box(_LEFT + index * step, top, name, number)
        shapes.append(_line([(_LEFT + index * step + _BOX, top + 22), (_LEFT + (index + 1) * step, top + 22)], _RED))
    for row, heaters in enumerate(rows):
        level = top + row * (_HIGH + 30) + 22
        shapes.append(_line([(first - 0.5 * _GAP, top + 22), (first - 0.5 * _GAP, level), (first, level)], _RED))
        for place, heater in enumerate(heaters):
            shapes += _box(first + place * step, level - 22, f"heater {heater}", "")
            if place:
                shapes.append(_line([(first + place * step - _GAP, level), (first + place * step, level)], _BLACK))
        end = first + len(heaters) * step - _GAP
        shapes.append(_line([(end, level), (width - 20, level), (width - 20, back), (_LEFT + step + 65, back)], _BLACK))
    shapes.append(_line([(_LEFT + step + 65, back), (_LEFT + step + 65, top + _HIGH)], _BLACK))
    shapes.append(_line([(_LEFT + 65, top + _HIGH), (_LEFT + 65, top + 66), (_LEFT + step + 30, top + 66),
                         (_LEFT + step + 30, top + _HIGH)], _BLACK))  # fmt: skip
    low = height - 60
    shapes += _box(_LEFT, low, "controller", "")
    shapes += _box(_LEFT + step, low, f"{sensors} thermistor{'s' if sensors > 1 else ''}", "NTC 10 kohm")
    for beside in (14, 30):
        shapes.append(_line([(_LEFT + _BOX, low + beside), (_LEFT + step, low + beside)], _GREY))
    shapes.append(_line([(_LEFT + 20, low), (_LEFT + 20, back + 12), (_LEFT + step + 100, back + 12),
                         (_LEFT + step + 100, top + _HIGH)], _GREY))  # fmt: skip
    key = "red: + while it heats; black: return; grey: signals. A driver that turns the current round cools."
    shapes.append(_words(_LEFT, 20, key, "start"))
    size = f'width="{width:g}" height="{height:g}" viewBox="0 0 {width:g} {height:g}"'
    body = "\n".join(shapes)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="sans-serif" font-size="12">\n'
        f'<rect width="100%" height="100%" fill="white"/>\n{body}\n</svg>\n'
    ).encode()


def _box(x: float, y: float, name: str, number: str) -> list[str]:
    middle = x + 0.5 * _BOX
    frame = f'<rect x="{x:g}" y="{y:g}" width="{_BOX}" height="{_HIGH}" fill="#f4f6f8" stroke="{_BLACK}"/>'
    lines = [text for text in (name, number) if text]
    first = y + 0.5 * _HIGH + 4 - 8 * (len(lines) - 1)
    return [frame, *(_words(middle, first + 16 * index, text, "middle") for index, text in enumerate(lines))]


def _words(x: float, y: float, text: str, anchor: str) -> str:
    return f'<text x="{x:g}" y="{y:g}" text-anchor="{anchor}">{escape(text)}</text>'


def _line(points: Sequence[tuple[float, float]], colour: str) -> str:
    path = " ".join(f"{x:g},{y:g}" for x, y in points)
    return f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"/>'
