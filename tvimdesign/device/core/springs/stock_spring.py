"""A torsion spring from stock, bought whole: wire, coil and material are its record's, and what else it must have.

Stock springs have two straight tangential legs. One lies on the pin, cut to its length; the other one is bent down into
the floor as the tang.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Feature, Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup

FROM_STOCK = (Feature("stock_spring", "none"),)

quantities = QuantityGroup("Springs", FROM_STOCK)


@quantities.output("mm", at_least(0.0, "the stock spring's leg does not reach the pin"))
def stock_leg_margin(m: Module) -> Scalar:
    """Leg of the stock spring beyond what its pin asks for; what is over is cut off. Zero without."""
    return m.stock_spring.value("leg_length") - m.leg_length


@quantities.output("mm", at_least(0.0, "the stock spring's other leg is too short to be bent down into the floor"))
def stock_tang_margin(m: Module) -> Scalar:
    """Other leg of the stock spring beyond its tang and the quarter bend above that. Zero without."""
    return m.stock_spring.value("leg_length") - m.tang_length - 0.5 * np.pi * m.tang_bend_radius


@quantities.output("N*m", at_least(0.0, "the springs are wound beyond the torque that their maker gives"))
def stock_torque_margin(m: Module) -> Scalar:
    """Largest torque that the maker of the stock spring gives, less that at full winding. Zero without."""
    return m.stock_spring.value("largest_torque") - m.spring_rate * m.spring_winding
