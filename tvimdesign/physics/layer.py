"""A flat annular layer in shear between a fixed floor and a turning plate.

Textbook torsion of a flat ring: shear strain r theta/t, traction G r theta/t, torque the integral of r times traction.
"""

from __future__ import annotations

from typing import Any

import numpy as np


def series_modulus(storage: Any, loss: Any) -> tuple[Any, Any]:
    """Storage and loss modulus [Pa] of equally thick slices that carry one shear stress: 1/G* = mean of 1/G*_i.

    Takes the slices' moduli as arrays. A thin molten slice therefore softens the layer long before all of it is hot.
    """
    square = storage**2 + loss**2
    real, imaginary = np.mean(storage / square), np.mean(loss / square)
    square = real**2 + imaginary**2
    return real / square, imaginary / square


def series_stiffness(stiffness: Any, loss_stiffness: Any, support: Any) -> tuple[Any, Any]:
    """Real and imaginary part [N*m/rad] of K* = stiffness + i loss_stiffness behind a lossless support stiffness.

    K = K* S/(K* + S) with S the support.
    """
    real, imaginary = stiffness + support, loss_stiffness
    square = real**2 + imaginary**2
    return (
        support * (stiffness * real + loss_stiffness * imaginary) / square,
        support * (loss_stiffness * real - stiffness * imaginary) / square,
    )


def shear_strain(radius: Any, angle: Any, thickness: Any) -> Any:
    """Strain at a radius, gamma = r theta/t [1]."""
    return radius * angle / thickness


def torque_at_traction(traction: Any, polar_moment_of_area: Any, outer_radius: Any) -> Any:
    """Torque [N*m] at which the traction at the outer radius reaches a limit, T = tau J/r_o."""
    return traction * polar_moment_of_area / outer_radius


def traction(torque: Any, polar_moment_of_area: Any, outer_radius: Any) -> Any:
    """Traction at the outer radius under a torque [Pa], tau = T r_o/J."""
    return torque * outer_radius / polar_moment_of_area
