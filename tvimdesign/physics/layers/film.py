"""A block of which only a part is soft: squeezed, a molten film between stiff faces is held tighter than a whole block.

Sheared, a thin molten film is as soft as its thickness says. Squeezed, it has to flow out sideways, and its shape
factor grows as it gets thinner: the block's is S = w h/(2 L (w + h)), a film's of the share p of its depth is S/p (Gent
and Lindley, Proc. Inst. Mech. Eng. 173 (1959) 111, of a layer of the film's own thickness between stiff faces). So
K = 3 G (1 + 2 (S/p)^2) n A r^2/L with the modulus G of all slices in series, which is exact where the rest is rigid and
where all is alike; between the two it interpolates.
"""

from __future__ import annotations

from typing import Any

import numpy as np


def soft_share(storage: Any, loss: Any) -> Any:
    """Share of a layer's depth that is soft [1], (sum c)^2/(n sum c^2) of its equally thick slices' compliances c.

    The participation ratio: m of n slices alike and the others rigid give m/n. Takes the slices' moduli [Pa] as arrays.
    """
    square = 1.0 / (storage**2 + loss**2)
    return np.mean(np.sqrt(square)) ** 2 / np.mean(square)
