"""PNG files of our own: Pillow reads back the same points, at the same resolution."""

from __future__ import annotations

import io

import numpy as np
import pytest
from PIL import Image

from tvimdesign.base.png import png_bytes


@pytest.mark.parametrize("shape", [(1, 1), (7, 5), (40, 301)])
def test_points_are_read_back(shape: tuple[int, int]) -> None:
    points = np.random.default_rng(2).integers(0, 256, (*shape, 3), dtype=np.uint8)
    read = Image.open(io.BytesIO(png_bytes(points)))
    assert read.mode == "RGB"
    assert np.array_equal(np.asarray(read), points)
    assert "dpi" not in read.info


def test_upside_down_points_that_lie_apart_and_a_resolution() -> None:
    points = np.random.default_rng(3).integers(0, 256, (6, 9, 4), dtype=np.uint8)[::-1, :, :3]
    read = Image.open(io.BytesIO(png_bytes(points, 300)))
    assert np.array_equal(np.asarray(read), points)
    assert read.info["dpi"] == pytest.approx((300, 300), abs=0.01)


def test_other_than_three_colours_are_refused() -> None:
    with pytest.raises(ValueError, match="not 4 numbers"):
        png_bytes(np.zeros((2, 2, 4), dtype=np.uint8))
