"""A block of polymer squeezed between the faces of two vanes: its stiffness, and what it keeps of a hold.

The block does not slip on its faces, which have the sides w and h; its depth is L, and n of them stand at the mean
radius r about the axis. It pushes and never pulls. How its stiffness follows from the relaxation spectrum: the modes
are those of shear, and the bulk modulus is one elastic constant, frozen and molten alike. E = 9 K G/(3 K + G) then is
2 (1 + nu) G with nu of the record in the frozen polymer and 3 G in the melt, with no rule between needed. So a mode of
the block is one of shear, k_m = 3 G_m (1 + 2 S^2) n A r^2/L, and the bulk modulus is one more elastic spring in series
with them all, as the structure is.
Sources: [GL] Gent and Lindley, Proc. Inst. Mech. Eng. 173 (1959) 111 (bonded blocks, and their bulk correction);
[G] Gent, Engineering with Rubber, 2nd ed. (2001), ch. 3; [L] Love, Mathematical Theory of Elasticity (constants of
isotropic bodies); [F] Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 1 and 3 (Maxwell elements).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tvimdesign.physics import one_sided
from tvimdesign.physics.motion import Modes
from tvimdesign.physics.viscoelasticity import Retardation, creep_compliance, relaxation_modulus


def shape_factor(width: Any, height: Any, depth: Any) -> Any:
    """One loaded face over all force-free sides, S = w h/(2 L (w + h)) [1] [GL]."""
    return width * height / (2.0 * depth * (width + height))


def bulk_modulus(youngs_modulus: Any, poissons_ratio: Any) -> Any:
    """K = E/(3 (1 - 2 nu)) [Pa] [L], from the constants of the frozen polymer; assumed to be that of the melt too."""
    return youngs_modulus / (3.0 * (1.0 - 2.0 * poissons_ratio))


def shape_stiffening(shape: Any) -> Any:
    """Factor by which faces that do not slip stiffen an incompressible block, 1 + 2 S^2 [1] [GL, G]."""
    return 1.0 + 2.0 * shape**2


def volumetric_modulus(bulk: Any, shape: Any) -> Any:
    """What the change of volume adds in series to the shear modes of a block [Pa], K ((1 + 2 S^2)/(1/3 + 2 S^2))^2.

    The mean pressure is (1/3 + 2 S^2)/(1 + 2 S^2) of the stress: the third of plain compression, and all that 2 S^2
    stands for. Its energy p^2/(2 K) gives the formula. A flat block has K itself, which is the correction 1/E_app =
    1/(E (1 + 2 S^2)) + 1/K of [GL] for rubber; a slender one has 9 K, as 1/E = 1/(3 G) + 1/(9 K) says [L]. That
    correction would count a slender block's volume twice, and a frozen block (nu = 0.45) a quarter too soft.
    """
    return bulk * (shape_stiffening(shape) / (1.0 / 3.0 + 2.0 * shape**2)) ** 2


def apparent_modulus(shear_modulus: Any, bulk: Any, shape: Any) -> Any:
    """Stress over strain of a block [Pa], 1/E_app = 1/(3 G (1 + 2 S^2)) + 1/E_v, E_v the `volumetric_modulus`.

    Within 13 % below finite elements for S of 0.1 to 1.7 (tests). With a complex G, `layer.series_stiffness` of the
    two parts does the same.
    """
    return 1.0 / (1.0 / (3.0 * shear_modulus * shape_stiffening(shape)) + 1.0 / volumetric_modulus(bulk, shape))


def stiffness(modulus: Any, count: Any, area: Any, radius: Any, depth: Any) -> Any:
    """Stiffness of n blocks about the axis [N*m/rad], K = n E A r^2/L; textbook: force E A r theta/L at the arm r."""
    return modulus * count * area * radius**2 / depth


def block_modes(spectrum: Modes, shape: Any, count: Any, area: Any, radius: Any, depth: Any) -> list[tuple[Any, Any]]:
    """Modes of n blocks, (time [s], stiffness [N*m/rad]), from a spectrum (time [s], shear modulus [Pa]).

    In series with them belongs the `stiffness` of the `volumetric_modulus`.
    """
    factor = stiffness(3.0 * shape_stiffening(shape), count, area, radius, depth)
    return [(time, modulus * factor) for time, modulus in spectrum]


def strain(radius: Any, angle: Any, depth: Any) -> Any:
    """Mean compression of a block, r theta/L [1]; textbook."""
    return radius * angle / depth


def stress(torque: Any, count: Any, area: Any, radius: Any) -> Any:
    """Mean pressure on the faces under a torque [Pa], T/(n A r); textbook."""
    return torque / (count * area * radius)


def torque_at_stress(limit: Any, count: Any, area: Any, radius: Any) -> Any:
    """Torque [N*m] at which the mean pressure reaches a limit [Pa], such as yield: T = sigma n A r.

    The yield strength is that of a slender specimen; faces that do not slip let a flat block bear more.
    """
    return limit * count * area * radius


def relaxation_loss(time: Any, modes: Modes) -> Any:
    """Share of the stiffness that is lost in a hold [1], 1 - K(t)/K(0+), K(t) = sum k exp(-t/tau) [F]."""
    return 1.0 - relaxation_modulus(time, modes) / sum(stiffness for _, stiffness in modes)


def held_internal(compression: Any, time: Any, modes: Modes) -> list[Any]:
    """Angle of each mode's dashpot [rad] after a hold from a state free of strain, theta (1 - exp(-t/tau)) [F]."""
    return [compression * -np.expm1(-time / tau) for tau, _ in modes]


def held_share(time: Any, structure: Any, modes: Modes) -> Any:
    """Share of a held angle [1] that the block itself has taken at the end of a hold, S/(S + K(t)).

    The structure S [N*m/rad], volume included, takes the rest. This is the quasi-elastic approximation (Christensen,
    Theory of Viscoelasticity, 2nd ed.; Schapery 1965): exact where the block is soft or elastic beside the structure;
    times `backlash` of the whole angle it is up to a fifth more than `solve.contact.held` gives (tests).
    """
    return structure / (structure + relaxation_modulus(time, modes))


def backlash(angle: Any, time: Any, modes: Modes, precompression: Any = 0.0) -> Any:
    """Angle over which no block touches right after a hold at an angle [rad]: all that springs back at once has.

    `precompression` is the angle by which either block is squeezed with the link at rest. The block ahead was held by
    both angles together, the one behind by what was left of its precompression, if anything. Structure and volume
    count as rigid here: behind them take `held_share` of the angle, or `solve.contact.held` with `one_sided.gap`.
    """
    ahead = held_internal(angle + precompression, time, modes)
    behind = held_internal(np.fmax(precompression - angle, 0.0), time, modes)
    moved = [inner - precompression for inner in (*ahead, *behind)]
    return one_sided.gap(moved, one_sided.Blocks(modes, modes))


def recovered_angle(time: Any, internal: Sequence[float], modes: Modes, response: Retardation) -> Any:
    """Angle by which the face stands back a time [s] after nothing touches it any more [rad].

    With p = 1/tau, and r the rates of the retardation of the same modes, the balance sum k (phi - q) = 0 and
    q' = p (phi - q) have the Laplace transform phi(s) = sum k q_0/(s + p)/(s sum k/(s + p)); its partial fractions
    are phi = sum k tau q_0/sum k tau + sum_r r J_r exp(-r t) sum k q_0/(p - r) (textbook; J_r as in
    `viscoelasticity.retardation`). Numbers only.
    """
    elements = [(1.0 / tau, stiffness, inner) for (tau, stiffness), inner in zip(modes, internal, strict=True)]
    angle = sum(k * q / p for p, k, q in elements) / sum(k / p for p, k, _ in elements)
    for lag, compliance in response.modes:
        pull = sum(k * q / (p - 1.0 / lag) for p, k, q in elements)
        angle = angle + compliance / lag * pull * np.exp(-time / lag)
    return angle


def crept_angle(time: Any, torque: Any, response: Retardation) -> Any:
    """Angle [rad] a time [s] after a torque [N*m] came on, T J(t), from the retardation of the block's modes [F]."""
    return torque * creep_compliance(time, response)
