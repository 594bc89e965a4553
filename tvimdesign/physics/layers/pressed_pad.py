"""A soft pad pressed through its thickness between a stiff face and one with a slot in it: how far it gives.

Rubber hardly changes its volume, so a pad that cannot slip on its faces gives as its sides let it bulge. Over a slot it
is not held. Sources: [GL] Gent and Lindley, Proc. Inst. Mech. Eng. 173 (1959) 111 (bonded blocks by their shape
factor); FE of single pads (validation/fe_structure/pads.csv) for how far the edges of a slot hold it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tvimdesign.physics.layers import block

SPREAD = 0.51
"""How far beyond a slot's edge a pad is held, over its thickness; FE of single pads."""


def stiffness(moduli: tuple[Any, Any], sides: tuple[Any, Any], thickness: Any, slot: tuple[Any, Any]) -> Any:
    """Force over the way of a pad's face [N/m], E A/t with 1/E = 1/(3 G (1 + 2 S^2)) + 1/M.

    `moduli` are shear and bulk modulus [Pa], `sides` width and height of the pad [m]; the slot is as wide as `slot`
    says and reaches so far up from the pad's lower side [m]. A is the pad less the slot, of which half a thickness
    beside each edge holds too; S is A over the free sides, the pad's four and the slot's three [GL]. A slot narrower
    than the pad is thick opens no side in full. M is the bulk modulus as `block.volumetric_modulus` takes it. FE of
    single pads: within 8 %; of pads without a slot it is up to 12 % too soft, as [GL] is.
    """
    width, height = sides
    opening = np.fmax(slot[0] - 2.0 * SPREAD * thickness, 0.0)
    reach = np.fmax(slot[1] - SPREAD * thickness, 0.0)
    held = width * height - opening * reach
    edges = (2.0 * reach + opening) * np.fmin(slot[0] / (2.0 * SPREAD * thickness), 1.0)
    shape = held / (thickness * (2.0 * (width + height) + edges))
    plain = 3.0 * moduli[0] * block.shape_stiffening(shape)
    return held / thickness / (1.0 / plain + 1.0 / block.volumetric_modulus(moduli[1], shape))
