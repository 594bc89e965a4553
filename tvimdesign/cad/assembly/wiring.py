"""The wiring diagram of a module: supply, driver, cut-out, heaters, the controller and the thermistors' dividers."""

from collections.abc import Sequence
from html import escape

from tvimdesign.cad.assembly.bill_of_materials import DIVIDER, Item, driver_inputs
from tvimdesign.cad.assembly.heater_leads import pad_count
from tvimdesign.study import Design

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
    groups = design.value("arc_count" if design.mode != "compression" else "vane_count")
    each = max(len(heaters) // max(round(groups), 1), 1)
    return [heaters[start : start + each] for start in range(0, len(heaters), each)]


def wiring_svg(design: Design, items: Sequence[Item]) -> bytes:
    """Return the diagram as SVG, no lines crossing; `items` are lines of the list of parts: what feeds and controls."""
    rows = strings(design)
    number = {item.kind: item.offer.number if item.offer else "" if item.fits else "to be chosen" for item in items}
    feed = [("DC supply", number.get("supply", "")), ("driver", number.get("driver", ""))]
    if design.values.get("cutout_diameter", 0.0) > 0.0:
        feed.append(("thermal cut-out", number.get("thermal_cutout", "")))
    step, deep = _BOX + _GAP, _HIGH + 30
    first, driver = _LEFT + len(feed) * step, _LEFT + step
    right = max(first + max(map(len, rows)) * step, driver + 2 * step)
    top, level, back, low = 40, 54, 70 + len(rows) * deep, 110 + len(rows) * deep
    shapes = [_line([(_LEFT + _BOX, 72), (driver, 72)], _BLACK)]
    for index, (name, words) in enumerate(feed):
        shapes += _box(_LEFT + index * step, top, name, words)
        end = first - 0.5 * _GAP if index == len(feed) - 1 else _LEFT + (index + 1) * step
        shapes.append(_line([(_LEFT + index * step + _BOX, level), (end, level)], _RED))
    for row, heaters in enumerate(rows):
        at = level + row * deep
        shapes.append(_line([(first - 0.5 * _GAP, level), (first - 0.5 * _GAP, at), (first, at)], _RED))
        for place, heater in enumerate(heaters):
            shapes += _box(first + place * step, at - 14, f"heater {heater}", "")
            if place:
                shapes.append(_line([(first + place * step - _GAP, at), (first + place * step, at)], _BLACK))
        shapes.append(_line([(first + len(heaters) * step - _GAP, at), (right, at), (right, back)], _BLACK))
    shapes.append(_line([(right, back), (driver + 100, back), (driver + 100, top + _HIGH)], _BLACK))
    shapes.append(_line([(driver + 30, top + _HIGH), (driver + 30, low)], _GREY))
    shapes.append(_words(driver + 36, low - 8, driver_inputs(design).partition(":")[0], "start"))
    for beside, across, colour in ((30, 14, _RED), (100, 30, _BLACK)):
        shapes.append(_line([(_LEFT + beside, top + _HIGH), (_LEFT + beside, low)], colour))
        shapes.append(_line([(_LEFT + _BOX, low + across), (driver, low + across)], colour))
    shapes += _box(_LEFT, low, "step-down converter", "for the controller")
    shapes += _box(driver, low, "controller", number.get("controller", "").partition("(")[2].rstrip(")"), 2 * deep - 30)
    shapes += _dividers(design, driver + _BOX, low)
    cools = design.values.get("cooling_current", 0.0) > 0.0
    key = " while it heats, return while it cools" if cools else ""
    body = "\n".join([*shapes, _words(_LEFT, 20, f"red: +{key}; black: return; grey: signals.", "start")])
    size = 'width="{0:g}" height="{1:g}" viewBox="0 0 {0:g} {1:g}"'.format(right + _LEFT, low + 2 * deep)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="sans-serif" font-size="12">\n'
        f'<rect width="100%" height="100%" fill="white"/>\n{body}\n</svg>\n'
    ).encode()


def _dividers(design: Design, left: float, low: float) -> list[str]:
    """Return a thermistor's divider, right of the controller: 3.3 V, resistor, input, thermistor, ground."""
    sensors = round(design.values.get("thermistor_count", 1.0))
    plural, each = ("s", f"{sensors} ADC inputs, a divider each") if sensors > 1 else ("", "ADC input")
    x, deep, middle, half = left + 60, _HIGH + 30, left + 60 + 0.5 * _BOX, 0.5 * _HIGH
    return [
        *_box(x, low, f"{sensors} resistor{plural}", DIVIDER),
        *_box(x, low + deep, f"{sensors} thermistor{plural}", "NTC 10 kohm"),
        _line([(left, low + half), (x, low + half)], _RED),
        _line([(middle, low + _HIGH), (middle, low + deep)], _GREY),
        _line([(left, low + _HIGH + 15), (middle, low + _HIGH + 15)], _GREY),
        _line([(left, low + deep + half), (x, low + deep + half)], _BLACK),
        _words(left + 30, low + half - 5, "3.3 V", "middle"),
        _words(middle + 8, low + _HIGH + 19, each, "start"),
        _words(left + 30, low + deep + half - 5, "ground", "middle"),
    ]


def _box(x: float, y: float, name: str, number: str, high: float = _HIGH) -> list[str]:
    middle = x + 0.5 * _BOX
    frame = f'<rect x="{x:g}" y="{y:g}" width="{_BOX}" height="{high:g}" fill="#f4f6f8" stroke="{_BLACK}"/>'
    lines = [text for text in (name, number) if text]
    first = y + 0.5 * high + 4 - 8 * (len(lines) - 1)
    return [frame, *(_words(middle, first + 16 * index, text, "middle") for index, text in enumerate(lines))]


def _words(x: float, y: float, text: str, anchor: str) -> str:
    return f'<text x="{x:g}" y="{y:g}" text-anchor="{anchor}">{escape(text)}</text>'


def _line(points: Sequence[tuple[float, float]], colour: str) -> str:
    path = " ".join(f"{x:g},{y:g}" for x, y in points)
    return f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"/>'
