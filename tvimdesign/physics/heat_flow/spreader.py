"""A plate that spreads the heat of modules smaller than itself: thermal resistance beside what the layers add."""

from __future__ import annotations

from math import log, pi
from typing import Any

CORNER = 2.0 * log(2.0) / pi
"""Length over the thickness by which a fin seems longer that is fed through one face: conformal mapping of a strip."""


def spreading_resistance(area: Any, fed_area: Any, fed_edge: Any, conductivity: Any, thickness: Any) -> Any:
    """Mean rise of the fed part over the whole plate, per heat flux that leaves its face evenly [m^2 K/W].

    The part beside the modules is a fin, fed along their edge and as wide as it has area for that edge's length: under
    an even flux q its mean lies q w^2/(3 k t) below its root (Incropera, ch. 3, a fin of efficiency tanh(mw)/(mw) where
    mw is small), and its root by the way around the corner, q w 2 ln 2/(pi k), below the fed face. `area` and
    `fed_area` in m^2, `fed_edge` [m] the length of the modules' outlines, `conductivity` [W/m K], `thickness` [m]. The
    fed face is taken to have one temperature.
    """
    beside = area - fed_area
    width = beside / fed_edge
    return beside / area * width / conductivity * (width / (3.0 * thickness) + CORNER)


def contact_resistance(contact: Any, conductivity: Any, thickness: Any, fed_share: Any, fed_contact: Any) -> Any:
    """Resistance of joint, plate and the modules' joint in series, over the whole plate [m^2 K/W].

    1/h + t/k + 1/(f h_m): `contact` h and `fed_contact` h_m are conductances of the two joints [W/m^2 K], `fed_share` f
    the share of the plate that lies on modules.
    """
    return 1.0 / contact + thickness / conductivity + 1.0 / (fed_share * fed_contact)
