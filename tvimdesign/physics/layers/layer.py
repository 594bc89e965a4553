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


def series_stiffness(stiffness: Any, loss_stiffness: Any, support: Any, support_loss: Any = 0.0) -> tuple[Any, Any]:
    """Real and imaginary part [N*m/rad] of K* = stiffness + i loss_stiffness behind a support S* of its own loss.

    1/K = 1/K* + 1/S*, S* = support + i support_loss; each part in proportion to the other's square, so that neither
    difference of large numbers nor complex arithmetic is needed.
    """
    square = stiffness**2 + loss_stiffness**2
    support_square = support**2 + support_loss**2
    real, imaginary = stiffness + support, loss_stiffness + support_loss
    whole = real**2 + imaginary**2
    return (
        (support * square + stiffness * support_square) / whole,
        (support_loss * square + loss_stiffness * support_square) / whole,
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
