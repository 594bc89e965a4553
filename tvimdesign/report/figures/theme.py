"""The look of all figures: colours and sizes, axes, and the canvas in inches."""

import io
import math
import textwrap
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator, NullLocator
from PIL import Image

from tvimdesign.base.record import own_data

WIDTH = 7.1  # inches: two columns of a journal's page
RESOLUTION = 300  # dots per inch of a PNG file, as in theme.yaml
SMALL = 6.5  # points, as in theme.yaml
NAME_STRIP = 0.22  # inches at the top of every figure, where the study's name stands

COLOURS = ("#0072B2", "#E69F00", "#009E73", "#56B4E9", "#000000", "#CC79A7")
BROKEN = "#D55E00"  # The colour of a limit that does not hold; no series has it
FAINT = "#BBBBBB"
LINE_STYLES: tuple[Any, ...] = ("-", (0, (4, 1.5)), "-.", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 3)))
ASIDE: tuple[Any, ...] = ((0, (1, 1)), (0, (2, 1)), (0, (3, 1, 1, 1)), (0, (1, 2)))
"""Line styles of simpler models that stand beside the full one; no series has them."""
MARKERS = "osD^vP"
HATCHES = ("", "////", "....", "\\\\\\\\", "xxxx", "----", "++++")
SEQUENCE = "cividis"  # Colour map whose grey rises steadily, for what has an order
BAND: dict[str, Any] = {"alpha": 0.15, "color": COLOURS[1], "linewidth": 0.0}
LIMIT: dict[str, Any] = {"color": "black", "linewidth": 0.7, "linestyle": (0, (1, 2))}


SETTINGS: Any = own_data(__file__, "theme.yaml")  # Of matplotlib


def style_of(number: int) -> dict[str, Any]:
    """Colour and line style of a series, by its number from 0."""
    return {"color": COLOURS[number % len(COLOURS)], "linestyle": LINE_STYLES[number % len(LINE_STYLES)]}


TICKS = 6  # Steps of an axis at most: every tick, with its line and label, takes a millisecond to draw
_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def log_ticks(axis: Any) -> None:
    """Set few plain numbers as ticks of a logarithmic axis, at least two whatever it spans, none between them."""
    low, high = sorted(axis.get_view_interval())
    inside = [value for value in _log_values(low, high) if low <= value <= high]
    if len(inside) < 2:
        inside = [value for value in MaxNLocator(4).tick_values(low, high) if low <= value <= high]
    axis.set_major_locator(FixedLocator(inside))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: plain(value)))


def _log_values(low: float, high: float) -> list[float]:
    """Return powers of ten, with their doubles and fives where the axis spans less than three of them."""
    decades = math.log10(high / low)
    steps = (1.0, 2.0, 5.0) if decades < 2.5 else (1.0,)
    every = max(1, math.ceil(decades / TICKS))
    first = every * math.floor(math.log10(low) / every)
    return [step * 10.0**power for power in range(first, math.ceil(math.log10(high)) + 1, every) for step in steps]


def plain(value: float) -> str:
    """Return a tick's number for people: 0.5, 200, 10⁶."""
    if value == 0.0 or 1e-3 <= abs(value) < 1e5:
        return f"{value:.6g}"
    mantissa, _, power = f"{value:.3e}".partition("e")
    raised = "10" + str(int(power)).translate(_RAISED)
    return raised if float(mantissa) == 1.0 else f"{float(mantissa):g}·{raised}"


def heading(axes: Any, text: str) -> None:
    """Draw a title above the axes; matplotlib's own measures every label to find its place."""
    axes.annotate(text, (0.0, 1.0), (0.0, 4.0), xycoords="axes fraction", textcoords="offset points", fontsize=7.5)


def legend_above(axes: Any, columns: int) -> None:
    """Draw the legend above the axes, where it covers nothing."""
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns)


mpl.rcParams.update(SETTINGS)
_LONGEST_NAME = 110  # letters of a study's name on one line
_NO_DATE = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}  # Equal data then give equal bytes
_COMPRESSION = 1  # Of zlib, least: a third less time than its usual 6, and no more bytes
_NOT_NEEDED = ("GDEF", "GPOS", "GSUB", "kern", "MATH", "post")
"""Tables of a font for who sets text with it, and what its letters are called: OpenType 1.9, chapters 5 and 6."""


def new_figure(height: float, width: float = WIDTH) -> Figure:
    """Return an empty figure of a size in inches. Who draws places its axes: layouts take half of the drawing time."""
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    return figure


def place(figure: Figure, left: float, bottom: float, width: float, height: float, **more: Any) -> Axes:
    """Place axes of a size in inches, at a place in inches from the lower left corner of the figure."""
    across, up = figure.get_size_inches()
    return figure.add_axes((left / across, bottom / up, width / across, height / up), **more)


def in_rows(
    panels: Sequence[Any], across: int, left: float, gap: float, row: float = 0.0
) -> Iterator[tuple[Any, float, float, float]]:
    """Yield panels side by side in rows, the first above: left end, height above the lowest row, width [inches]."""
    wide, down = (WIDTH - left - 0.15 - gap * (across - 1)) / across, -(-len(panels) // across)
    for i, panel in enumerate(panels):
        yield panel, left + (i % across) * (wide + gap), row * (down - 1 - i // across), wide


def caption(figure: Figure, text: str) -> None:
    """Draw a title of the whole figure, below the study's name."""
    up = figure.get_figheight()
    figure.text(0.01, 1.0 - (NAME_STRIP + 0.02) / up, text, va="top", ha="left", fontsize=8.5)


def sign(figure: Figure, study: str) -> None:
    """Write the study's name at the top of a figure."""
    up = figure.get_figheight()
    shown = textwrap.shorten(study, _LONGEST_NAME, placeholder=" …") or study[:_LONGEST_NAME]
    figure.text(0.01, 1.0 - 0.06 / up, shown, va="top", ha="left", fontsize=SMALL, color="0.35", parse_math=False)


def png(figure: Figure) -> bytes:
    """Render a figure of `new_figure` as a PNG file. Without transparent places it is written in half the time."""
    canvas: Any = figure.canvas
    canvas.draw()
    stream = io.BytesIO()
    picture = Image.fromarray(np.asarray(canvas.buffer_rgba())[:, :, :3])
    picture.save(stream, format="png", compress_level=_COMPRESSION, dpi=(RESOLUTION, RESOLUTION))
    return stream.getvalue()


def as_file(figure: Figure, ending: str) -> bytes:
    """Return a figure as a file: `png`, or with lines and letters as such, `pdf` and `svg`."""
    if ending == "png":
        return png(figure)
    stream = io.BytesIO()
    with _letters_alone():
        figure.savefig(stream, format=ending, metadata=_NO_DATE[ending])
    return stream.getvalue()


@contextmanager
def _letters_alone() -> Iterator[None]:
    """Let fonts be cut without what sets text or names letters: a PDF places each letter itself, by its number.

    To read and to cut these tables takes as long as the rest of a PDF.
    """
    from fontTools import subset

    usual = subset.load_font

    def letters(*arguments: Any, **options: Any) -> Any:
        font = usual(*arguments, **options)
        font.setGlyphOrder([f"glyph{number}" for number in range(font["maxp"].numGlyphs)])
        for table in _NOT_NEEDED:
            if table in font:
                del font[table]
        return font

    subset.load_font = letters
    try:
        yield
    finally:
        subset.load_font = usual
