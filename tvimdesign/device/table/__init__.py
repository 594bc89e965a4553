"""The table: kinds of quantities, their definition in a file, and the phases of the working cycle."""

from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Feature, Scalar, at_least, at_most
from tvimdesign.device.table.quantity_group import QuantityGroup

__all__ = ["Feature", "Module", "QuantityGroup", "Scalar", "at_least", "at_most"]
