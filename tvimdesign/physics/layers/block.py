"""A block of polymer squeezed between the faces of two vanes: its stiffness, and what a hold takes of it.

The block does not slip on its faces, which have the sides w and h; its depth is L, and n of them stand at the mean
radius r about the axis. It pushes and never pulls. How its stiffness follows from the relaxation spectrum: the modes
are those of shear, and the bulk modulus is one elastic constant, frozen and molten alike. E = 9 K G/(3 K + G) then is
2 (1 + nu) G with nu of the record in the frozen polymer and 3 G in the melt, with no rule between needed. So a mode of
the block is one of shear, k_m = 3 G_m (1 + 2 S^2) n A r^2/L, and the bulk modulus is one more elastic spring in series
with them all, as the structure is.
Sources: [GL] Gent and Lindley, Proc. Inst. Mech. Eng. 173 (1959) 111 (bonded blocks, and their bulk correction);
[G] Gent, Engineering with Rubber, 2nd ed. (2001), ch. 3; [L] Love, Mathematical Theory of Elasticity (constants of
isotropic bodies); [F] Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 1 and 3 (Maxwell elements).

Part of a block may be molten: a molten film between stiff faces is squeezed less than a whole block. Sheared, a thin
molten film is as soft as its thickness says. Squeezed, it has to flow out sideways, and its shape factor grows as it
gets thinner: the block's is S = w h/(2 L (w + h)), a film's of the share p of its depth is S/p (Gent and Lindley, Proc.
Inst. Mech. Eng. 173 (1959) 111, of a layer of the film's own thickness between stiff faces). So K = 3 G (1 + 2 (S/p)^2)
n A r^2/L with the modulus G of all slices in series, which is exact where the rest is rigid and where all is alike;
between the two it interpolates.

A soft pad is pressed through its thickness between a stiff face and one with a slot in it. Rubber hardly changes its
volume, so a pad that cannot slip on its faces gives as its sides let it bulge. Over a slot it is not held. Sources:
[GL] Gent and Lindley, Proc. Inst. Mech. Eng. 173 (1959) 111 (bonded blocks by their shape factor); FE of single pads
(validation/fe_structure/pads.csv) for how far the edges of a slot hold it."""

from typing import Any

import numpy as np

from tvimdesign.physics.motions.motion import Modes
from tvimdesign.physics.polymers.viscoelasticity import relaxation_modulus


def shape_factor(width: Any, height: Any, depth: Any) -> Any:
    """Return one loaded face over all force-free sides, S = w h/(2 L (w + h)) [1] [GL]."""
    return width * height / (2.0 * depth * (width + height))


def bulk_modulus(youngs_modulus: Any, poissons_ratio: Any) -> Any:
    """Return K = E/(3 (1 - 2 nu)) [Pa] [L], from the constants of the frozen polymer; assumed to be that of the melt
    too."""
    return youngs_modulus / (3.0 * (1.0 - 2.0 * poissons_ratio))


def shape_stiffening(shape: Any) -> Any:
    """Return the factor by which faces that do not slip stiffen an incompressible block, 1 + 2 S^2 [1] [GL, G]."""
    return 1.0 + 2.0 * shape**2


def volumetric_modulus(bulk: Any, shape: Any) -> Any:
    """Return what the change of volume adds in series to the shear modes of a block [Pa], K ((1 + 2 S^2)/(1/3 + 2
    S^2))^2.

    The mean pressure is (1/3 + 2 S^2)/(1 + 2 S^2) of the stress: the third of plain compression, and all that 2 S^2
    stands for. Its energy p^2/(2 K) gives the formula. A flat block has K itself, which is the correction 1/E_app =
    1/(E (1 + 2 S^2)) + 1/K of [GL] for rubber; a slender one has 9 K, as 1/E = 1/(3 G) + 1/(9 K) says [L]. That
    correction would count a slender block's volume twice, and a frozen block (nu = 0.45) a quarter too soft. With it a
    block is within 13 % below finite elements for S of 0.1 to 1.7 (tests).
    """
    return bulk * (shape_stiffening(shape) / (1.0 / 3.0 + 2.0 * shape**2)) ** 2


def stiffness(modulus: Any, count: Any, area: Any, radius: Any, depth: Any) -> Any:
    """Return the stiffness of n blocks about the axis [N*m/rad], K = n E A r^2/L; textbook: force E A r theta/L at the
    arm r."""
    return modulus * count * area * radius**2 / depth


def strain(radius: Any, angle: Any, depth: Any) -> Any:
    """Return the mean compression of a block, r theta/L [1]; textbook."""
    return radius * angle / depth


def equivalent_shear_strain(squeeze: Any, shape: Any) -> Any:
    """Return the shear strain with the energy of a squeeze [1], sqrt(3 (1 + 2 S^2)) e: from G g^2/2 = 3 G (1 + 2 S^2)
    e^2/2 [GL].

    A mean over the block. At its faces a flat block is sheared more, in its middle less.
    """
    return np.sqrt(3.0 * shape_stiffening(shape)) * squeeze


def squeezed_outer_radius(inner_radius: Any, outer_radius: Any, span: Any, squeeze: Any) -> Any:
    """Return the outer radius [m] of a sector of the angle `span` [rad] squeezed by an angle, if it bulged
    outwards alone.

    Its volume stays, h a (r_o^2 - r_i^2)/2, as that of any incompressible body; textbook.
    """
    return np.sqrt(inner_radius**2 + (outer_radius**2 - inner_radius**2) * span / (span - squeeze))


def stress(torque: Any, count: Any, area: Any, radius: Any) -> Any:
    """Return the mean pressure on the faces under a torque [Pa], T/(n A r); textbook."""
    return torque / (count * area * radius)


def torque_at_stress(limit: Any, count: Any, area: Any, radius: Any) -> Any:
    """Return the torque [N*m] at which the mean pressure reaches a limit [Pa], such as yield: T = sigma n A r.

    The yield strength is that of a slender specimen; faces that do not slip let a flat block bear more.
    """
    return limit * count * area * radius


def relaxation_loss(time: Any, modes: Modes) -> Any:
    """Return the share of the stiffness that is lost in a hold [1], 1 - K(t)/K(0+), K(t) = sum k exp(-t/tau) [F]."""
    return 1.0 - relaxation_modulus(time, modes) / sum(stiffness for _, stiffness in modes)


def soft_share(storage: Any, loss: Any) -> Any:
    """Return the share of a layer's depth that is soft [1], (sum c)^2/(n sum c^2) of its equally thick slices'
    compliances c.

    The participation ratio: m of n slices alike and the others rigid give m/n. Takes the slices' moduli [Pa] as arrays.
    """
    square = 1.0 / (storage**2 + loss**2)
    return np.mean(np.sqrt(square)) ** 2 / np.mean(square)


HELD_BEYOND_SLOT = 0.51  # Distance beyond a slot's edge to which a pad is held, over its thickness; FE of single pads


def pad_stiffness(moduli: tuple[Any, Any], sides: tuple[Any, Any], thickness: Any, slot: tuple[Any, Any]) -> Any:
    """Return the force over the way of a pad's face [N/m], E A/t with 1/E = 1/(3 G (1 + 2 S^2)) + 1/M.

    `moduli` are shear and bulk modulus [Pa], `sides` width and height of the pad [m]; the slot is as wide as `slot`
    says and reaches so far up from the pad's lower side [m]. A is the pad less the slot, but half a thickness beside
    each of its edges holds too. S is A over the free sides, the pad's four and the slot's three [GL]. A slot narrower
    than the pad is thick opens no side in full. M is the bulk modulus as `block.volumetric_modulus` takes it. FE of
    single pads: within 8 %; of pads without a slot it is up to 12 % too soft, as [GL] is.
    """
    width, height = sides
    opening = np.fmax(slot[0] - 2.0 * HELD_BEYOND_SLOT * thickness, 0.0)
    reach = np.fmax(slot[1] - HELD_BEYOND_SLOT * thickness, 0.0)
    held = width * height - opening * reach
    edges = (2.0 * reach + opening) * np.fmin(slot[0] / (2.0 * HELD_BEYOND_SLOT * thickness), 1.0)
    shape = held / (thickness * (2.0 * (width + height) + edges))
    plain = 3.0 * moduli[0] * shape_stiffening(shape)
    return held / thickness / (1.0 / plain + 1.0 / volumetric_modulus(moduli[1], shape))
