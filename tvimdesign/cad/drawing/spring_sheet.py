"""Sheet and table for a spring maker: every number of the torsion springs with its tolerance."""

import csv
import io
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from math import atan2, cos, degrees, hypot, pi, radians, sin, tan

from tvimdesign import __version__
from tvimdesign.base.atomic_files import TABLE_ENCODING
from tvimdesign.base.errors import CatalogError
from tvimdesign.base.units import ZERO_CELSIUS
from tvimdesign.cad.drawing.drawing_sheet import SIZE, DrawingSheet, Field, issue_fields, ratio, sheet_number
from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.spring_solids import Coil, free_coil
from tvimdesign.device.components.tang import BONDED
from tvimdesign.study import Design, catalog_of

_N_MM = 1e3
_BEND = "coils to tang; under 1.5 d it may crack (Newcomb)"
_DIN = "DIN 2194 grade 2"
_REFERENCE = "reference"  # Tolerance of what follows from the others, and is not inspected: in brackets on the sheet
_SCALES = (10.0, 5.0, 2.0, 1.0, 0.5, 0.2)


@dataclass(frozen=True)
class SpringLine:
    """One line of the table."""

    name: str
    value: str
    unit: str = ""
    tolerance: str = ""
    note: str = ""


def spring_lines(design: Design, dims: Dimensions, titles: Mapping[str, str]) -> list[SpringLine]:
    """Return all numbers of the spring, free and loaded."""
    coil, tight = free_coil(dims), dims.spring_wound_diameter
    d, mean = coil.wire_diameter, coil.diameter
    spread, angle = 1e3 * design.value("coil_diameter_tolerance"), degrees(design.value("free_angle_tolerance"))
    rate = design.value("spring_rate") * _N_MM * radians(1.0)
    preload, full = degrees(dims.preload_angle), degrees(dims.spring_winding)
    material = design.choices["spring_material"]
    half = dims.count("spring_count") // 2
    return [
        *_from_stock(design, titles),
        SpringLine("wire", titles.get("spring_material", material), note=f"record {material}"),
        SpringLine("wire diameter d", _figure(d, 3), "mm", "of the wire's standard"),
        SpringLine("mean coil diameter D", _figure(mean), "mm", f"± {_figure(spread)}", _DIN),
        SpringLine("inside diameter", _figure(mean - d), "mm", _REFERENCE, "follows from D and d"),
        SpringLine("outside diameter", _figure(mean + d), "mm", _REFERENCE, "follows from D and d"),
        SpringLine("body coils n", _figure(coil.turns, 3), "", "by the free angle"),
        SpringLine("coils that bend", _figure(design.value("active_coils"), 3), "", _REFERENCE, "with the leg's share"),
        SpringLine("gap between coils", _figure(coil.pitch - d), "mm", "", "coils must not rub"),
        SpringLine("body length, free", _figure(coil.pitch * coil.turns + d), "mm", _REFERENCE),
        SpringLine("quantity for one module", f"{half} wound right, {half} wound left", "", "",
             "right: coils leave the eye clockwise"),
        SpringLine("leg, tangential", _figure(coil.leg_length), "mm", "± 0.5", "straight, square to the axis; assumed"),
        SpringLine("tang, parallel to the axis", _figure(coil.tang_length), "mm", "+ 0 / - 0.3", "assumed"),
        SpringLine("inside radius of the bend", _figure(coil.bend_radius - 0.5 * d), "mm", "+ 0.5 / - 0", _BEND),
        SpringLine("free angle", _figure(_free_angle(coil), 1), "deg", f"± {_figure(angle, 1)}",
             f"from tang to leg around the axis; {_DIN}"),
        SpringLine("rate", _figure(rate, 3), "N.mm/deg", _REFERENCE, "follows from d, D and the coils that bend"),
        SpringLine(f"torque M1 at {_figure(preload)} deg", _figure(rate * preload), "N.mm", _REFERENCE,
             "preload: the free angle is kept, not the torque"),
        SpringLine(f"torque M2 at {_figure(full)} deg", _figure(rate * full), "N.mm", _REFERENCE, "full stroke; as M1"),
        SpringLine("winds", "so that the coil gets smaller"),
        SpringLine("mean coil diameter at M2", _figure(tight), "mm", _REFERENCE),
        SpringLine("body length at M2", _figure(1e3 * design.value("spring_body_length")), "mm", _REFERENCE),
        SpringLine("winding mandrel", _figure(1e3 * design.value("winding_mandrel"), 1), "mm", "",
             "trial size: by its strength the wire springs back to D"),
        SpringLine("measuring mandrel, at most", _figure(2.0 * dims.post_radius), "mm", "",
             "the post the spring stands on"),
        SpringLine("stress at M2, inner fibre", _figure(1e-6 * design.value("spring_stress"), 0), "MPa"),
        SpringLine("tensile strength taken", _figure(1e-6 * design.value("spring_tensile_strength"), 0), "MPa"),
        _stress_relief(design),
        SpringLine("finish", "bright, oiled", "", "", _finish(design)),
        SpringLine("to be measured", "D and free angle", "", "", "of each, on such a mandrel; report the rate"),
        SpringLine("wire length", _figure(coil.wire_length, 1), "mm"),
        SpringLine("mass of one", _figure(1e3 * design.value("spring_volume") * design.value("spring_density")), "g"),
    ]  # fmt: skip


def _from_stock(design: Design, titles: Mapping[str, str]) -> list[SpringLine]:
    """Return what is bought from stock, before what is bent of it; nothing for a spring that is wound to order."""
    record = str(design.choices.get("stock_spring", "none"))
    if record == "none":
        return []
    name, _, details = titles.get("stock_spring", record).partition(", ")
    maker = f"{details.rpartition('(')[2].rstrip(')')}; " if details.endswith(")") else ""
    return [SpringLine("from stock", name, note=f"{maker}cut one leg, bend the other one down")]


def _stress_relief(design: Design) -> SpringLine:
    """Return how the coiled spring is heated, as the record of its wire has it."""
    note = "the free angle is that after it"
    with suppress(CatalogError):
        wire = catalog_of(design).record("spring_materials", str(design.choices["spring_material"]))
        heat, minutes = wire.entry("stress_relief_temperature"), wire.value("stress_relief_time") / 60.0
        low, high = (temperature - ZERO_CELSIUS for temperature in (heat.low or heat.value, heat.high or heat.value))
        warm = f"{low:.0f}" if high - low < 0.5 else f"{low:.0f} to {high:.0f}"
        maker = heat.source.split(",")[0]
        return SpringLine("stress relief after coiling", f"{warm} °C, {minutes:.0f} min", "", "", f"{note}; {maker}")
    return SpringLine("stress relief after coiling", "as for this wire", "", "", note)


def _finish(design: Design) -> str:
    """Return what the surface is for."""
    return "tang degreased: it is bonded" if design.choices.get("tang_hold") == BONDED else "no plating on the tang"


def _free_angle(coil: Coil) -> float:
    """Return the azimuth of the coils' end seen from their start [deg], whole turns left out."""
    return 360.0 * (coil.turns % 1.0)


def spring_csv(lines: Sequence[SpringLine]) -> bytes:
    """Return the table as CSV."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["name", "value", "unit", "tolerance", "note"])
    writer.writerows([line.name, line.value, line.unit, line.tolerance, line.note] for line in lines)
    return stream.getvalue().encode(TABLE_ENCODING)


def spring_sheet(design: Design, dims: Dimensions, lines: Sequence[SpringLine]) -> DrawingSheet:
    """Return the right-hand spring, free, drawn in simple lines, beside the table."""
    coil = free_coil(dims)
    reach = 0.5 * coil.diameter + coil.bend_radius + 0.5 * coil.wire_diameter
    height = coil.end_level + coil.tang_length + coil.wire_diameter
    room = min(150.0 / (reach + max(coil.leg_length, reach)), 165.0 / (2.0 * reach + height))
    scale = next((candidate for candidate in _SCALES if candidate <= room), _SCALES[-1])
    sheet = DrawingSheet(scale)
    across = 100.0 - 0.5 * (max(coil.leg_length, reach) - reach) * scale
    plan_at = (across, 45.0 + reach * scale)
    _plan(sheet, coil, plan_at)
    _side(sheet, coil, (across, plan_at[1] + (reach + coil.tang_length) * scale + 26.0))
    sheet.text("right-hand spring, free, at 20 °C; the left-hand one is its mirror image", (20.0, 16.0))
    for index, line in enumerate((SpringLine("", "", "", "tolerance", ""), *lines)):
        y = SIZE[1] - 18.0 - 6.2 * index
        value = f"({line.value})" if line.tolerance == _REFERENCE else line.value
        for x, text in ((202.0, line.name), (252.0, f"{value} {line.unit}"), (302.0, line.tolerance)):
            sheet.text(text, (x, y), 2.3)
        sheet.text(line.note, (340.0, y), 1.8)
    sheet.title_block(
        "torsion spring",
        [
            issue_fields("Ordered by", sheet_number("torsion_spring", map(repr, lines))),
            [Field("Made by", f"tvimdesign {__version__}"), Field("Size, projection", "A3, first angle")],
            [Field("Module", design.name, 0.6), Field("Scale", ratio(scale), 0.4)],
        ],
    )
    return sheet


def _plan(sheet: DrawingSheet, coil: Coil, origin: tuple[float, float]) -> None:
    """Draw the spring seen along its axis from the leg's side, turned so that the leg points to the right."""
    x, y = sheet.at(origin)
    space, outline, dimension = sheet.space, {"layer": "OUTLINE"}, {"layer": "DIMENSION"}
    half, radius = 0.5 * coil.wire_diameter, 0.5 * coil.diameter
    for other in (radius - half, radius + half):
        space.add_circle((x, y), other, dxfattribs=outline)
    tang, begin = _turned(coil, *coil.tang_position), _coil_start(coil)
    space.add_circle((x + tang[0], y + tang[1]), half, dxfattribs=outline)
    for beside in (-half / radius, half / radius):
        shift = (beside * begin[0], beside * begin[1])
        first, last = ((x + at[0] + shift[0], y + at[1] + shift[1]) for at in (begin, tang))
        space.add_line(first, last, dxfattribs=outline)
    low, high, far = y - radius - half, y - radius + half, x + coil.leg_length
    space.add_lwpolyline([(x, low), (far, low), (far, high), (x, high)], close=True, dxfattribs=outline)
    for end in (begin, (0.0, -radius)):
        space.add_line((x, y), (x + end[0], y + end[1]), dxfattribs={"layer": "CENTRE"})
    space.add_linear_dim(
        (x, low - 8.0 / sheet.scale), (x, low), (far, low), dimstyle="SHEET", dxfattribs=dimension
    ).render()
    if 1.0 < _free_angle(coil) < 359.0:
        space.add_angular_dim_cra(
            (x, y), radius + half, degrees(atan2(begin[1], begin[0])), -90.0, distance=7.0 / sheet.scale,
            dimstyle="SHEET", dxfattribs=dimension,
        ).render()  # fmt: skip


def _side(sheet: DrawingSheet, coil: Coil, origin: tuple[float, float]) -> None:
    """Draw the body from the side, its coils as slanting lines, the leg to the right and the tang below."""
    x, y = sheet.at(origin)
    space, outline, dimension = sheet.space, {"layer": "OUTLINE"}, {"layer": "DIMENSION"}
    half, radius, away = 0.5 * coil.wire_diameter, 0.5 * coil.diameter, 8.0 / sheet.scale
    bottom, top = y + coil.start_level - half, y + coil.end_level + half
    left, right = x - radius - half, x + radius + half
    space.add_lwpolyline([(left, bottom), (right, bottom), (right, top), (left, top)], close=True, dxfattribs=outline)
    level = bottom + coil.pitch
    while level < top:
        space.add_line((left, level - 0.5 * coil.pitch), (right, level), dxfattribs={"layer": "FINE"})
        level += coil.pitch
    rise = coil.leg_length * tan(coil.rise)
    far = (x + coil.leg_length, top + rise)
    leg = [(right, top), far, (far[0], far[1] - 2.0 * half), (right, top - 2.0 * half)]
    space.add_lwpolyline(leg, dxfattribs=outline)
    begin, tang, low = x + _coil_start(coil)[0], x + _turned(coil, *coil.tang_position)[0], y - coil.tang_length
    reach = tang - begin
    for beside in (-half, half):
        edge = []
        for angle in (0.05 * pi * step for step in range(11)):
            along, down = reach * cos(angle), coil.bend_radius * sin(angle)
            across = beside / hypot(along, down) if along or down else 0.0
            edge.append(
                (begin + reach * sin(angle) + across * down, y + coil.bend_radius * cos(angle) + across * along)
            )
        space.add_lwpolyline([*edge, (tang + beside, low)], dxfattribs=outline)
    space.add_line((tang - half, low), (tang + half, low), dxfattribs=outline)
    space.add_line((x, low), (x, top + 0.4 * away), dxfattribs={"layer": "CENTRE"})
    for index, (inset, label) in enumerate(((2.0 * half, "(inside ⌀<>)"), (half, "D <>"), (0.0, "(outside ⌀<>)"))):
        space.add_linear_dim(
            (x, far[1] + (index + 1) * away), (left + inset, top), (right - inset, top), text=label, dimstyle="SHEET",
            dxfattribs=dimension,
        ).render()  # fmt: skip
    for base, from_low, to_high, shown in ((left - away, bottom, top, "(<>)"), (left - 2.0 * away, low, y, "<>")):
        space.add_linear_dim(
            (base, y), (left if from_low == bottom else tang - half, from_low), (left, to_high), angle=90,
            text=shown, dimstyle="SHEET", dxfattribs=dimension,
        ).render()  # fmt: skip


def _coil_start(coil: Coil) -> tuple[float, float]:
    """Return where the coils start, above the bend, as `_turned` sees it."""
    radius, azimuth = 0.5 * coil.diameter, coil.start_azimuth
    return _turned(coil, radius * cos(azimuth), radius * sin(azimuth))


def _turned(coil: Coil, x: float, y: float) -> tuple[float, float]:
    """Return a point seen from above, the spring turned so that its leg points to the right."""
    cosine, sine = cos(coil.leg_azimuth), sin(coil.leg_azimuth)
    return x * cosine + y * sine, y * cosine - x * sine


def _figure(value: float, digits: int = 2) -> str:
    return f"{value:.{digits}f}".rstrip("0").rstrip(".") if digits else f"{value:.0f}"
