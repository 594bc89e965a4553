"""A field in colours: low blue, high red, and no stretch of the scale by one corner."""

from __future__ import annotations

from pathlib import Path

import matplotlib.image
import numpy as np

from tvimdesign.cad.render.field_picture import write_field_picture


def test_the_picture_has_both_ends_of_the_scale_on_the_body(tmp_path: Path) -> None:
    grid = np.stack(np.meshgrid(np.linspace(0, 40, 41), np.linspace(0, 20, 41), indexing="ij"), axis=-1).reshape(-1, 2)
    points = np.column_stack([grid, np.zeros(len(grid))])
    index = np.arange(41 * 41).reshape(41, 41)
    a, b, c, d = index[:-1, :-1].ravel(), index[1:, :-1].ravel(), index[1:, 1:].ravel(), index[:-1, 1:].ravel()
    values = points[:, 0].copy()
    values[0] = 1e6  # one sharp corner
    path = tmp_path / "field.png"
    write_field_picture(path, points, np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])]), values,
                        np.zeros_like(points), "x\nmm")  # fmt: skip
    body = matplotlib.image.imread(path)[:, :1100, :3]
    red, green, blue = body[..., 0], body[..., 1], body[..., 2]
    assert np.mean((red > 0.6) & (green < 0.3) & (blue < 0.3)) > 0.005
    assert np.mean((blue > 0.6) & (red < 0.3)) > 0.005
