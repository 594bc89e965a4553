"""Where the rotor plate stands in the shear module: on the PCL layer, which lies on the floor."""

from __future__ import annotations

from tvimdesign.device.core.layout import quantities as shared
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup

quantities = QuantityGroup(shared.group)


@quantities.output("mm", hidden=True)
def rotor_bottom_level(m: Module) -> Scalar:
    """Lower face of the rotor plate, which lies on the layer."""
    return m.pcl_thickness


@quantities.helper()
def pcl_depth(m: Module) -> Scalar:
    """Way of heat and load through the PCL [m]."""
    return m.pcl_thickness
