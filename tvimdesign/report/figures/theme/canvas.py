"""Matplotlib without a display: an empty figure of the theme, axes placed in inches, and a figure as a file's bytes."""

from __future__ import annotations

import io
import textwrap
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from tvimdesign.report.figures.theme.style import NAME_STRIP, RESOLUTION, SETTINGS, SMALL, WIDTH

mpl.rcParams.update(SETTINGS)
_LONGEST_NAME = 110  # letters of a study's name on one line
_NO_DATE = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}
"""The same bytes from the same data."""
_COMPRESSION = 1
"""Of zlib, least: a third less time than its usual 6, and no more bytes."""
_NOT_NEEDED = ("GDEF", "GPOS", "GSUB", "kern", "MATH", "post")
"""Tables of a font for who sets text with it, and what its letters are called: OpenType 1.9, chapters 5 and 6."""


def new_figure(height: float, width: float = WIDTH) -> Figure:
    """An empty figure of a size in inches. Who draws places its axes: layouts take half of the drawing time."""
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    return figure


def place(figure: Figure, left: float, bottom: float, width: float, height: float, **more: Any) -> Axes:
    """Axes of a size in inches, at a place in inches from the lower left corner of the figure."""
    across, up = figure.get_size_inches()
    return figure.add_axes((left / across, bottom / up, width / across, height / up), **more)


def caption(figure: Figure, text: str) -> None:
    """A title of the whole figure, below the study's name."""
    up = figure.get_figheight()
    figure.text(0.01, 1.0 - (NAME_STRIP + 0.02) / up, text, va="top", ha="left", fontsize=8.5)


def sign(figure: Figure, study: str) -> None:
    """Write the study's name at the top of a figure."""
    up = figure.get_figheight()
    shown = textwrap.shorten(study, _LONGEST_NAME, placeholder=" …") or study[:_LONGEST_NAME]
    figure.text(0.01, 1.0 - 0.06 / up, shown, va="top", ha="left", fontsize=SMALL, color="0.35", parse_math=False)


def png(figure: Figure) -> bytes:
    """A figure of `new_figure` as a file. It has no transparent places: without them it is written in half the time."""
    canvas: Any = figure.canvas
    canvas.draw()
    stream = io.BytesIO()
    picture = Image.fromarray(np.asarray(canvas.buffer_rgba())[:, :, :3])
    picture.save(stream, format="png", compress_level=_COMPRESSION, dpi=(RESOLUTION, RESOLUTION))
    return stream.getvalue()


def as_file(figure: Figure, ending: str) -> bytes:
    """A figure as a file: `png`, or with lines and letters as such, `pdf` and `svg`."""
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

    def letters(*asked: Any, **options: Any) -> Any:
        font = usual(*asked, **options)
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
