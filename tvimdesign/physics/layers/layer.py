"""A flat annular layer in shear between a fixed floor and a turning plate.

Textbook torsion of a flat ring: shear strain r theta/t, traction G r theta/t, torque the integral of r times traction.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from tvimdesign.physics.polymers import polymer


def series_modulus(storage: Any, loss: Any) -> tuple[Any, Any]:
    """Return the storage and loss modulus [Pa] of equally thick slices that carry one shear stress: 1/G* = mean of
    1/G*_i.

    Takes the slices' moduli as arrays. A thin molten slice therefore softens the layer long before all of it is hot.
    """
    return reciprocal(*mean_compliance(storage, loss))


def mean_compliance(storage: Any, loss: Any) -> tuple[Any, Any]:
    """Return the mean storage and loss compliance [1/Pa] of slices with these moduli, arrays [Pa]."""
    real, imaginary = reciprocal(storage, loss)
    return np.mean(real), np.mean(imaginary)


def reciprocal(storage: Any, loss: Any) -> tuple[Any, Any]:
    """Return the compliances J', J'' [1/Pa] of moduli G', G'' [Pa], J' - i J'' = 1/(G' + i G''), or moduli of
    compliances."""
    square = storage**2 + loss**2
    return storage / square, loss / square


def side_by_side(compliances: Sequence[tuple[Any, Any]], shares: Sequence[float]) -> tuple[Any, Any]:
    """Return the storage and loss modulus [Pa] of columns of a layer that are sheared alike: the mean by their shares
    of it.

    Each column is given by its compliance [1/Pa].
    """
    moduli = [reciprocal(*column) for column in compliances]
    storage, loss = (
        sum(share * part for share, part in zip(shares, parts, strict=True)) for parts in zip(*moduli, strict=True)
    )
    return storage, loss


def melting_compliance(
    temperatures: Any, melting: polymer.Melting, angular_frequency: Any, rheology: polymer.AnyRheology
) -> tuple[Any, Any]:
    """Return the mean compliance [1/Pa] of slices at some temperatures [K] that are on the melting curve."""
    fractions = polymer.fraction_at(temperatures, melting)
    return mean_compliance(*polymer.moduli(temperatures, fractions, angular_frequency, rheology))


def series_stiffness(stiffness: Any, loss_stiffness: Any, support: Any, support_loss: Any = 0.0) -> tuple[Any, Any]:
    """Return the real and imaginary part [N*m/rad] of K* = stiffness + i loss_stiffness behind a support S* of its own
    loss.

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


def loss_stiffness(damping: Any, frequency: Any) -> Any:
    """Return the loss stiffness [N*m/rad] of a damping [N*m*s/rad] at a frequency [Hz], K'' = 2 pi f b."""
    return 2.0 * np.pi * frequency * damping


def dissipation(layer: tuple[Any, Any], branch: tuple[Any, Any], amplitude: Any, frequency: Any) -> Any:
    """Return the mean heat [W] in a layer behind a support, turned as a sine by an amplitude [rad] at a frequency [Hz].

    pi f phi^2 |K|^2 K_l''/|K_l|^2 with K_l of the layer and K of layer and support in series, real and imaginary parts
    [N*m/rad]: the work of a period, pi M^2 J'' of the torque M and the layer's compliance J'' (Ferry, ch. 1).
    """
    square = layer[0] ** 2 + layer[1] ** 2
    torque_square = (branch[0] ** 2 + branch[1] ** 2) * amplitude**2
    return np.pi * frequency * torque_square * layer[1] / square


def loss_shares(storage: Any, loss: Any) -> Any:
    """Return the shares of a layer's dissipation that its slices have [1], from their moduli [Pa]: as their loss
    compliances."""
    compliance = loss / (storage**2 + loss**2)
    return compliance / np.sum(compliance)


def shear_strain(radius: Any, angle: Any, thickness: Any) -> Any:
    """Return the strain at a radius, gamma = r theta/t [1]."""
    return radius * angle / thickness


def torque_at_traction(traction: Any, polar_moment_of_area: Any, outer_radius: Any) -> Any:
    """Return the torque [N*m] at which the traction at the outer radius reaches a limit, T = tau J/r_o."""
    return traction * polar_moment_of_area / outer_radius


def traction(torque: Any, polar_moment_of_area: Any, outer_radius: Any) -> Any:
    """Return the traction at the outer radius under a torque [Pa], tau = T r_o/J."""
    return torque * outer_radius / polar_moment_of_area
