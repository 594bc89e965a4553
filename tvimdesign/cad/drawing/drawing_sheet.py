"""A drawing sheet: A3 or A2 with frame, title block and dimension style, geometry at its true size, as DXF and PDF."""

import io
import random
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from decimal import ROUND_HALF_UP, Decimal
from functools import cache
from hashlib import sha256
from itertools import pairwise
from math import inf
from pathlib import Path
from typing import Any

import ezdxf
import matplotlib
from ezdxf.addons.drawing.backend import BkPath2d, BkPoints2d
from ezdxf.addons.drawing.config import BackgroundPolicy, ColorPolicy, Configuration, LineweightPolicy
from ezdxf.addons.drawing.frontend import Frontend
from ezdxf.addons.drawing.matplotlib import MatplotlibBackend
from ezdxf.addons.drawing.properties import BackendProperties, RenderContext
from ezdxf.document import Drawing
from ezdxf.enums import TextEntityAlignment
from ezdxf.fonts import fonts
from ezdxf.math import Vec2
from ezdxf.npshapes import to_matplotlib_path
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline
from typing_extensions import override

_HUNDREDTH = Decimal("0.01")
_POINTS = 72.0 / 25.4  # In a millimetre
_LISTED = 4  # Azimuths that are listed; of more that are evenly apart the ends are listed


def figure(value: float) -> str:
    """Return a length or an angle with at most two decimals, a half rounded up: every text of a drawing rounds here.

    A micrometre is settled first: 23.155 read off two faces is 23.16 in both places.
    """
    settled = Decimal(f"{value:.4f}").quantize(_HUNDREDTH, ROUND_HALF_UP)
    return f"{settled:f}".rstrip("0").rstrip(".") if settled else "0"


def around(azimuths: Sequence[float]) -> str:
    """Return azimuths [deg] in ascending order: all around evenly, or the first few and how often they come again."""
    if len(azimuths) == 1:
        return f"at {figure(azimuths[0])}°"
    steps = [later - earlier for earlier, later in pairwise([*azimuths, azimuths[0] + 360.0])]
    if _even(steps):
        return f"every {figure(360.0 / len(azimuths))}° from {figure(azimuths[0])}°"
    few = next(
        few
        for few in range(1, len(steps) + 1)
        if len(steps) % few == 0 and all(_even(steps[start::few]) for start in range(few))
    )
    # The pattern begins behind the widest step.
    start = (max(range(few), key=lambda index: steps[index]) + 1) % few
    first = azimuths[start : start + few] if start + few <= len(azimuths) else azimuths
    again = f", {len(steps) // few} times around" if few < len(steps) else ""
    if few > _LISTED and _even([later - earlier for earlier, later in pairwise(first)]):
        apart = figure(first[1] - first[0])
        return f"from {figure(first[0])}° every {apart}° to {figure(first[-1])}°{again}"
    return f"at {', '.join(f'{figure(azimuth)}°' for azimuth in first)}{again}"


def _even(steps: Sequence[float]) -> bool:
    return max(steps) - min(steps) < 0.01


REVISION = "A"
"""Of every sheet: what is drawn again in another shape has another number, and no later revision of this one."""
_DIGITS = 8
_RELEASED = "of approval"  # A sheet has no date of its own: the same design gives the same bytes on any day


def sheet_number(kind: str, contents: Iterable[str]) -> str:
    """Return the kind of part, and a mark of all that its sheet shows."""
    mark = sha256("\n".join(contents).encode()).hexdigest()[:_DIGITS]
    return f"{kind.replace('_', '-')}-{mark}"


def issue_fields(signed: str, number: str) -> "list[Field]":
    """Return the row of the title block that identifies the sheet.

    `signed` is the label of the field left for a name.
    """
    return [
        Field(signed, "", 0.24), Field("Number", number, 0.4), Field("Revision", REVISION, 0.12),
        Field("Date", _RELEASED, 0.24),
    ]  # fmt: skip


Point = tuple[float, float]
SIZE = (420.0, 297.0)  # A3, landscape [mm]
SIZES = {"A3": SIZE, "A2": (594.0, 420.0)}  # Sheets by ISO 216, landscape [mm]
_FONT = "DejaVuSans.ttf"  # Comes with matplotlib, so that a drawing looks the same on every machine
_LAYERS = {"OUTLINE": 50, "FINE": 25, "HATCH": 18, "CENTRE": 18, "HIDDEN": 18, "DIMENSION": 25, "TEXT": 25, "FRAME": 50}
"""Line widths by layer, 1/100 mm."""
_DASHES = {"CENTRE": [6.5, 5.0, -0.6, 0.3, -0.6], "HIDDEN": [2.7, 2.1, -0.6]}
"""Line types by layer, in mm on paper: their whole length, then lines (above zero) and gaps (below). ISO 128-2 has gaps
of three widths of the line; lines are shortened to what a small part has room for."""
TITLE_WIDTH, MARGIN = 180.0, 10.0  # Of the title block, and around the frame [mm]
TITLE_ROW = 8.0
_TEXT = 2.5  # Height of letters and figures on paper [mm]


@dataclass(frozen=True)
class Field:
    """One field of the title block."""

    label: str
    text: str
    share: float = 0.5  # Of the block's width


def _within(text: str, room: float, width: Callable[[str], float]) -> list[str]:
    """Return a text in lines whose width is at most some room."""
    lines = [""]
    for word in text.split():
        longer = f"{lines[-1]} {word}".lstrip()
        lines = [*lines[:-1], longer] if not lines[-1] or width(longer) <= room else [*lines, word]
    return lines


class DrawingSheet:
    """A sheet at a scale. Places are in mm on paper; geometry keeps its size, and the frame is scaled."""

    def __init__(self, scale: float, form: str = "A3") -> None:
        """`scale` is paper over part: 2 for 2:1; `form` is a name of `SIZES`."""
        self.scale = scale
        self.form, self.size = form, SIZES[form]
        _use_own_font()
        with undated():
            self.document = ezdxf.new("R2010")
        self.document.header["$INSUNITS"] = 4
        self.document.header["$MEASUREMENT"] = 1
        self.document.header["$LTSCALE"] = 1.0 / scale
        self.space = self.document.modelspace()
        self.document.styles.add("SHEET", font=_FONT)
        for name, pattern in _DASHES.items():
            self.document.linetypes.add(name, pattern)
        for name, width in _LAYERS.items():
            self.document.layers.add(name, lineweight=width, linetype=name if name in _DASHES else "CONTINUOUS")
        style = self.document.dimstyles.new("SHEET").dxf
        unit = 1.0 / self.scale
        sizes = {"dimtxt": _TEXT, "dimasz": 2.5, "dimexe": 1.0, "dimexo": 0.8, "dimgap": 0.8, "dimcen": 0.0}
        for name, value in sizes.items():
            setattr(style, name, value * unit)
        # Lengths as measured, a point before the decimals, no zeros at their end; text above its line.
        settings = {"dimlfac": 1.0, "dimdec": 2, "dimdsep": 46, "dimzin": 8, "dimtad": 1, "dimtih": 0, "dimtoh": 0,
                    "dimtxsty": "SHEET", "dimblk": "", "dimlunit": 2, "dimadec": 1, "dimtmove": 1}  # fmt: skip
        for name, setting in settings.items():
            setattr(style, name, setting)
        right, top = self.size[0] - MARGIN, self.size[1] - MARGIN
        self.lines([(MARGIN, MARGIN), (right, MARGIN), (right, top), (MARGIN, top), (MARGIN, MARGIN)], "FRAME")

    def at(self, point: Point) -> Point:
        """Return where a place on paper is in the drawing's own coordinates."""
        return point[0] / self.scale, point[1] / self.scale

    def lines(self, points: Sequence[Point], layer: str) -> None:
        """Draw straight lines between places on paper."""
        self.space.add_lwpolyline([self.at(point) for point in points], dxfattribs={"layer": layer})

    def text(self, text: str, at: Point, height: float = _TEXT, align: str = "BOTTOM_LEFT", room: float = inf) -> None:
        """Write one line of text at a place on paper, its letters narrowed where it is longer than its `room` [mm]."""
        entity = self.space.add_text(text, height=height / self.scale, dxfattribs={"layer": "TEXT", "style": "SHEET"})
        if room < inf and (length := fonts.make_font(_FONT, height).text_width(text)) > room:
            entity.dxf.width = room / length
        entity.set_placement(self.at(at), align=TextEntityAlignment[align])

    def cut_short(self, text: str, room: float, height: float = _TEXT) -> str:
        """Return as many words of a text as a line has room for [mm], and a mark where that is not all of it."""
        first, *more = _within(text, room - height, fonts.make_font(_FONT, height).text_width)
        return f"{first.rstrip(',;:')} …" if more else first

    def column(self, lines: Sequence[str], at: Point, pitch: float = 4.6, height: float = _TEXT) -> None:
        """Write texts below one another, the first below a place on paper, each within the width of the title block."""
        width = fonts.make_font(_FONT, height).text_width
        for index, line in enumerate(line for text in lines for line in _within(text, TITLE_WIDTH, width)):
            self.text(line, (at[0], at[1] - (index + 1) * pitch), height)

    def title_block(self, title: str, rows: Sequence[Sequence[Field]]) -> None:
        """Draw the title block in the lower right corner: a title, and rows of fields from the bottom up."""
        left, bottom = self.size[0] - MARGIN - TITLE_WIDTH, MARGIN
        top = bottom + TITLE_ROW * len(rows) + 1.5 * TITLE_ROW
        self.lines([(left, bottom), (left, top), (left + TITLE_WIDTH, top)], "FRAME")
        for index, row in enumerate(rows):
            level = bottom + TITLE_ROW * (index + 1)
            self.lines([(left, level), (left + TITLE_WIDTH, level)], "FINE")
            x = left
            for field in row:
                if x > left:
                    self.lines([(x, level - TITLE_ROW), (x, level)], "FINE")
                self.text(field.label, (x + 1.5, level - 0.8), 1.6, "TOP_LEFT")
                self.text(field.text, (x + 1.5, level - TITLE_ROW + 1.4), room=field.share * TITLE_WIDTH - 3.0)
                x += field.share * TITLE_WIDTH
        self.text(title, (left + 3.0, top - 1.0 * TITLE_ROW), 5.0)
        self._first_angle((left + TITLE_WIDTH - 28.0, top - 0.75 * TITLE_ROW))

    def _first_angle(self, at: Point) -> None:
        """Draw the symbol of first-angle projection, ISO 5456-2: a cone, and to its right its view from the left."""
        x, y = at
        self.lines([(x, y - 2), (x, y + 2), (x + 9, y + 4), (x + 9, y - 4), (x, y - 2)], "FINE")
        self.lines([(x - 2, y), (x + 11, y)], "CENTRE")
        for radius in (2.0, 4.0):
            self.space.add_circle(self.at((x + 18, y)), radius / self.scale, dxfattribs={"layer": "FINE"})
        self.lines([(x + 12.5, y), (x + 23.5, y)], "CENTRE")
        self.lines([(x + 18, y - 5.5), (x + 18, y + 5.5)], "CENTRE")

    def dxf(self) -> bytes:
        """Return the sheet as DXF."""
        return dxf_bytes(self.document)

    def pdf(self) -> bytes:
        """Return the sheet as PDF in its true size."""
        look = Configuration(
            background_policy=BackgroundPolicy.WHITE, color_policy=ColorPolicy.BLACK,
            lineweight_policy=LineweightPolicy.ABSOLUTE, lineweight_scaling=_POINTS, min_lineweight=0.0,
        )  # fmt: skip
        paper = Figure((self.size[0] / 25.4, self.size[1] / 25.4))
        axes = paper.add_axes((0.0, 0.0, 1.0, 1.0))
        page = _Strokes(axes, adjust_figure=False)
        with _fixed_chance():
            Frontend(RenderContext(self.document), page, config=look).draw_layout(self.space, finalize=True)
        axes.set(xlim=(0.0, self.size[0] / self.scale), ylim=(0.0, self.size[1] / self.scale))
        stream = io.BytesIO()
        paper.savefig(stream, format="pdf", metadata={"Creator": "tvimdesign", "CreationDate": None})
        return stream.getvalue()


def dxf_bytes(document: Drawing) -> bytes:
    """Return a drawing as DXF, the same bytes for the same drawing."""
    stream = io.StringIO()
    # ezdxf writes the classes of a drawing in the order of a set; those that are there already keep their places.
    for name in sorted(document.entitydb.dxf_types_in_use()):
        document.classes.add_class(name)
    with undated():
        document.write(stream)
    return stream.getvalue().encode(document.output_encoding)


class _Strokes(MatplotlibBackend):
    """Draw all lines of one width as one outline: ten times as fast as an artist for each."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._lines: dict[float, list[Outline]] = defaultdict(list)
        self._filled: list[Outline] = []

    def draw_line(self, start: Vec2, end: Vec2, properties: BackendProperties) -> None:
        """Draw one line."""
        self.draw_solid_lines([(start, end)], properties)

    def draw_solid_lines(self, lines: Iterable[tuple[Vec2, Vec2]], properties: BackendProperties) -> None:
        """Draw lines of one kind, such as the dashes of a hidden edge."""
        for start, end in lines:
            if start.isclose(end):
                self.draw_point(start, properties)
            else:
                self._lines[self.get_lineweight(properties)].append(Outline([(start.x, start.y), (end.x, end.y)]))

    def draw_path(self, path: BkPath2d, properties: BackendProperties) -> None:
        """Draw a line with bends and curves."""
        if len(path):
            self._lines[self.get_lineweight(properties)].append(to_matplotlib_path([path]))

    @override
    def draw_filled_paths(self, paths: Iterable[BkPath2d], properties: BackendProperties) -> None:
        """Draw a letter: the sense in which an outline runs says whether it is filled, as fonts mean it."""
        self._filled += [to_matplotlib_path([path]) for path in paths if len(path)]

    @override
    def draw_filled_polygon(self, points: BkPoints2d, properties: BackendProperties) -> None:
        """Draw an arrowhead, or what else has straight sides."""
        self._filled.append(Outline([(point.x, point.y) for point in points.vertices()]))

    def finalize(self) -> None:
        """Put the outlines on the page."""
        looks = [(paths, {"fill": False, "linewidth": width}) for width, paths in self._lines.items()]
        for paths, look in [*looks, (self._filled, {"linewidth": 0.0})]:
            if paths:
                outline = Outline.make_compound_path(*paths)
                outline.should_simplify = False
                self.ax.add_artist(PathPatch(outline, color="black", joinstyle="round", **look))


def ratio(scale: float) -> str:
    """Return a scale as it is written on a drawing."""
    return f"{scale:g}:1" if scale >= 1.0 else f"1:{1.0 / scale:g}"


@contextmanager
def undated() -> Iterator[None]:
    """Leave the time of writing and random numbers out of a DXF file."""
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before


@contextmanager
def _fixed_chance() -> Iterator[None]:
    """Yield hatching is moved by a random hair, to miss corners; let it be the same hair every time."""
    before = random.getstate()
    random.seed(0)
    try:
        yield
    finally:
        random.setstate(before)


@cache
def _use_own_font() -> None:
    """Let drawings use the one font that is there on every machine, whatever else is installed."""
    folder = Path(matplotlib.get_data_path()) / "fonts" / "ttf"
    fonts.font_manager.clear()
    fonts.font_manager.scan_folder(folder)
