"""One page of PDF with the lines, curves and letters of a drawing, its size and the widths of its lines true.

Coordinates are those of the drawing, to 0.0001 mm. Nothing in the file depends on the time.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import NoReturn

import numpy as np
from ezdxf.addons.drawing.backend import Backend, BkPath2d, BkPoints2d, ImageData
from ezdxf.addons.drawing.properties import BackendProperties
from ezdxf.math import Vec2
from ezdxf.path import Command
from numpy.typing import NDArray

_Places = NDArray[np.intp]
_POINTS = 72.0 / 25.4
"""In a millimetre."""
_DOT = 0.1
"""Diameter of what has no length [mm]."""
_COMPRESSION = 4
"""Of zlib: the usual 6 takes three times as long for a file a twentieth smaller."""
_HEADER = b"%PDF-1.4\n%\xac\xdc\xab\xba\n"


class PdfPage(Backend):
    """A sheet of a size [mm] that ezdxf draws on; `scale` is paper over drawing."""

    def __init__(self, size: tuple[float, float], scale: float) -> None:
        super().__init__()
        self._size = size
        self._scale = scale
        self._said: list[str] = []
        self._pen = self._ink = ""

    def bytes(self) -> bytes:
        """Return the page as a file."""
        width, height = (f"{length * _POINTS:.12g}" for length in self._size)
        factor = f"{self._scale * _POINTS:.10g}"
        drawn = "\n".join([f"{factor} 0 0 {factor} 0 0 cm 1 j", *self._said])
        content = zlib.compress(drawn.encode("ascii"), _COMPRESSION)
        return _file([
            b"<< /Type /Catalog /Pages 2 0 R >>",
            b"<< /Type /Pages /Kids [ 3 0 R ] /Count 1 >>",
            f"<< /Type /Page /Parent 2 0 R /Resources << >> "
            f"/MediaBox [ 0 0 {width} {height} ] /Contents 4 0 R >>".encode(),
            b"<< /Length %d /Filter /FlateDecode >>\nstream\n" % len(content) + content + b"\nendstream",
            b"<< /Creator (tvimdesign) /Producer (tvimdesign) >>",
        ])  # fmt: skip

    def set_background(self, color: str) -> None:
        """Do nothing: paper is white."""

    def draw_point(self, pos: Vec2, properties: BackendProperties) -> None:
        """Draw a dot."""
        self._fill_with(properties)
        side = _DOT / self._scale
        self._said.append(f"{pos.x - 0.5 * side:.4f} {pos.y - 0.5 * side:.4f} {side:.4f} {side:.4f} re f")

    def draw_line(self, start: Vec2, end: Vec2, properties: BackendProperties) -> None:
        """Draw one line."""
        self.draw_solid_lines([(start, end)], properties)

    def draw_solid_lines(self, lines: Iterable[tuple[Vec2, Vec2]], properties: BackendProperties) -> None:
        """Draw lines of one kind, such as the dashes of a hidden edge."""
        drawn = []
        for start, end in lines:
            if start.isclose(end):
                self.draw_point(start, properties)
            else:
                drawn.append(f"{_at(start)} m {_at(end)} l")
        if drawn:
            self._draw_with(properties)
            self._said += [*drawn, "S"]

    def draw_path(self, path: BkPath2d, properties: BackendProperties) -> None:
        """Draw a line with bends and curves."""
        if len(path):
            self._draw_with(properties)
            self._said += [self._along(path), "S"]

    def draw_filled_paths(self, paths: Iterable[BkPath2d], properties: BackendProperties) -> None:
        """Draw a letter: the sense in which an outline runs says whether it is filled, as fonts mean it."""
        outlines = [self._along(path) for path in paths if len(path)]
        if outlines:
            self._fill_with(properties)
            self._said += [*outlines, "f"]

    def draw_filled_polygon(self, points: BkPoints2d, properties: BackendProperties) -> None:
        """Draw an arrowhead, or what else has straight sides."""
        corners = [_at(point) for point in points.vertices()]
        if corners:
            self._fill_with(properties)
            self._said += [f"{corners[0]} m", *(f"{corner} l" for corner in corners[1:]), "f"]

    def draw_image(self, image_data: ImageData, properties: BackendProperties) -> NoReturn:
        """Return no drawing has one."""
        raise NotImplementedError("a drawing sheet has no images")

    def clear(self) -> None:
        """Take away all that is drawn."""
        self._said, self._pen, self._ink = [], "", ""

    def finalize(self) -> None:
        """Do nothing: all is drawn."""

    def _along(self, path: BkPath2d) -> str:
        """Return a path in the words of PDF, which has cubic curves only."""
        words, thirds, ends, middles = _words(tuple(path.command_codes()))
        corners = path.np_vertices()
        points = corners[ends]
        points[thirds] += 2.0 / 3.0 * (corners[middles] - points[thirds])
        return words % tuple(points.ravel().tolist())

    def _draw_with(self, properties: BackendProperties) -> None:
        pen = f"{properties.lineweight / self._scale:.4f} w {_colour(properties.color)} RG"
        if pen != self._pen:
            self._said.append(pen)
            self._pen = pen

    def _fill_with(self, properties: BackendProperties) -> None:
        ink = f"{_colour(properties.color)} rg"
        if ink != self._ink:
            self._said.append(ink)
            self._ink = ink


# Plain numbers: to look one up in an enumeration takes longer than to write a curve.
_LINE, _CURVE_OF_THREE, _CURVE, _GAP = (
    int(one) for one in (Command.LINE_TO, Command.CURVE3_TO, Command.CURVE4_TO, Command.MOVE_TO)
)
_VERTICES = {_LINE: 1, _CURVE_OF_THREE: 2, _CURVE: 3, _GAP: 1}
_OPERATOR = {_LINE: "l", _CURVE_OF_THREE: "c", _CURVE: "c", _GAP: "m"}


def _at(point: Vec2) -> str:
    return f"{point.x:.4f} {point.y:.4f}"


@lru_cache(maxsize=1024)
def _words(codes: tuple[int, ...]) -> tuple[str, _Places, _Places, _Places]:
    """Return words of a path of some steps, such as a letter, with a gap for every number, and where these come from.

    Each point is a corner of the path (the third result); those at the places of the second are moved two thirds of the
    way to another corner (the fourth), as the points of the cubic curve that is a quadratic one lie.
    """
    steps, ends, thirds, middles, place = ["%.4f %.4f m"], [0], list[int](), list[int](), 1
    for code in codes:
        taken = list(range(place, place + _VERTICES[code]))
        if code == _CURVE_OF_THREE:
            middle, end = taken
            thirds += [len(ends), len(ends) + 1]
            middles += [middle, middle]
            taken = [place - 1, end, end]
        place += _VERTICES[code]
        ends += taken
        steps.append(" ".join(["%.4f %.4f"] * len(taken) + [_OPERATOR[code]]))
    return "\n".join(steps), _places(thirds), _places(ends), _places(middles)


def _places(numbers: list[int]) -> _Places:
    return np.array(numbers, dtype=np.intp)


def _colour(name: str) -> str:
    """Return the red, green and blue of #rrggbb, from 0 to 1."""
    return " ".join(f"{int(name[start : start + 2], 16) / 255.0:.3g}" for start in (1, 3, 5))


def _file(objects: Sequence[bytes]) -> bytes:
    """Return a file of numbered objects, the first its root, the last its metadata."""
    written, places = bytearray(_HEADER), []
    for number, content in enumerate(objects, start=1):
        places.append(len(written))
        written += b"%d 0 obj\n" % number + content + b"\nendobj\n"
    start, count = len(written), len(objects) + 1
    written += b"xref\n0 %d\n0000000000 65535 f \n" % count
    for place in places:
        written += b"%010d 00000 n \n" % place
    written += b"trailer\n<< /Size %d /Root 1 0 R /Info %d 0 R >>\n" % (count, len(objects))
    written += b"startxref\n%d\n%%%%EOF\n" % start
    return bytes(written)
