"""Torsional stiffness of what carries the layer: shaft and flat rings.

Source: Timoshenko and Goodier, Theory of Elasticity, 3rd ed.: torsion of round bars; rings sheared in their plane.
"""

from __future__ import annotations

from typing import Any

import numpy as np


def shear_modulus(youngs_modulus: Any, poissons_ratio: Any) -> Any:
    """G = E/(2 (1 + nu)) [Pa]."""
    return youngs_modulus / (2.0 * (1.0 + poissons_ratio))


def shear_yield(tensile_yield: Any) -> Any:
    """Shear stress at which a body yields [Pa], sigma/sqrt(3) (Shigley, section 5-5, distortion energy)."""
    return tensile_yield / np.sqrt(3.0)


def shaft_stiffness(modulus: Any, radius: Any, length: Any) -> Any:
    """Round bar, G pi r^4/(2 L) [N*m/rad]."""
    return modulus * np.pi * radius**4 / (2.0 * length)


def shaft_torque(shear_yield: Any, radius: Any) -> Any:
    """Torque [N*m] at which a round bar starts to yield at its surface, tau pi r^3/2."""
    return 0.5 * np.pi * shear_yield * radius**3


def ring_stiffness(modulus: Any, thickness: Any, inner_radius: Any, outer_radius: Any) -> Any:
    """Flat ring turned in its plane, inner edge against outer edge, 4 pi G h/(1/a^2 - 1/b^2) [N*m/rad]."""
    return 4.0 * np.pi * modulus * thickness / (inner_radius**-2 - outer_radius**-2)


def series(*stiffnesses: Any) -> Any:
    """Stiffness of springs in series, 1/K = sum 1/K_i [N*m/rad]."""
    return 1.0 / sum(1.0 / stiffness for stiffness in stiffnesses)


def loss_stiffness(stiffness: Any, loss_factor: Any) -> Any:
    """Imaginary part [N*m/rad] of a stiffness with hysteretic loss, S* = S (1 + i eta); eta [1] is tan(delta).

    Source: Cremer and Heckl, Structure-Borne Sound, 2nd ed., ch. III (complex moduli).
    """
    return stiffness * loss_factor


def overhung_load(force: Any, height: Any, spread: Any) -> Any:
    """Load [N] on the nearer of two bearings, `spread` [m] apart, of a force `height` [m] beyond it: F (1 + h/s).

    Source: statics, moments about the farther bearing.
    """
    return force * (1.0 + height / spread)
