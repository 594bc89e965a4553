"""A single-turn wave spring of flat wire: a ring that is waved along its circumference, pressed between two faces."""

from __future__ import annotations

from typing import Any

import numpy as np

WAVE_FACTOR = np.pi**3 / 8.0
"""Deflection factor K [1] for two to four waves, which makers round to 3.88: half that of N beams in a ring, each of
the length of a wave, freely supported and loaded in the middle (pi^3/4)."""


def rate(
    youngs_modulus: Any, inner_diameter: Any, outer_diameter: Any, thickness: Any, waves: Any, factor: Any = WAVE_FACTOR
) -> Any:
    """Return the rate of the spring [N/m], E b t^3 N^4/(K D_m^3) D_o/D_i; modulus [Pa], lengths [m], two to four waves.

    Source: Rotor Clip, formulas for spiral wound wave springs, single turn with gap.
    """
    mean, wall = 0.5 * (inner_diameter + outer_diameter), 0.5 * (outer_diameter - inner_diameter)
    return youngs_modulus * wall * thickness**3 * waves**4 / (factor * mean**3) * outer_diameter / inner_diameter


def stress(force: Any, inner_diameter: Any, outer_diameter: Any, thickness: Any, waves: Any) -> Any:
    """Return the bending stress [Pa] under a force [N], 3 pi F D_m/(4 b t^2 N^2); lengths [m].

    Source: as `rate`.
    """
    mean, wall = 0.5 * (inner_diameter + outer_diameter), 0.5 * (outer_diameter - inner_diameter)
    return 3.0 * np.pi * force * mean / (4.0 * wall * thickness**2 * waves**2)
