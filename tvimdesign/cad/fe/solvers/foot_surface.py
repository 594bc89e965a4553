"""Places where the stress at a core's foot is read: along its surface, from the middle of its fillet on."""

from typing import Any

import numpy as np

MEAN, STEPS = 1.0, 20  # Length over which the stress is a mean [mm], and points of a millimetre
WITHIN = 0.002  # How far within the surface it is read, over the core's radius


def places(core: float, fillet: float) -> tuple[Any, Any]:
    """Return radii and heights above the plate [mm], evenly along the surface of a core with a fillet of a radius at
    its foot.

    What lies below the middle of the fillet faces the plate, as the plate's own face beside a sharp foot does.
    """
    deep = WITHIN * core
    way = (np.arange(round((MEAN + fillet) * STEPS)) + 0.5) / STEPS + 0.25 * np.pi * fillet
    up = way - 0.5 * np.pi * fillet
    turn = np.minimum(way / fillet, 0.5 * np.pi) if fillet else np.full_like(way, 0.5 * np.pi)
    radius = core + fillet - (fillet + deep) * np.sin(turn)
    return radius, np.where(up > 0, fillet + up, fillet - (fillet + deep) * np.cos(turn))


def highest_mean(along: Any) -> Any:
    """Return the highest of the means over a millimetre of what was read at such places, down the first axis."""
    window = round(MEAN * STEPS)
    means = [np.nanmean(along[low : low + window], axis=0) for low in range(len(along) - window + 1)]
    return np.max(means, axis=0)
