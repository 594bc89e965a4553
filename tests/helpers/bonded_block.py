"""A block between two plates it cannot slip on, by finite elements: an octant of bricks, its volume taken at one point.

Hughes, The Finite Element Method, ch. 4 (selective reduced integration, which does not lock in nearly incompressible
bodies). Lengths in units of one's own, stress in units of Young's modulus.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import spsolve

Array = NDArray[np.float64]
CORNERS = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], dtype=float)


def strains(point: Array, size: Array) -> Array:
    """Strains (xx, yy, zz, xy, yz, zx) at a point of a brick from the displacements of its corners."""
    sides = 1.0 + CORNERS * point
    slopes = CORNERS / 8.0 * sides[:, [1, 0, 0]] * sides[:, [2, 2, 1]] * 2.0 / size
    rows = np.zeros((6, 24))
    for axis in range(3):
        rows[axis, axis::3] = slopes[:, axis]
    for row, (a, b) in enumerate(((0, 1), (1, 2), (2, 0)), start=3):
        rows[row, a::3], rows[row, b::3] = slopes[:, b], slopes[:, a]
    return rows


def brick(size: Array, poissons_ratio: float) -> Array:
    """Stiffness of a brick: what changes its shape at eight points, what changes its volume at one."""
    shear, bulk = 0.5 / (1.0 + poissons_ratio), 1.0 / (3.0 * (1.0 - 2.0 * poissons_ratio))
    volume = float(np.prod(size))
    shape = 2.0 * shear * np.diag([1.0, 1.0, 1.0, 0.5, 0.5, 0.5])
    shape[:3, :3] -= 2.0 / 3.0 * shear
    rows = [strains(corner / np.sqrt(3.0), size) for corner in CORNERS]
    swelling = strains(np.zeros(3), size)[:3].sum(axis=0)
    whole = bulk * volume * np.outer(swelling, swelling)
    return np.asarray(whole + sum(r.T @ shape @ r for r in rows) * volume / 8.0)


def apparent_modulus(
    width: float, height: float, depth: float, poissons_ratio: float, cells: tuple[int, int, int]
) -> float:
    """Stress over strain of the block, in units of Young's modulus."""
    half = 0.5 * np.array([width, height, depth])
    count = np.array(cells)
    grid = np.stack(np.meshgrid(*(np.arange(n + 1) for n in cells), indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(len(grid)).reshape(count + 1)
    first = np.stack(np.meshgrid(*(np.arange(n) for n in cells), indexing="ij"), axis=-1).reshape(-1, 3)
    nodes = np.stack([number[tuple((first + (corner > 0)).T)] for corner in CORNERS], axis=1)
    freedoms = (3 * nodes[:, :, None] + np.arange(3)).reshape(len(nodes), 24)
    entries = np.tile(brick(half / count, poissons_ratio).ravel(), len(nodes))
    places = (np.repeat(freedoms, 24, axis=1).ravel(), np.tile(freedoms, (1, 24)).ravel())
    matrix = csr_matrix((entries, places), shape=(3 * len(grid), 3 * len(grid)))
    pressed = grid[:, 2] == cells[2]
    fixed = (grid == 0) | pressed[:, None]  # planes of symmetry, and the plate
    moved = np.zeros((len(grid), 3))
    moved[pressed, 2] = -half[2]
    given, free = np.flatnonzero(fixed.ravel()), np.flatnonzero(~fixed.ravel())
    ways = moved.ravel()
    ways[free] = spsolve(matrix[free][:, free].tocsc(), -(matrix[free][:, given] @ ways[given]))
    return float(ways @ (matrix @ ways) / np.prod(half))
