"""The theme of every figure: sizes of a journal's page, colours that print in grey, line styles, fonts.

The colours are those of M. Okabe and K. Ito (2008), which colour-blind readers tell apart. They stand in an order in
which neighbours also differ in grey, and every series has a line style as a second cue.
"""

from __future__ import annotations

from typing import Any

WIDTH = 7.1  # inches: two columns of a journal's page
RESOLUTION = 300  # dots per inch of a PNG file
SMALL = 6.5  # points
NAME_STRIP = 0.22  # inches at the top of every figure, where the study's name stands

COLOURS = ("#0072B2", "#E69F00", "#009E73", "#56B4E9", "#000000", "#CC79A7")
BROKEN = "#D55E00"
"""The colour of a limit that does not hold; no series has it."""
FAINT = "#BBBBBB"
LINE_STYLES: tuple[Any, ...] = ("-", (0, (4, 1.5)), "-.", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 3)))
ASIDE: tuple[Any, ...] = ((0, (1, 1)), (0, (2, 1)), (0, (3, 1, 1, 1)), (0, (1, 2)))
"""Line styles of simpler models that stand beside the full one; no series has them."""
MARKERS = "osD^vP"
HATCHES = ("", "////", "....", "\\\\\\\\", "xxxx", "----", "++++")
SEQUENCE = "cividis"
"""Colour map whose grey rises steadily, for what has an order."""
BAND: dict[str, Any] = {"alpha": 0.15, "color": COLOURS[1], "linewidth": 0.0}
LIMIT: dict[str, Any] = {"color": "black", "linewidth": 0.7, "linestyle": (0, (1, 2))}

SETTINGS: Any = {
    "figure.dpi": RESOLUTION,
    "font.size": 7.5,
    "axes.labelsize": 7.0,
    "xtick.labelsize": SMALL,
    "ytick.labelsize": SMALL,
    "legend.fontsize": SMALL,
    "legend.frameon": False,
    "legend.handlelength": 2.6,
    "legend.columnspacing": 1.4,
    "legend.borderaxespad": 0.2,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 1.2,
    "lines.markersize": 4.0,
    "hatch.linewidth": 0.5,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "grid.linewidth": 0.5,
    "text.hinting": "none",  # a tenth of the drawing
    "pdf.fonttype": 42,  # letters stay letters: journals refuse fonts of type 3
    "svg.fonttype": "path",  # the same look wherever it is opened
    "svg.hashsalt": "tvimdesign",  # the same bytes from the same data
}
"""What matplotlib is set to."""


def style_of(number: int) -> dict[str, Any]:
    """Colour and line style of a series, by its number from 0."""
    return {"color": COLOURS[number % len(COLOURS)], "linestyle": LINE_STYLES[number % len(LINE_STYLES)]}


def luminance(colour: str) -> float:
    """How light a colour `#rrggbb` prints in grey, from 0 to 1 (ITU-R BT.601)."""
    red, green, blue = (int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5))
    return 0.299 * red + 0.587 * green + 0.114 * blue
